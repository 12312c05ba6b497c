//! Leaf area of all instances in rows, columns and layers: exact areas under the full transform of each.
//!
//! An instance that lies in one cell adds a sum that is known. Others descend a tree over their mesh: nodes that lie in
//! one cell add their sums, and surfaces that lie in several are cut at the sides of the cells, triangles and discs in
//! closed form. Upright instances above one cell of level ground add their layers from a table by height.

mod collector;
mod height_table;
mod shape;

use std::collections::{BTreeMap, HashMap};

use hecs::World;
use rayon::prelude::*;

use self::collector::{Collector, CountingSpace, ScaledTree};
use self::height_table::HeightTable;
use self::shape::ScaledAreas;
use super::cell_grid::{CellCount, CellGrid, Elsewhere, HeightReference, round_number};
use super::surfaces::{GroundHeights, MaterialTree, PlacementTransform, prototype_trees};
use crate::components::{
    Instance, InstanceCount, MaterialId, Mesh, Name, PartMaterials, Placement, SceneId,
    TerrainPatch,
};
use crate::document::Material;
use crate::statistics::Sums;
use crate::terrain::Ground;

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
        "{columns} columns, {rows} rows and {layers} layers of {classes} classes take {needed} bytes of memory, \
         and {free} are free: choose fewer or larger cells"
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

/// Instances whose areas are added up in one block of sums.
const BLOCK: usize = 1024;

/// Blocks that are held at a time.
const BLOCKS: usize = 64;

/// Upright instances of a mesh from which a table by height is made for it.
const TABLE_FROM: usize = 16;

/// Sums that are held for each cell at the same time, at least: all, and blocks of each thread.
const COPIES: u128 = 3;

/// Leaf area of all instances. Reads the components of instances, [`Mesh`], [`PartMaterials`],
/// `document::Material`, [`TerrainPatch`] and [`Ground`].
///
/// - `progress`: called with the fraction that is done
///
/// # Errors
/// If nothing could be counted, or the cells take more memory than there is.
///
/// # Panics
/// If the world has no terrain.
pub fn leaf_area(
    world: &World,
    request: &LeafAreaRequest,
    progress: &dyn Fn(f64),
) -> Result<LeafAreaGrid, LeafAreaError> {
    let mut terrains = world.query::<(&TerrainPatch, &Ground)>();
    let (patch, ground) = terrains.iter().next().expect("a world has a terrain");
    let ground = GroundHeights::new(patch, ground, request.is_periodic);
    let mut instances = Instance::in_order(world);
    let mut query = world.query::<(&SceneId, &Mesh, &PartMaterials, &InstanceCount)>();
    let meshes: Vec<_> = query
        .iter()
        .filter(|(.., count)| count.0 > 0)
        .map(|(id, mesh, materials, _)| (id, mesh, materials))
        .collect();
    let classes = Classes::new(world, request, &meshes)?;
    let trees = prototype_trees(&meshes, |material| classes.of_material(material));
    instances
        .retain(|one| trees.get(&one.placement.prototype.0).is_some_and(|all| !all.is_empty()));
    if instances.is_empty() {
        return Err(LeafAreaError::NoInstances);
    }
    let ground_of_heights = (request.heights == HeightReference::Ground).then_some(&ground);
    let span = height_span(&instances, &trees, ground_of_heights);
    let grid = grid(request, patch, span, classes.names.len())?;
    let space = CountingSpace { grid: &grid, ground: ground_of_heights };
    let prepared = prepare(&trees, &instances, &space);
    // Instances that are scaled alike stand together and share the areas of their mesh; the order among them is that
    // of the document.
    instances.par_sort_unstable_by_key(|one| {
        (one.placement.prototype.0, ratio(&one.placement).to_bits(), one.id)
    });
    let slots = grid.cells() + Elsewhere::COUNT;
    let mut sums = Sums::new_sparse(slots, classes.names.len());
    let mut done = 0;
    for wave in instances.chunks(BLOCK * BLOCKS) {
        let blocks: Vec<Sums> = wave
            .par_chunks(BLOCK)
            .map(|block| {
                let mut sums = Sums::new_sparse(slots, classes.names.len());
                add_block(block, &prepared, space, &mut sums);
                sums
            })
            .collect();
        for block in &blocks {
            sums.merge(block);
        }
        done += wave.len();
        progress(done as f64 / instances.len() as f64);
    }
    Ok(collected(grid, classes, &sums, request.layers))
}

/// A tree with what all instances share whose scales are equal.
struct PreparedTree<'a> {
    surfaces: &'a MaterialTree<'a>,
    uniform: ScaledAreas,
    table: Option<HeightTable>,
}

