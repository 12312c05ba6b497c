//! ENVI rasters: raw values beside a text header.

use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::crs::{Axes, Crs, Length, UtmZone, from_wkt};
use super::super::error::excerpt;
use super::layers::BandDescription;
use super::metadata::BandMetadata;
use super::names::{headers, values};
use super::raw::{Interleave, RawReader, SampleLayout, SampleType};
use super::window::CellWindow;
use super::{
    BandRaster, Projection, Raster, RasterBand, RasterError, RasterExtent, RasterGeoreference,
    parse_no_data, sidecar,
};
use crate::files;

/// Longest header, bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// The header of an ENVI raster, which may be the named file itself.
pub(super) fn header_of(path: &Path, start: &[u8]) -> Option<PathBuf> {
    if is_envi(start) {
        return Some(path.to_owned());
    }
    headers(path).into_iter().find(|header| header != path && is_header(header))
}

/// Returns whether a file starts as an ENVI header does, be it with the mark of UTF-8 text.
fn is_envi(start: &[u8]) -> bool {
    start.strip_prefix(b"\xef\xbb\xbf").unwrap_or(start).starts_with(b"ENVI")
}

fn is_header(path: &Path) -> bool {
    let mut start = Vec::new();
    files::open(path).and_then(|file| file.take(7).read_to_end(&mut start)).is_ok()
        && is_envi(&start)
}

/// The values that belong to a header which was named itself.
pub(super) fn values_of(header: &Path) -> Result<PathBuf, RasterError> {
    let (mut found, tried) = values(header);
    match found.len() {
        0 => Err(RasterError::NoValues(tried.join(", "))),
        1 => Ok(found.remove(0)),
        _ => {
            let names = found.iter().filter_map(|path| path.file_name());
            let names: Vec<_> = names.map(|name| name.to_string_lossy()).collect();
            Err(RasterError::ManyValues(names.join(", ")))
        }
    }
}

/// `key = value` entries of a header; values in braces may go over several lines.
pub(super) struct EnviHeader {
    name: String,
    entries: Vec<(String, String)>,
}

impl EnviHeader {
    pub(super) fn read(path: &Path) -> Result<Self, RasterError> {
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let mut bytes = Vec::new();
        let read = files::open(path).and_then(|f| f.take(LONGEST_HEADER).read_to_end(&mut bytes));
        read.map_err(|_unreadable| RasterError::NoHeader(name.clone()))?;
        let text = String::from_utf8_lossy(&bytes);
        if text.contains('\0') {
            return Err(RasterError::Utf16);
        }
        let mut entries = Vec::new();
        let mut lines = text.lines().skip(1);
        while let Some(line) = lines.next() {
            let Some((key, value)) = line.split_once('=') else { continue };
            let mut value = value.trim().to_owned();
            let mut is_open = value.starts_with('{') && !value.contains('}');
            while is_open {
                let Some(more) = lines.next() else { break };
                is_open = !more.contains('}');
                value.push(' ');
                value.push_str(more.trim());
            }
            let value = value.trim_start_matches('{').split('}').next().unwrap_or_default();
            let key = key.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
            entries.push((key, value.trim().to_owned()));
        }
        Ok(Self { name, entries })
    }

    /// Entry with a key in small letters.
    pub(super) fn get(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    /// Name of its file.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    fn error(&self, problem: String) -> RasterError {
        RasterError::Envi { header: self.name.clone(), problem }
    }

    /// A whole number; the default where nothing is written.
    fn whole(&self, key: &str, default: Option<u64>) -> Result<u64, RasterError> {
        match (self.get(key), default) {
            (Some(text), _) => text.parse().map_err(|_invalid| {
                let found = excerpt(text);
                self.error(format!("says `{key} = {found}`; write a whole number"))
            }),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(self.error(format!("has no `{key}`; add a line `{key} = 100`"))),
        }
    }

