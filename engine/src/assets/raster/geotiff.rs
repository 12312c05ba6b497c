//! `GeoTIFF`: TIFF with where it lies. Source: OGC `GeoTIFF` 1.1 (OGC 19-008r4).

use std::fs::File;
use std::io::{BufReader, Seek};
use std::path::Path;

use glam::DVec2;
use tiff::TiffError;
use tiff::decoder::{Decoder, Limits};
use tiff::tags::Tag;

use super::directory::{self, PhotometricPatch};
use super::geokeys::GeoKeys;
use super::layers::{BandDescription, FileLayout, SampleReader};
use super::metadata::{BandItems, BandMetadata};
use super::tiff_picture::TiffPicture;
use super::window::CellWindow;
use super::{
    BandRaster, MOST_CELLS, Raster, RasterBand, RasterError, RasterExtent, RasterGeoreference,
    length, parse_no_data, sidecar,
};
use crate::files;

pub(super) type Tiff = Decoder<BufReader<PhotometricPatch<File>>>;

pub(super) fn wrong(error: TiffError) -> RasterError {
    match error {
        TiffError::UnsupportedError(problem) => RasterError::Unsupported(problem.to_string()),
        error => RasterError::Tiff(error.to_string()),
    }
}

/// A file that can be decoded, and which of its pictures is the mask of the first.
struct Opened {
    tiff: Tiff,
    length: u64,
    mask: Option<usize>,
}

fn open(mut file: File) -> Result<Opened, RasterError> {
    let length = length(&file);
    let unreadable = |cause: std::io::Error| RasterError::Tiff(cause.to_string());
    let directories = directory::read(BufReader::new(&mut file), length)?;
    file.rewind().map_err(unreadable)?;
    let first = directories[0];
    let mask = directories.iter().position(|directory| directory.is_mask_of(&first));
    let shown = PhotometricPatch::new(file, &directories).map_err(unreadable)?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MOST_CELLS as usize;
    let tiff = Tiff::new(BufReader::new(shown)).map_err(wrong)?.with_limits(limits);
    Ok(Opened { tiff, length, mask })
}

/// Reads the only band.
pub(super) fn read(path: &Path, extent: Option<&RasterExtent>) -> Result<Raster, RasterError> {
    let mut reader = TiffReader::new(path)?;
    reader.picture.1.check()?;
    let TiffReader { columns, rows, place, .. } = &reader;
    let (window, place) = CellWindow::new(*columns, *rows, place.as_ref(), extent)?;
    let (tiff, picture) = &mut reader.picture;
    let mut values = picture.read(tiff, &window, 0)?;
    let band = &reader.bands[0].metadata;
    let assumed = band.apply(&mut values);
    let heights = band.heights(place.as_ref().and_then(|place| place.crs.heights.as_ref()))?;
    for mask in reader.masks(&window)? {
        hide(&mut values, &mask);
    }
    let (columns, rows) = (window.columns.len(), window.rows.len());
    Ok(Raster { columns, rows, values, place, class_names: Vec::new(), heights, assumed })
}

/// Reads all bands.
pub(super) fn read_bands(file: File) -> Result<BandRaster, RasterError> {
    let Opened { mut tiff, length, .. } = open(file)?;
    let (columns, rows) = tiff.dimensions().map_err(wrong)?;
    let (columns, rows) = (u64::from(columns), u64::from(rows));
    let picture = TiffPicture::new(&mut tiff)?;
    if picture.bits < 8 {
        return Err(RasterError::Bits(picture.bits));
    }
    claimed_bytes(&mut tiff, columns, rows, length)?;
    let place = place(&mut tiff, columns as f64, rows as f64)?;
    let items = BandItems::from_tag(&text_of(&mut tiff, METADATA)?.unwrap_or_default());
    let description = text_of(&mut tiff, Tag::ImageDescription)?.unwrap_or_default();
    let (window, place) = CellWindow::new(columns, rows, place.as_ref(), None)?;
    let mut bands = Vec::new();
    for sample in 0..usize::from(picture.samples) {
        let mut values = picture.read(&mut tiff, &window, sample)?;
        band(&mut tiff, sample)?.apply(&mut values);
        bands.push(RasterBand {
            name: items.name(sample).unwrap_or_else(|| format!("band {}", sample + 1)),
            wavelength_nm: items.wavelength_nm(sample),
            values: values.into_iter().map(|value| value as f32).collect(),
        });
    }
    let (columns, rows) = (window.columns.len(), window.rows.len());
    Ok(BandRaster { columns, rows, bands, description, place })
}

