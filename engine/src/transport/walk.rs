use glam::DVec3;

use super::Path;
use crate::accel::Ray;
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::Sampler;

/// Follows a ray from a sensor into the scene; one value is reused for many rays.
pub(super) trait Walk {
    /// Follows the ray; whether it meets the scene at all.
    fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool;

    /// Takes what a ray in this direction, which met nothing, finds in the sky; whether it finds
    /// anything. For cameras that see the sky.
    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool;

    /// What the last ray found, shape `[columns]` or longer.
    fn values(&self) -> &[f32];

    /// Adds what the last ray found to a cell.
    fn add_to(&self, sums: &mut Sums, cell: usize) {
        sums.add(cell, self.values(), 1.0);
    }

    /// Columns of what is summed over the whole image alone.
    fn zones(&self) -> usize {
        0
    }

    /// Adds what the last ray found to sums over the whole image, shape `[cells, zones]`.
    fn add_to_zones(&self, _: &mut Sums, _: usize) {}

    /// Rays traced so far.
    fn rays(&self) -> u64;
}

impl Walk for Path {
    fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool {
        self.trace(stage, ray, sampler)
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        self.see_sky(stage, direction)
    }

    fn values(&self) -> &[f32] {
        self.radiance()
    }

    fn add_to(&self, sums: &mut Sums, cell: usize) {
        self.add_to(sums, cell);
    }

    fn rays(&self) -> u64 {
        self.rays()
    }
}
