//! Coordinates of a surface along an axis, and fractions of its area below any of them.

use std::f64::consts::PI;

use super::FlatPatch;

/// Range of one coordinate of a flat surface, m, in a form from which the fraction of its area below a value follows.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) enum CoordinateSpan {
    /// Coordinates of the corners of a triangle, from low to high.
    Triangle([f64; 3]),
    /// Coordinate of the centre of an ellipse, and distance of its lowest and highest point from it.
    Ellipse(f64, f64),
}

impl CoordinateSpan {
    pub(in crate::queries) fn new(patch: &FlatPatch, axis: usize) -> Self {
        let (at, u, v) = (patch.origin[axis], patch.u[axis], patch.v[axis]);
        if patch.is_ellipse {
            return Self::Ellipse(at, u.hypot(v));
        }
        let (low, high) = if u < v { (u, v) } else { (v, u) };
        Self::Triangle(if low > 0.0 {
            [at, at + low, at + high]
        } else if high > 0.0 {
            [at + low, at, at + high]
        } else {
            [at + low, at + high, at]
        })
    }

    /// Lowest and highest coordinate.
    pub(in crate::queries) fn range(&self) -> (f64, f64) {
        match *self {
            Self::Triangle([low, _, high]) => (low, high),
            Self::Ellipse(center, reach) => (center - reach, center + reach),
        }
    }

    /// Fraction of the area whose coordinate is below a value.
    pub(in crate::queries) fn fraction_below(&self, value: f64) -> f64 {
        let (first, last) = self.range();
        if value <= first {
            return 0.0;
        }
        if value > last {
            return 1.0;
        }
        match *self {
            Self::Triangle([low, middle, high]) => {
                if value < middle {
                    (value - low).powi(2) / ((middle - low) * (high - low))
                } else if high > middle {
                    1.0 - (high - value).powi(2) / ((high - middle) * (high - low))
                } else {
                    1.0
                }
            }
            Self::Ellipse(center, reach) => {
                let d = ((value - center) / reach).clamp(-1.0, 1.0);
                1.0 - (d.acos() - d * (1.0 - d * d).sqrt()) / PI
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Fractions are those of the patch, cut as a polygon.
    #[test]
    fn fractions_are_those_of_pieces() {
        for is_ellipse in [false, true] {
            let (u, v) = (DVec3::new(2.0, 0.5, -0.3), DVec3::new(-0.4, 1.0, -0.8));
            let patch = FlatPatch { origin: DVec3::new(10.0, -3.0, 5.0), u, v, is_ellipse };
            let (low, high) = patch.bounds();
            for axis in 0..3 {
                let span = CoordinateSpan::new(&patch, axis);
                assert!((span.range().0 - low[axis]).abs() < 1e-14);
                assert!((span.range().1 - high[axis]).abs() < 1e-14);
                for step in -1..22 {
                    let value = low[axis] + (high[axis] - low[axis]) * f64::from(step) / 20.0;
                    let [below, _] = patch.whole().split(patch.coordinate(axis), value);
                    let expected = if below.is_empty() { 0.0 } else { below.fraction() };
                    let fraction = span.fraction_below(value);
                    assert!((fraction - expected).abs() < 1e-14, "{fraction} {expected}");
                }
            }
        }
    }
}