    fn place(&self, rows: u64) -> Result<Option<RasterGeoreference>, RasterError> {
        let Some(text) = self.get("map info") else { return Ok(None) };
        let items: Vec<&str> = text.split(',').map(str::trim).collect();
        let numbers: Vec<f64> =
            items.iter().skip(1).take(6).map_while(|item| item.parse().ok()).collect();
        let &[column, row, east, north, width, height] = numbers.as_slice() else {
            let problem = "has a `map info` without six numbers behind its name; write, for \
                           example, `map info = {Arbitrary, 1, 1, 500000, 4000000, 10, 10}`";
            return Err(self.error(problem.to_owned()));
        };
        let rest = &items[7..];
        let rotated = rest.iter().filter_map(|item| item.split_once('=')).any(|(key, value)| {
            key.trim() == "rotation" && value.trim().parse::<f64>().is_ok_and(|angle| angle != 0.0)
        });
        if rotated {
            return Err(RasterError::Rotated);
        }
        let units = rest.iter().find_map(|item| item.split_once('='));
        let units = units.map(|(_, unit)| unit.trim().to_lowercase());
        let is_geographic = items[0].to_lowercase().starts_with("geographic");
        let axes = match units.as_deref() {
            Some("degrees") => Axes::Degrees,
            _ if is_geographic => Axes::Degrees,
            Some(unit) => match Length::from_name(unit) {
                Some(unit) if unit.is_metre() => Axes::Metres,
                Some(unit) => Axes::Length(unit),
                None => Axes::Length(Length { name: unit.to_owned(), metres: f64::NAN }),
            },
            None if items[0].eq_ignore_ascii_case("UTM") => Axes::Metres,
            None => Axes::Unknown,
        };
        let named: Vec<&str> =
            rest.iter().take_while(|item| !item.contains('=')).copied().collect();
        let is_named = !is_geographic && !items[0].eq_ignore_ascii_case("arbitrary");
        let crs = self.crs(items[0], &named, axes);
        let projection = is_named.then(|| Projection {
            name: items[0].to_owned(),
            rest: named.join(", "),
            epsg: crs.code,
            wkt: self.get("coordinate system string").map(str::to_owned),
        });
        // Pixel (1, 1) is the outer corner of the first pixel, (1.5, 1.5) its centre.
        let corner = DVec2::new(
            east - (column - 1.0) * width,
            north + (row - 1.0) * height - rows as f64 * height,
        );
        Ok(Some(RasterGeoreference { corner, cell: DVec2::new(width, height), crs, projection }))
    }

    /// The system that a `map info` and the well-known text beside it name.
    fn crs(&self, name: &str, rest: &[&str], axes: Axes) -> Crs {
        let is_south = |text: &&str| text.eq_ignore_ascii_case("south");
        let zone = rest.first().and_then(|zone| zone.parse::<u8>().ok());
        let zone = zone.filter(|zone| (1..=60).contains(zone));
        let mut crs = match zone {
            Some(number) if name.eq_ignore_ascii_case("UTM") => {
                let zone = UtmZone { number, is_south: rest.iter().any(is_south) };
                Crs::of_utm(zone, rest.get(2).copied())
            }
            _ if name.eq_ignore_ascii_case("arbitrary") => Crs::named(""),
            _ => Crs::named(name),
        };
        crs.axes = axes;
        let Some(text) = self.get("coordinate system string").and_then(from_wkt) else {
            return crs;
        };
        // Where both say something, the unit of `map info` is that of its own numbers.
        let is_of_text = crs.axes == Axes::Unknown || text.axes == Axes::World;
        let axes = if is_of_text { text.axes.clone() } else { crs.axes.clone() };
        let is_bare = crs.name.is_empty() || crs.utm.is_none();
        let (utm, datum) = (crs.utm.or(text.utm), crs.datum.clone().or(text.datum.clone()));
        let named =
            if is_bare { text } else { Crs { heights: text.heights, wkt: text.wkt, ..crs } };
        Crs { axes, utm, datum, ..named }
    }
}

