use glam::{DVec3, Vec3};

use crate::geometry::{round_down, round_up};

/// Axis-aligned box in `f32`; boxes that a hierarchy is built over must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::accel) struct Bounds32 {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds32 {
    pub(in crate::accel) const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// Smallest `f32` box around an `f64` one.
    pub(in crate::accel) fn from_f64(min: DVec3, max: DVec3) -> Self {
        Self {
            min: Vec3::new(round_down(min.x), round_down(min.y), round_down(min.z)),
            max: Vec3::new(round_up(max.x), round_up(max.y), round_up(max.z)),
        }
    }

    pub(in crate::accel) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub(in crate::accel) fn padded(self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    pub(in crate::accel) fn half_area(self) -> f32 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Twice the centre.
    pub(in crate::accel) fn double_center(self) -> Vec3 {
        self.min + self.max
    }

    /// Largest absolute coordinate.
    pub(in crate::accel) fn max_coordinate(self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }
}

/// Padding of the boxes of a hierarchy, with which the rounding of the slab test never loses a primitive.
///
/// With `m = max_coordinate`, the test runs on `|origin| <= 4 m`; each of its roundings, of relative size 2⁻²⁴,
/// moves a plane of the box by at most that fraction of `|origin|`, of the plane's coordinate, or of the distance
/// between the two: together less than `32 · 2⁻²⁴ m`.
pub(in crate::accel) fn slab_padding(max_coordinate: f32) -> f32 {
    max_coordinate * (-19_f32).exp2()
}
