use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::geometry::Bounds;

use crate::accel::{
    layout::{Domain, InstanceRecord, MeshBvh, PeriodicCopies},
    simd::with_huge_pages,
};

use super::{BuildError, InstanceInput, extent::MeshExtent};

/// Maximum number of instances and periodic copies.
const MAX_RECORDS: usize = 1 << 30;

/// Records of all instances, and their boxes; the box of an instance without primitives is empty.
pub(super) fn records(
    meshes: &[MeshBvh],
    instances: impl IndexedParallelIterator<Item = InstanceInput>,
) -> Result<(Vec<InstanceRecord>, Vec<Bounds>), BuildError> {
    let count = instances.len();
    if count > MAX_RECORDS {
        return Err(BuildError::TooManyCopies { count, limit: MAX_RECORDS });
    }
    let extents: Vec<_> =
        meshes.par_iter().map(|mesh| MeshExtent::new(mesh, count / meshes.len())).collect();
    let first_invalid = AtomicUsize::new(usize::MAX);
    let (mut records, mut boxes) = (with_huge_pages(count), Vec::new());
    instances
        .enumerate()
        .map(|(instance, input)| {
            let extent = extents.get(input.mesh as usize);
            extent.and_then(|extent| record(&input, extent)).unwrap_or_else(|| {
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
fn record(input: &InstanceInput, extent: &MeshExtent) -> Option<(InstanceRecord, Bounds)> {
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
    if !extent.is_empty() {
        for axis in 0..3 {
            let (low, high) = extent.along(linear.row(axis));
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
