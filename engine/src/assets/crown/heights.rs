//! Heights of leaves where they have no closed form: a piecewise linear density.

use std::f64::consts::PI;

use super::{CrownError, shape};
use crate::document::{CrownShape, LeafProfile};

/// Slices that a crown's height is cut into, at least.
const SLICES: f64 = 1024.0;

/// A distribution of heights above the crown's base.
pub(super) struct HeightDistribution(Vec<Slice>);

/// Heights within which the density is linear.
struct Slice {
    /// Lower and upper end, m.
    z: [f64; 2],
    /// Leaf area in a metre of height at either end, any unit.
    density: [f64; 2],
    /// Leaf area from the lowest slice to the upper end of this one, the same unit.
    up_to: f64,
}

impl HeightDistribution {
    /// The heights of a crown's leaves; none where [`shape::point`] knows them.
    pub(super) fn new(
        outline: &CrownShape,
        profile: &LeafProfile,
        base_m: f64,
    ) -> Result<Option<Self>, CrownError> {
        let top = shape::height(outline);
        let section = |z: f64| PI * shape::radius(outline, z).powi(2);
        let (points, by_volume) = match profile {
            LeafProfile::Even if shape::is_simple(outline) => return Ok(None),
            LeafProfile::Even => (vec![(0.0, 1.0), (top, 1.0)], true),
            LeafProfile::Density(points) => (above_base(points, base_m)?, true),
            LeafProfile::Area(points) => (above_base(points, base_m)?, false),
        };
        let mut slices = Vec::new();
        let mut up_to = 0.0;
        for ends in points.windows(2) {
            let [(low, at_low), (high, at_high)] = [ends[0], ends[1]];
            let at = |z: f64| {
                let leaves = at_low + (at_high - at_low) * ((z - low) / (high - low));
                leaves.max(0.0) * if by_volume { section(z) } else { 1.0 }
            };
            for smooth in shape::smooth_between(outline).windows(2) {
                let (from, to) = (low.max(smooth[0]), high.min(smooth[1]));
                if from >= to {
                    continue;
                }
                let count = (SLICES * (to - from) / top).ceil();
                let edge = |i: f64| from + (to - from) * (i / count);
                for i in 0..count as u32 {
                    let z = [edge(i.into()), edge(f64::from(i) + 1.0).min(to)];
                    let density = z.map(at);
                    up_to += 0.5 * (density[0] + density[1]) * (z[1] - z[0]);
                    slices.push(Slice { z, density, up_to });
                }
            }
        }
        if !(up_to > 0.0 && up_to.is_finite()) {
            return Err(CrownError::ProfileBesideCrown { base: base_m, top: base_m + top });
        }
        Ok(Some(Self(slices)))
    }

    /// The height above the base below which the share `u` of all leaves is, m; `u` in [0, 1).
    pub(super) fn at(&self, u: f64) -> f64 {
        let whole = self.0.last().map_or(0.0, |slice| slice.up_to);
        let wanted = u * whole;
        let index = self.0.partition_point(|slice| slice.up_to <= wanted).min(self.0.len() - 1);
        let Slice { z: [low, high], density: [f, g], up_to } = self.0[index];
        let below = if index == 0 { 0.0 } else { self.0[index - 1].up_to };
        let part = ((wanted - below) / (up_to - below)).clamp(0.0, 1.0);
        // f s + (g - f) s² / 2 = part (f + g) / 2, in the form that does not cancel.
        let root = (f * f + part * (g * g - f * f)).max(0.0).sqrt();
        let s = if f + root > 0.0 { part * (f + g) / (f + root) } else { 0.0 };
        (low + (high - low) * s).min(high)
    }
}

/// The points of a profile with heights above the crown's base.
fn above_base(points: &[(f64, f64)], base_m: f64) -> Result<Vec<(f64, f64)>, CrownError> {
    if points.len() < 2 {
        return Err(CrownError::ShortProfile { points: points.len() });
    }
    for (index, &(height, leaves)) in points.iter().enumerate() {
        if !(leaves >= 0.0 && leaves.is_finite() && height.is_finite()) {
            return Err(CrownError::BadProfile { index, height, leaves });
        }
    }
    if let Some(index) = points.windows(2).position(|pair| pair[0].0 > pair[1].0) {
        return Err(CrownError::ProfileNotUpwards { index: index + 1 });
    }
    Ok(points.iter().map(|&(height, leaves)| (height - base_m, leaves)).collect())
}
