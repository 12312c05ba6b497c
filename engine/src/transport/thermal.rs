use glam::DVec3;

use super::walk::{Answer, Ask, Walk};
use super::{Roulette, roulette};
use crate::accel::{Hit, Ray};
use crate::extract::{Stage, Thermal};
use crate::sampling::{Key, Sampler};

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
    sampler: Sampler,
    /// Where the ray goes that the path waits for.
    direction: DVec3,
    order: u32,
    has_met: bool,
    rays: u64,
}

impl ThermalPath {
    pub(super) fn new(stage: &Stage) -> Self {
        let dark = vec![0.0; stage.lanes()];
        Self {
            throughput: dark.clone(),
            radiance: dark,
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            order: 0,
            has_met: false,
            rays: 0,
        }
    }

    /// Adds what the surface emits towards `-direction`.
    fn add_surface(&mut self, stage: &Stage, thermal: &Thermal, hit: &Hit, scattered: &[f32]) {
        let (black, rays) = thermal.black_body(stage, hit, &mut self.sampler);
        self.rays += rays;
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), (black, scattered)) in paths.zip(black.iter().zip(scattered)) {
            *radiance += weight * (1.0 - scattered) * black;
        }
    }

    /// The ray on which the path goes on, if it does.
    fn scatter(&mut self, stage: &Stage, thermal: &Thermal, hit: &Hit) -> Option<Ray> {
        let bsdf = &stage.surface(hit).bsdf;
        let wo = -self.direction;
        self.add_surface(stage, thermal, hit, bsdf.scattered(hit.normal, wo));
        if self.order == stage.rules.max_order {
            return None;
        }
        self.order += 1;
        let [lobe, u, v, chance] = self.sampler.next_event();
        let scattered = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])?;
        for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
            *weight *= factor * scattered.scale;
        }
        // What surfaces emit differs little from path to path.
        let weak = Roulette::Gentle.weak();
        roulette::survives(&stage.rules, self.order, weak, &mut self.throughput, chance)
            .then(|| hit.leave(scattered.direction))
    }
}

impl Walk for ThermalPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.radiance.fill(0.0);
        (self.sampler, self.direction) = (sampler, ray.direction);
        (self.order, self.has_met) = (0, false);
    }

    fn go_on(&mut self, stage: &Stage, Answer { hit, .. }: Answer) -> Ask {
        let Some(thermal) = &stage.thermal else { return Ask::END };
        if !self.has_met {
            self.throughput.copy_from_slice(&thermal.bands);
        }
        let Some(hit) = hit else {
            if self.has_met && self.direction.z > 0.0 {
                let paths = self.radiance.iter_mut().zip(&self.throughput);
                for ((radiance, weight), sky) in paths.zip(&*thermal.sky) {
                    *radiance += weight * sky;
                }
            }
            return Ask::END;
        };
        if stage.is_cut(&hit) {
            return Ask::END;
        }
        self.has_met = true;
        let onward = self.scatter(stage, thermal, &hit);
        self.direction = onward.map_or(self.direction, |ray| ray.direction);
        Ask { shadow: None, onward }
    }

    fn has_met(&self) -> bool {
        self.has_met
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