/// Ratio of the vertical scale to the horizontal one.
fn ratio(placement: &Placement) -> f64 {
    f64::from(placement.scale.vertical) / f64::from(placement.scale.horizontal)
}

fn prepare<'a>(
    trees: &'a BTreeMap<u32, Vec<MaterialTree<'a>>>,
    instances: &[Instance],
    space: &CountingSpace<'_>,
) -> BTreeMap<u32, Vec<PreparedTree<'a>>> {
    let mut upright: HashMap<u32, usize> = HashMap::new();
    for instance in instances.iter().filter(|one| one.placement.lean.tilt == 0.0) {
        *upright.entry(instance.placement.prototype.0).or_default() += 1;
    }
    let has_layers = space.level().is_some() && space.grid.layers > 1;
    let of_prototype = |(&prototype, trees): (&u32, &'a Vec<MaterialTree<'a>>)| {
        let often = upright.get(&prototype).is_some_and(|&count| count >= TABLE_FROM);
        let tree = |surfaces: &'a MaterialTree<'a>| {
            let table = (has_layers && often).then(|| HeightTable::new(&surfaces.tree));
            let uniform = ScaledAreas::new(&surfaces.tree, 1.0, table.as_ref());
            PreparedTree { surfaces, uniform, table }
        };
        (prototype, trees.iter().map(tree).collect())
    };
    trees.par_iter().map(of_prototype).collect()
}

/// Adds the areas of some instances, of which those that are scaled alike stand together.
fn add_block(
    instances: &[Instance],
    prepared: &BTreeMap<u32, Vec<PreparedTree<'_>>>,
    space: CountingSpace<'_>,
    sums: &mut Sums,
) {
    let alike = instances.chunk_by(|a, b| {
        a.placement.prototype == b.placement.prototype
            && ratio(&a.placement).to_bits() == ratio(&b.placement).to_bits()
    });
    for group in alike {
        let first = &group[0].placement;
        let trees = &prepared[&first.prototype.0];
        let ratio = ratio(first);
        let is_uniform = ratio.to_bits() == 1.0_f64.to_bits();
        let scaled: Vec<ScaledAreas> = if is_uniform {
            Vec::new()
        } else {
            let areas = |tree: &PreparedTree<'_>| {
                ScaledAreas::new(&tree.surfaces.tree, ratio.abs(), tree.table.as_ref())
            };
            trees.iter().map(areas).collect()
        };
        for Instance { placement, .. } in group {
            for (index, tree) in trees.iter().enumerate() {
                let PreparedTree { surfaces, uniform, table } = tree;
                let areas = scaled.get(index).unwrap_or(uniform);
                let scaled = ScaledTree { surfaces, areas, table: table.as_ref() };
                Collector::new(space, scaled, *placement, sums).collect();
            }
        }
    }
}

/// Lowest and highest height of the boxes around all instances, m.
fn height_span(
    instances: &[Instance],
    trees: &BTreeMap<u32, Vec<MaterialTree<'_>>>,
    ground: Option<&GroundHeights<'_>>,
) -> (f64, f64) {
    let of_instance = |instance: &Instance| {
        let transform = PlacementTransform::new(&instance.placement);
        let of_tree = |tree: &MaterialTree<'_>| {
            let bounds = transform.bounds(tree.tree.nodes()[0].middle_and_half());
            let below = ground.map_or(Some((0.0, 0.0)), |ground| {
                ground.range(bounds.low.truncate(), bounds.high.truncate())
            });
            let place = instance.placement.position.truncate();
            let (lowest, highest) = below.unwrap_or_else(|| {
                let height = ground.and_then(|ground| ground.below(place)).unwrap_or(0.0);
                (height, height)
            });
            (bounds.low.z - highest, bounds.high.z - lowest)
        };
        trees[&instance.placement.prototype.0].iter().map(of_tree).fold(EMPTY, wider)
    };
    instances.par_iter().map(of_instance).reduce(|| EMPTY, wider)
}

/// Lowest and highest of no heights.
const EMPTY: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

