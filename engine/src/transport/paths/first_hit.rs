//! First surface that a sensor sees: sunlit or shaded, ground or canopy.

use std::ops::Range;

use glam::DVec3;

use super::tracer::PathTracer;
use crate::accel::Ray;
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::statistics::Sums;
use crate::transport::band_blocks::Block;
use crate::transport::ray_queue::{RayQueue, RayResults};

/// Number of columns: the four components in the order of their numbers (1 sunlit ground, 2 sunlit canopy,
/// 3 shaded ground, 4 shaded canopy) and gaps.
pub const COMPONENT_COLUMNS: usize = 5;

/// Column of gaps: ground that is seen from above, and the sky where a camera sees it.
pub const GAP_COLUMN: usize = 4;

/// Number of rings of 1° about the vertical.
pub const GAP_RINGS: usize = 90;

/// A ray to the first surface and a shadow ray from there to the sun.
#[derive(Clone, Debug)]
pub(in crate::transport) struct FirstHitPath {
    /// The columns, and behind them a 1 if the scene or the sky is visible.
    columns: [f32; COMPONENT_COLUMNS + 1],
    /// 1 to count gaps by zenith angle above, -1 to count them by nadir angle below.
    upright: Option<f64>,
    /// Cosine of that angle.
    cosine: f64,
    sampler: Sampler,
    direction: DVec3,
    /// True if the shadow ray that is queued starts at the ground.
    queued_at_ground: Option<bool>,
    has_hit: bool,
}

impl FirstHitPath {
    pub(in crate::transport) fn new(upright: Option<f64>) -> Self {
        Self {
            columns: [0.0; COMPONENT_COLUMNS + 1],
            upright,
            cosine: 0.0,
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            queued_at_ground: None,
            has_hit: false,
        }
    }

    fn count(&mut self, is_sunlit: bool, is_ground: bool) {
        self.columns = [0.0; COMPONENT_COLUMNS + 1];
        self.columns[2 * usize::from(!is_sunlit) + usize::from(!is_ground)] = 1.0;
        self.columns[GAP_COLUMN] = f32::from(is_ground && self.direction.z < 0.0);
        self.columns[COMPONENT_COLUMNS] = 1.0;
    }
}

impl PathTracer for FirstHitPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        (self.sampler, self.direction) = (sampler, ray.direction);
        self.cosine = ray.direction.z * self.upright.unwrap_or(0.0);
        (self.queued_at_ground, self.has_hit) = (None, false);
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, queue: &mut RayQueue) {
        if let Some(is_ground) = self.queued_at_ground {
            return self.count(results.is_lit(), is_ground);
        }
        let Some(hit) = results.hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_hit = true;
        let is_ground = stage.is_ground(hit);
        let sun = stage.light.sun.as_ref().map(|sun| sun.towards(&mut self.sampler));
        // The visible side must face the sun.
        let is_front = hit.normal.dot(self.direction) < 0.0;
        let Some(sun) = sun.filter(|sun| is_front == (hit.normal.dot(*sun) > 0.0)) else {
            return self.count(false, is_ground);
        };
        self.queued_at_ground = Some(is_ground);
        queue.push_shadow(hit.leave(sun));
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, _: &Stage, direction: DVec3) -> bool {
        self.columns = [0.0; COMPONENT_COLUMNS + 1];
        self.columns[GAP_COLUMN] = 1.0;
        self.columns[COMPONENT_COLUMNS] = 1.0;
        direction.z > 0.0
    }

    fn write_radiance(&self, _: &Stage, columns: Range<usize>, values: &mut [Block]) {
        for (value, column) in values.iter_mut().flatten().zip(&self.columns[columns]) {
            *value = f64::from(*column);
        }
    }

    fn image_columns(&self) -> usize {
        if self.upright.is_some() { 2 * GAP_RINGS } else { 0 }
    }

    fn add_to_image_sums(&self, sums: &mut Sums, cell: usize) {
        if self.cosine > 0.0 {
            let ring = (self.cosine.min(1.0).acos().to_degrees() as usize).min(GAP_RINGS - 1);
            sums.add_at(cell, 2 * ring, self.columns[GAP_COLUMN].into());
            sums.add_at(cell, 2 * ring + 1, 1.0);
        }
    }
}
