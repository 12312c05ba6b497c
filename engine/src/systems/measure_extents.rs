use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use glam::{DVec2, DVec3};
use hecs::World;
use rayon::prelude::*;

use super::Resources;
use super::coordinate_advice::place_of_instance;
use super::measure_bounds::{MeshSummary, placed_meshes};
use crate::components::{
    Instance, InstanceQuery, Placement, Position, SceneExtents, SceneId, TerrainPatch,
};
use crate::counts::{agreeing, counted};
use crate::document::{Diagnostic, HEIGHT, LENGTH, LawfulRange, SCALE, ScenePath};
use crate::geometry::Bounds;

/// Tiles that a periodic scene may be high: scattered light crosses one and a half times as many on
/// average before it leaves.
pub(super) const MOST_TILES_HIGH: f64 = 2000.0;

/// Images that one instance may have in a periodic tile: a ray may meet the boxes of all of them.
const MOST_IMAGES: f64 = 2000.0;

/// Images of one instance from which on the scene is slow.
const MANY_IMAGES: f64 = 200.0;

/// Instances that may stand in one place, turned and scaled alike: a ray there meets all of them.
const MOST_ALIKE: usize = 1000;

/// Instances that one thread looks at at a time.
pub(super) const BATCH: u32 = 1 << 14;

/// Scene id that no instance has.
const NO_INSTANCE: SceneId = SceneId(u32::MAX);

/// Vertical extent and images of some instances.
#[derive(Clone, Copy)]
struct Reach {
    /// Heights of the highest and the lowest point, m, and the instances they belong to.
    high: (f64, SceneId),
    low: (f64, SceneId),
    /// Number of images in the periodic tile, and the instance that has most.
    records: f64,
    most: (f64, SceneId),
}

impl Reach {
    const NOTHING: Self = Self {
        high: (f64::NEG_INFINITY, NO_INSTANCE),
        low: (f64::INFINITY, NO_INSTANCE),
        records: 0.0,
        most: (0.0, NO_INSTANCE),
    };

    fn union(self, other: Self) -> Self {
        // The first in document order of two equal ones, whatever the order of comparison.
        let better = |a: (f64, SceneId), b: (f64, SceneId), sign: f64| {
            let (x, y) = (sign * a.0, sign * b.0);
            if x > y || (x >= y && a.1 <= b.1) { a } else { b }
        };
        Self {
            high: better(self.high, other.high, 1.0),
            low: better(self.low, other.low, -1.0),
            records: self.records + other.records,
            most: better(self.most, other.most, 1.0),
        }
    }
}

/// Instance whose position, scale or extent is beyond the lawful ranges.
struct Unlawful {
    instance: SceneId,
    message: String,
    help: &'static str,
}

impl Unlawful {
    fn first(self, other: Self) -> Self {
        if other.instance < self.instance { other } else { self }
    }
}

/// Heights of the lowest and the highest ground, m.
#[derive(Clone, Copy)]
struct GroundHeights {
    lowest: f64,
    highest: f64,
}

/// Measures the extents of all geometry, and refuses instances and meshes beyond the lawful ranges. Reads the
/// components of instances,
/// `MeshBounds` and [`TerrainPatch`]; writes the resource `extents`.
pub(super) fn measure_extents(world: &mut World, resources: &mut Resources) {
    resources.extents = SceneExtents::default();
    let Ok(patch) = world.get::<&TerrainPatch>(resources.terrain) else { return };
    let meshes = placed_meshes(world);
    let bounds: BTreeMap<u32, Bounds> = meshes
        .iter()
        .filter_map(|(&id, mesh)| Some((id, mesh.bounds?)))
        .map(|(id, box_)| (id, Bounds { min: box_.low.as_dvec3(), max: box_.high.as_dvec3() }))
        .collect();
    check_meshes(&bounds, &meshes, resources);
    let tile = resources.is_periodic().then_some(patch.size);
    let reach = match reach(world, &bounds, patch.corner, tile) {
        Ok(reach) => reach,
        Err(problem) => {
            refuse(problem, world, resources);
            Reach::NOTHING
        }
    };
    let heights = patch.mesh.vertices.iter().map(|v| patch.base + patch.unit * f64::from(v.z));
    let (lowest, highest) = heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    let largest = meshes.values().max_by_key(|mesh| mesh.primitives);
    let ground = patch.mesh.triangles.len();
    let primitives = meshes.values().map(|mesh| mesh.primitives).sum::<usize>() + ground;
    resources.extents = SceneExtents {
        low: lowest.min(reach.low.0),
        high: highest.max(reach.high.0),
        tile,
        primitives: primitives as u64,
        records: reach.records as u64,
        largest_mesh: largest
            .filter(|largest| largest.primitives > ground)
            .map_or_else(|| "terrain".into(), |mesh| ScenePath::from("meshes").name(&mesh.name)),
        most_records: match reach.most.1 {
            NO_INSTANCE => "instances".into(),
            instance => place_of_instance(instance, world, resources).0,
        },
    };
    if let Some(tile) = tile {
        check_images(reach, tile, world, resources);
        check_tiles_high(reach, GroundHeights { lowest, highest }, tile, world, resources);
    }
    check_duplicates(world, &meshes, resources);
}

