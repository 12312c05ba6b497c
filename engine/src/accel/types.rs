use glam::{DMat3, DVec2, DVec3};

use crate::components::Mesh;

use super::tree::Ref;

/// A mesh, and what its parts are made of.
#[derive(Clone, Copy, Debug)]
pub struct MeshInput<'a> {
    /// Geometry in object space, m.
    pub mesh: &'a Mesh,
    /// Surface of each part, shape `[parts]`.
    pub surfaces: &'a [u32],
}

/// Where a mesh stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstanceInput {
    /// Place of the mesh in the list that [`super::Scene::build`] is given.
    pub mesh: u32,
    /// Linear part of `world_from_object`: any rotation, scale or mirror image.
    pub linear: DMat3,
    /// World position of the object's origin, m.
    pub translation: DVec3,
}

/// What becomes of a ray at the sides of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// It leaves; geometry outside counts like any other.
    Isolated,
    /// It re-enters through the opposite side.
    Periodic,
}

/// The scene's rectangle; its tile when periodic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// South-west corner, m.
    pub min: DVec2,
    /// North-east corner, m.
    pub max: DVec2,
    /// What happens at its sides.
    pub boundary: Boundary,
}

/// A half-line that light travels along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start, m.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// The primitive that it starts on, which it cannot hit.
    pub from: Option<Departure>,
}

/// The primitive that a ray starts on, in one of the copies that a periodic scene has of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Departure {
    pub(super) instance: u32,
    pub(super) block: Ref,
    pub(super) lane: u8,
    /// Periods from the instance's own place to this copy of it, in the frame of the ray's origin.
    pub(super) tile: [i32; 2],
}

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Along the ray, wraps included, m.
    pub distance: f64,
    /// On the surface, m; inside the tile when the scene is periodic.
    pub point: DVec3,
    /// Unit geometric normal of the front side, whichever side was hit.
    ///
    /// The front of a triangle is where its corners run counter-clockwise in object space, that of
    /// a disc where its normal points; a mirror image has the image of the front.
    pub normal: DVec3,
    /// Surface of the part that was hit.
    pub surface: u32,
    /// Place of the instance in the list that [`super::Scene::build`] was given; a periodic image
    /// counts as its original.
    pub instance: u32,
    /// Triangle in the mesh, or the number of triangles plus the disc.
    pub primitive: u32,
    /// Bound of the distance between `point` and the exact surface, m.
    pub(super) error: f64,
    pub(super) departure: Departure,
}

impl Hit {
    /// The ray from here in a unit direction.
    ///
    /// Its origin lies off the surface by a bound of the rounding error of [`Hit::point`], on the
    /// side that the direction goes to, and the ray cannot hit the primitive that it leaves.
    #[must_use]
    pub fn leave(&self, direction: DVec3) -> Ray {
        let side = self.error.copysign(self.normal.dot(direction));
        Ray { origin: self.point + side * self.normal, direction, from: Some(self.departure) }
    }
}

/// Memory that a scene keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Triangles and discs in meshes; each counts once, however many instances there are.
    pub primitives: usize,
    /// Bytes of all meshes: primitives, ids and the nodes above them.
    pub mesh_bytes: usize,
    /// Instances; images of border crossers are not counted.
    pub instances: usize,
    /// Bytes of all instances, their images and the nodes above them.
    pub instance_bytes: usize,
}
