//! Leaf area that was counted.

use super::LayerCount;
use super::classes::Classes;
use crate::queries::cell_grid::{CellGrid, Elsewhere};
use crate::statistics::Sums;

/// Leaf area of a scene by cell.
#[derive(Clone, Debug, PartialEq)]
pub struct LeafAreaGrid {
    /// Cells.
    pub grid: CellGrid,
    /// Names of the classes: materials, or `leaf` and `other`.
    pub classes: Vec<String>,
    /// True for each class of leaves.
    pub is_leaf: Vec<bool>,
    /// One-sided area, m², shape `[layers, rows from south to north, columns, classes]`.
    pub areas: Vec<f64>,
    /// Area beside the rectangle of an isolated scene, m², shape `[classes]`.
    pub outside: Vec<f64>,
    /// Area below the lowest layer, m², shape `[classes]`.
    pub below: Vec<f64>,
    /// Area over holes in the ground, m², shape `[classes]`.
    pub over_holes: Vec<f64>,
}

impl LeafAreaGrid {
    /// Area of a class in all cells, m².
    #[must_use]
    pub fn total(&self, class: usize) -> f64 {
        self.areas.iter().skip(class).step_by(self.classes.len()).sum()
    }

    /// Area of each class above each cell of the ground, m², shape `[rows from south to north, columns, classes]`.
    #[must_use]
    pub fn columns_total(&self) -> Vec<f64> {
        let layer = self.grid.columns * self.grid.rows * self.classes.len();
        let mut all = vec![0.0; layer];
        for areas in self.areas.chunks_exact(layer) {
            all.iter_mut().zip(areas).for_each(|(sum, area)| *sum += area);
        }
        all
    }

    /// Area of each class in each layer, m², shape `[layers, classes]`.
    #[must_use]
    pub fn layers_total(&self) -> Vec<f64> {
        let classes = self.classes.len();
        let layer = self.grid.columns * self.grid.rows * classes;
        let of_layer = |areas: &[f64]| {
            let mut sums = vec![0.0; classes];
            for cell in areas.chunks_exact(classes) {
                sums.iter_mut().zip(cell).for_each(|(sum, area)| *sum += area);
            }
            sums
        };
        self.areas.chunks_exact(layer).flat_map(of_layer).collect()
    }

    /// Result from the sums of all instances; layers above the highest surface are left out.
    pub(super) fn from_sums(
        mut grid: CellGrid,
        classes: Classes,
        sums: &Sums,
        layers: LayerCount,
    ) -> Self {
        let count = classes.names.len();
        let ordered = sums.ordered();
        let read = |cells| ordered.values(cells, &mut Vec::new()).to_vec();
        let elsewhere = |place: Elsewhere| {
            let slot = grid.elsewhere(place);
            read(slot..slot + 1)
        };
        let [outside, below, over_holes] =
            [Elsewhere::Outside, Elsewhere::Below, Elsewhere::OverHole].map(elsewhere);
        let mut areas = read(0..grid.cells());
        let layer = grid.columns * grid.rows * count;
        let is_empty = |layer: &[f64]| layer.iter().all(|&area| area == 0.0);
        let filled =
            areas.chunks(layer).rposition(|layer| !is_empty(layer)).map_or(1, |last| last + 1);
        // Boxes around leaning instances reach higher than they do.
        if !matches!(layers, LayerCount::Count(_)) {
            grid.layers = filled;
            areas.truncate(filled * layer);
        }
        let Classes { names, is_leaf, .. } = classes;
        Self { grid, classes: names, is_leaf, areas, outside, below, over_holes }
    }
}
