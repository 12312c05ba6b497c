//! First surface that a sensor sees: sunlit or shaded, ground or canopy.

use std::ops::Range;

use glam::DVec3;

use super::tracer::PathTracer;
use crate::accel::Ray;
use crate::extract::{DiscPoint, Stage};
use crate::sampling::{Key, Sampler};
use crate::statistics::Sums;
use crate::transport::band_blocks::Block;
use crate::transport::ray_queue::{RayQueue, RayResults};

/// Columns of a first surface: for each sun of the stage the four components in the order of their numbers (1 sunlit
/// ground, 2 sunlit canopy, 3 shaded ground, 4 shaded canopy), and gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ComponentColumns {
    suns: usize,
}

impl ComponentColumns {
    /// Number of components.
    pub const COMPONENTS: usize = 4;

    /// Columns of a stage: without a sun all is shaded.
    #[must_use]
    pub fn new(stage: &Stage) -> Self {
        Self { suns: stage.light.suns.len().max(1) }
    }

    /// Number of columns.
    #[must_use]
    pub const fn count(self) -> usize {
        self.gap() + 1
    }

    /// The four components of a sun.
    #[must_use]
    pub const fn of_sun(self, sun: usize) -> Range<usize> {
        Self::COMPONENTS * sun..Self::COMPONENTS * (sun + 1)
    }

    /// Column of gaps: ground that is seen from above, and the sky where a camera sees it.
    #[must_use]
    pub const fn gap(self) -> usize {
        Self::COMPONENTS * self.suns
    }
}

/// Number of rings of 1° about the vertical.
pub const GAP_RINGS: usize = 90;

/// A ray to the first surface and shadow rays from there to all suns.
#[derive(Clone, Debug)]
pub(in crate::transport) struct FirstHitPath {
    columns: ComponentColumns,
    /// Values of the columns, and behind them a 1 if the scene or the sky is visible.
    values: Vec<f32>,
    /// 1 to count gaps by zenith angle above, -1 to count them by nadir angle below.
    upright: Option<f64>,
    /// Cosine of that angle.
    cosine: f64,
    sampler: Sampler,
    direction: DVec3,
    /// Suns whose shadow rays are queued, in their order.
    queued: Vec<usize>,
    has_hit: bool,
}

impl FirstHitPath {
    pub(in crate::transport) fn new(stage: &Stage, upright: Option<f64>) -> Self {
        let columns = ComponentColumns::new(stage);
        Self {
            columns,
            values: vec![0.0; columns.count() + 1],
            upright,
            cosine: 0.0,
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            queued: Vec::new(),
            has_hit: false,
        }
    }

    /// Counts a surface that is seen as shaded from all suns.
    fn count_shaded(&mut self, is_ground: bool) {
        let Self { columns, values, .. } = self;
        values.fill(0.0);
        for sun in 0..columns.suns {
            values[columns.of_sun(sun)][2 + usize::from(!is_ground)] = 1.0;
        }
        values[columns.gap()] = f32::from(is_ground && self.direction.z < 0.0);
        values[columns.count()] = 1.0;
    }
}

impl PathTracer for FirstHitPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        (self.sampler, self.direction) = (sampler, ray.direction);
        self.cosine = ray.direction.z * self.upright.unwrap_or(0.0);
        self.queued.clear();
        self.has_hit = false;
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, queue: &mut RayQueue) {
        if self.has_hit {
            for (sun, _) in self.queued.iter().zip(results.occluded).filter(|(_, it)| !**it) {
                let components = &mut self.values[self.columns.of_sun(*sun)];
                let (sunlit, shaded) = components.split_at_mut(2);
                sunlit.swap_with_slice(shaded);
            }
            return;
        }
        let Some(hit) = results.hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_hit = true;
        self.count_shaded(stage.is_ground(hit));
        let suns = &stage.light.suns;
        let point = DiscPoint::sample(suns, &mut self.sampler);
        // The visible side must face the sun.
        let is_front = hit.normal.dot(self.direction) < 0.0;
        for (index, sun) in suns.iter().enumerate() {
            let sun = sun.towards(point);
            if is_front == (hit.normal.dot(sun) > 0.0) {
                self.queued.push(index);
                queue.push_shadow(hit.leave(sun));
            }
        }
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, _: &Stage, direction: DVec3) -> bool {
        let Self { columns, values, .. } = self;
        values.fill(0.0);
        values[columns.gap()] = 1.0;
        values[columns.count()] = 1.0;
        direction.z > 0.0
    }

    fn write_radiance(&self, _: &Stage, columns: Range<usize>, values: &mut [Block]) {
        for (value, column) in values.iter_mut().flatten().zip(&self.values[columns]) {
            *value = f64::from(*column);
        }
    }

    fn image_columns(&self) -> usize {
        if self.upright.is_some() { 2 * GAP_RINGS } else { 0 }
    }

    fn add_to_image_sums(&self, sums: &mut Sums, cell: usize) {
        if self.cosine > 0.0 {
            let ring = (self.cosine.min(1.0).acos().to_degrees() as usize).min(GAP_RINGS - 1);
            sums.add_at(cell, 2 * ring, self.values[self.columns.gap()].into());
            sums.add_at(cell, 2 * ring + 1, 1.0);
        }
    }
}
