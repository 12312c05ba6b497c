//! Bounds of what is placed: how far it reaches, how many tiles it is high, and the memory that the ray
//! engine will take for it.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::Spawner;
use super::meshes::Prototype;
use crate::components::{Placement, TerrainPatch};
use crate::document::{Diagnostic, HEIGHT, Instances, LENGTH, Range, SCALE, Scene};
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

/// Memory of a triangle or disc while its tree is built, bytes.
const PRIMITIVE_BYTES: u64 = 130;

/// Memory of an instance or an image while the tree over them is built, bytes.
const RECORD_BYTES: u64 = 330;

/// Extent of all geometry.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reach {
    /// Lowest and highest point, m.
    pub(super) low: f64,
    pub(super) high: f64,
    /// Extent of the tile of a periodic scene, m.
    pub(super) tile: Option<DVec2>,
    /// Triangles and discs of all meshes.
    primitives: u64,
    /// Instances and images of instances in the periodic tile.
    records: u64,
    /// Where most primitives and most records come from.
    largest_mesh: String,
    most_records: String,
}

/// Which places in the document instances come from.
#[derive(Clone, Debug, Default)]
pub(crate) struct Origins {
    /// Number of an entry of `instances`, and of all instances up to its last.
    ends: Vec<(usize, usize)>,
}

impl Origins {
    /// Notes where the instances of an entry end.
    pub(super) fn push(&mut self, entry: usize, end: usize) {
        self.ends.push((entry, end));
    }

    /// Number of the entry that an instance is of, and of the instance within it.
    pub(super) fn entry_and_row(&self, instance: usize) -> Option<(usize, usize)> {
        let at = self.ends.partition_point(|&(_, end)| end <= instance);
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before].1);
        let &(entry, _) = self.ends.get(at)?;
        Some((entry, instance - start))
    }

    /// Path in the document of an instance, and a name for it.
    pub(crate) fn place(&self, scene: &Scene, instance: usize) -> (String, String) {
        let Some((entry, row)) = self.entry_and_row(instance) else {
            return ("instances".to_owned(), "an instance".to_owned());
        };
        let path = format!("instances[{entry}]");
        match scene.instances.get(entry) {
            Some(Instances::List { .. }) => {
                (format!("{path}.at_m[{row}]"), "this instance".to_owned())
            }
            Some(Instances::Table { file, .. }) => {
                (format!("{path}.file"), format!("row {} of `{file}`", row + 1))
            }
            _ => (path, format!("instance {}", row + 1)),
        }
    }
}

impl Reach {
    /// An error if the ray engine will take more memory for the scene than is free, bytes.
    pub(crate) fn check_memory(&self, free: u64) -> Option<Diagnostic> {
        let meshes = self.primitives.saturating_mul(PRIMITIVE_BYTES);
        let records = self.records.saturating_mul(RECORD_BYTES);
        let all = meshes.saturating_add(records);
        if all <= free {
            return None;
        }
        let size = crate::products::data_size;
        let message = format!(
            "the ray engine takes {} of memory for {} triangles and discs in meshes and {} instances, images \
             in neighbouring tiles included, and {} are free",
            size(all),
            self.primitives,
            self.records,
            size(free)
        );
        let (path, help) = if records > meshes {
            (&self.most_records, "place fewer instances, or choose a larger tile")
        } else {
            (&self.largest_mesh, "take meshes of fewer triangles, and place them more often")
        };
        Some(Diagnostic::error(path, message).help(help))
    }
}

/// What instances reach, as far as one thread has looked at them.
#[derive(Clone, Copy)]
struct Seen {
    /// Highest and lowest point, and the instances they belong to.
    high: (f64, usize),
    low: (f64, usize),
    /// Images in the periodic tile, and the instance that has most.
    records: f64,
    most: (f64, usize),
}

impl Seen {
    const NOTHING: Self = Self {
        high: (f64::NEG_INFINITY, usize::MAX),
        low: (f64::INFINITY, usize::MAX),
        records: 0.0,
        most: (0.0, usize::MAX),
    };

