//! Trees from a canopy height model: their tops, their crowns, and which mesh fits each.

mod crowns;
mod fit;
#[cfg(test)]
mod tests;
mod tops;

use glam::DVec2;

pub use crowns::{Crown, crowns};
pub use fit::{Model, fit};
pub use tops::Window;

/// Heights of a canopy above the ground in square or rectangular cells.
#[derive(Clone, Debug)]
pub struct HeightModel {
    /// Cells from west to east.
    pub columns: usize,
    /// Cells from north to south.
    pub rows: usize,
    /// Heights, m, shape `[rows, columns]`, row 0 in the north; NaN where unknown.
    pub heights: Vec<f64>,
    /// South-west corner of the south-westernmost cell, m.
    pub corner: DVec2,
    /// Width and height of a cell, m.
    pub cell: DVec2,
}

impl HeightModel {
    /// Centre of a cell, m.
    fn center(&self, index: usize) -> DVec2 {
        let (column, row) = (index % self.columns, index / self.columns);
        let place = DVec2::new(column as f64 + 0.5, (self.rows - row) as f64 - 0.5);
        self.corner + self.cell * place
    }

    /// The up to eight cells around one.
    fn around(&self, index: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (index % self.columns, index / self.columns);
        let (columns, rows) = (self.columns, self.rows);
        (row.saturating_sub(1)..(row + 2).min(rows)).flat_map(move |r| {
            (column.saturating_sub(1)..(column + 2).min(columns))
                .map(move |c| r * columns + c)
                .filter(move |&other| other != index)
        })
    }
}
