//! Construction of the hierarchies: meshes and instances in, a [`TwoLevelBvh`] out.
//!
//! `mesh` and `instances` turn the input into boxes and leaves, those of instances by the `extent` of their mesh;
//! `wide` builds the eight-wide hierarchy over boxes from binary ones (`binary`) by collapsing them (`collapse`).

mod binary;
mod collapse;
mod error;
mod extent;
mod input;
mod instances;
mod leaves;
mod mesh;
mod parallelogram;
mod subtree;
mod wide;

use glam::DVec3;
use rayon::prelude::*;

use crate::geometry::Bounds;

use crate::accel::{
    layout::{
        Bounds32, ChildRef, Domain, MIN_FETCHED_BYTES, MeshBvh, PeriodicCopies, TwoLevelBvh,
        WideBvh, slab_padding,
    },
    simd::SimdLevel,
};
use collapse::CollapsedBvh;
use wide::BuildSettings;

pub use error::BuildError;
pub use input::{InstanceInput, MeshInput};

impl TwoLevelBvh {
    /// Builds both levels. The result depends on nothing but the input, whatever the number of
    /// threads.
    ///
    /// # Errors
    /// The first mesh, instance or domain that is not valid. Degenerate primitives and meshes
    /// without any are valid, and never hit.
    pub fn build(
        meshes: &[MeshInput<'_>],
        instances: impl IndexedParallelIterator<Item = InstanceInput>,
        domain: Domain,
    ) -> Result<Self, BuildError> {
        check_domain(&domain)?;
        let meshes = meshes
            .par_iter()
            .enumerate()
            .map(|(number, input)| mesh::build(number, input))
            .collect::<Result<Vec<_>, _>>()?;
        let (mut records, mut boxes) = instances::records(&meshes, instances)?;
        let bounds = union(&boxes);
        let copies = if domain.is_periodic {
            instances::add_periodic_copies(&mut records, &mut boxes, &domain)?
        } else {
            PeriodicCopies::default()
        };
        let covered = union(&boxes);
        let center =
            if covered.is_empty() { DVec3::ZERO } else { 0.5 * (covered.min + covered.max) };
        let (instances, max_coordinate) = build_top_level(boxes, center);
        // The boxes of the nodes are padded for f32; this is padded for f64.
        let room = DVec3::splat(f64::from(max_coordinate) * (-40_f64).exp2());
        let covered = Bounds { min: covered.min - room, max: covered.max + room };
        let mesh_bytes: usize = meshes.iter().map(MeshBvh::bytes).sum();
        Ok(Self {
            meshes,
            records,
            copies,
            instances,
            domain,
            bounds,
            covered,
            center,
            level: SimdLevel::detect(),
            is_fetched_ahead: mesh_bytes >= MIN_FETCHED_BYTES,
        })
    }
}

fn check_domain(domain: &Domain) -> Result<(), BuildError> {
    let Domain { min, max, .. } = *domain;
    if min.is_finite() && max.is_finite() && domain.size().min_element() > 0.0 {
        return Ok(());
    }
    let (min_x, min_y, max_x, max_y) = (min.x, min.y, max.x, max.y);
    Err(BuildError::Domain { min_x, min_y, max_x, max_y })
}

fn union(boxes: &[Bounds]) -> Bounds {
    boxes.par_iter().copied().reduce(|| Bounds::EMPTY, Bounds::union)
}

/// Hierarchy over the boxes of records that are not empty, in coordinates from `center`, and its largest
/// absolute coordinate.
fn build_top_level(boxes: Vec<Bounds>, center: DVec3) -> (WideBvh, f32) {
    let present: Vec<u32> =
        (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty()).collect();
    let present_boxes: Vec<Bounds32> = present
        .par_iter()
        .map(|&i| boxes[i as usize])
        .map(|b| Bounds32::from_f64(b.min - center, b.max - center))
        .collect();
    drop(boxes);
    let max_coordinate =
        present_boxes.par_iter().map(|b| b.max_coordinate()).reduce(|| 0.0, f32::max);
    let padding = slab_padding(max_coordinate);
    let settings = BuildSettings { leaf_size: 1, leaf_cost: 1.0, padding };
    let CollapsedBvh { mut tree, leaves } = wide::build(present_boxes, settings, |_| false);
    wide::link_leaves(&mut tree, |leaf| {
        ChildRef(ChildRef::LEAF | present[leaves.order[leaf] as usize])
    });
    (tree, max_coordinate)
}
