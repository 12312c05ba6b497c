//! Raw values of a file beside a header: where they lie and what they are.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use super::layers::{BandDescription, FileLayout, SampleReader};
use super::metadata::BandMetadata;
use super::window::CellWindow;
use super::{Raster, RasterError, RasterExtent, RasterGeoreference, length};
use crate::files;

/// Order of values of several bands.
#[derive(Clone, Copy, Debug)]
pub(super) enum Interleave {
    Bands,
    Lines,
    Pixels,
}

/// Type of a value.
#[derive(Clone, Copy, Debug)]
pub(super) enum SampleType {
    Unsigned,
    Signed,
    Real,
}

/// Layout of the values in a file.
#[derive(Clone, Debug)]
pub(super) struct SampleLayout {
    pub(super) columns: u64,
    pub(super) rows: u64,
    pub(super) bands: u64,
    pub(super) offset: u64,
    pub(super) interleave: Interleave,
    pub(super) kind: SampleType,
    /// Bytes of a value.
    pub(super) size: u64,
    pub(super) is_big: bool,
}

/// Values beside a header that are read strip by strip.
pub(super) struct RawReader {
    pub(super) file: PathBuf,
    pub(super) layout: SampleLayout,
    pub(super) place: Option<RasterGeoreference>,
    pub(super) bands: Vec<BandDescription>,
}

impl RawReader {
    /// The first band, with its metadata.
    pub(super) fn first_band(
        &self,
        band: &BandMetadata,
        extent: Option<&RasterExtent>,
    ) -> Result<Raster, RasterError> {
        let Self { file, layout, place, .. } = self;
        let (window, place) = CellWindow::new(layout.columns, layout.rows, place.as_ref(), extent)?;
        let mut values = layout.read(file, &window, 0)?;
        let assumed = band.apply(&mut values);
        let heights = band.heights(place.as_ref().and_then(|place| place.crs.heights.as_ref()))?;
        let (columns, rows) = (window.columns.len(), window.rows.len());
        Ok(Raster { columns, rows, values, place, class_names: Vec::new(), heights, assumed })
    }
}

impl SampleReader for RawReader {
    fn layout(&self) -> FileLayout<'_> {
        let SampleLayout { columns, rows, .. } = self.layout;
        FileLayout { columns, rows, place: self.place.as_ref() }
    }

    fn bands(&self) -> &[BandDescription] {
        &self.bands
    }

    fn rows_at_once(&self) -> usize {
        1
    }

    fn read(
        &mut self,
        strip: &CellWindow,
        bands: &[usize],
        values: &mut [Vec<f64>],
    ) -> Result<(), RasterError> {
        for (&band, values) in bands.iter().zip(values) {
            *values = self.layout.read(&self.file, strip, band as u64)?;
        }
        Ok(())
    }
}

impl SampleLayout {
    /// Values of the cells of a window in a band, which is counted from 0.
    pub(super) fn read(
        &self,
        path: &Path,
        window: &CellWindow,
        band: u64,
    ) -> Result<Vec<f64>, RasterError> {
        let Self { columns, rows, bands, offset, size, .. } = *self;
        let mut file = self.open(path)?;
        // Values from one of the band to the next in a row, from row to row, and before the first of the band.
        let (step, stride, before) = match self.interleave {
            Interleave::Bands => (1, columns, band * columns * rows),
            Interleave::Lines => (1, columns * bands, band * columns),
            Interleave::Pixels => (bands, columns * bands, band),
        };
        let first = before + window.columns.start as u64 * step;
        let count = (window.columns.len() as u64 - 1) * step + 1;
        let mut bytes = vec![0; (count * size) as usize];
        let mut values = Vec::with_capacity(window.len());
        let unreadable = |cause: std::io::Error| RasterError::Unreadable(cause.to_string());
        for row in window.rows.clone() {
            let start = offset + (row as u64 * stride + first) * size;
            file.seek(SeekFrom::Start(start)).map_err(unreadable)?;
            file.read_exact(&mut bytes).map_err(unreadable)?;
            let pixels = bytes.chunks((step * size) as usize);
            values.extend(pixels.map(|pixel| self.number(&pixel[..size as usize])));
        }
        Ok(values)
    }

    /// Opens a file that holds all the values.
    pub(super) fn open(&self, path: &Path) -> Result<File, RasterError> {
        let Self { columns, rows, bands, offset, size, .. } = *self;
        let file = files::open(path)
            .map_err(|_unreadable| RasterError::NoValues(path.display().to_string()))?;
        let needed = columns
            .checked_mul(rows)
            .and_then(|count| count.checked_mul(size))
            .and_then(|bytes| bytes.checked_mul(bands))
            .and_then(|bytes| bytes.checked_add(offset));
        let found = length(&file);
        if needed.is_none_or(|needed| needed > found) {
            let needed = needed.unwrap_or(u64::MAX);
            return Err(RasterError::TooShort { columns, rows, needed, found });
        }
        Ok(file)
    }

    fn number(&self, raw: &[u8]) -> f64 {
        // The bytes in little-endian order, the least first.
        let mut bytes = [0; 8];
        for (index, &byte) in raw.iter().enumerate() {
            bytes[if self.is_big { raw.len() - 1 - index } else { index }] = byte;
        }
        let whole = u64::from_le_bytes(bytes);
        let unused = 64 - 8 * raw.len() as u32;
        match self.kind {
            SampleType::Unsigned => whole as f64,
            SampleType::Signed => ((whole << unused) as i64 >> unused) as f64,
            SampleType::Real if raw.len() == 4 => f64::from(f32::from_bits(whole as u32)),
            SampleType::Real => f64::from_bits(whole),
        }
    }
}
