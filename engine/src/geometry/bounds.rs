use glam::DVec3;

/// An axis-parallel box, m; empty when a lower corner lies above the upper one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner, m.
    pub min: DVec3,
    /// Highest corner, m.
    pub max: DVec3,
}

impl Bounds {
    /// Empty box: the neutral element of [`Bounds::union`].
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Smallest box around this one and a point.
    #[must_use]
    pub fn with(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// Returns whether the box holds no point.
    #[must_use]
    pub fn is_empty(self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns the range `(enter, leave)` of `t` within which `origin + t direction` is inside the box, clipped to
    /// `t >= 0`; `None` if the line misses the box.
    #[must_use]
    pub fn clip(self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let inverse = direction[axis].recip();
            let (low, high) = (self.min[axis], self.max[axis]);
            let (near, far) = if inverse > 0.0 { (low, high) } else { (high, low) };
            // On a face and parallel to it, 0 · ∞ is NaN, and min and max drop it: inside.
            enter = enter.max((near - origin[axis]) * inverse);
            leave = leave.min((far - origin[axis]) * inverse);
        }
        (enter <= leave).then_some((enter, leave))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_clipped_to_what_is_inside() {
        let cube = Bounds { min: DVec3::ZERO, max: DVec3::ONE };
        assert_eq!(cube.clip(DVec3::new(-1.0, 0.5, 0.5), DVec3::X), Some((1.0, 2.0)));
        assert_eq!(cube.clip(DVec3::new(-1.0, 1.0, 0.5), DVec3::X), Some((1.0, 2.0)), "in a face");
        assert_eq!(cube.clip(DVec3::new(-1.0, 1.1, 0.5), DVec3::X), None);
        assert_eq!(cube.clip(DVec3::splat(0.5), -DVec3::Z), Some((0.0, 0.5)));
        assert_eq!(Bounds::EMPTY.clip(DVec3::ZERO, DVec3::X), None);
    }
}
