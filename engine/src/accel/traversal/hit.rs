use glam::{DMat3, DVec3};

use crate::accel::layout::{ChildRef, PARALLELOGRAM, TwoLevelBvh};

use super::{
    tiles::{self, TileRay},
    trace::Candidate,
};

/// Half-line that light travels along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Start, m.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
    /// Primitive that the ray starts on, which it cannot hit.
    pub from: Option<Departure>,
}

/// Primitive that a ray starts on, in one of the copies that a periodic scene has of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Departure {
    instance: u32,
    block: ChildRef,
    lane: u8,
    /// Number of periods from the instance itself to this copy of it, in the frame of the ray's origin.
    tile: [i32; 2],
}

/// Intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, through all tiles, m.
    pub distance: f64,
    /// Point on the surface, m; inside the tile if the scene is periodic.
    pub point: DVec3,
    /// Unit geometric normal of the front side, whichever side was hit.
    ///
    /// The front of a triangle is where its corners run counter-clockwise in object space, that of
    /// a disc where its normal points; a mirror image has the image of the front.
    pub normal: DVec3,
    /// Surface of the part that was hit.
    pub surface: u32,
    /// Index into the instances that [`TwoLevelBvh::build`] was given; a periodic copy counts as its original.
    pub instance: u32,
    /// Triangle in the mesh, or the number of triangles plus the disc.
    pub primitive: u32,
    /// Bound of the distance between `point` and the exact surface, m.
    pub(in crate::accel) error: f64,
    departure: Departure,
}

impl Hit {
    /// Returns the ray from here in a unit direction.
    ///
    /// Its origin is moved off the surface by a bound of the rounding error of [`Hit::point`], to the
    /// side of the direction, and the ray cannot hit the primitive that it leaves.
    #[must_use]
    pub fn leave(&self, direction: DVec3) -> Ray {
        let side = self.error.copysign(self.normal.dot(direction));
        Ray { origin: self.point + side * self.normal, direction, from: Some(self.departure) }
    }
}

/// Block of primitives, and the bits of its lanes that a ray cannot hit.
#[derive(Clone, Copy)]
pub(super) struct SkippedLanes {
    pub block: ChildRef,
    pub lanes: u32,
}

impl TwoLevelBvh {
    /// Order of candidates at one distance: instance, then primitive.
    pub(super) fn rank(&self, candidate: &Candidate) -> (u32, u32) {
        (candidate.record, self.primitive(candidate))
    }

    fn primitive(&self, candidate: &Candidate) -> u32 {
        let first = candidate.id & !PARALLELOGRAM;
        if candidate.block.is_discs() {
            self.mesh_of(candidate.record).triangles + first
        } else {
            first
        }
    }

    /// Lanes that a ray cannot hit in an instance, because it starts there.
    #[inline(always)]
    pub(super) fn skipped(&self, ray: &TileRay<'_>, record: u32) -> SkippedLanes {
        let Some(from) = ray.from else { return SkippedLanes { block: ChildRef::NONE, lanes: 0 } };
        let (instance, offset) = self.copies.original(record);
        let x = ray.tile[0].wrapping_add(offset[0]) == from.tile[0];
        let y = ray.tile[1].wrapping_add(offset[1]) == from.tile[1];
        // No branch: the processor cannot predict whether a ray is in the instance that it leaves.
        let lanes = u32::from((instance == from.instance) & x & y) << from.lane;
        SkippedLanes { block: from.block, lanes }
    }

    /// Computes the hit of the closest candidate. Always inlined: it runs between steps of other rays, all of whose
    /// registers a call would save and restore.
    #[inline(always)]
    pub(super) fn resolve(&self, ray: &TileRay<'_>, candidate: &Candidate) -> Hit {
        let mesh = self.mesh_of(candidate.record);
        let record = &self.records[candidate.record as usize];
        let object_from_world = DMat3::from_cols_array(&record.object_from_world.map(f64::from));
        let mut primitive = self.primitive(candidate);
        // The normal, and the square of the length that its rounding is relative to.
        let (front, square) = if candidate.block.is_discs() {
            let front = mesh.discs[candidate.block.index()].normal(candidate.lane.into());
            (front, front.length_squared())
        } else {
            let corners = mesh.planar[candidate.block.index()].lane(candidate.lane.into());
            let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
            let front = ab.cross(ac);
            if candidate.id & PARALLELOGRAM != 0 {
                let origin = object_from_world * (ray.origin - record.translation);
                let at = origin + candidate.distance * (object_from_world * ray.direction);
                // Beyond the diagonal, the sum of the barycentric coordinates is above 1.
                let is_beyond = (corners[2] - corners[1]).cross(at - corners[1]).dot(front) < 0.0;
                if is_beyond {
                    primitive = mesh.second_triangle(candidate.block, candidate.lane, primitive);
                }
            }
            (front, ab.length_squared() * ac.length_squared())
        };
        let up = object_from_world.transpose() * front;
        let pace = 1.0 / up.length();
        let point = ray.origin + candidate.distance * ray.direction;
        let spread = object_from_world.to_cols_array().map(|v| v * v).iter().sum::<f64>();
        let lever = (ray.origin - record.translation).abs().element_sum() + candidate.distance;
        let size = ray.origin.abs().max_element()
            + record.translation.abs().max_element()
            + candidate.distance;
        // Each of some 16 roundings in `exact` is relative to the lever in object space; along
        // the normal, it grows by how much edges that are nearly parallel tilt the plane and by how
        // much the map squeezes that direction.
        let error = f64::EPSILON * (16.0 * (spread * square).sqrt() * pace * lever + 4.0 * size);
        let (point, shift) = tiles::wrap(&self.domain, point);
        let (instance, offset) = self.copies.original(candidate.record);
        let tile = [offset[0].wrapping_sub(shift[0]), offset[1].wrapping_sub(shift[1])];
        let departure = Departure { instance, block: candidate.block, lane: candidate.lane, tile };
        Hit {
            distance: candidate.distance,
            point,
            normal: up * pace,
            surface: mesh.surface(primitive),
            instance,
            primitive,
            error,
            departure,
        }
    }
}