/// Reads the first band.
pub(super) fn read(
    named: &Path,
    header_path: &Path,
    extent: Option<&RasterExtent>,
) -> Result<Raster, RasterError> {
    let (header, reader) = open(named, header_path)?;
    let (auxiliary, _) = sidecar::auxiliary(&reader.file, 0)?;
    let raster = reader.first_band(&header.band(0)?.or(auxiliary), extent)?;
    let class_names = header.get("class names").map_or_else(Vec::new, |names| {
        names.split(',').map(|name| name.trim().to_owned()).collect()
    });
    Ok(Raster { class_names, ..raster })
}

/// Reads all bands.
pub(super) fn read_bands(named: &Path, header_path: &Path) -> Result<BandRaster, RasterError> {
    let (header, RawReader { file, layout, .. }) = open(named, header_path)?;
    let place = header.place(layout.rows)?;
    let (window, place) = CellWindow::new(layout.columns, layout.rows, place.as_ref(), None)?;
    let mut bands = Vec::new();
    for (index, band) in header.bands(&layout)?.into_iter().enumerate() {
        let mut values = layout.read(&file, &window, index as u64)?;
        band.metadata.apply(&mut values);
        bands.push(RasterBand {
            name: band.name.unwrap_or_else(|| format!("band {}", index + 1)),
            wavelength_nm: band.wavelength_nm,
            values: values.into_iter().map(|value| value as f32).collect(),
        });
    }
    let description = header.get("description").unwrap_or_default().to_owned();
    let (columns, rows) = (window.columns.len(), window.rows.len());
    Ok(BandRaster { columns, rows, bands, description, place })
}

/// Opens a raster whose values are read strip by strip.
pub(super) fn reader(named: &Path, header_path: &Path) -> Result<RawReader, RasterError> {
    let (header, reader) = open(named, header_path)?;
    reader.layout.open(&reader.file)?;
    let mut bands = header.bands(&reader.layout)?;
    for (index, band) in bands.iter_mut().enumerate() {
        let (auxiliary, _) = sidecar::auxiliary(&reader.file, index)?;
        let metadata = std::mem::take(&mut band.metadata).or(auxiliary);
        band.metadata =
            BandMetadata { scale: metadata.scale.or(header.reflectance_scale()?), ..metadata };
    }
    Ok(RawReader { bands, ..reader })
}

/// Header and values of a raster, whose bands are not described yet.
fn open(named: &Path, header_path: &Path) -> Result<(EnviHeader, RawReader), RasterError> {
    let header = EnviHeader::read(header_path)?;
    let file = if named == header_path { values_of(header_path)? } else { named.to_owned() };
    let layout = header.layout()?;
    let (_, crs) = sidecar::auxiliary(&file, 0)?;
    let place = header.place(layout.rows)?.map(|place| place.or_in(crs));
    Ok((header, RawReader { file, layout, place, bands: Vec::new() }))
}

