//! Parts of rasters: which cells a rectangle of their coordinates reaches.

use std::ops::Range;

use glam::DVec2;

use super::{RasterError, RasterGeoreference, cells};

/// Rectangle in the coordinates of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterExtent {
    /// South-west corner, in the unit of the file's coordinates.
    pub min: DVec2,
    /// North-east corner, in the same unit.
    pub max: DVec2,
}

/// Cells that are read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CellWindow {
    pub(super) columns: Range<usize>,
    pub(super) rows: Range<usize>,
}

impl CellWindow {
    /// Cells that an extent reaches, and where they lie; all of them without an extent.
    pub(super) fn new(
        columns: u64,
        rows: u64,
        place: Option<&RasterGeoreference>,
        extent: Option<&RasterExtent>,
    ) -> Result<(Self, Option<RasterGeoreference>), RasterError> {
        let (window, place) = Self::of_any_size(columns, rows, place, extent)?;
        cells(window.columns.len() as u64, window.rows.len() as u64)?;
        Ok((window, place))
    }

    /// Window of any number of cells, for values that are read in parts.
    pub(super) fn of_any_size(
        columns: u64,
        rows: u64,
        place: Option<&RasterGeoreference>,
        extent: Option<&RasterExtent>,
    ) -> Result<(Self, Option<RasterGeoreference>), RasterError> {
        let Some(extent) = extent else {
            let window = Self { columns: 0..columns as usize, rows: 0..rows as usize };
            return Ok((window, place.cloned()));
        };
        let place = place.ok_or(RasterError::WindowOfNowhere)?;
        let size = DVec2::new(columns as f64, rows as f64);
        let cell = place.cell;
        if !(cell.is_finite() && cell.min_element() > 0.0) {
            return Err(RasterError::BadCell { width: cell.x, height: cell.y });
        }
        // A side on the border of cells, but for rounding, does not reach into the next one.
        let low = ((extent.min - place.corner) / cell + 1e-6).floor().max(DVec2::ZERO);
        let high = ((extent.max - place.corner) / cell - 1e-6).ceil().min(size);
        if !low.cmplt(high).all() {
            let (min, max) = (place.corner, place.corner + size * cell);
            return Err(RasterError::WindowBeside { window: *extent, min, max });
        }
        let (first, end) = (low.as_u64vec2(), high.as_u64vec2());
        let window = Self {
            columns: first.x as usize..end.x as usize,
            rows: (rows - end.y) as usize..(rows - first.y) as usize,
        };
        let corner = place.corner + low * cell;
        Ok((window, Some(RasterGeoreference { corner, ..place.clone() })))
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.columns.len() * self.rows.len()
    }
}
