//! Height model of a scene: the highest surface above each cell of the ground, exactly.
//!
//! Every triangle and disc is cut at the sides of the cells, and the highest point of each part is found in closed form:
//! what is narrower than a cell is not missed, as it is by rays through the middles of cells. Nodes of the trees over
//! the meshes that lie below what is known already are left out.

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};
use hecs::World;
use rayon::prelude::*;

use super::cell_grid::{CellCount, CellGrid, HeightReference};
use super::surfaces::{
    FlatPatch, GroundHeights, MaterialTree, PlacedBox, PlacementTransform, PlantedGround,
    SurfaceTree, prototype_trees,
};
use crate::components::{Instance, TerrainPatch};
use crate::counts::counted;

/// Heights of a scene by cell of the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightModel {
    /// Cells, of one layer.
    pub grid: CellGrid,
    /// Height of the highest surface, plants and ground, m, local frame, shape `[rows from south to north, columns]`;
    /// NaN where there is none.
    pub surface: Vec<f64>,
    /// Largest height of a plant above the ground below it, m, in the same shape; 0 without plants, NaN over holes
    /// without plants.
    pub canopy: Vec<f64>,
}

/// Error of a height model of more cells than fit into memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{} and {} of heights take {needed} bytes of memory, and {free} are free: choose larger cells",
    counted(.columns, "column"),
    counted(.rows, "row")
)]
pub struct TooManyCells {
    /// Number of cells from west to east.
    pub columns: u128,
    /// Number of cells from south to north.
    pub rows: u128,
    /// Memory that they take, bytes.
    pub needed: u128,
    /// Memory that is free, bytes.
    pub free: u64,
}

/// Memory of a cell until its files are written, bytes.
const BYTES: u128 = 64;

/// Cells of a node that are compared with it, at most.
const MOST_COMPARED: i64 = 64;

/// Distance below known heights, relative to their size, from which a node is left out: rounding must not decide.
const MARGIN: f64 = 1e-9;

/// Highest surfaces of all plants and of the ground. Reads the components of instances,
/// [`Mesh`](crate::components::Mesh), [`PartMaterials`](crate::components::PartMaterials), [`TerrainPatch`] and
/// [`Ground`](crate::terrain::Ground).
///
/// The height of a plant above the ground is, for each part of a triangle or disc above a cell, that of its highest
/// point above the ground below this point.
///
/// - `cells`: number of cells
/// - `memory`: that the heights may take, bytes
/// - `progress`: called with the fraction that is done
///
/// # Errors
/// If the cells take more memory.
///
/// # Panics
/// If the world has no terrain.
pub fn height_model(
    world: &World,
    cells: CellCount,
    is_periodic: bool,
    memory: u64,
    progress: &dyn Fn(f64),
) -> Result<HeightModel, TooManyCells> {
    PlantedGround::of_world(world, is_periodic, |planted| {
        let grid = CellGrid::of_ground(cells, planted.patch, is_periodic, memory)?;
        Ok(heights(&planted, &grid, progress))
    })
}

fn heights(planted: &PlantedGround<'_>, grid: &CellGrid, progress: &dyn Fn(f64)) -> HeightModel {
    let PlantedGround { patch, ground, meshes, instances } = planted;
    let heights = Heights::new(grid);
    raise_ground(patch, &heights);
    let trees = prototype_trees(meshes, |_| Some(0));
    let mut done = 0;
    for wave in instances.chunks(WAVE) {
        wave.par_iter().for_each(|Instance { placement, .. }| {
            let transform = PlacementTransform::new(placement);
            let trees = trees.get(&placement.prototype.0);
            for MaterialTree { tree, .. } in trees.into_iter().flatten() {
                raise(tree, &transform, Some(ground), &heights);
            }
        });
        done += wave.len();
        progress(done as f64 / instances.len() as f64);
    }
    heights.model()
}

/// Instances after which progress is shown.
const WAVE: usize = 1 << 14;

/// Raises the surface to the ground, without the faces along which an isolated ground is cut out.
fn raise_ground(patch: &TerrainPatch, heights: &Heights<'_>) {
    let linear = patch.world_from_object();
    for triangle in 0..patch.first_cut as usize {
        let corners = patch.mesh.corners(triangle).map(Vec3::as_dvec3);
        let [a, b, c] = corners.map(|corner| linear * corner + patch.origin());
        let face = FlatPatch { origin: a, u: b - a, v: c - a, is_ellipse: false };
        heights.raise_patch(&face, None);
    }
}

/// Raises the heights of cells to the surfaces of a tree at a place.
fn raise(
    tree: &SurfaceTree<'_>,
    transform: &PlacementTransform,
    ground: Option<&GroundHeights<'_>>,
    heights: &Heights<'_>,
) {
    let mut stack = Vec::with_capacity(64);
    stack.push(0_u32);
    let bounds_of = |node: u32| transform.bounds(tree.nodes()[node as usize].middle_and_half());
    while let Some(index) = stack.pop() {
        if heights.are_above(&bounds_of(index), ground) {
            continue;
        }
        let node = tree.nodes()[index as usize];
        match node.children(index) {
            // The higher one first: it may hide the other.
            Some([left, right]) if bounds_of(left).high.z > bounds_of(right).high.z => {
                stack.extend([right, left]);
            }
            Some(children) => stack.extend(children),
            None => {
                for place in node.places() {
                    heights.raise_patch(&transform.patch(&tree.patch(place)), ground);
                }
            }
        }
    }
}

