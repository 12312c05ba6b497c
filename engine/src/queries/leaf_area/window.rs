//! Areas of one instance in the cells around it.

use crate::queries::cell_grid::{CellFinder, CellGrid, CellNumbers, Elsewhere};
use crate::queries::surfaces::PlacedBox;
use crate::statistics::Sums;

/// Areas of one class of an instance by cell, m², before the factor of its scale.
///
/// They are added up here and then added to the sums of all instances, which takes a look-up for each cell instead of
/// each surface.
#[derive(Debug)]
pub(super) struct InstanceAreas {
    extent: CellExtent,
    /// Shape `[columns, rows, layers]`.
    areas: Vec<f64>,
    outside: f64,
    over_holes: f64,
    /// Cell of the ground whose areas follow from those of all others.
    rest: Option<CellPlace>,
}

/// Columns, rows and layers that an instance touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellExtent {
    pub(super) columns: CellNumbers,
    pub(super) rows: CellNumbers,
    pub(super) layers: CellNumbers,
}

/// A cell by its numbers; columns and rows of other tiles go on without end.
#[derive(Clone, Copy, Debug)]
pub(super) struct CellPlace {
    pub(super) column: i64,
    pub(super) row: i64,
    pub(super) layer: i64,
}

impl CellExtent {
    /// Columns and rows below a box, and all layers.
    pub(super) fn below(finder: &CellFinder, PlacedBox { low, high }: &PlacedBox) -> Self {
        Self {
            columns: finder.touched(0, low.x, high.x),
            rows: finder.touched(1, low.y, high.y),
            layers: finder.all_layers(),
        }
    }

    /// Returns whether all of it lies outside the rectangle of an isolated scene.
    pub(super) const fn is_outside(&self, grid: &CellGrid) -> bool {
        let Self { columns, rows, .. } = self;
        let is_beside = columns.last < 0
            || rows.last < 0
            || columns.first >= grid.columns as i64
            || rows.first >= grid.rows as i64;
        is_beside && !grid.is_periodic
    }

    /// Returns whether there is only one column and one row.
    pub(super) const fn is_one_column(&self) -> bool {
        self.columns.is_one() && self.rows.is_one()
    }

    /// First cell.
    pub(super) const fn first(&self) -> CellPlace {
        CellPlace { column: self.columns.first, row: self.rows.first, layer: self.layers.first }
    }

    const fn count(&self) -> u64 {
        self.columns.count().saturating_mul(self.rows.count()).saturating_mul(self.layers.count())
    }

    /// Part of it inside the rectangle of an isolated scene.
    fn inside(&self, grid: &CellGrid) -> Self {
        if grid.is_periodic {
            return *self;
        }
        let inside = |CellNumbers { first, last }: CellNumbers, count: usize| CellNumbers {
            first: first.max(0),
            last: last.min(count as i64 - 1),
        };
        Self {
            columns: inside(self.columns, grid.columns),
            rows: inside(self.rows, grid.rows),
            layers: self.layers,
        }
    }
}

/// Cells of a window, at most; of more, areas go to the sums surface by surface.
const MOST_CELLS: u64 = 1 << 16;

/// Cells of a window for each surface of the instance, at most.
const MOST_CELLS_PER_SURFACE: u64 = 64;

/// Cells of the ground of which one may be left out, at most.
const MOST_CELLS_WITH_REST: u64 = 4;

/// Areas of this part of a layer are rounding.
const ROUNDING: f64 = 1e-13;

impl InstanceAreas {
    pub(super) const fn new() -> Self {
        let none = CellNumbers { first: 0, last: 0 };
        let extent = CellExtent { columns: none, rows: none, layers: none };
        Self { extent, areas: Vec::new(), outside: 0.0, over_holes: 0.0, rest: None }
    }

    /// Begins an instance.
    pub(super) fn open(&mut self, extent: CellExtent, grid: &CellGrid, surfaces: usize) {
        self.extent = extent.inside(grid);
        (self.outside, self.over_holes, self.rest) = (0.0, 0.0, None);
        self.areas.clear();
        let cells = self.extent.count();
        if cells <= MOST_CELLS.min(MOST_CELLS_PER_SURFACE.saturating_mul(surfaces as u64)) {
            self.areas.resize(cells as usize, 0.0);
        }
    }