/// Refuses meshes whose coordinates are beyond the lawful range of lengths.
fn check_meshes(
    bounds: &BTreeMap<u32, Bounds>,
    meshes: &BTreeMap<u32, MeshSummary>,
    resources: &mut Resources,
) {
    for (id, Bounds { min, max }) in bounds {
        let farthest = min.abs().max(max.abs()).max_element();
        if let Some((message, _)) = LENGTH.problem(farthest) {
            let help = "if its file is in another unit, write that in metres as `unit_m`";
            let path = ScenePath::from("meshes").name(&meshes[id].name);
            resources.report(Diagnostic::error(path, message).help(help));
        }
    }
}

/// Reports an instance with an unlawful position, scale or extent.
fn refuse(
    Unlawful { instance, message, help }: Unlawful,
    world: &World,
    resources: &mut Resources,
) {
    let (path, name) = place_of_instance(instance, world, resources);
    resources.report(Diagnostic::error(path, format!("{name}: {message}")).help(help));
}

/// Refuses and warns of instances that reach over many periodic tiles.
fn check_images(reach: Reach, tile: DVec2, world: &World, resources: &mut Resources) {
    let (images, instance) = reach.most;
    if images <= MANY_IMAGES {
        return;
    }
    let (path, name) = place_of_instance(instance, world, resources);
    let message = format!(
        "{name} reaches over {images} tiles of {} x {} m, and each ray in the tile may meet as many images",
        tile.x, tile.y
    );
    let help = "choose a larger terrain, a smaller mesh or scale, or `boundary: Isolated`";
    let problem = if images > MOST_IMAGES {
        Diagnostic::error(path, format!("{message}; at most {MOST_IMAGES} are allowed"))
    } else {
        Diagnostic::warning(path, format!("{message}: this is slow"))
    };
    resources.report(problem.help(help));
}

/// Refuses scenes that are far higher than their periodic tile is wide.
fn check_tiles_high(
    reach: Reach,
    ground: GroundHeights,
    tile: DVec2,
    world: &World,
    resources: &mut Resources,
) {
    let SceneExtents { low, high, .. } = resources.extents;
    let height = high - low;
    let tiles = height / tile.min_element();
    if tiles <= MOST_TILES_HIGH {
        return;
    }
    // Whatever reaches farthest from the ground; the ground itself if nothing does.
    let (above, below) = (reach.high.0 - ground.highest, ground.lowest - reach.low.0);
    let instance = if above >= below { reach.high.1 } else { reach.low.1 };
    let (path, name) = if above.max(below) > 0.0 {
        place_of_instance(instance, world, resources)
    } else {
        ("terrain".into(), "the ground".to_owned())
    };
    let message = format!(
        "with {name}, the scene reaches from {:?} to {:?} m: it is {tiles:.0} times as high as its tile of \
             {} x {} m is wide, and rays would cross as many tiles; at most {MOST_TILES_HIGH} are allowed",
        low, high, tile.x, tile.y
    );
    let help = "choose a larger terrain, or write a height that is meant in metres";
    resources.report(Diagnostic::error(path, message).help(help));
}

/// Refuses and warns of instances with the place, orientation, scale and mesh of another one.
fn check_duplicates(world: &World, meshes: &BTreeMap<u32, MeshSummary>, resources: &mut Resources) {
    let pose_of = |components: InstanceQuery<'_>| {
        let Instance { id, placement, .. } = Instance::from_components(components);
        (pose(&placement), id)
    };
    if !may_hold_duplicates(world) {
        return;
    }
    let mut query = world.query::<InstanceQuery<'_>>();
    let mut poses: Vec<([u64; 6], SceneId)> = query.iter().map(pose_of).collect();
    poses.par_sort_unstable();
    let (mut duplicates, mut most) = (0, &poses[..0]);
    for run in poses.chunk_by(|a, b| a.0 == b.0) {
        duplicates += run.len() - 1;
        if run.len() > most.len() {
            most = run;
        }
    }
    let Some(&([x, y, z, .., last], instance)) = most.first().filter(|_| duplicates > 0) else {
        return;
    };
    let count = most.len();
    let (path, _) = place_of_instance(instance, world, resources);
    let name = meshes.get(&((last >> 32) as u32)).map_or("", |mesh| mesh.name.as_str());
    let DVec3 { x, y, z } = DVec3::from([x, y, z].map(f64::from_bits));
    if count > MOST_ALIKE {
        let message = format!(
            "{count} instances of `{name}` stand in one place, ({x}, {y}, {z}), turned and scaled alike"
        );
        let help = "each ray there would meet all of them: keep one";
        resources.report(Diagnostic::error(path, message).help(help));
    } else {
        let message = format!(
            "{} exactly where {} of the same mesh {}, turned and scaled alike",
            format_args!(
                "{} {}",
                counted(duplicates, "instance"),
                agreeing(duplicates, "stands", "stand")
            ),
            agreeing(duplicates, "another one", "others"),
            agreeing(duplicates, "does", "do")
        );
        let help = format!("{count} of `{name}` stand at ({x}, {y}, {z}): keep one");
        resources.report(Diagnostic::warning(path, message).help(help));
    }
}

