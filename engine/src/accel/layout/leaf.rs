use glam::DVec3;

use crate::accel::simd::{Lanes, Words};

/// Bit of a lane's id that is set when the lane is a parallelogram.
pub(in crate::accel) const PARALLELOGRAM: u32 = 1 << 31;

/// Block of up to eight triangles or parallelograms.
///
/// Corners are kept as the mesh has them, bit for bit, and not as edges: neighbours then agree on
/// which side of their common edge a ray passes.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(in crate::accel) struct PlanarBlock {
    /// Three corners, each as x, y, z; a parallelogram's fourth is `b + c - a`.
    pub corners: [[Lanes; 3]; 3],
    /// Length of the longer of the two edges at the first corner; negative in an unused lane.
    pub edge: Lanes,
    /// Triangle in the mesh, the first of two with [`PARALLELOGRAM`].
    pub id: Words,
}

impl PlanarBlock {
    /// Corners of one lane, m, object space.
    #[inline(always)]
    pub(in crate::accel) fn lane(&self, lane: usize) -> [DVec3; 3] {
        let lane = lane & 7;
        self.corners.each_ref().map(|corner| {
            DVec3::new(corner[0].0[lane].into(), corner[1].0[lane].into(), corner[2].0[lane].into())
        })
    }
}

/// Block of up to eight discs.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(in crate::accel) struct DiscBlock {
    pub center: [Lanes; 3],
    /// Unit within rounding.
    pub normal: [Lanes; 3],
    /// Negative in an unused lane.
    pub radius: Lanes,
    /// Disc in the mesh.
    pub id: Words,
}

impl DiscBlock {
    /// Centre of one lane, m, object space.
    #[inline(always)]
    pub(in crate::accel) fn center(&self, lane: usize) -> DVec3 {
        vector(&self.center, lane)
    }

    /// Normal of one lane, object space.
    #[inline(always)]
    pub(in crate::accel) fn normal(&self, lane: usize) -> DVec3 {
        vector(&self.normal, lane)
    }

    /// Radius of one lane, m, object space.
    #[inline(always)]
    pub(in crate::accel) fn radius(&self, lane: usize) -> f64 {
        self.radius.0[lane & 7].into()
    }
}

/// One lane of three coordinates.
#[inline(always)]
fn vector(lanes: &[Lanes; 3], lane: usize) -> DVec3 {
    let lane = lane & 7;
    DVec3::new(lanes[0].0[lane].into(), lanes[1].0[lane].into(), lanes[2].0[lane].into())
}
