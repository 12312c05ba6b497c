use std::{
    ops::Range,
    sync::atomic::{AtomicUsize, Ordering},
};

use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;

use crate::geometry::Bounds;

use crate::accel::{
    layout::{Bounds32, ChildRef, Domain, InstanceRecord, MeshBvh, PeriodicCopies},
    simd::with_huge_pages,
};

use super::{BuildError, InstanceInput};

/// Maximum number of instances and periodic copies.
const MAX_RECORDS: usize = 1 << 30;

/// Maximum number of topmost parts of a mesh from which the boxes of instances follow, eight smaller ones in each:
/// with the boxes of the topmost alone, a ray enters a tenth more instances.
const MAX_TOPMOST_PARTS: usize = 64;

/// Records of all instances, and their boxes; the box of an instance without primitives is empty.
pub(super) fn records(
    meshes: &[MeshBvh],
    instances: impl IndexedParallelIterator<Item = InstanceInput>,
) -> Result<(Vec<InstanceRecord>, Vec<Bounds>), BuildError> {
    let count = instances.len();
    if count > MAX_RECORDS {
        return Err(BuildError::TooManyCopies { count, limit: MAX_RECORDS });
    }
    let parts: Vec<_> = meshes.iter().map(MeshParts::new).collect();
    let first_invalid = AtomicUsize::new(usize::MAX);
    let (mut records, mut boxes) = (with_huge_pages(count), Vec::new());
    instances
        .enumerate()
        .map(|(instance, input)| {
            let parts = parts.get(input.mesh as usize);
            parts.and_then(|parts| record(&input, parts)).unwrap_or_else(|| {
                first_invalid.fetch_min(instance, Ordering::Relaxed);
                let (object_from_world, translation) = ([0.0; 9], input.translation);
                let mesh = input.mesh;
                (InstanceRecord { object_from_world, mesh, translation }, Bounds::EMPTY)
            })
        })
        .unzip_into_vecs(&mut records, &mut boxes);
    let instance = first_invalid.into_inner();
    match records.get(instance) {
        None => Ok((records, boxes)),
        Some(&InstanceRecord { mesh, .. }) if mesh as usize >= meshes.len() => {
            Err(BuildError::Mesh { instance, mesh, count: meshes.len() })
        }
        Some(_) => Err(BuildError::Transform { instance }),
    }
}

/// Record of an instance and its box in the world; `None` if its map is not finite or not invertible.
fn record(input: &InstanceInput, parts: &MeshParts) -> Option<(InstanceRecord, Bounds)> {
    let determinant = input.linear.determinant();
    if !determinant.is_finite() || determinant == 0.0 || !input.translation.is_finite() {
        return None;
    }
    let object_from_world = input.linear.inverse().to_cols_array().map(|v| v as f32);
    let exact = DMat3::from_cols_array(&object_from_world.map(f64::from));
    let determinant = exact.determinant();
    let linear = exact.inverse();
    if !determinant.is_finite() || determinant == 0.0 || !linear.is_finite() {
        return None;
    }
    let (mut min, mut max) = (input.translation, input.translation);
    let mut bounds = Bounds::EMPTY;
    if !parts.topmost.is_empty() {
        for axis in 0..3 {
            let (low, high) = parts.extent(linear.row(axis));
            min[axis] += low;
            max[axis] += high;
        }
        bounds = Bounds { min, max };
    }
    (min.is_finite() && max.is_finite()).then_some((
        InstanceRecord { object_from_world, mesh: input.mesh, translation: input.translation },
        bounds,
    ))
}

/// Boxes around parts of a mesh, from its topmost nodes: their union, when rotated, is tighter than the rotated box
/// around the whole mesh.
struct MeshParts {
    /// Boxes of the topmost parts and the ranges of their own parts, those that are farthest from the middle first.
    topmost: Vec<(PartBox, Range<usize>)>,
    parts: Vec<PartBox>,
}

