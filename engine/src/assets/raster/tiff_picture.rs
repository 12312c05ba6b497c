//! Samples of a picture of a TIFF, strip by strip or tile by tile.

use tiff::decoder::DecodingResult;
use tiff::tags::{PlanarConfiguration, Tag};

use super::RasterError;
use super::geotiff::{Tiff, wrong};
use super::window::CellWindow;

/// Samples beside those that are shown: 1 and 2 are opacities.
const EXTRA_SAMPLES: Tag = Tag::ExtraSamples;

/// Layout of the samples of a picture in its strips or tiles.
pub(super) struct TiffPicture {
    pub(super) bits: u16,
    pub(super) samples: u16,
    is_planar: bool,
    /// True if the last sample is a mask.
    pub(super) has_mask: bool,
    /// Cells from strip to strip or tile to tile.
    pub(super) chunk: (usize, usize),
    columns: usize,
}

impl TiffPicture {
    pub(super) fn new(tiff: &mut Tiff) -> Result<Self, RasterError> {
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

    /// Refuses what holds no one band.
    pub(super) fn check(&self) -> Result<(), RasterError> {
        match (self.samples, self.has_mask) {
            (1, _) | (2, true) => Ok(()),
            (samples, true) => Err(RasterError::BandsWithMask(samples)),
            (samples, false) => Err(RasterError::Bands(samples)),
        }
    }

    /// One sample of the cells of a window; only the strips and tiles that it reaches are decoded.
    pub(super) fn read(
        &self,
        tiff: &mut Tiff,
        window: &CellWindow,
        sample: usize,
    ) -> Result<Vec<f64>, RasterError> {
        let mut values = vec![Vec::new()];
        self.read_samples(tiff, window, &[sample], &mut values)?;
        Ok(values.remove(0))
    }

    /// Reads some samples of the cells of a window, shape `[samples, cells]`; each strip or tile that it reaches is
    /// decoded once.
    pub(super) fn read_samples(
        &self,
        tiff: &mut Tiff,
        window: &CellWindow,
        samples: &[usize],
        values: &mut [Vec<f64>],
    ) -> Result<(), RasterError> {
        let (width, height) = self.chunk;
        for values in values.iter_mut() {
            values.clear();
            values.resize(window.len(), f64::NAN);
        }
        for chunk_row in window.rows.start / height..=(window.rows.end - 1) / height {
            for chunk_column in window.columns.start / width..=(window.columns.end - 1) / width {
                let chunk = (chunk_column, chunk_row);
                if !self.is_planar {
                    self.read_chunk(tiff, window, chunk, samples, values)?;
                    continue;
                }
                for (sample, values) in samples.iter().zip(values.iter_mut()) {
                    let values = std::slice::from_mut(values);
                    self.read_chunk(tiff, window, chunk, &[*sample], values)?;
                }
            }
        }
        Ok(())
    }

    /// Reads samples of the cells of a strip or tile; only one of planes.
    fn read_chunk(
        &self,
        tiff: &mut Tiff,
        window: &CellWindow,
        (chunk_column, chunk_row): (usize, usize),
        samples: &[usize],
        values: &mut [Vec<f64>],
    ) -> Result<(), RasterError> {
        let (width, height) = self.chunk;
        let across = self.columns.div_ceil(width.max(1));
        let down = tiff.dimensions().map_err(wrong)?.1 as usize;
        let down = down.div_ceil(height.max(1));
        let (first, step) = if self.is_planar {
            (samples[0] * across * down, 1)
        } else {
            (0, usize::from(self.samples))
        };
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
            for (sample, values) in samples.iter().zip(values.iter_mut()) {
                let offset = if self.is_planar { 0 } else { *sample };
                for column in start..end {
                    let inside = (row - chunk_row * height) * held + column - chunk_column * width;
                    let to = line + column - window.columns.start;
                    values[to] = chunk.get(inside * step + offset).copied().unwrap_or(f64::NAN);
                }
            }
        }
        Ok(())
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
