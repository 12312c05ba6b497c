//! Area of a mesh whose heights and widths are scaled by different factors.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

/// Area of surfaces under scales `diag(1, 1, r)`, as a function of the ratio `r`; m².
///
/// Each surface has the area `√(p r² + q)`, with the squares `p` and `q` of the horizontal and vertical part of the
/// vector of its area. The sum over all is smooth in `ln r`: its singularities lie at a distance of π/2 from the real
/// axis. A polynomial through Chebyshev points converges geometrically, and is exact but for rounding.
///
/// Source: Trefethen (2013), "Approximation theory and approximation practice", theorem 8.2.
#[derive(Clone, Debug)]
pub(super) struct StretchedArea {
    /// Middle and half length of the range of `ln r`.
    middle: f64,
    half: f64,
    /// Chebyshev points in [-1, 1], and the areas there.
    points: Vec<(f64, f64)>,
}

/// Relative error that the polynomial is to stay below.
const ERROR: f64 = 1e-13;

impl StretchedArea {
    /// Area for all ratios between two, which are positive.
    ///
    /// - `areas`: vectors of areas, m²: perpendicular to the surfaces, as long as they are large
    pub(super) fn new(areas: impl Iterator<Item = DVec3>, (low, high): (f64, f64)) -> Self {
        let (low, high) = (low.ln(), high.ln());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let distance = FRAC_PI_2 / half;
        // Half axes of the largest ellipse without a singularity.
        let convergence = (distance + distance.hypot(1.0)).ln();
        let count = if half > 0.0 { (-ERROR.ln() / convergence).ceil() as usize + 2 } else { 1 };
        let place = |index: usize| (PI * (index as f64 + 0.5) / count as f64).cos();
        let mut points: Vec<(f64, f64)> = (0..count).map(|index| (place(index), 0.0)).collect();
        let squares: Vec<f64> =
            points.iter().map(|point| (2.0 * (middle + half * point.0)).exp()).collect();
        for vector in areas {
            let (p, q) = (vector.truncate().length_squared(), vector.z * vector.z);
            for ((_, area), square) in points.iter_mut().zip(&squares) {
                *area += (p * square + q).sqrt();
            }
        }
        Self { middle, half, points }
    }

    /// Area for a ratio, m².
    ///
    /// Source: Berrut and Trefethen (2004), "Barycentric Lagrange interpolation", SIAM Review 46, eq. 4.2 and 5.4.
    pub(super) fn at(&self, ratio: f64) -> f64 {
        if let [(_, area)] = self.points[..] {
            return area;
        }
        let x = (ratio.ln() - self.middle) / self.half;
        let (mut sum, mut weights) = (0.0, 0.0);
        let mut sign = 1.0;
        for &(point, area) in &self.points {
            let distance = x - point;
            if distance == 0.0 {
                return area;
            }
            let weight = sign * (1.0 - point * point).sqrt() / distance;
            (sum, weights, sign) = (sum + weight * area, weights + weight, -sign);
        }
        sum / weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_those_of_the_surfaces_for_all_ratios() {
        let vectors: Vec<DVec3> = (0..200_u32)
            .map(|index| {
                let at = |factor: u32| f64::from(index * factor % 101) - 50.0;
                // Some are level, some vertical.
                DVec3::new(at(31), at(57) * f64::from(index % 3), at(71) * f64::from(index % 2))
            })
            .collect();
        for (low, high) in [(1.0, 1.0), (0.8, 1.3), (0.2, 7.0), (1e-3, 1e3)] {
            let stretched = StretchedArea::new(vectors.iter().copied(), (low, high));
            for step in 0..=50 {
                let ratio: f64 = low * (high / low).powf(f64::from(step) / 50.0);
                let scale = DVec3::new(ratio, ratio, 1.0);
                let expected: f64 = vectors.iter().map(|vector| (*vector * scale).length()).sum();
                let error = stretched.at(ratio) / expected - 1.0;
                assert!(error.abs() < 1e-12, "{ratio}: {error:e}");
            }
        }
    }
}
