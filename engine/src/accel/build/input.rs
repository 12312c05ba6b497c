use glam::{DMat3, DVec3};

use crate::components::Mesh;

/// Mesh with the surfaces of its parts.
#[derive(Clone, Copy, Debug)]
pub struct MeshInput<'a> {
    /// Geometry in object space, m.
    pub mesh: &'a Mesh,
    /// Surface of each part, shape `[parts]`.
    pub surfaces: &'a [u32],
}

/// Placement of a mesh in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceInput {
    /// Index into the meshes that [`TwoLevelBvh::build`](crate::accel::TwoLevelBvh::build) is given.
    pub mesh: u32,
    /// Linear part of `world_from_object`: any rotation, scale or mirror image.
    pub linear: DMat3,
    /// World position of the object's origin, m.
    pub translation: DVec3,
}