fn wider(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// The cells that a request asks for.
fn grid(
    request: &LeafAreaRequest,
    patch: &TerrainPatch,
    (lowest, highest): (f64, f64),
    classes: usize,
) -> Result<CellGrid, LeafAreaError> {
    let TerrainPatch { corner, size, .. } = *patch;
    let (columns, rows) = request.cells.over(size);
    let from_ground = request.heights == HeightReference::Ground;
    let thickness_of = |bottom: f64| match request.layers {
        // Where nothing stands above the ground, layers are of any height.
        LayerCount::Count(_) if highest <= bottom => 1.0,
        LayerCount::Count(count) => (highest - bottom) / count as f64,
        LayerCount::Thickness(thickness) => thickness,
        LayerCount::Automatic => match highest - bottom {
            8.0..=100.0 => 1.0,
            height => round_number(height / 10.0),
        },
    };
    let (bottom, thickness) = match request.layers {
        _ if from_ground => (0.0, thickness_of(0.0)),
        LayerCount::Count(_) => (lowest, thickness_of(lowest)),
        _ => {
            let thickness = thickness_of(lowest);
            ((lowest / thickness).floor() * thickness, thickness)
        }
    };
    let layers = match request.layers {
        LayerCount::Count(count) => count as f64,
        // Rounding of a height must not make a layer.
        _ => ((highest - bottom) / thickness - 1e-9).ceil().max(1.0),
    };
    let layers = layers as u128;
    let slots = columns.saturating_mul(rows).saturating_mul(layers).saturating_mul(classes as u128);
    let needed = slots.saturating_mul(COPIES * size_of::<f64>() as u128);
    if needed > u128::from(request.memory) || layers > u128::from(u32::MAX) {
        let free = request.memory;
        return Err(LeafAreaError::TooManyCells { columns, rows, layers, classes, needed, free });
    }
    Ok(CellGrid {
        corner,
        size,
        columns: columns as usize,
        rows: rows as usize,
        layers: layers as usize,
        bottom,
        thickness,
        heights: request.heights,
        is_periodic: request.is_periodic,
    })
}

/// Classes that areas are counted by.
struct Classes {
    names: Vec<String>,
    is_leaf: Vec<bool>,
    by_material: BTreeMap<MaterialId, usize>,
}

impl Classes {
    fn new(
        world: &World,
        request: &LeafAreaRequest,
        meshes: &[(&SceneId, &Mesh, &PartMaterials)],
    ) -> Result<Self, LeafAreaError> {
        let has_surfaces = |mesh: &Mesh, part: usize| {
            let part = &mesh.parts[part];
            !part.triangles.is_empty() || !part.discs.is_empty()
        };
        let mut used: Vec<MaterialId> = meshes
            .iter()
            .flat_map(|(_, mesh, materials)| {
                let parts = materials.0.iter().enumerate();
                parts.filter(|(part, _)| has_surfaces(mesh, *part)).map(|(_, material)| *material)
            })
            .collect();
        used.sort_unstable();
        used.dedup();
        let mut query = world.query::<(&SceneId, &Name, &Material)>();
        let mut all: Vec<(MaterialId, &Name, bool)> = query
            .iter()
            .map(|(id, name, material)| (MaterialId(id.0), name, material.is_leaf()))
            .filter(|(id, _, is_leaf)| {
                used.contains(id) && (*is_leaf || request.surfaces == CountedSurfaces::All)
            })
            .collect();
        if all.is_empty() {
            return Err(if used.is_empty() {
                LeafAreaError::NoInstances
            } else {
                LeafAreaError::NoLeaves
            });
        }
        all.sort_unstable_by_key(|material| material.0);
        let mut classes =
            Self { names: Vec::new(), is_leaf: Vec::new(), by_material: BTreeMap::new() };
        for (id, name, is_leaf) in all {
            let class = if request.by_material {
                name.0.clone()
            } else {
                if is_leaf { "leaf" } else { "other" }.to_owned()
            };
            let known = classes.names.iter().position(|known| *known == class);
            let index = known.unwrap_or_else(|| {
                classes.names.push(class);
                classes.is_leaf.push(is_leaf);
                classes.names.len() - 1
            });
            classes.by_material.insert(id, index);
        }
        Ok(classes)
    }

    fn of_material(&self, material: MaterialId) -> Option<usize> {
        self.by_material.get(&material).copied()
    }
}

/// Result from the sums of all instances; layers above the highest surface are left out.
fn collected(
    mut grid: CellGrid,
    classes: Classes,
    sums: &Sums,
    layers: LayerCount,
) -> LeafAreaGrid {
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
    let filled = areas.chunks(layer).rposition(|layer| !is_empty(layer)).map_or(1, |last| last + 1);
    // Boxes around leaning instances reach higher than they do.
    if !matches!(layers, LayerCount::Count(_)) {
        grid.layers = filled;
        areas.truncate(filled * layer);
    }
    let Classes { names, is_leaf, .. } = classes;
    LeafAreaGrid { grid, classes: names, is_leaf, areas, outside, below, over_holes }
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
}
