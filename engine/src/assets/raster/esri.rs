//! Esri's binary rasters: values in `.bil`, `.bip`, `.bsq` or `.flt` beside a text header.
//! Source: Esri, "BIL, BIP, and BSQ raster files" and "Float to raster" (`ArcGIS` documentation).

use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::crs::Crs;
use super::super::error::excerpt;
use super::envi::values_of;
use super::layers::BandDescription;
use super::metadata::BandMetadata;
use super::names::{headers, split, without};
use super::raw::{Interleave, RawReader, SampleLayout, SampleType};
use super::{Raster, RasterError, RasterExtent, RasterGeoreference, parse_no_data, sidecar};
use crate::files;

/// Longest header, bytes.
const LONGEST_HEADER: u64 = 1 << 16;

/// Entries of a header: the key in lower case, and its value.
struct EsriHeader {
    name: String,
    entries: Vec<(String, String)>,
}

/// The header of one of Esri's binary rasters, which may be the named file itself.
pub(super) fn header_of(path: &Path) -> Option<PathBuf> {
    let is_header = without(&split(path).1, "hdr").is_some();
    let itself = is_header.then(|| path.to_owned());
    itself.into_iter().chain(headers(path)).find(|header| {
        EsriHeader::read(header)
            .is_some_and(|header| header.get("nrows").is_some() && header.get("ncols").is_some())
    })
}