    /// Leaves out a cell of the ground, whose areas [`Self::add_rest`] is to add, if the instance lies in few cells and
    /// in the rectangle.
    pub(super) fn leave_out(&mut self, place: CellPlace, all: &CellExtent) {
        let CellExtent { columns, rows, .. } = self.extent;
        let count = columns.count() * rows.count();
        let is_inside = columns == all.columns && rows == all.rows;
        if self.has_cells() && is_inside && (2..=MOST_CELLS_WITH_REST).contains(&count) {
            self.rest = Some(place);
        }
    }

    /// Returns whether a column is left out.
    pub(super) fn is_left_out(&self, column: i64, row: i64) -> bool {
        self.rest.is_some_and(|rest| rest.column == column && rest.row == row)
    }

    /// Gives the cell that was left out what all others lack of these areas.
    ///
    /// - `areas`: layer and area of the whole instance
    pub(super) fn add_rest(&mut self, areas: impl Fn(&mut dyn FnMut(i64, f64))) {
        let Some(rest) = self.rest.take() else { return };
        let CellExtent { columns, rows, layers } = self.extent;
        let (start, count) = (self.column_start(rest.column, rest.row), layers.count() as usize);
        areas(&mut |layer, area| self.areas[start + (layer - layers.first) as usize] += area);
        for layer in start..start + count {
            let whole = self.areas[layer];
            let others =
                columns.range().flat_map(|column| rows.range().map(move |row| (column, row)));
            let others = others.filter(|&place| place != (rest.column, rest.row));
            let sum: f64 = others
                .map(|place| self.areas[self.column_start(place.0, place.1) + layer - start])
                .sum();
            let left = whole - sum;
            // Rounding is no area.
            self.areas[layer] = if left > ROUNDING * whole { left } else { 0.0 };
        }
    }

    pub(super) const fn add_outside(&mut self, area: f64) {
        self.outside += area;
    }

    pub(super) const fn add_over_hole(&mut self, area: f64) {
        self.over_holes += area;
    }

    /// Returns whether the window has cells; else areas go to the sums.
    pub(super) const fn has_cells(&self) -> bool {
        !self.areas.is_empty()
    }

    /// Adds area to a cell that the instance touches.
    pub(super) fn add(&mut self, place: CellPlace, area: f64) {
        let CellExtent { columns, rows, layers } = &self.extent;
        if self.is_left_out(place.column, place.row) {
            return;
        }
        // The extent holds all that the instance touches in the rectangle.
        if columns.contains(place.column) && rows.contains(place.row) {
            let start = self.column_start(place.column, place.row);
            self.areas[start + (place.layer - layers.first) as usize] += area;
        } else {
            self.outside += area;
        }
    }

    fn column_start(&self, column: i64, row: i64) -> usize {
        let CellExtent { columns, rows, layers } = &self.extent;
        let row = (row - rows.first) as usize;
        ((column - columns.first) as usize * rows.count() as usize + row) * layers.count() as usize
    }

    /// Ends an instance: adds its areas to those of all, in the order of the cells.
    pub(super) fn close(&self, grid: &CellGrid, class: usize, factor: f64, sums: &mut Sums) {
        let mut add = |slot: usize, area: f64| {
            if area != 0.0 {
                sums.add_at(slot, class, area * factor);
            }
        };
        add(grid.elsewhere(Elsewhere::Outside), self.outside);
        add(grid.elsewhere(Elsewhere::OverHole), self.over_holes);
        if self.areas.is_empty() {
            return;
        }
        let CellExtent { columns, rows, layers } = &self.extent;
        for (column, row) in
            columns.range().flat_map(|column| rows.range().map(move |row| (column, row)))
        {
            let Some(cell) = grid.ground_cell(column, row) else { continue };
            let start = self.column_start(column, row);
            for (layer, &area) in layers.range().zip(&self.areas[start..]) {
                add(grid.slot(cell, layer), area);
            }
        }
    }
}
