//! Leaf area of all instances in rows, columns and layers: exact areas under the full transform of each.
//!
//! An instance that lies in one cell adds a sum that is known. Others descend a tree over their mesh: nodes that lie in
//! one cell add their sums, and surfaces that lie in several are cut at the sides of the cells, triangles and discs in
//! closed form. Upright instances above level ground descend a tree of columns: a column above one cell of the ground
//! adds its layers from a table by height.

mod areas;
mod classes;
mod collector;
mod counted;
mod layer_profiles;
mod request;
mod window;

use std::collections::BTreeMap;

use hecs::World;
use rayon::prelude::*;

pub use self::counted::LeafAreaGrid;
pub use self::request::{CountedSurfaces, LayerCount, LeafAreaError, LeafAreaRequest};

use self::areas::ScaledAreas;
use self::classes::Classes;
use self::collector::{AreaSums, Collector, CountingSpace, ScaledTree, is_upright};
use self::layer_profiles::LayerProfiles;
use super::cell_grid::{Elsewhere, HeightReference};
use super::surfaces::{
    GroundHeights, MaterialTree, PlacementTransform, PlantedGround, SurfaceTree, prototype_trees,
};
use crate::components::{Instance, Placement};
use crate::statistics::Sums;

/// Instances of a block of sums that share tables, at most.
const BLOCK: usize = 1024;

/// Surfaces of the instances of a block that share none, about.
const BLOCK_SURFACES: usize = 1 << 21;

/// Blocks that are held at a time.
const BLOCKS: usize = 64;

/// Instances that are scaled alike from which they share areas, and tables by height if they stand upright above level
/// ground.
const SHARED_FROM: usize = 64;

/// Leaf area of all instances. Reads the components of instances, [`Mesh`](crate::components::Mesh),
/// [`PartMaterials`](crate::components::PartMaterials), `document::Material`,
/// [`TerrainPatch`](crate::components::TerrainPatch) and [`Ground`](crate::terrain::Ground).
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
    PlantedGround::of_world(world, request.is_periodic, |planted| {
        counted(world, planted, request, progress)
    })
}

fn counted(
    world: &World,
    planted: PlantedGround<'_>,
    request: &LeafAreaRequest,
    progress: &dyn Fn(f64),
) -> Result<LeafAreaGrid, LeafAreaError> {
    let PlantedGround { patch, ground, meshes, mut instances } = planted;
    let classes = Classes::new(world, request, &meshes)?;
    let trees = prototype_trees(&meshes, |material| classes.of_material(material));
    instances
        .retain(|one| trees.get(&one.placement.prototype.0).is_some_and(|all| !all.is_empty()));
    if instances.is_empty() {
        return Err(LeafAreaError::NoInstances);
    }
    let ground_of_heights = (request.heights == HeightReference::Ground).then_some(&ground);
    let span = height_span(&instances, &trees, ground_of_heights);
    let grid = request.grid(patch, span, classes.names.len())?;
    let space = CountingSpace { grid: &grid, finder: grid.finder(), ground: ground_of_heights };
    // Instances that are scaled alike stand together and share the areas of their mesh; the order among them is that
    // of the document.
    instances.par_sort_unstable_by_key(|one| (alike(&one.placement), one.id));
    let mut sums = Sums::new_sparse(grid.cells() + Elsewhere::COUNT, classes.names.len());
    let mut done = 0;
    for batch in batches(&instances) {
        let trees = BatchTrees::new(batch, &trees, space, request.memory);
        for wave in batch.chunks(trees.block * BLOCKS) {
            let blocks: Vec<Sums> =
                wave.par_chunks(trees.block).map(|block| trees.sums(block, space, &sums)).collect();
            for block in &blocks {
                sums.merge(block);
            }
            done += wave.len();
            progress(done as f64 / instances.len() as f64);
        }
    }
    Ok(LeafAreaGrid::from_sums(grid, classes, &sums, request.layers))
}

/// Key of the instances whose surfaces have the same areas but for a factor: prototype, and ratio of scales.
fn alike(placement: &Placement) -> (u32, u64) {
    (placement.prototype.0, placement.scale.ratio().to_bits())
}

/// Divides instances into those that are scaled alike if they are many, and the others between them.
fn batches(instances: &[Instance]) -> impl Iterator<Item = &[Instance]> {
    let mut rest = instances;
    std::iter::from_fn(move || {
        let mut count = 0;
        for group in rest.chunk_by(|a, b| alike(&a.placement) == alike(&b.placement)) {
            if group.len() < SHARED_FROM {
                count += group.len();
                continue;
            }
            if count == 0 {
                count = group.len();
            }
            break;
        }
        let (batch, others) = rest.split_at(count);
        rest = others;
        (count > 0).then_some(batch)
    })
}

