use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::geometry::Bounds;

use crate::accel::layout::{Bounds32, ChildRef, Domain, InstanceRecord, MeshBvh, PeriodicCopies};

use super::{BuildError, InstanceInput};

/// Maximum number of instances and periodic copies.
const MAX_RECORDS: usize = 1 << 30;

/// Maximum number of boxes of parts of a mesh; an instance's box is the union of these, transformed.
const MAX_PART_BOXES: usize = 64;

/// Records of all instances, and their boxes; the box of an instance without primitives is empty.
pub(super) fn records(
    meshes: &[MeshBvh],
    instances: &[InstanceInput],
) -> Result<(Vec<InstanceRecord>, Vec<Bounds>), BuildError> {
    if instances.len() > MAX_RECORDS {
        return Err(BuildError::TooManyCopies { count: instances.len(), limit: MAX_RECORDS });
    }
    let part_boxes: Vec<_> = meshes.iter().map(part_boxes).collect();
    let made: Result<Vec<_>, _> = instances
        .par_iter()
        .enumerate()
        .map(|(number, input)| {
            let Some(boxes) = part_boxes.get(input.mesh as usize) else {
                let (mesh, count) = (input.mesh, meshes.len());
                return Err(BuildError::Mesh { instance: number, mesh, count });
            };
            record(input, boxes).ok_or(BuildError::Transform { instance: number })
        })
        .collect();
    Ok(made?.into_iter().unzip())
}

/// Record of an instance and its box in the world; `None` if its map is not finite or not invertible.
fn record(input: &InstanceInput, part_boxes: &[Bounds32]) -> Option<(InstanceRecord, Bounds)> {
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
    let absolute = DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
    let bounds = part_boxes.iter().fold(Bounds::EMPTY, |all, part| {
        let (min, max) = (part.min.as_dvec3(), part.max.as_dvec3());
        let center = linear * (0.5 * (min + max)) + input.translation;
        let half = absolute * (0.5 * (max - min));
        all.union(Bounds { min: center - half, max: center + half })
    });
    let Bounds { min, max } = bounds;
    let is_valid = part_boxes.is_empty() || (min.is_finite() && max.is_finite());
    is_valid.then_some((
        InstanceRecord { object_from_world, mesh: input.mesh, translation: input.translation },
        bounds,
    ))
}

/// Boxes around parts of a mesh, from its topmost nodes: their union, when rotated, is tighter than the rotated box
/// around the whole mesh.
fn part_boxes(mesh: &MeshBvh) -> Vec<Bounds32> {
    if mesh.tree.root == ChildRef::NONE {
        return Vec::new();
    }
    let mut parts = vec![(mesh.bounds, mesh.tree.root)];
    let mut next = 0;
    while next < parts.len() && parts.len() + 7 <= MAX_PART_BOXES {
        let (_, node) = parts[next];
        if !node.is_inner() {
            next += 1;
            continue;
        }
        parts.remove(next);
        let node = &mesh.tree.nodes[node.index()];
        for slot in 0..8 {
            let child = ChildRef(node.child.0[slot]);
            if child != ChildRef::NONE {
                let side = |side: usize| {
                    glam::Vec3::from_array(std::array::from_fn(|axis| {
                        node.bounds[axis][side].0[slot]
                    }))
                };
                // The mesh's own box is not padded.
                let part = Bounds32 {
                    min: side(0).max(mesh.bounds.min),
                    max: side(1).min(mesh.bounds.max),
                };
                parts.push((part, child));
            }
        }
    }
    parts.into_iter().map(|(part, _)| part).collect()
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