/// Returns whether some positions are alike, or a rare pair of them has the same hash: far less memory than that of
/// all poses is sorted.
fn may_hold_duplicates(world: &World) -> bool {
    let mut query = world.query::<&Position>();
    let hash = |position: &Position| {
        let mut hasher = DefaultHasher::new();
        position.0.to_array().map(f64::to_bits).hash(&mut hasher);
        hasher.finish()
    };
    let batches = query.iter_batched(BATCH).par_bridge();
    let mut hashes: Vec<u64> = batches.flat_map_iter(|batch| batch.map(hash)).collect();
    hashes.par_sort_unstable();
    hashes.windows(2).any(|pair| pair[0] == pair[1])
}

/// Problem with the place of an instance, and advice.
fn problem_of_place(placement: &Placement) -> Option<(String, &'static str)> {
    let Placement { position, scale, .. } = placement;
    let all: [(&LawfulRange, f64); 5] = [
        (&LENGTH, position.x),
        (&LENGTH, position.y),
        (&HEIGHT, position.z),
        (&SCALE, scale.horizontal.into()),
        (&SCALE, scale.vertical.into()),
    ];
    all.into_iter().find_map(|(range, value)| range.problem(value))
}

/// Problem with how far the box around an instance reaches, and advice.
fn problem_of_box(Bounds { min, max }: &Bounds) -> Option<(String, &'static str)> {
    let farthest = min.abs().max(max.abs());
    [(&LENGTH, farthest.x), (&LENGTH, farthest.y), (&HEIGHT, farthest.z)]
        .into_iter()
        .find_map(|(range, value)| range.problem(value))
        .map(|(message, help)| (format!("it reaches too far: {message}"), help))
}

fn world_bounds(placement: &Placement, bounds: &Bounds) -> Bounds {
    let linear = placement.world_from_object();
    let center = linear * (0.5 * (bounds.min + bounds.max)) + placement.position;
    let half = 0.5 * (bounds.max - bounds.min);
    let half =
        linear.x_axis.abs() * half.x + linear.y_axis.abs() * half.y + linear.z_axis.abs() * half.z;
    Bounds { min: center - half, max: center + half }
}

/// Heights and images of all instances, or the first that is unlawful.
fn reach(
    world: &World,
    bounds: &BTreeMap<u32, Bounds>,
    corner: DVec2,
    tile: Option<DVec2>,
) -> Result<Reach, Unlawful> {
    let of = |components: InstanceQuery<'_>| {
        let Instance { id, placement, .. } = Instance::from_components(components);
        let unlawful = |(message, help)| Unlawful { instance: id, message, help };
        problem_of_place(&placement).map_or(Ok(()), |problem| Err(unlawful(problem)))?;
        let Some(bounds) = bounds.get(&placement.prototype.0) else { return Ok(Reach::NOTHING) };
        let reached = world_bounds(&placement, bounds);
        problem_of_box(&reached).map_or(Ok(()), |problem| Err(unlawful(problem)))?;
        let Bounds { min, max } = reached;
        let images = tile.map_or(1.0, |tile| {
            // Offsets k, in tiles, for which the box and the tile overlap.
            let first = ((corner - max.truncate()) / tile).ceil();
            let last = ((corner + tile - min.truncate()) / tile).floor();
            (last - first + 1.0).max(DVec2::ONE).element_product()
        });
        Ok(Reach { high: (max.z, id), low: (min.z, id), records: images, most: (images, id) })
    };
    let both = |a: Result<Reach, Unlawful>, b: Result<Reach, Unlawful>| match (a, b) {
        (Ok(a), Ok(b)) => Ok(a.union(b)),
        (Err(a), Err(b)) => Err(a.first(b)),
        (Err(unlawful), Ok(_)) | (Ok(_), Err(unlawful)) => Err(unlawful),
    };
    let mut query = world.query::<InstanceQuery<'_>>();
    let batches = query.iter_batched(BATCH).par_bridge();
    batches
        .map(|batch| batch.map(of).fold(Ok(Reach::NOTHING), both))
        .reduce(|| Ok(Reach::NOTHING), both)
}

/// Bits of all that decides where an instance is.
fn pose(placement: &Placement) -> [u64; 6] {
    let Placement { position, yaw, scale, lean, prototype } = placement;
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    [
        position.x.to_bits(),
        position.y.to_bits(),
        position.z.to_bits(),
        pair(*yaw, lean.tilt),
        pair(scale.horizontal, scale.vertical),
        u64::from(prototype.0) << 32 | u64::from(lean.azimuth.to_bits()),
    ]
}