/// Trees of the instances of a batch.
struct BatchTrees<'a> {
    trees: &'a BTreeMap<u32, Vec<MaterialTree<'a>>>,
    /// Areas that all instances share; none if they are not scaled alike.
    areas: Vec<ScaledAreas>,
    /// Trees of columns with tables that its upright instances share, or none.
    columns: Vec<ColumnTree<'a>>,
    /// Instances of a block.
    block: usize,
}

/// Tree of columns over the surfaces of one class of a mesh, for upright instances.
struct ColumnTree<'a> {
    tree: SurfaceTree<'a>,
    areas: ScaledAreas,
    profiles: LayerProfiles,
}

impl<'a> ColumnTree<'a> {
    fn new(tree: &SurfaceTree<'a>, ratio: f64) -> Self {
        let tree = tree.in_columns();
        let areas = ScaledAreas::new(&tree, ratio);
        let profiles = LayerProfiles::new(&tree, &areas.surfaces);
        Self { tree, areas, profiles }
    }
}

impl<'a> BatchTrees<'a> {
    fn new(
        batch: &[Instance],
        trees: &'a BTreeMap<u32, Vec<MaterialTree<'a>>>,
        space: CountingSpace<'_>,
        memory: u64,
    ) -> Self {
        let first = &batch[0].placement;
        let surfaces = |one: &Instance| {
            trees[&one.placement.prototype.0].iter().map(|tree| tree.tree.len()).sum::<usize>()
        };
        let last = &batch[batch.len() - 1].placement;
        let is_shared = batch.len() >= SHARED_FROM && alike(first) == alike(last);
        let (mut areas, mut columns) = (Vec::new(), Vec::new());
        if is_shared {
            let (trees, ratio) = (&trees[&first.prototype.0], first.scale.ratio());
            let upright = batch.iter().filter(|one| is_upright(&one.placement)).count();
            let has_columns = space.level().is_some()
                && upright >= SHARED_FROM
                && LayerProfiles::bytes(surfaces(&batch[0])) < memory / 2;
            if has_columns {
                columns = trees.par_iter().map(|tree| ColumnTree::new(&tree.tree, ratio)).collect();
            }
            if !has_columns || upright < batch.len() {
                let of_tree = |tree: &MaterialTree<'a>| ScaledAreas::new(&tree.tree, ratio);
                areas = trees.par_iter().map(of_tree).collect();
            }
        }
        let all: usize = batch.iter().map(surfaces).sum();
        let block = if columns.is_empty() {
            (BLOCK_SURFACES / (all / batch.len()).max(1)).clamp(1, BLOCK)
        } else {
            BLOCK
        };
        Self { trees, areas, columns, block }
    }

    /// Sums of the areas of some instances, of which those that are scaled alike stand together.
    ///
    /// - `like`: sums of the same shape
    fn sums(&self, instances: &[Instance], space: CountingSpace<'_>, like: &Sums) -> Sums {
        let mut sums = AreaSums::new(Sums::new_sparse(like.cells(), like.bands()));
        for group in instances.chunk_by(|a, b| alike(&a.placement) == alike(&b.placement)) {
            let first = &group[0].placement;
            let trees = &self.trees[&first.prototype.0];
            let mut own = Vec::new();
            if self.areas.is_empty() && self.columns.is_empty() {
                let ratio = first.scale.ratio();
                own.extend(trees.iter().map(|tree| ScaledAreas::new(&tree.tree, ratio)));
            }
            let areas = if own.is_empty() { &self.areas } else { &own };
            for Instance { placement, .. } in group {
                let mut collect = |scaled| {
                    Collector::new(space, scaled, placement, &mut sums).collect();
                };
                if !self.columns.is_empty() && is_upright(placement) {
                    for (ColumnTree { tree, areas, profiles }, MaterialTree { class, .. }) in
                        self.columns.iter().zip(trees)
                    {
                        let profiles = Some(profiles);
                        collect(ScaledTree { tree, class: *class, areas, profiles });
                    }
                    continue;
                }
                for (MaterialTree { tree, class }, areas) in trees.iter().zip(areas) {
                    collect(ScaledTree { tree, class: *class, areas, profiles: None });
                }
            }
        }
        sums.sums
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