/// Heights that several threads raise: the largest stays, whatever the order.
struct Heights<'a> {
    grid: &'a CellGrid,
    surface: Vec<AtomicU64>,
    canopy: Vec<AtomicU64>,
}

impl<'a> Heights<'a> {
    fn new(grid: &'a CellGrid) -> Self {
        let nothing = || (0..grid.columns * grid.rows).map(|_| AtomicU64::new(0)).collect();
        Self { grid, surface: nothing(), canopy: nothing() }
    }

    /// Returns whether all cells below a box are known to reach higher, or lie outside.
    fn are_above(&self, bounds: &PlacedBox, ground: Option<&GroundHeights<'_>>) -> bool {
        let PlacedBox { low, high } = bounds;
        let [columns, rows] = self.touched(*low, *high);
        if self.grid.is_outside([&columns, &rows]) {
            return true;
        }
        let count = |range: &RangeInclusive<i64>| range.end() - range.start() + 1;
        if count(&columns) * count(&rows) > MOST_COMPARED {
            return false;
        }
        let below =
            ground.map_or(Some((0.0, 0.0)), |ground| ground.range(low.truncate(), high.truncate()));
        let Some((lowest, _)) = below else { return false };
        let margin = MARGIN * (1.0 + high.z.abs() + lowest.abs());
        let cells = columns.flat_map(|column| rows.clone().map(move |row| (column, row)));
        cells.filter_map(|(column, row)| self.grid.ground_cell(column, row)).all(|cell| {
            let known = |heights: &[AtomicU64]| height_of(heights[cell].load(Ordering::Relaxed));
            known(&self.surface) > high.z + margin && known(&self.canopy) > high.z - lowest + margin
        })
    }

    fn touched(&self, low: DVec3, high: DVec3) -> [RangeInclusive<i64>; 2] {
        [self.grid.touched(0, low.x, high.x), self.grid.touched(1, low.y, high.y)]
    }

    /// Raises the cells below a surface to it: the height of plants above this ground too, if there is one.
    fn raise_patch(&self, patch: &FlatPatch, ground: Option<&GroundHeights<'_>>) {
        let (low, high) = patch.bounds();
        let [columns, rows] = self.touched(low, high);
        let by_column = patch.slices(patch.whole(), 0, columns, |column| self.grid.side(0, column));
        for (column, piece) in by_column {
            let by_row = patch.slices(piece, 1, rows.clone(), |row| self.grid.side(1, row));
            for (row, piece) in by_row {
                let cell = self.grid.ground_cell(column, row);
                let (Some(cell), Some(top)) = (cell, patch.highest(&piece)) else { continue };
                raise_cell(&self.surface[cell], top.z);
                let height = ground.and_then(|ground| ground.below(top.truncate()));
                if let Some(height) = height {
                    raise_cell(&self.canopy[cell], (top.z - height).max(0.0));
                }
            }
        }
    }

    fn model(self) -> HeightModel {
        let Self { grid, surface, canopy } = self;
        let read = |heights: Vec<AtomicU64>| -> Vec<f64> {
            heights.into_iter().map(|height| height_of(height.into_inner())).collect()
        };
        let (surface, canopy) = (read(surface), read(canopy));
        let known = |height: f64| if height == f64::NEG_INFINITY { f64::NAN } else { height };
        let plants = surface.iter().zip(&canopy).map(|(&surface, &canopy)| {
            // Where there is ground and no plant, plants are 0 m high.
            if canopy == f64::NEG_INFINITY && surface.is_finite() { 0.0 } else { known(canopy) }
        });
        let canopy = plants.collect();
        HeightModel {
            grid: grid.clone(),
            surface: surface.into_iter().map(known).collect(),
            canopy,
        }
    }
}

fn raise_cell(cell: &AtomicU64, height: f64) {
    cell.fetch_max(ordered(height), Ordering::Relaxed);
}

/// Number that is the larger, the higher a height is; above 0.
fn ordered(height: f64) -> u64 {
    let bits = height.to_bits();
    if height.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

/// Height of a number that [`ordered`] returned; minus infinity of 0.
fn height_of(number: u64) -> f64 {
    match number {
        0 => f64::NEG_INFINITY,
        _ if number >> 63 == 1 => f64::from_bits(number & !(1 << 63)),
        _ => f64::from_bits(!number),
    }
}

impl CellGrid {
    /// Cells of one layer over a terrain.
    fn of_ground(
        cells: CellCount,
        patch: &TerrainPatch,
        is_periodic: bool,
        memory: u64,
    ) -> Result<Self, TooManyCells> {
        let (columns, rows) = cells.over(patch.size);
        let needed = columns.saturating_mul(rows).saturating_mul(BYTES);
        if needed > u128::from(memory) {
            return Err(TooManyCells { columns, rows, needed, free: memory });
        }
        Ok(Self {
            corner: patch.corner,
            size: patch.size,
            columns: columns as usize,
            rows: rows as usize,
            layers: 1,
            bottom: 0.0,
            thickness: 1.0,
            heights: HeightReference::Ground,
            is_periodic,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_heights_are_in_their_order() {
        let heights = [-1e9, -2.5, -0.0, 0.0, 1e-300, 3.0, 1e9];
        assert!(heights.windows(2).all(|pair| ordered(pair[0]) < ordered(pair[1])));
        for height in heights {
            assert_eq!(height_of(ordered(height)).to_bits(), height.to_bits());
            assert!(ordered(height) > 0);
        }
        assert!(height_of(0).is_infinite() && height_of(0) < 0.0);
    }
}