/// Georeference of a file, or of those beside it.
fn place_or_beside(
    tiff: &mut Tiff,
    path: &Path,
) -> Result<Option<RasterGeoreference>, RasterError> {
    let (columns, rows) = tiff.dimensions().map_err(wrong)?;
    let place = match place(tiff, columns.into(), rows.into())? {
        None => sidecar::world(path, rows.into())?,
        place => place,
    };
    let (_, crs) = sidecar::auxiliary(path, 0)?;
    Ok(place.map(|place| place.or_in(crs)))
}

/// A file whose samples are read strip by strip.
pub(super) struct TiffReader {
    picture: (Tiff, TiffPicture),
    /// Pictures whose cells of 0 have no data.
    masks: Vec<(Tiff, TiffPicture)>,
    pub(super) columns: u64,
    pub(super) rows: u64,
    pub(super) place: Option<RasterGeoreference>,
    pub(super) bands: Vec<BandDescription>,
}

impl TiffReader {
    /// Opens a file of any number of bands, with its masks.
    pub(super) fn new(path: &Path) -> Result<Self, RasterError> {
        let unreadable = |cause: std::io::Error| RasterError::Tiff(cause.to_string());
        let opened = || open(files::open(path).map_err(unreadable)?);
        let Opened { mut tiff, length, mask } = opened()?;
        let (columns, rows) = tiff.dimensions().map_err(wrong)?;
        let picture = TiffPicture::new(&mut tiff)?;
        if picture.bits < 8 {
            return Err(RasterError::Bits(picture.bits));
        }
        claimed_bytes(&mut tiff, columns.into(), rows.into(), length)?;
        let mut masks = Vec::new();
        if let Some(index) = mask {
            let mut tiff = opened()?.tiff;
            tiff.seek_to_image(index).map_err(wrong)?;
            let picture = TiffPicture::new(&mut tiff)?;
            masks.push((tiff, picture));
        }
        if let Some(file) = sidecar::mask(path) {
            let bad = || RasterError::BadMask { columns: columns.into(), rows: rows.into() };
            let Opened { mut tiff, .. } = open(files::open(&file).map_err(|_unreadable| bad())?)?;
            if tiff.dimensions().map_err(wrong)? != (columns, rows) {
                return Err(bad());
            }
            let picture = TiffPicture::new(&mut tiff)?;
            masks.push((tiff, picture));
        }
        let items = BandItems::from_tag(&text_of(&mut tiff, METADATA)?.unwrap_or_default());
        let describe = |sample: usize| {
            Ok(BandDescription {
                name: items.name(sample),
                wavelength_nm: items.wavelength_nm(sample),
                metadata: band(&mut tiff, sample)?.or(sidecar::auxiliary(path, sample)?.0),
            })
        };
        let samples = usize::from(picture.samples) - usize::from(picture.has_mask);
        let bands = (0..samples).map(describe).collect::<Result<_, RasterError>>()?;
        let place = place_or_beside(&mut tiff, path)?;
        let (columns, rows) = (columns.into(), rows.into());
        Ok(Self { picture: (tiff, picture), masks, columns, rows, place, bands })
    }

    /// Masks of the cells of a strip: cells of 0 have no data.
    fn masks(&mut self, strip: &CellWindow) -> Result<Vec<Vec<f64>>, RasterError> {
        let (tiff, picture) = &mut self.picture;
        let mut masks = Vec::new();
        if picture.has_mask {
            masks.push(picture.read(tiff, strip, usize::from(picture.samples) - 1)?);
        }
        for (tiff, picture) in &mut self.masks {
            masks.push(picture.read(tiff, strip, 0)?);
        }
        Ok(masks)
    }
}

impl SampleReader for TiffReader {
    fn layout(&self) -> FileLayout<'_> {
        let Self { columns, rows, place, .. } = self;
        FileLayout { columns: *columns, rows: *rows, place: place.as_ref() }
    }

    fn bands(&self) -> &[BandDescription] {
        &self.bands
    }

    fn rows_at_once(&self) -> usize {
        self.picture.1.chunk.1
    }

    fn read(
        &mut self,
        strip: &CellWindow,
        bands: &[usize],
        values: &mut [Vec<f64>],
    ) -> Result<(), RasterError> {
        let (tiff, picture) = &mut self.picture;
        picture.read_samples(tiff, strip, bands, values)?;
        let masks = self.masks(strip)?;
        for values in values {
            for mask in &masks {
                hide(values, mask);
            }
        }
        Ok(())
    }
}

/// Tag of GDAL's own description of bands.
const METADATA: Tag = Tag::Unknown(42112);