impl EnviHeader {
    pub(super) fn layout(&self) -> Result<SampleLayout, RasterError> {
        let (columns, rows) = (self.whole("samples", None)?, self.whole("lines", None)?);
        let (kind, size) = match self.whole("data type", None)? {
            1 => (SampleType::Unsigned, 1),
            2 => (SampleType::Signed, 2),
            3 => (SampleType::Signed, 4),
            4 => (SampleType::Real, 4),
            5 => (SampleType::Real, 8),
            12 => (SampleType::Unsigned, 2),
            13 => (SampleType::Unsigned, 4),
            14 => (SampleType::Signed, 8),
            15 => (SampleType::Unsigned, 8),
            other => {
                return Err(self.error(format!(
                    "says `data type = {other}`; use 1 to 5 or 12 to 15, whole or real numbers"
                )));
            }
        };
        let is_big = match self.whole("byte order", Some(0))? {
            0 => false,
            1 => true,
            other => return Err(self.error(format!("says `byte order = {other}`; write 0 or 1"))),
        };
        let interleave = self.get("interleave").unwrap_or("bsq").to_lowercase();
        let interleave = match interleave.as_str() {
            "bsq" => Interleave::Bands,
            "bil" => Interleave::Lines,
            "bip" => Interleave::Pixels,
            other => {
                let found = excerpt(other);
                let problem = format!("says `interleave = {found}`; write bsq, bil or bip");
                return Err(self.error(problem));
            }
        };
        if self.whole("file compression", Some(0))? != 0 {
            let problem = "says that the values are compressed; write them plainly \
                           (gdal_translate -of ENVI)";
            return Err(self.error(problem.to_owned()));
        }
        Ok(SampleLayout {
            columns,
            rows,
            bands: self.whole("bands", Some(1))?.max(1),
            offset: self.whole("header offset", Some(0))?,
            interleave,
            kind,
            size,
            is_big,
        })
    }

    /// Names, wavelengths and metadata of all bands.
    fn bands(&self, layout: &SampleLayout) -> Result<Vec<BandDescription>, RasterError> {
        let list = |key: &str| -> Vec<&str> {
            self.get(key).map_or_else(Vec::new, |text| text.split(',').map(str::trim).collect())
        };
        let (names, wavelengths) = (list("band names"), list("wavelength"));
        let nm = match self.get("wavelength units").map(str::to_lowercase).as_deref() {
            Some("micrometers" | "um") => 1000.0,
            // Programs that write no unit write nanometres.
            None | Some("nanometers" | "nm" | "unknown") => 1.0,
            Some(_) => f64::NAN,
        };
        let describe = |index: usize| {
            let wavelength = wavelengths.get(index).and_then(|text| text.parse::<f64>().ok());
            Ok(BandDescription {
                name: names.get(index).map(|&name| name.to_owned()),
                wavelength_nm: wavelength.map(|one| one * nm).filter(|nm| nm.is_finite()),
                metadata: self.band(index)?,
            })
        };
        (0..layout.bands as usize).map(describe).collect()
    }

    /// Factor that makes fractions of the values, 1 / `reflectance scale factor`.
    fn reflectance_scale(&self) -> Result<Option<f64>, RasterError> {
        let Some(text) = self.get("reflectance scale factor") else { return Ok(None) };
        let factor = text.parse().ok().filter(|factor: &f64| factor.is_finite() && *factor > 0.0);
        let found = excerpt(text);
        let problem = format!("says `reflectance scale factor = {found}`; write a number above 0");
        factor.map(|factor| Some(1.0 / factor)).ok_or_else(|| self.error(problem))
    }

    /// Scale, offset and value for no data of a band, which is counted from 0.
    fn band(&self, index: usize) -> Result<BandMetadata, RasterError> {
        let wrong = |key: &str, text: &str| {
            let found = excerpt(text);
            self.error(format!("says `{key} = {found}`; write a number"))
        };
        let no_data = match self.get("data ignore value") {
            None => None,
            Some(text) => {
                let value = parse_no_data(text);
                Some(value.ok_or_else(|| wrong("data ignore value", text))?)
            }
        };
        let item_of = |key: &str| {
            let Some(text) = self.get(key) else { return Ok(None) };
            // One number holds for all bands.
            let items: Vec<&str> = text.split(',').map(str::trim).collect();
            let Some(item) = items.get(if items.len() == 1 { 0 } else { index }) else {
                return Ok(None);
            };
            let number: Option<f64> = item.parse().ok().filter(|number: &f64| number.is_finite());
            number.map(Some).ok_or_else(|| wrong(key, text))
        };
        let (scale, offset) = (item_of("data gain values")?, item_of("data offset values")?);
        let unit = self.get("data units").or_else(|| self.get("z units")).map(str::to_owned);
        Ok(BandMetadata { no_data, scale, offset, unit })
    }
}
