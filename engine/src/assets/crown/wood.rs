//! Trunk and branches.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{GeneratedCrown, shape};
use crate::components::Mesh;
use crate::document::Trunk;

/// Sides of the trunk's prism.
const TRUNK_SIDES: u32 = 12;

/// Sides of a branch's prism.
const BRANCH_SIDES: u32 = 8;

/// Length of branches, as a fraction of the distance from the trunk's axis to the outline.
const REACH: f64 = 0.9;

/// Thickness of a branch's tip as a share of its foot.
const TAPER: f64 = 0.2;

/// Adds trunk and branches of the crown to a mesh.
pub(super) fn grow(crown: &GeneratedCrown, mesh: &mut Mesh) {
    let Some(trunk) = &crown.trunk else { return };
    let radii = [0.5 * trunk.diameter_m, 0.5 * trunk.tip_diameter_m];
    prism([DVec3::ZERO, DVec3::Z * trunk.height_m], radii, TRUNK_SIDES, mesh);

    for Branch { start, end, foot } in branches(crown) {
        prism([start, end], [foot, TAPER * foot], BRANCH_SIDES, mesh);
    }
}

/// A branch.
pub(super) struct Branch {
    /// Point where it leaves the trunk's axis, m.
    pub(super) start: DVec3,
    /// Its tip, m.
    pub(super) end: DVec3,
    /// Its radius at the trunk, m.
    foot: f64,
}

/// The angle that never lines up again, rad: 2π over the golden ratio squared.
pub(super) fn golden_angle() -> f64 {
    TAU * (1.5 - 0.5 * 5_f64.sqrt())
}

/// The branches of a crown, from the lowest up.
pub(super) fn branches(crown: &GeneratedCrown) -> Vec<Branch> {
    let (Some(trunk), Some(branches)) = (&crown.trunk, &crown.branches) else { return Vec::new() };
    let (sin, cos) = branches.zenith_deg.to_radians().sin_cos();
    let (low, high) = (crown.base_m.max(0.0), trunk.height_m);
    let branch = |index: u32| {
        let part = (f64::from(index) + 0.5) / f64::from(branches.count);
        let z = low + (high - low) * part;
        let (sin_azimuth, cos_azimuth) = (golden_angle() * f64::from(index)).sin_cos();
        let direction = DVec3::new(sin * sin_azimuth, sin * cos_azimuth, cos);
        let length = REACH * shape::way_out(&crown.shape, z - crown.base_m, direction);
        // No branch is thicker than the trunk where it starts.
        let foot = (0.5 * branches.diameter_m).min(radius_at(trunk, z));
        let start = DVec3::Z * z;
        Branch { start, end: start + length * direction, foot }
    };
    (0..branches.count).map(branch).collect()
}

fn radius_at(trunk: &Trunk, z: f64) -> f64 {
    let part = z / trunk.height_m;
    0.5 * (trunk.diameter_m * (1.0 - part) + trunk.tip_diameter_m * part)
}

/// Adds a tapered prism around an axis, closed at both ends, its fronts outwards; a tip of radius 0
/// is a point.
fn prism(axis: [DVec3; 2], radii: [f64; 2], sides: u32, mesh: &mut Mesh) {
    let Some(along) = (axis[1] - axis[0]).try_normalize() else { return };
    let (right, _) = along.any_orthonormal_pair();
    let up = along.cross(right);
    let mut ring = |center: DVec3, radius: f64| {
        let first = mesh.vertices.len() as u32;
        let count = if radius > 0.0 { sides } else { 1 };
        mesh.vertices.extend((0..count).map(|side| {
            let (sin, cos) = (TAU * f64::from(side) / f64::from(sides)).sin_cos();
            (center + radius * (cos * right + sin * up)).as_vec3()
        }));
        // Corners of the ring by side; a point is all of them.
        move |side: u32| first + side % count
    };
    let (foot, tip) = (ring(axis[0], radii[0]), ring(axis[1], radii[1]));
    let mut add = |corners: [u32; 3]| {
        if corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0] {
            mesh.triangles.push(corners);
        }
    };
    for side in 0..sides {
        add([foot(side), foot(side + 1), tip(side + 1)]);
        add([foot(side), tip(side + 1), tip(side)]);
    }
    for side in 1..sides - 1 {
        add([foot(0), foot(side + 1), foot(side)]);
        add([tip(0), tip(side), tip(side + 1)]);
    }
}
