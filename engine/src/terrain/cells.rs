use glam::DVec2;

use crate::geometry::Rectangle;

/// A rectangle of cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells<T> {
    /// Number of columns, counted from west to east.
    pub columns: usize,
    /// Number of rows, counted from north to south.
    pub rows: usize,
    /// Shape `[rows, columns]`, row 0 in the north.
    pub values: Vec<T>,
    /// South-west corner, m, local frame.
    pub corner: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
}

impl<T> Cells<T> {
    /// Other values of the same cells.
    #[must_use]
    pub const fn with<U>(&self, values: Vec<U>) -> Cells<U> {
        let Self { columns, rows, corner, size, .. } = *self;
        Cells { columns, rows, values, corner, size }
    }

    /// Width and height of a cell, m.
    #[must_use]
    pub fn cell(&self) -> DVec2 {
        self.size / DVec2::new(self.columns as f64, self.rows as f64)
    }

    /// The ground of a cell.
    #[must_use]
    pub fn rectangle(&self, index: usize) -> Rectangle {
        let (column, row) = (index % self.columns, index / self.columns);
        let min = DVec2::new(column as f64, (self.rows - 1 - row) as f64);
        let cell = self.cell();
        Rectangle { min: self.corner + cell * min, max: self.corner + cell * (min + 1.0) }
    }

    /// Centre of a cell, m.
    #[must_use]
    pub fn center(&self, index: usize) -> DVec2 {
        self.rectangle(index).at(0.5, 0.5)
    }

    /// The up to eight cells around one.
    pub fn around(&self, index: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (index % self.columns, index / self.columns);
        let (columns, rows) = (self.columns, self.rows);
        (row.saturating_sub(1)..(row + 2).min(rows)).flat_map(move |r| {
            (column.saturating_sub(1)..(column + 2).min(columns))
                .map(move |c| r * columns + c)
                .filter(move |&other| other != index)
        })
    }
}