impl EsriHeader {
    fn read(path: &Path) -> Option<Self> {
        let mut bytes = Vec::new();
        files::open(path).ok()?.take(LONGEST_HEADER).read_to_end(&mut bytes).ok()?;
        let text = String::from_utf8(bytes).ok()?;
        let lines = text.trim_start_matches('\u{feff}').lines();
        let entries = lines.filter_map(|line| {
            let (key, value) = line.trim().split_once(char::is_whitespace)?;
            Some((key.to_lowercase(), value.trim().to_owned()))
        });
        Some(Self { name: split(path).1, entries: entries.collect() })
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    fn wrong(&self, key: &str, found: &str, wanted: &str) -> RasterError {
        let problem = format!("says `{key} {}`; write {wanted}", excerpt(found));
        RasterError::Envi { header: self.name.clone(), problem }
    }

    fn whole(&self, key: &str, default: Option<u64>) -> Result<u64, RasterError> {
        match (self.get(key), default) {
            (Some(text), _) => {
                text.parse().map_err(|_invalid| self.wrong(key, text, "a whole number"))
            }
            (None, Some(default)) => Ok(default),
            (None, None) => {
                let problem = format!("has no `{key}`; add a line `{key} 100`");
                Err(RasterError::Envi { header: self.name.clone(), problem })
            }
        }
    }

    fn real(&self, key: &str) -> Result<Option<f64>, RasterError> {
        let Some(text) = self.get(key) else { return Ok(None) };
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.map(Some).ok_or_else(|| self.wrong(key, text, "a number"))
    }

    fn layout(&self, values: &Path) -> Result<SampleLayout, RasterError> {
        let is_float = without(&split(values).1, "flt").is_some();
        let bits = self.whole("nbits", Some(if is_float { 32 } else { 8 }))?;
        let pixel = self.get("pixeltype").unwrap_or(if is_float { "FLOAT" } else { "UNSIGNEDINT" });
        let kind = match (pixel.to_uppercase().as_str(), bits) {
            ("FLOAT", 32 | 64) => SampleType::Real,
            // Whole numbers of 16 bits and more are signed unless the header says otherwise.
            ("SIGNEDINT", 8 | 16 | 32 | 64) => SampleType::Signed,
            ("UNSIGNEDINT", 16 | 32) if self.get("pixeltype").is_none() => SampleType::Signed,
            ("UNSIGNEDINT", 8 | 16 | 32 | 64) => SampleType::Unsigned,
            _ => {
                let found = format!("{pixel}` with `nbits {bits}");
                let wanted = "SIGNEDINT, UNSIGNEDINT or FLOAT of 8 to 64 bits";
                return Err(self.wrong("pixeltype", &found, wanted));
            }
        };
        let order = self.get("byteorder").unwrap_or("I").to_uppercase();
        let is_big = match order.as_str() {
            "M" | "MSBFIRST" | "MOTOROLA" => true,
            "I" | "LSBFIRST" | "INTEL" | "VMS_FLOAT" => false,
            other => return Err(self.wrong("byteorder", other, "I or M")),
        };
        let interleave = match self.get("layout").unwrap_or("BIL").to_uppercase().as_str() {
            "BIL" => Interleave::Lines,
            "BIP" => Interleave::Pixels,
            "BSQ" => Interleave::Bands,
            other => return Err(self.wrong("layout", other, "BIL, BIP or BSQ")),
        };
        let columns = self.whole("ncols", None)?;
        let (size, bands) = (bits / 8, self.whole("nbands", Some(1))?.max(1));
        for (key, plain) in [
            ("bandrowbytes", columns.saturating_mul(size)),
            ("totalrowbytes", columns.saturating_mul(size).saturating_mul(bands)),
            ("bandgapbytes", 0),
        ] {
            let found = self.whole(key, Some(plain))?;
            if found != plain && found != 0 {
                return Err(self.wrong(
                    key,
                    &found.to_string(),
                    &format!("{plain}: rows without gaps"),
                ));
            }
        }
        Ok(SampleLayout {
            columns,
            rows: self.whole("nrows", None)?,
            bands,
            offset: self.whole("skipbytes", Some(0))?,
            interleave,
            kind,
            size,
            is_big,
        })
    }

    fn place(
        &self,
        rows: u64,
        crs: Option<Crs>,
    ) -> Result<Option<RasterGeoreference>, RasterError> {
        let size = self.real("cellsize")?;
        let (width, height) = (self.real("xdim")?.or(size), self.real("ydim")?.or(size));
        let (Some(width), Some(height)) = (width, height) else { return Ok(None) };
        let cell = DVec2::new(width, height);
        let side = |corner: &str, center: &str, cell: f64| {
            Ok(match (self.real(corner)?, self.real(center)?) {
                (Some(corner), _) => Some(corner),
                (None, center) => center.map(|center| center - 0.5 * cell),
            })
        };
        let lower =
            (side("xllcorner", "xllcenter", width)?, side("yllcorner", "yllcenter", height)?);
        // The upper left coordinates are the centre of the first cell.
        let upper = (self.real("ulxmap")?, self.real("ulymap")?);
        let corner = match (lower, upper) {
            ((Some(x), Some(y)), _) => DVec2::new(x, y),
            (_, (Some(x), Some(y))) => {
                DVec2::new(x - 0.5 * width, y + 0.5 * height - rows as f64 * height)
            }
            _ => return Ok(None),
        };
        let crs = crs.unwrap_or_else(|| Crs::named(""));
        Ok(Some(RasterGeoreference { corner, cell, crs, projection: None }))
    }
}

/// Reads the first band.
pub(super) fn read(
    path: &Path,
    header_path: &Path,
    extent: Option<&RasterExtent>,
) -> Result<Raster, RasterError> {
    let reader = reader(path, header_path)?;
    reader.first_band(&reader.bands[0].metadata, extent)
}

/// Opens a raster whose values are read strip by strip.
pub(super) fn reader(path: &Path, header_path: &Path) -> Result<RawReader, RasterError> {
    let file = if path == header_path { values_of(header_path)? } else { path.to_owned() };
    let unreadable = || RasterError::NoHeader(split(header_path).1);
    let header = EsriHeader::read(header_path).ok_or_else(unreadable)?;
    let layout = header.layout(&file)?;
    layout.open(&file)?;
    let (_, crs) = sidecar::auxiliary(&file, 0)?;
    let crs = sidecar::projection(&file)?.or(crs);
    let no_data = header
        .get("nodata")
        .or_else(|| header.get("nodata_value"))
        .map(|text| parse_no_data(text).ok_or_else(|| header.wrong("nodata", text, "a number")));
    let no_data = no_data.transpose()?;
    let describe = |index: usize| {
        let own = BandMetadata { no_data, ..BandMetadata::default() };
        let metadata = own.or(sidecar::auxiliary(&file, index)?.0);
        Ok(BandDescription { name: None, wavelength_nm: None, metadata })
    };
    let bands = (0..layout.bands as usize).map(describe).collect::<Result<_, RasterError>>()?;
    let place = header.place(layout.rows, crs)?;
    Ok(RawReader { file, layout, place, bands })
}
