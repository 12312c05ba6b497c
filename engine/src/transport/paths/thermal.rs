use std::ops::Range;

use glam::DVec3;

use super::history::{History, LitBands};
use super::tracer::PathTracer;
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::scattering::{Interaction, Lobe};
use crate::transport::band_blocks::Block;
use crate::transport::ray_queue::{RayQueue, RayResults};
use crate::transport::roulette::{RouletteThreshold, RussianRoulette, sample_with_roulette};

/// A random walk from the sensor that gathers the radiance that surfaces and the sky emit,
/// W m⁻² sr⁻¹ nm⁻¹; 0 in bands that hold no emission.
///
/// At each point the surface adds `(1 - ρ - τ) B(T)` with the reflectance of the visible side, and the sky adds
/// its radiance where the walk leaves the scene. The sun adds nothing. `T` is the sunlit temperature where the
/// sun is visible from the point, on either side.
#[derive(Clone, Debug)]
pub(in crate::transport) struct ThermalPath {
    history: History,
    /// Throughput in the representative bands.
    throughput: Vec<f32>,
    sampler: Sampler,
    /// Pending emission of a surface, whose temperature depends on the shadow rays to all suns.
    emission: Option<(Hit, Lobe)>,
    /// Pending weight of the continuation ray.
    continuation: Option<Lobe>,
    /// Direction of the continuation ray, if one is queued.
    direction: Option<DVec3>,
    order: u32,
    has_hit: bool,
}

impl ThermalPath {
    pub(in crate::transport) fn new(stage: &Stage) -> Self {
        let lanes = stage.models.spectra.representative_bands().lanes();
        Self {
            history: History::default(),
            throughput: vec![0.0; lanes],
            sampler: Sampler::new(Key::new(0), 0),
            emission: None,
            continuation: None,
            direction: None,
            order: 0,
            has_hit: false,
        }
    }

    /// Continuation ray, if the path survives Russian roulette.
    fn scatter(&mut self, stage: &Stage, hit: &Hit, surface: &Interaction<'_>) -> Option<Ray> {
        if self.order == stage.rules.max_order {
            return None;
        }
        self.order += 1;
        // Emission varies little between paths.
        let roulette = RussianRoulette {
            rules: &stage.rules,
            threshold: RouletteThreshold::Low,
            initial: 1.0,
        };
        let u = self.sampler.next_4d();
        let sample = sample_with_roulette(surface, &roulette, self.order, &mut self.throughput, u)?;
        self.continuation = Some(sample.weight);
        Some(hit.leave(sample.wi))
    }
}

impl PathTracer for ThermalPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        (self.sampler, self.direction) = (sampler, Some(ray.direction));
        (self.emission, self.continuation) = (None, None);
        (self.order, self.has_hit) = (0, false);
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, queue: &mut RayQueue) {
        let Some(thermal) = &stage.thermal else { return };
        if !self.has_hit {
            self.throughput.copy_from_slice(stage.models.spectra.representatives(thermal.bands));
            self.history.scatter(thermal.bands.into());
        }
        if let Some((hit, emitted)) = self.emission.take() {
            for (sun, is_occluded) in stage.light.suns.iter().zip(results.occluded) {
                let radiance = thermal.black_body(&hit, !is_occluded);
                self.history.light(emitted, radiance, 1.0, LitBands::from(&sun.bands));
            }
        }
        let Some(direction) = self.direction.take() else { return };
        if let Some(weight) = self.continuation.take() {
            self.history.scatter(weight);
        }
        let Some(hit) = results.hit else {
            if self.has_hit && direction.z > 0.0 {
                self.history.see(thermal.sky, 1.0);
            }
            return;
        };
        if stage.is_cut(hit) {
            return;
        }
        self.has_hit = true;
        let surface = stage.interaction(hit, -direction);
        let emitted = surface.absorbed_fraction();
        for ray in thermal.sun_rays(stage, hit, &mut self.sampler) {
            queue.push_shadow(ray);
            self.emission = Some((*hit, emitted));
        }
        if self.emission.is_none() {
            self.history.light(emitted, thermal.black_body(hit, false), 1.0, LitBands::ALL);
        }
        if let Some(ray) = self.scatter(stage, hit, &surface) {
            self.direction = Some(ray.direction);
            queue.push_closest(ray);
        }
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        let Some(thermal) = &stage.thermal else { return false };
        self.history.clear();
        self.history.see(thermal.sky, 1.0);
        direction.z > 0.0
    }

    #[inline(always)]
    fn write_radiance(&self, stage: &Stage, bands: Range<usize>, radiance: &mut [Block]) {
        let [radiance, ..] = radiance else { return };
        self.history.radiance(&stage.models, self.history.len(), bands, radiance);
    }
}
