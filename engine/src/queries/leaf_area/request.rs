//! Requests for leaf area, and the cells that they ask for.

use crate::components::TerrainPatch;
use crate::counts::counted;
use crate::queries::cell_grid::{CellCount, CellGrid, HeightReference, round_number};

/// Surfaces that are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountedSurfaces {
    /// Those of `Leaf` materials.
    Leaves,
    /// Those of all materials of meshes.
    All,
}

/// Cells, surfaces and classes of a leaf area grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafAreaRequest {
    /// Number of columns and of rows.
    pub cells: CellCount,
    /// Number or height of layers.
    pub layers: LayerCount,
    /// Heights that layers are counted by.
    pub heights: HeightReference,
    /// Surfaces that are counted.
    pub surfaces: CountedSurfaces,
    /// True if each material is a class of its own.
    pub by_material: bool,
    /// True if the terrain's rectangle repeats without end.
    pub is_periodic: bool,
    /// Memory that the sums may take, bytes.
    pub memory: u64,
}

/// Number of layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LayerCount {
    /// Layers of equal height from the lowest to the highest surface, or from the ground.
    Count(usize),
    /// Height of a layer, m.
    Thickness(f64),
    /// Layers of 1 m in a forest.
    Automatic,
}

/// Reason why leaf area cannot be counted.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum LeafAreaError {
    #[error("the scene has no instances whose area could be counted")]
    NoInstances,
    #[error(
        "no mesh that is placed has a surface of a `Leaf` material; `--surfaces all` counts the others"
    )]
    NoLeaves,
    #[error(
        "{}, {} and {} of {} take {needed} bytes of memory, and {free} are free: choose fewer or larger cells",
        counted(.columns, "column"),
        counted(.rows, "row"),
        counted(.layers, "layer"),
        counted(.classes, "class")
    )]
    TooManyCells {
        columns: u128,
        rows: u128,
        layers: u128,
        classes: usize,
        needed: u128,
        free: u64,
    },
}

/// Sums that are held for each cell at the same time, at least: all, and blocks of each thread.
const COPIES: u128 = 3;

impl LeafAreaRequest {
    /// Cells over a terrain.
    ///
    /// - `lowest`, `highest`: heights of the counted surfaces, m
    pub(super) fn grid(
        &self,
        patch: &TerrainPatch,
        (lowest, highest): (f64, f64),
        classes: usize,
    ) -> Result<CellGrid, LeafAreaError> {
        let TerrainPatch { corner, size, .. } = *patch;
        let (columns, rows) = self.cells.over(size);
        let from_ground = self.heights == HeightReference::Ground;
        let thickness_of = |bottom: f64| match self.layers {
            // Layers of a scene without a surface above the ground may be of any height.
            LayerCount::Count(_) if highest <= bottom => 1.0,
            LayerCount::Count(count) => (highest - bottom) / count as f64,
            LayerCount::Thickness(thickness) => thickness,
            LayerCount::Automatic => match highest - bottom {
                8.0..=100.0 => 1.0,
                height => round_number(height / 10.0),
            },
        };
        let (bottom, thickness) = match self.layers {
            _ if from_ground => (0.0, thickness_of(0.0)),
            LayerCount::Count(_) => (lowest, thickness_of(lowest)),
            _ => {
                let thickness = thickness_of(lowest);
                ((lowest / thickness).floor() * thickness, thickness)
            }
        };
        let layers = match self.layers {
            LayerCount::Count(count) => count as f64,
            // Rounding of a height must not make a layer.
            _ => ((highest - bottom) / thickness - 1e-9).ceil().max(1.0),
        };
        let layers = layers as u128;
        let slots =
            columns.saturating_mul(rows).saturating_mul(layers).saturating_mul(classes as u128);
        let needed = slots.saturating_mul(COPIES * size_of::<f64>() as u128);
        if needed > u128::from(self.memory) || layers > u128::from(u32::MAX) {
            let free = self.memory;
            return Err(LeafAreaError::TooManyCells {
                columns,
                rows,
                layers,
                classes,
                needed,
                free,
            });
        }
        Ok(CellGrid {
            corner,
            size,
            columns: columns as usize,
            rows: rows as usize,
            layers: layers as usize,
            bottom,
            thickness,
            heights: self.heights,
            is_periodic: self.is_periodic,
        })
    }
}
