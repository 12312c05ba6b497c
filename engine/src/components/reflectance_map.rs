use std::sync::Arc;

use glam::DVec2;

/// Reflectance of the ground in the cells of a raster, in one or more layers.
///
/// A place has the values of the cell that it lies in.
#[derive(Clone, Debug, PartialEq)]
pub struct ReflectanceCells {
    /// Number of columns, counted from west to east.
    columns: usize,
    /// Number of rows, counted from north to south.
    rows: usize,
    /// South-west corner, m, local frame.
    corner: DVec2,
    /// Width and height of a cell, m.
    cell: DVec2,
    /// Number of layers.
    layers: usize,
    /// Fractions of the incident flux, shape `[cells, layers]`, row 0 in the north; one more cell at the end holds the
    /// ground beside the raster, if it has values of its own.
    values: Vec<f32>,
}

/// Lambertian reflectance of an opaque ground, alike on both sides, by cells.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedReflectance {
    /// Values, which may be shared by several scenes.
    cells: Arc<ReflectanceCells>,
    /// Layer of the cells that each band has its values in, shape `[bands]`.
    layers: Vec<u32>,
}

/// Rectangle of equal cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellLayout {
    /// Number of columns, counted from west to east.
    pub columns: usize,
    /// Number of rows, counted from north to south.
    pub rows: usize,
    /// South-west corner, m, local frame.
    pub corner: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
}

impl ReflectanceCells {
    /// Cells of a layout with these values, shape `[cells, layers]`, row 0 in the north. Ground beside the cells has the
    /// values of one more cell at their end, or else those of the nearest cell.
    ///
    /// # Panics
    /// If there are not as many values as cells and layers, or a value is not a fraction.
    #[must_use]
    pub fn new(layout: CellLayout, layers: usize, values: Vec<f32>) -> Self {
        let CellLayout { columns, rows, corner, size } = layout;
        let cells = columns * rows;
        let is_complete = layers > 0 && [cells, cells + 1].contains(&(values.len() / layers));
        assert!(cells > 0 && is_complete && values.len().is_multiple_of(layers), "a value a layer");
        assert!(
            values.iter().all(|value| (0.0..=1.0).contains(value)),
            "reflectances are fractions"
        );
        let cell = size / DVec2::new(columns as f64, rows as f64);
        Self { columns, rows, corner, cell, layers, values }
    }

    /// Number of the cell that a place lies in.
    #[must_use]
    pub fn cell_at(&self, place: DVec2) -> u32 {
        let at = (place - self.corner) / self.cell;
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let is_beside = at.x < 0.0 || at.y < 0.0 || at.x > columns || at.y > rows;
        if is_beside && self.values.len() > self.columns * self.rows * self.layers {
            return (self.columns * self.rows) as u32;
        }
        // A conversion to a whole number ends at 0.
        let column = (at.x as usize).min(self.columns - 1);
        let row_from_south = (at.y as usize).min(self.rows - 1);
        ((self.rows - 1 - row_from_south) * self.columns + column) as u32
    }

    /// Values of a cell, shape `[layers]`.
    #[must_use]
    pub fn values_of(&self, cell: u32) -> &[f32] {
        &self.values[cell as usize * self.layers..][..self.layers]
    }

    /// Number of cells that have values of their own.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.values.len() / self.layers
    }

    /// Returns whether two have the same cells, whatever their values are.
    fn is_alike(&self, other: &Self) -> bool {
        (self.columns, self.rows, self.corner, self.cell, self.count())
            == (other.columns, other.rows, other.corner, other.cell, other.count())
    }

    /// The layers of both.
    fn joined(&self, next: &Self) -> Self {
        assert!(self.is_alike(next), "maps that are joined have the same cells");
        let rows = self.values.chunks(self.layers).zip(next.values.chunks(next.layers));
        let values = rows.flat_map(|(own, next)| own.iter().chain(next)).copied().collect();
        Self { layers: self.layers + next.layers, values, ..*self }
    }
}