fn text_of(tiff: &mut Tiff, tag: Tag) -> Result<Option<String>, RasterError> {
    let value = tiff.find_tag(tag).map_err(wrong)?;
    Ok(value.and_then(|value| value.into_string().ok()))
}

/// Leaves out the cells whose mask is 0.
fn hide(values: &mut [f64], mask: &[f64]) {
    for (value, mask) in values.iter_mut().zip(mask) {
        if mask.abs() == 0.0 {
            *value = f64::NAN;
        }
    }
}

/// Reads the metadata of a band, which is counted from 0.
fn band(tiff: &mut Tiff, sample: usize) -> Result<BandMetadata, RasterError> {
    let band = BandMetadata::from_tag(&text_of(tiff, METADATA)?.unwrap_or_default(), sample)?;
    let no_data =
        text_of(tiff, Tag::GdalNodata)?.filter(|text| !text.trim_matches(['\0', ' ']).is_empty());
    let no_data = no_data.map(|text| {
        parse_no_data(&text).ok_or(RasterError::BadMetadata { what: "NODATA", found: text })
    });
    Ok(BandMetadata { no_data: no_data.transpose()?, ..band })
}

/// Refuses a file that is shorter than its own strips or tiles before any memory is asked for.
fn claimed_bytes(tiff: &mut Tiff, columns: u64, rows: u64, found: u64) -> Result<(), RasterError> {
    for tag in [Tag::StripByteCounts, Tag::TileByteCounts] {
        let Some(counts) = tiff.find_tag_unsigned_vec::<u64>(tag).map_err(wrong)? else { continue };
        if counts.contains(&0) {
            return Err(RasterError::Tiff(
                "it leaves out empty tiles or strips; write it whole (gdal_translate -co \
                 SPARSE_OK=FALSE)"
                    .to_owned(),
            ));
        }
        let needed = counts.iter().fold(0_u64, |sum, &count| sum.saturating_add(count));
        if needed > found {
            return Err(RasterError::TooShort { columns, rows, needed, found });
        }
    }
    Ok(())
}

fn reals(tiff: &mut Tiff, tag: Tag) -> Result<Option<Vec<f64>>, RasterError> {
    let value = tiff.find_tag(tag).map_err(wrong)?;
    value.map(|value| value.into_f64_vec().map_err(wrong)).transpose()
}

fn place(
    tiff: &mut Tiff,
    columns: f64,
    rows: f64,
) -> Result<Option<RasterGeoreference>, RasterError> {
    let scale = reals(tiff, Tag::ModelPixelScaleTag)?;
    let tie = reals(tiff, Tag::ModelTiepointTag)?;
    let map = reals(tiff, Tag::ModelTransformationTag)?;
    // World coordinates of the raster's point (0, 0), and the size of a cell.
    let (origin, cell) = match (scale.as_deref(), tie.as_deref(), map.as_deref()) {
        (Some(&[width, height, ..]), Some(&[column, row, _, x, y, ..]), _) => {
            let cell = DVec2::new(width, height);
            (DVec2::new(x - column * width, y + row * height), cell)
        }
        // GDAL writes this where it knows no place.
        (_, _, Some(&[1.0, 0.0, _, 0.0, 0.0, 1.0, _, 0.0, ..])) => return Ok(None),
        (_, _, Some(&[width, a, _, x, b, height, _, y, ..])) => {
            if a != 0.0 || b != 0.0 || height >= 0.0 {
                return Err(RasterError::Rotated);
            }
            (DVec2::new(x, y), DVec2::new(width, -height))
        }
        _ => return Ok(None),
    };
    let text = tiff.find_tag(Tag::GeoAsciiParamsTag).map_err(wrong)?;
    let keys = GeoKeys {
        directory: tiff
            .find_tag_unsigned_vec(Tag::GeoKeyDirectoryTag)
            .map_err(wrong)?
            .unwrap_or_default(),
        reals: reals(tiff, Tag::GeoDoubleParamsTag)?.unwrap_or_default(),
        texts: text.and_then(|text| text.into_string().ok()).unwrap_or_default(),
    };
    // A raster of points has its origin in the middle of the first cell.
    let shift = if keys.is_point() { 0.5 } else { 0.0 };
    let north_west = origin + DVec2::new(-shift, shift) * cell;
    let corner = DVec2::new(north_west.x, north_west.y - rows * cell.y);
    if !(columns * cell.x).is_finite() {
        return Err(RasterError::BadCell { width: cell.x, height: cell.y });
    }
    Ok(Some(RasterGeoreference { corner, cell, crs: keys.crs(), projection: None }))
}