    fn union(self, other: Self) -> Self {
        // Of two alike the first, whatever the order they were looked at in.
        let better = |a: (f64, usize), b: (f64, usize), sign: f64| {
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

impl Spawner<'_> {
    /// Refuses meshes and instances that reach beyond all reason, and notes what the rest takes.
    pub(super) fn check_reach(
        &mut self,
        placements: &[Placement],
        meshes: &BTreeMap<u32, Prototype>,
        patch: &TerrainPatch,
    ) {
        let bounds: BTreeMap<u32, Bounds> = meshes
            .iter()
            .filter_map(|(&id, prototype)| Some((id, prototype.mesh.bounds()?)))
            .map(|(id, (min, max))| (id, Bounds { min: min.as_dvec3(), max: max.as_dvec3() }))
            .collect();
        self.check_meshes(&bounds, meshes);
        let tile = self.is_periodic().then_some(patch.size);
        let is_lawful = self.check_placements(placements, &bounds);
        let seen = if is_lawful { seen(placements, &bounds, patch, tile) } else { Seen::NOTHING };
        let heights = patch.mesh.vertices.iter().map(|v| patch.base + patch.unit * f64::from(v.z));
        let (low, high) = heights
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
        let of_mesh = |p: &Prototype| (p.mesh.triangles.len() + p.mesh.discs.len()) as u64;
        let largest = meshes.values().max_by_key(|prototype| of_mesh(prototype));
        let ground = patch.mesh.triangles.len() as u64;
        self.reach = Reach {
            low: low.min(seen.low.0),
            high: high.max(seen.high.0),
            tile,
            primitives: meshes.values().map(of_mesh).sum::<u64>() + ground,
            records: seen.records as u64,
            largest_mesh: largest
                .filter(|largest| of_mesh(largest) > ground)
                .map_or_else(|| "terrain".to_owned(), |one| format!("meshes.{}", one.name.0)),
            most_records: match seen.most.1 {
                usize::MAX => "instances".to_owned(),
                instance => self.origins.place(self.scene, instance).0,
            },
        };
        if let Some(tile) = tile {
            self.check_images(seen, tile);
            self.check_tiles_high(seen, (low, high), tile);
        }
        self.check_alike(placements, meshes);
    }

    /// Meshes whose coordinates are no lengths in metres.
    fn check_meshes(&mut self, bounds: &BTreeMap<u32, Bounds>, meshes: &BTreeMap<u32, Prototype>) {
        for (id, Bounds { min, max }) in bounds {
            let farthest = min.abs().max(max.abs()).max_element();
            if let Some((message, _)) = LENGTH.problem(farthest) {
                let help = "if its file is in another unit, write that in metres as `unit_m`";
                let path = format!("meshes.{}", meshes[id].name.0);
                self.problems.push(Diagnostic::error(path, message).help(help));
            }
        }
    }

    /// Returns whether all positions and scales are lawful; reports the first that is not.
    fn check_placements(
        &mut self,
        placements: &[Placement],
        bounds: &BTreeMap<u32, Bounds>,
    ) -> bool {
        let first = placements.par_iter().enumerate().find_map_first(|(index, placement)| {
            Some((index, problem_of(placement, bounds.get(&placement.prototype.0))?))
        });
        let Some((index, (message, help))) = first else { return true };
        let (path, name) = self.origins.place(self.scene, index);
        self.problems.push(Diagnostic::error(path, format!("{name}: {message}")).help(help));
        false
    }

    fn check_images(&mut self, seen: Seen, tile: DVec2) {
        let (images, instance) = seen.most;
        if images <= MANY_IMAGES {
            return;
        }
        let (path, name) = self.origins.place(self.scene, instance);
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
        self.problems.push(problem.help(help));
    }

    fn check_tiles_high(&mut self, seen: Seen, (low, high): (f64, f64), tile: DVec2) {
        let height = self.reach.high - self.reach.low;
        let tiles = height / tile.min_element();
        if tiles <= MOST_TILES_HIGH {
            return;
        }
        // Whatever reaches farthest from the ground; the ground itself if nothing does.
        let (above, below) = (seen.high.0 - high, low - seen.low.0);
        let instance = if above >= below { seen.high.1 } else { seen.low.1 };
        let (path, name) = if above.max(below) > 0.0 {
            self.origins.place(self.scene, instance)
        } else {
            ("terrain".to_owned(), "the ground".to_owned())
        };
        let message = format!(
            "with {name}, the scene reaches from {:?} to {:?} m: it is {tiles:.0} times as high as its tile of \
             {} x {} m is wide, and rays would cross as many tiles; at most {MOST_TILES_HIGH} are allowed",
            self.reach.low, self.reach.high, tile.x, tile.y
        );
        let help = "choose a larger terrain, or write a height that is meant in metres";
        self.problems.push(Diagnostic::error(path, message).help(help));
    }

    /// Instances that stand in the place of others.
    fn check_alike(&mut self, placements: &[Placement], meshes: &BTreeMap<u32, Prototype>) {
        let mut poses: Vec<([u64; 6], u32)> =
            placements.par_iter().map(|p| (pose(p), p.id.0)).collect();
        poses.par_sort_unstable();
        let (mut alike, mut most) = (0, (0, 0));
        for run in poses.chunk_by(|a, b| a.0 == b.0) {
            alike += run.len() - 1;
            if run.len() > most.0 {
                most = (run.len(), run[0].1 as usize);
            }
        }
        if alike == 0 {
            return;
        }
        let (count, instance) = most;
        let Placement { position, prototype, .. } = placements[instance];
        let (path, _) = self.origins.place(self.scene, instance);
        let name = meshes.get(&prototype.0).map_or("", |prototype| &prototype.name.0);
        let DVec3 { x, y, z } = position;
        if count > MOST_ALIKE {
            let message = format!(
                "{count} instances of `{name}` stand in one place, ({x}, {y}, {z}), turned and scaled alike"
            );
            let help = "each ray there would meet all of them: keep one";
            self.problems.push(Diagnostic::error(path, message).help(help));
        } else {
            let message = format!(
                "{alike} instances stand exactly where others of the same mesh do, turned and scaled alike"
            );
            let help = format!("{count} of `{name}` stand at ({x}, {y}, {z}): keep one");
            self.problems.push(Diagnostic::warning(path, message).help(help));
        }
    }
}

/// Fault of the place of an instance.
fn problem_of(placement: &Placement, bounds: Option<&Bounds>) -> Option<(String, &'static str)> {
    let Placement { position, scale_horizontal, scale_vertical, .. } = placement;
    let all: [(&Range, f64); 5] = [
        (&LENGTH, position.x),
        (&LENGTH, position.y),
        (&HEIGHT, position.z),
        (&SCALE, (*scale_horizontal).into()),
        (&SCALE, (*scale_vertical).into()),
    ];
    if let Some(problem) = all.into_iter().find_map(|(range, value)| range.problem(value)) {
        return Some(problem);
    }
    let Bounds { min, max } = world_bounds(placement, bounds?);
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

/// Heights and images of all instances.
fn seen(
    placements: &[Placement],
    bounds: &BTreeMap<u32, Bounds>,
    patch: &TerrainPatch,
    tile: Option<DVec2>,
) -> Seen {
    let one = |(index, placement): (usize, &Placement)| {
        let Some(bounds) = bounds.get(&placement.prototype.0) else { return Seen::NOTHING };
        let Bounds { min, max } = world_bounds(placement, bounds);
        let images = tile.map_or(1.0, |tile| {
            // Offsets k, in tiles, for which the box and the tile overlap.
            let first = ((patch.corner - max.truncate()) / tile).ceil();
            let last = ((patch.corner + tile - min.truncate()) / tile).floor();
            (last - first + 1.0).max(DVec2::ONE).element_product()
        });
        Seen { high: (max.z, index), low: (min.z, index), records: images, most: (images, index) }
    };
    placements.par_iter().enumerate().map(one).reduce(|| Seen::NOTHING, Seen::union)
}

/// All that decides where an instance is.
fn pose(placement: &Placement) -> [u64; 6] {
    let Placement {
        position,
        yaw,
        tilt,
        tilt_azimuth,
        scale_horizontal,
        scale_vertical,
        prototype,
        id: _,
    } = placement;
    let pair = |a: f32, b: f32| u64::from(a.to_bits()) << 32 | u64::from(b.to_bits());
    [
        position.x.to_bits(),
        position.y.to_bits(),
        position.z.to_bits(),
        pair(*yaw, *tilt),
        pair(*scale_horizontal, *scale_vertical),
        u64::from(prototype.0) << 32 | u64::from(tilt_azimuth.to_bits()),
    ]
}