impl MeshParts {
    fn new(mesh: &MeshBvh) -> Self {
        let mut topmost = Vec::new();
        if mesh.tree.root != ChildRef::NONE {
            topmost.push((mesh.bounds, mesh.tree.root));
        }
        let mut next = 0;
        while next < topmost.len() && topmost.len() + 7 <= MAX_TOPMOST_PARTS {
            let (_, node) = topmost[next];
            if node.is_inner() {
                topmost.remove(next);
                topmost.extend(children(mesh, node));
            } else {
                next += 1;
            }
        }
        let mut parts = Vec::new();
        let mut topmost: Vec<_> = topmost
            .into_iter()
            .map(|(bounds, node)| {
                let start = parts.len();
                if node.is_inner() {
                    parts.extend(children(mesh, node).map(|(part, _)| PartBox::from(part)));
                } else {
                    parts.push(PartBox::from(bounds));
                }
                (PartBox::from(bounds), start..parts.len())
            })
            .collect();
        let middle = PartBox::from(mesh.bounds).center;
        let distance = |part: &PartBox| part.center.distance_squared(middle);
        topmost.sort_by(|(a, _), (b, _)| distance(b).total_cmp(&distance(a)));
        Self { topmost, parts }
    }

    /// Lowest and highest scalar product of `direction` and a point of the parts.
    fn extent(&self, direction: DVec3) -> (f64, f64) {
        let absolute = direction.abs();
        let project = |part: &PartBox| {
            let (center, half) = (direction.dot(part.center), absolute.dot(part.half));
            (center - half, center + half)
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (part, parts) in &self.topmost {
            let (part_low, part_high) = project(part);
            if part_low < low || part_high > high {
                for (part_low, part_high) in self.parts[parts.clone()].iter().map(project) {
                    low = low.min(part_low);
                    high = high.max(part_high);
                }
            }
        }
        (low, high)
    }
}

struct PartBox {
    center: DVec3,
    half: DVec3,
}

impl From<Bounds32> for PartBox {
    fn from(bounds: Bounds32) -> Self {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        Self { center: 0.5 * (min + max), half: 0.5 * (max - min) }
    }
}

/// Children of a node, with boxes that are not padded beyond the mesh's own.
fn children(mesh: &MeshBvh, node: ChildRef) -> impl Iterator<Item = (Bounds32, ChildRef)> {
    let node = &mesh.tree.nodes[node.index()];
    let present = (0..8).filter(|&slot| node.child.0[slot] != ChildRef::NONE.0);
    present.map(|slot| {
        let side =
            |side: usize| Vec3::from_array([0, 1, 2].map(|axis| node.bounds[axis][side].0[slot]));
        let (min, max) = (side(0).max(mesh.bounds.min), side(1).min(mesh.bounds.max));
        (Bounds32 { min, max }, ChildRef(node.child.0[slot]))
    })
}

/// Adds records of the periodic copies that reach into the tile, and clips every box to the tile: a ray that has
/// left the tile meets the geometry outside as a copy inside.
pub(super) fn add_periodic_copies(
    records: &mut Vec<InstanceRecord>,
    boxes: &mut Vec<Bounds>,
    domain: &Domain,
) -> Result<PeriodicCopies, BuildError> {
    let size = domain.size();
    // Rays may overrun the tile by rounding; see `TileIter::cross`.
    let max_coordinate = domain.min.abs().max(domain.max.abs()).max_element();
    let room = max_coordinate * (-36_f64).exp2();
    let tile = Bounds {
        min: (domain.min - room).extend(f64::NEG_INFINITY),
        max: (domain.max + room).extend(f64::INFINITY),
    };
    let instances = records.len();
    let mut originals = Vec::new();
    for index in 0..instances {
        let Bounds { min, max } = boxes[index];
        if boxes[index].is_empty() {
            continue;
        }
        // The offsets k for which min + k size <= tile.max and max + k size >= tile.min.
        let first = ((tile.min - max).truncate() / size).ceil();
        let last = ((tile.max - min).truncate() / size).floor();
        let copies = (last - first + 1.0).max(glam::DVec2::ZERO);
        let count = (copies.x * copies.y) as usize;
        if records.len() + count > MAX_RECORDS {
            let count = records.len() + count;
            return Err(BuildError::TooManyCopies { count, limit: MAX_RECORDS });
        }
        let mut clipped = Bounds::EMPTY;
        for j in first.y as i32..=last.y as i32 {
            for i in first.x as i32..=last.x as i32 {
                let shift = DVec3::new(f64::from(i) * size.x, f64::from(j) * size.y, 0.0);
                let part =
                    Bounds { min: (min + shift).max(tile.min), max: (max + shift).min(tile.max) };
                if (i, j) == (0, 0) {
                    clipped = part;
                    continue;
                }
                let record = records[index];
                records.push(InstanceRecord { translation: record.translation + shift, ..record });
                boxes.push(part);
                originals.push((index as u32, [i, j]));
            }
        }
        boxes[index] = clipped;
    }
    Ok(PeriodicCopies { instances: instances as u32, originals })
}
