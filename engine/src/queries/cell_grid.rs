//! Cells that leaf area is counted in: rows, columns and layers.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

/// Heights that layers are counted by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeightReference {
    /// The ground below the middle of each triangle and disc.
    Ground,
    /// Zero of the scene's local frame.
    Absolute,
}

/// Rows, columns and layers over the terrain's rectangle; all cells are alike.
#[derive(Clone, Debug, PartialEq)]
pub struct CellGrid {
    /// South-west corner of the rectangle, m, local frame.
    pub corner: DVec2,
    /// Extent of the rectangle to the east and to the north, m.
    pub size: DVec2,
    /// Number of cells from west to east.
    pub columns: usize,
    /// Number of cells from south to north.
    pub rows: usize,
    /// Number of layers.
    pub layers: usize,
    /// Height of the lowest layer's bottom, m.
    pub bottom: f64,
    /// Height of a layer, m.
    pub thickness: f64,
    /// Heights that layers are counted by.
    pub heights: HeightReference,
    /// True if the rectangle repeats without end.
    pub is_periodic: bool,
}

/// Number of columns and rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellCount {
    /// Columns and rows.
    Counts {
        /// From west to east.
        columns: usize,
        /// From south to north.
        rows: usize,
    },
    /// Side of a cell, m: as many cells as come closest to it.
    Side(f64),
    /// Some twenty along the shorter side.
    Automatic,
}

impl CellCount {
    /// Columns and rows over a rectangle of this extent, m.
    pub(in crate::queries) fn over(self, size: DVec2) -> (u128, u128) {
        let by_side = |side: f64| {
            let counts = (size / side).round().max(DVec2::ONE);
            (counts.x as u128, counts.y as u128)
        };
        match self {
            Self::Counts { columns, rows } => (columns as u128, rows as u128),
            Self::Side(side) => by_side(side),
            Self::Automatic => by_side(round_number(size.min_element() / 20.0)),
        }
    }
}

/// Consecutive numbers of columns, rows or layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::queries) struct CellNumbers {
    pub(in crate::queries) first: i64,
    pub(in crate::queries) last: i64,
}

impl CellNumbers {
    /// Returns whether there is only one.
    pub(in crate::queries) const fn is_one(self) -> bool {
        self.first == self.last
    }

    /// Returns whether a number is one of them.
    pub(in crate::queries) const fn contains(self, number: i64) -> bool {
        self.first <= number && number <= self.last
    }

    /// Number of them.
    pub(in crate::queries) const fn count(self) -> u64 {
        self.last.abs_diff(self.first).saturating_add(1)
    }

    pub(in crate::queries) const fn range(self) -> RangeInclusive<i64> {
        self.first..=self.last
    }
}

/// Numbers of the columns, rows and layers that places lie in.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct CellFinder {
    corner: DVec3,
    cells_per_m: DVec3,
    last_layer: i64,
}

impl CellFinder {
    /// Number of the column (axis 0) or row (axis 1) of a coordinate, m; those of other tiles go on without end.
    pub(in crate::queries) fn along(&self, axis: usize, place: f64) -> i64 {
        floor((place - self.corner[axis]) * self.cells_per_m[axis])
    }

    /// Numbers of the columns or rows that a range of coordinates touches.
    pub(in crate::queries) fn touched(&self, axis: usize, low: f64, high: f64) -> CellNumbers {
        CellNumbers { first: self.along(axis, low), last: self.along(axis, high) }
    }

    /// Numbers of the layers that a range of heights touches.
    pub(in crate::queries) fn layers(&self, low: f64, high: f64) -> CellNumbers {
        CellNumbers { first: self.layer(low), last: self.layer(high) }
    }

    /// Numbers of all layers, and of what is below the lowest.
    pub(in crate::queries) const fn all_layers(&self) -> CellNumbers {
        CellNumbers { first: -1, last: self.last_layer }
    }

    /// Number of the layer of a height, m; -1 below the lowest. The highest has no top.
    pub(in crate::queries) fn layer(&self, height: f64) -> i64 {
        floor((height - self.corner.z) * self.cells_per_m.z).clamp(-1, self.last_layer)
    }
}

