use super::roulette;
use crate::accel::Ray;
use crate::extract::{Light, Stage};
use crate::sampling::Sampler;

/// Backward path tracing: the radiance that arrives along a ray, from next-event estimation to the
/// sun at each point of a random walk and from the sky where the walk leaves the scene.
///
/// One value is reused for many paths, so that a path allocates nothing.
#[derive(Clone, Debug)]
pub struct Path {
    throughput: Vec<f32>,
    radiance: Vec<f32>,
    rays: u64,
    log: Option<Vec<Traced>>,
}

/// A ray that a path traced, for benchmarks of the ray engine.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// The ray.
    pub ray: Ray,
    /// Whether any hit would do, as for a shadow ray, or the closest was asked for.
    pub any: bool,
}

impl Path {
    /// For stages with this many lanes.
    #[must_use]
    pub fn new(lanes: usize) -> Self {
        Self { throughput: vec![0.0; lanes], radiance: vec![0.0; lanes], rays: 0, log: None }
    }

    /// The same, with a log of all rays.
    #[must_use]
    pub fn logged(lanes: usize) -> Self {
        Self { log: Some(Vec::new()), ..Self::new(lanes) }
    }

    /// All rays so far, if they are logged.
    #[must_use]
    pub fn into_log(self) -> Vec<Traced> {
        self.log.unwrap_or_default()
    }

    fn note(&mut self, ray: Ray, any: bool) {
        self.rays += 1;
        if let Some(log) = &mut self.log {
            log.push(Traced { ray, any });
        }
    }

    /// Rays traced so far.
    #[must_use]
    pub const fn rays(&self) -> u64 {
        self.rays
    }

    /// Radiance over irradiance, `L / E` in sr⁻¹, of the last trace; shape `[lanes]`.
    #[must_use]
    pub fn radiance(&self) -> &[f32] {
        &self.radiance
    }

    /// Estimates the radiance that arrives against the ray's direction; whether the ray meets the
    /// scene at all. The direct light of sun and sky, which the sensor would look into, is left out.
    pub fn trace(&mut self, stage: &Stage, mut ray: Ray, sampler: &mut Sampler) -> bool {
        self.radiance.fill(0.0);
        self.throughput.fill(1.0);
        // Scattering events between the sensor and the ray.
        let mut order = 0;
        loop {
            self.note(ray, false);
            let Some(hit) = stage.geometry.closest(&ray) else {
                if order > 0 && ray.direction.z > 0.0 {
                    self.add_sky(&stage.light);
                }
                return order > 0;
            };
            if order == stage.rules.max_order {
                return true;
            }
            order += 1;
            let bsdf = &stage.surface(&hit).bsdf;
            let wo = -ray.direction;
            let sun = stage.light.beam.as_ref().map(|beam| (beam, beam.towards(sampler)));
            if let Some((beam, towards)) = sun
                && let Some(scattering) = bsdf.eval(hit.normal, wo, towards)
            {
                let shadow = hit.leave(towards);
                self.note(shadow, true);
                if !stage.geometry.occluded(&shadow) {
                    // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
                    let cosine = hit.normal.dot(towards).abs();
                    let scale = (cosine / towards.z * Light::RADIANCE_OF_SHARE) as f32;
                    let light = beam.share.iter().zip(scattering);
                    let paths = self.radiance.iter_mut().zip(&self.throughput);
                    for ((radiance, weight), (sun, f)) in paths.zip(light) {
                        *radiance += weight * sun * f * scale;
                    }
                }
            }
            // The last order's light can still come from the sky; without one the walk is over.
            if order == stage.rules.max_order && stage.light.dome.is_none() {
                return true;
            }
            let [lobe, u, v, chance] = sampler.next_event();
            let Some(scattered) = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])
            else {
                return true;
            };
            for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
                *weight *= factor * scattered.scale;
            }
            if !roulette::survives(&stage.rules, order, &mut self.throughput, chance) {
                return true;
            }
            ray = hit.leave(scattered.direction);
        }
    }

    fn add_sky(&mut self, light: &Light) {
        let Some(dome) = &light.dome else { return };
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), share) in paths.zip(&*dome.share) {
            *radiance += weight * share * Light::RADIANCE_OF_SHARE as f32;
        }
    }
}
