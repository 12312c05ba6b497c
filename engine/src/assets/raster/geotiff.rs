//! `GeoTIFF`: TIFF with where it lies. Source: OGC `GeoTIFF` 1.1 (OGC 19-008r4).

use std::fs::File;
use std::io::{BufReader, Seek};
use std::path::Path;

use glam::DVec2;
use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::{PlanarConfiguration, Tag};

use super::directory::{self, PhotometricPatch};
use super::geokeys::GeoKeys;
use super::metadata::{BandItems, BandMetadata};
use super::window::CellWindow;
use super::{
    BandRaster, MOST_CELLS, Raster, RasterBand, RasterError, RasterExtent, RasterGeoreference,
    length, parse_no_data, sidecar,
};
use crate::files;

type Tiff = Decoder<BufReader<PhotometricPatch<File>>>;

/// Samples beside those that are shown: 1 and 2 are opacities.
const EXTRA_SAMPLES: Tag = Tag::ExtraSamples;

fn wrong(error: TiffError) -> RasterError {
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

pub(super) fn read(
    path: &Path,
    file: File,
    extent: Option<&RasterExtent>,
) -> Result<Raster, RasterError> {
    let Opened { mut tiff, length, mask } = open(file)?;
    let (columns, rows) = tiff.dimensions().map_err(wrong)?;
    let (columns, rows) = (u64::from(columns), u64::from(rows));
    let picture = TiffPicture::new(&mut tiff)?;
    let is_masked = picture.check()?;
    claimed_bytes(&mut tiff, columns, rows, length)?;
    let place = match place(&mut tiff, columns as f64, rows as f64)? {
        None => sidecar::world(path, rows as f64)?,
        place => place,
    };
    let (auxiliary, crs) = sidecar::auxiliary(path)?;
    let place = place.map(|place| match crs {
        Some(crs) if place.crs.name.is_empty() => RasterGeoreference { crs, ..place },
        _ => place,
    });
    let band = band(&mut tiff)?.or(auxiliary);
    let (window, place) = CellWindow::new(columns, rows, place.as_ref(), extent)?;
    let mut values = picture.read(&mut tiff, &window, 0)?;
    let assumed = band.apply(&mut values);
    if is_masked {
        hide(&mut values, &picture.read(&mut tiff, &window, 1)?);
    }
    if let Some(index) = mask {
        tiff.seek_to_image(index).map_err(wrong)?;
        hide(&mut values, &TiffPicture::new(&mut tiff)?.read(&mut tiff, &window, 0)?);
    }
    if let Some(file) = sidecar::mask(path) {
        let bad = || RasterError::BadMask { columns, rows };
        let Opened { mut tiff, .. } = open(files::open(&file).map_err(|_unreadable| bad())?)?;
        let (width, height) = tiff.dimensions().map_err(wrong)?;
        if (u64::from(width), u64::from(height)) != (columns, rows) {
            return Err(bad());
        }
        hide(&mut values, &TiffPicture::new(&mut tiff)?.read(&mut tiff, &window, 0)?);
    }
    let heights = band.heights(place.as_ref().and_then(|place| place.crs.heights.as_ref()))?;
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
    let metadata = band(&mut tiff)?;
    let items = BandItems::from_tag(&text_of(&mut tiff, METADATA)?.unwrap_or_default());
    let description = text_of(&mut tiff, Tag::ImageDescription)?.unwrap_or_default();
    let (window, place) = CellWindow::new(columns, rows, place.as_ref(), None)?;
    let mut bands = Vec::new();
    for sample in 0..usize::from(picture.samples) {
        let mut values = picture.read(&mut tiff, &window, sample)?;
        metadata.apply(&mut values);
        bands.push(RasterBand {
            name: items.name(sample).unwrap_or_else(|| format!("band {}", sample + 1)),
            wavelength_nm: items.wavelength_nm(sample),
            values: values.into_iter().map(|value| value as f32).collect(),
        });
    }
    let (columns, rows) = (window.columns.len(), window.rows.len());
    Ok(BandRaster { columns, rows, bands, description, place })
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

/// Reads the metadata of the first band.
fn band(tiff: &mut Tiff) -> Result<BandMetadata, RasterError> {
    let band = BandMetadata::from_tag(&text_of(tiff, METADATA)?.unwrap_or_default())?;
    let no_data =
        text_of(tiff, Tag::GdalNodata)?.filter(|text| !text.trim_matches(['\0', ' ']).is_empty());
    let no_data = no_data.map(|text| {
        parse_no_data(&text).ok_or(RasterError::BadMetadata { what: "NODATA", found: text })
    });
    Ok(BandMetadata { no_data: no_data.transpose()?, ..band })
}

/// Layout of the samples of a picture in its strips or tiles.
struct TiffPicture {
    bits: u16,
    samples: u16,
    is_planar: bool,
    /// True if the last sample is a mask.
    has_mask: bool,
    /// Cells from strip to strip or tile to tile.
    chunk: (usize, usize),
    columns: usize,
}

impl TiffPicture {
    fn new(tiff: &mut Tiff) -> Result<Self, RasterError> {
        let mut number = |tag: Tag, default: u16| {
            let value = tiff.find_tag_unsigned_vec::<u16>(tag).map_err(wrong)?;
            Ok::<_, RasterError>(value.and_then(|all| all.last().copied()).unwrap_or(default))
        };
        let samples = number(Tag::SamplesPerPixel, 1)?;
        let bits = number(Tag::BitsPerSample, 1)?;
        let planar = number(Tag::PlanarConfiguration, 1)?;
        let has_mask = matches!(number(EXTRA_SAMPLES, 0)?, 1 | 2) && samples > 1;
        let (columns, _) = tiff.dimensions().map_err(wrong)?;
        let (width, height) = tiff.chunk_dimensions();
        Ok(Self {
            bits,
            samples,
            is_planar: planar == PlanarConfiguration::Planar.to_u16(),
            has_mask,
            chunk: (width as usize, height as usize),
            columns: columns as usize,
        })
    }

    /// Refuses what holds no one band; returns whether its second sample is a mask.
    fn check(&self) -> Result<bool, RasterError> {
        match (self.samples, self.has_mask) {
            (1, _) | (2, true) => {}
            (samples, true) => return Err(RasterError::BandsWithMask(samples)),
            (samples, false) => return Err(RasterError::Bands(samples)),
        }
        if self.bits < 8 {
            return Err(RasterError::Bits(self.bits));
        }
        Ok(self.samples == 2)
    }

    /// One sample of the cells of a window; only the strips and tiles that it reaches are decoded.
    fn read(
        &self,
        tiff: &mut Tiff,
        window: &CellWindow,
        sample: usize,
    ) -> Result<Vec<f64>, RasterError> {
        let (width, height) = self.chunk;
        let across = self.columns.div_ceil(width.max(1));
        let down = tiff.dimensions().map_err(wrong)?.1 as usize;
        let down = down.div_ceil(height.max(1));
        let (first, step) = if self.is_planar {
            (sample * across * down, 1)
        } else {
            (0, usize::from(self.samples))
        };
        let offset = if self.is_planar { 0 } else { sample };
        let mut values = vec![f64::NAN; window.len()];
        for chunk_row in window.rows.start / height..=(window.rows.end - 1) / height {
            for chunk_column in window.columns.start / width..=(window.columns.end - 1) / width {
                let index = (first + chunk_row * across + chunk_column) as u32;
                let chunk = tiff.read_chunk(index).map_err(wrong)?;
                let (held, _) = tiff.chunk_data_dimensions(index);
                let held = held as usize;
                let chunk = self.numbers(chunk, held * step);
                let rows = chunk_row * height..((chunk_row + 1) * height).min(window.rows.end);
                for row in rows.filter(|row| window.rows.contains(row)) {
                    let start = (chunk_column * width).max(window.columns.start);
                    let end = (chunk_column * width + held).min(window.columns.end);
                    let line = (row - window.rows.start) * window.columns.len();
                    for column in start..end {
                        let inside =
                            (row - chunk_row * height) * held + column - chunk_column * width;
                        let to = line + column - window.columns.start;
                        values[to] = chunk.get(inside * step + offset).copied().unwrap_or(f64::NAN);
                    }
                }
            }
        }
        Ok(values)
    }

    /// Numbers of a chunk whose rows hold so many; those of less than a byte are unpacked.
    fn numbers(&self, chunk: DecodingResult, in_row: usize) -> Vec<f64> {
        let DecodingResult::U8(bytes) = chunk else { return numbers(chunk) };
        if self.bits >= 8 {
            return bytes.into_iter().map(f64::from).collect();
        }
        let bits = usize::from(self.bits);
        let stride = (in_row * bits).div_ceil(8).max(1);
        let most = (1_u16 << bits) - 1;
        let number = |row: &[u8], index: usize| {
            let (byte, bit) = (index * bits / 8, index * bits % 8);
            // The first value stands in the highest bits.
            f64::from(u16::from(row[byte]) >> (8 - bits - bit) & most)
        };
        let rows = bytes.chunks_exact(stride);
        rows.flat_map(|row| (0..in_row).map(move |index| number(row, index))).collect()
    }
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

fn numbers(image: DecodingResult) -> Vec<f64> {
    fn of<T: Into<f64>>(values: Vec<T>) -> Vec<f64> {
        values.into_iter().map(Into::into).collect()
    }
    match image {
        DecodingResult::U8(values) => of(values),
        DecodingResult::U16(values) => of(values),
        DecodingResult::U32(values) => of(values),
        DecodingResult::U64(values) => values.into_iter().map(|value| value as f64).collect(),
        DecodingResult::I8(values) => of(values),
        DecodingResult::I16(values) => of(values),
        DecodingResult::I32(values) => of(values),
        DecodingResult::I64(values) => values.into_iter().map(|value| value as f64).collect(),
        DecodingResult::F16(values) => values.into_iter().map(f64::from).collect(),
        DecodingResult::F32(values) => of(values),
        DecodingResult::F64(values) => values,
    }
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