/// Largest whole number that is not above a value; much faster than `f64::floor`, which is a call without SSE 4.1.
fn floor(value: f64) -> i64 {
    let whole = value as i64;
    whole - i64::from(whole as f64 > value)
}

/// Place that area is counted at.
pub(in crate::queries) type Slot = usize;

/// Area that no cell holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::queries) enum Elsewhere {
    /// Beside the rectangle of an isolated scene.
    Outside,
    /// Below the lowest layer.
    Below,
    /// Over a hole in the ground, so that there is no height.
    OverHole,
}

impl Elsewhere {
    /// Number of places that are no cells.
    pub(in crate::queries) const COUNT: usize = 3;
}

impl CellGrid {
    /// Number of cells.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.columns * self.rows * self.layers
    }

    /// Area of the ground of a cell, m².
    #[must_use]
    pub fn ground_area(&self) -> f64 {
        self.size.element_product() / (self.columns * self.rows) as f64
    }

    /// Height of the bottom of a layer, m.
    #[must_use]
    pub fn layer_bottom(&self, layer: usize) -> f64 {
        self.bottom + layer as f64 * self.thickness
    }

    /// Number of cells along a horizontal axis.
    const fn along(&self, axis: usize) -> usize {
        if axis == 0 { self.columns } else { self.rows }
    }

    /// Finder of cells by place.
    pub(in crate::queries) fn finder(&self) -> CellFinder {
        let counts = DVec2::new(self.columns as f64, self.rows as f64);
        CellFinder {
            corner: self.corner.extend(self.bottom),
            cells_per_m: (counts / self.size).extend(1.0 / self.thickness),
            last_layer: self.layers as i64 - 1,
        }
    }

    /// Numbers of the columns or rows that a range of coordinates touches; those of other tiles go on without end.
    pub(in crate::queries) fn touched(
        &self,
        axis: usize,
        low: f64,
        high: f64,
    ) -> RangeInclusive<i64> {
        let finder = self.finder();
        finder.along(axis, low)..=finder.along(axis, high)
    }

    /// Coordinate of the lower side of a column or row, m.
    pub(in crate::queries) fn side(&self, axis: usize, number: i64) -> f64 {
        self.corner[axis] + self.size[axis] * (number as f64 / self.along(axis) as f64)
    }

    /// Height of the bottom of a layer by its number, m.
    pub(in crate::queries) fn layer_side(&self, number: i64) -> f64 {
        self.bottom + number as f64 * self.thickness
    }

    /// Number of the cell at a column and a row on the ground, of the lowest layer; `None` outside.
    pub(in crate::queries) fn ground_cell(&self, column: i64, row: i64) -> Option<usize> {
        let (columns, rows) = (self.columns as i64, self.rows as i64);
        let (column, row) = if self.is_periodic {
            (column.rem_euclid(columns), row.rem_euclid(rows))
        } else {
            (column, row)
        };
        let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
        is_inside.then(|| (row * columns + column) as usize)
    }

    /// Returns whether all cells of some columns and rows lie outside.
    pub(in crate::queries) fn is_outside(&self, ranges: [&RangeInclusive<i64>; 2]) -> bool {
        let is_beside = |axis: usize| {
            *ranges[axis].end() < 0 || *ranges[axis].start() >= self.along(axis) as i64
        };
        !self.is_periodic && (is_beside(0) || is_beside(1))
    }

    /// Place of a layer above a cell of the ground.
    pub(in crate::queries) fn slot(&self, ground_cell: usize, layer: i64) -> Slot {
        match usize::try_from(layer) {
            Ok(layer) => layer * self.columns * self.rows + ground_cell,
            Err(_below) => self.elsewhere(Elsewhere::Below),
        }
    }

    /// Place of what no cell holds.
    pub(in crate::queries) const fn elsewhere(&self, elsewhere: Elsewhere) -> Slot {
        self.cells() + elsewhere as usize
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a value.
pub(in crate::queries) fn round_number(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = 10_f64.powf(value.log10().floor());
    let digit = [5.0, 2.0].into_iter().find(|digit| digit * power <= value * (1.0 + 1e-12));
    digit.unwrap_or(1.0) * power
}
