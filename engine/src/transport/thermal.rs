use glam::DVec3;

use super::{Walk, roulette};
use crate::accel::{Hit, Ray};
use crate::extract::{Stage, Thermal};
use crate::sampling::Sampler;

/// A random walk from the sensor that gathers what surfaces and the sky emit, W m⁻² sr⁻¹ nm⁻¹; 0 in
/// bands that hold no emission.
///
/// At each point the surface adds `(1 - ρ - τ) B(T)` with the reflectance of the side that is seen,
/// and the sky adds its radiance where the walk leaves the scene. Nothing of the sun is in it. `T` is
/// the sunlit temperature where the sun is visible from the point, on whichever side.
#[derive(Clone, Debug)]
pub(super) struct ThermalPath {
    throughput: Vec<f32>,
    radiance: Vec<f32>,
    rays: u64,
}

impl ThermalPath {
    pub(super) fn new(stage: &Stage) -> Self {
        let dark = vec![0.0; stage.lanes()];
        Self { throughput: dark.clone(), radiance: dark, rays: 0 }
    }

    fn closest(&mut self, stage: &Stage, ray: &Ray) -> Option<Hit> {
        self.rays += 1;
        stage.geometry.closest(ray)
    }

    /// Adds what the surface emits towards `-direction`.
    fn add_surface(
        &mut self,
        stage: &Stage,
        thermal: &Thermal,
        (hit, scattered): (&Hit, &[f32]),
        sampler: &mut Sampler,
    ) {
        let (black, rays) = thermal.black_body(stage, hit, sampler);
        self.rays += rays;
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), (black, scattered)) in paths.zip(black.iter().zip(scattered)) {
            *radiance += weight * (1.0 - scattered) * black;
        }
    }

    fn walk(
        &mut self,
        stage: &Stage,
        thermal: &Thermal,
        mut ray: Ray,
        sampler: &mut Sampler,
    ) -> bool {
        self.throughput.copy_from_slice(&thermal.bands);
        let mut order = 0;
        loop {
            let Some(hit) = self.closest(stage, &ray) else {
                if order > 0 && ray.direction.z > 0.0 {
                    let paths = self.radiance.iter_mut().zip(&self.throughput);
                    for ((radiance, weight), sky) in paths.zip(&*thermal.sky) {
                        *radiance += weight * sky;
                    }
                }
                return order > 0;
            };
            if stage.is_cut(&hit) {
                return order > 0;
            }
            let bsdf = &stage.surface(&hit).bsdf;
            let wo = -ray.direction;
            self.add_surface(stage, thermal, (&hit, bsdf.scattered(hit.normal, wo)), sampler);
            if order == stage.rules.max_order {
                return true;
            }
            order += 1;
            let [lobe, u, v, chance] = sampler.next_event();
            let Some(scattered) = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])
            else {
                return true;
            };
            for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
                *weight *= factor * scattered.scale;
            }
            if !roulette::survives(&stage.rules, order, 1.0, &mut self.throughput, chance) {
                return true;
            }
            ray = hit.leave(scattered.direction);
        }
    }
}

impl Walk for ThermalPath {
    fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool {
        self.radiance.fill(0.0);
        let Some(thermal) = &stage.thermal else { return false };
        self.walk(stage, thermal, ray, sampler)
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        let Some(thermal) = &stage.thermal else { return false };
        self.radiance.copy_from_slice(&thermal.sky);
        direction.z > 0.0
    }

    fn values(&self) -> &[f32] {
        &self.radiance
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