impl MappedReflectance {
    /// Reflectance of cells, with the layer of each band.
    ///
    /// # Panics
    /// If there is no such layer.
    #[must_use]
    pub fn new(cells: Arc<ReflectanceCells>, layers: Vec<u32>) -> Self {
        assert!(layers.iter().all(|&layer| (layer as usize) < cells.layers), "every layer exists");
        Self { cells, layers }
    }

    /// The cells.
    #[must_use]
    pub const fn cells(&self) -> &Arc<ReflectanceCells> {
        &self.cells
    }

    /// Layer of each band, shape `[bands]`.
    #[must_use]
    pub fn layers(&self) -> &[u32] {
        &self.layers
    }

    /// Mean over the cells of the raster, shape `[bands]`.
    #[must_use]
    pub fn mean(&self) -> Vec<f64> {
        let ReflectanceCells { columns, rows, layers, values, .. } = &*self.cells;
        let cells = columns * rows;
        let mut sums = vec![0.0; *layers];
        for cell in values.chunks(*layers).take(cells) {
            for (sum, value) in sums.iter_mut().zip(cell) {
                *sum += f64::from(*value);
            }
        }
        self.layers.iter().map(|&layer| sums[layer as usize] / cells as f64).collect()
    }

    /// Appends the bands of the same map in another scene.
    pub(super) fn join(&mut self, next: &Self) {
        let is_same = Arc::ptr_eq(&self.cells, &next.cells) || self.cells == next.cells;
        let first = if is_same { 0 } else { self.cells.layers as u32 };
        if !is_same {
            self.cells = Arc::new(self.cells.joined(&next.cells));
        }
        self.layers.extend(next.layers.iter().map(|layer| first + layer));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(values: Vec<f32>) -> ReflectanceCells {
        let (corner, size) = (DVec2::new(10.0, 20.0), DVec2::new(6.0, 4.0));
        ReflectanceCells::new(CellLayout { columns: 3, rows: 2, corner, size }, 1, values)
    }

    #[test]
    fn a_place_lies_in_the_cell_around_it_and_row_0_is_in_the_north() {
        let map = cells(vec![0.0; 6]);
        let at = |x: f64, y: f64| map.cell_at(DVec2::new(x, y));
        assert_eq!([at(10.0, 23.9), at(12.1, 23.9), at(15.9, 22.1)], [0, 1, 2]);
        assert_eq!([at(10.0, 20.0), at(13.9, 21.9), at(16.0, 20.0)], [3, 4, 5]);
        // Beside the raster there is the nearest cell, unless it has values of its own.
        assert_eq!([at(9.0, 30.0), at(16.1, 19.0)], [0, 5]);
        let map = cells(vec![0.0; 7]);
        let at = |x: f64, y: f64| map.cell_at(DVec2::new(x, y));
        assert_eq!([at(9.9, 21.0), at(11.0, 24.1), at(16.0, 24.0), at(10.0, 20.0)], [6, 6, 2, 3]);
    }

    #[test]
    fn scenes_that_are_joined_share_the_values_that_are_equal() {
        let map = |value: f32| {
            MappedReflectance::new(
                Arc::new(cells(vec![value, 0.1, 0.2, 0.3, 0.4, 0.5])),
                vec![0, 0],
            )
        };
        let mut joined = map(0.7);
        joined.join(&map(0.7));
        assert_eq!((joined.layers(), joined.cells().layers), (&[0; 4][..], 1));
        joined.join(&map(0.9));
        assert_eq!(joined.layers(), [0, 0, 0, 0, 1, 1]);
        let bits = |cell| joined.cells().values_of(cell).iter().map(|one| one.to_bits());
        assert!(
            bits(0).eq([0.7, 0.9].map(f32::to_bits)) && bits(5).eq([0.5, 0.5].map(f32::to_bits))
        );
        let mean = (0.7_f32 + 0.1 + 0.2 + 0.3 + 0.4 + 0.5) / 6.0;
        assert!((joined.mean()[0] - f64::from(mean)).abs() < 1e-7);
    }
}
