use glam::DVec3;

use super::{Part, roulette, spectra};
use crate::accel::{Hit, Ray};
use crate::extract::{Light, Stage};
use crate::film::Sums;
use crate::sampling::Sampler;

/// Backward path tracing: the radiance that arrives along a ray, from next-event estimation to the
/// sun at each point of a random walk and from the sky where the walk leaves the scene.
///
/// One value is reused for many paths, so that a path allocates nothing.
#[derive(Clone, Debug)]
pub struct Path {
    throughput: Vec<f32>,
    radiance: Vec<f32>,
    /// What the sun adds if it is seen.
    light: Vec<f32>,
    rays: u64,
    /// Whether to tell light of different orders apart.
    orders_apart: bool,
    /// Radiance of the last path when it was scattered for the second time.
    single: Vec<f32>,
    /// How often it was scattered, and whether first at the ground.
    orders: u32,
    met_ground: bool,
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
        let dark = vec![0.0; lanes];
        Self {
            throughput: dark.clone(),
            radiance: dark.clone(),
            light: dark.clone(),
            rays: 0,
            orders_apart: false,
            single: dark,
            orders: 0,
            met_ground: true,
            log: None,
        }
    }

    /// The same, which tells light of different orders apart if asked to.
    #[must_use]
    pub fn of_orders(lanes: usize, orders_apart: bool) -> Self {
        Self { orders_apart, ..Self::new(lanes) }
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

    fn note(&mut self, ray: &Ray, any: bool) {
        self.rays += 1;
        if let Some(log) = &mut self.log {
            log.push(Traced { ray: *ray, any });
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

    /// Adds what the last trace found to a cell: the radiance or, with orders apart, the whole and
    /// its parts in a row. The differences are exact in f64, so the parts sum to the whole.
    pub fn add_to(&self, sums: &mut Sums, cell: usize) {
        if !self.orders_apart {
            return sums.add(cell, &self.radiance, 1.0);
        }
        let bands = sums.bands() / spectra(true);
        sums.add_with(cell, |channel| {
            let (spectrum, lane) = (channel / bands, channel % bands);
            let whole = f64::from(self.radiance[lane]);
            let single = if self.orders < 2 { whole } else { f64::from(self.single[lane]) };
            match spectrum.checked_sub(1).map(|part| Part::ALL[part]) {
                None => whole,
                Some(Part::Multiple) => whole - single,
                Some(part) if part == Part::of(1, self.met_ground) => single,
                Some(_) => 0.0,
            }
        });
    }

    /// Estimates the radiance that arrives against the ray's direction; whether the ray meets the
    /// scene at all. The direct light of sun and sky, which the sensor would look into, is left out.
    pub fn trace(&mut self, stage: &Stage, ray: Ray, sampler: &mut Sampler) -> bool {
        self.radiance.fill(0.0);
        self.throughput.fill(1.0);
        // Light that met nothing at all is uncollided.
        (self.orders, self.met_ground) = (0, true);
        self.note(&ray, false);
        let first = stage.geometry.closest(&ray);
        let Some(first) = first.filter(|hit| !stage.is_cut(hit)) else { return false };
        if stage.rules.max_order == 0 {
            return true;
        }
        let (mut hit, mut wo) = (first, -ray.direction);
        // Scattering events between the sensor and the ray.
        for order in 1.. {
            self.orders = order;
            match order {
                1 => self.met_ground = stage.is_ground(&hit),
                2 if self.orders_apart => self.single.copy_from_slice(&self.radiance),
                _ => {}
            }
            let shadow = self.sunlight(stage, &hit, wo, sampler);
            let onward = self.scatter(stage, &hit, wo, order, sampler);
            let (is_dark, next) = match (&shadow, &onward) {
                // One walk towards the sun and one onwards fill each other's waiting time.
                (Some(shadow), Some(onward)) => stage.geometry.occluded_and_closest(shadow, onward),
                (Some(shadow), None) => (stage.geometry.occluded(shadow), None),
                (None, Some(onward)) => (true, stage.geometry.closest(onward)),
                (None, None) => (true, None),
            };
            if !is_dark {
                for (radiance, light) in self.radiance.iter_mut().zip(&self.light) {
                    *radiance += light;
                }
            }
            let Some(onward) = onward else { return true };
            let Some(found) = next else {
                if onward.direction.z > 0.0 {
                    self.add_sky(&stage.light);
                }
                return true;
            };
            if order == stage.rules.max_order || stage.is_cut(&found) {
                return true;
            }
            (hit, wo) = (found, -onward.direction);
        }
        true
    }

    /// The ray towards the sun, if it could bring light, and that light if nothing is in its way.
    fn sunlight(
        &mut self,
        stage: &Stage,
        hit: &Hit,
        wo: DVec3,
        sampler: &mut Sampler,
    ) -> Option<Ray> {
        let beam = stage.light.beam.as_ref()?;
        let towards = beam.towards(sampler);
        let scattering = stage.surface(hit).bsdf.eval(hit.normal, wo, towards)?;
        // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
        let cosine = hit.normal.dot(towards).abs();
        let scale = (cosine / towards.z * Light::RADIANCE_OF_SHARE) as f32;
        let paths = self.light.iter_mut().zip(&self.throughput);
        for ((light, weight), (sun, f)) in paths.zip(beam.share.iter().zip(scattering)) {
            *light = weight * sun * f * scale;
        }
        let shadow = hit.leave(towards);
        self.note(&shadow, true);
        Some(shadow)
    }

    /// The ray on which the path goes on, if it does; the throughput is then that ray's.
    fn scatter(
        &mut self,
        stage: &Stage,
        hit: &Hit,
        wo: DVec3,
        order: u32,
        sampler: &mut Sampler,
    ) -> Option<Ray> {
        // The last order's light can still come from the sky; without one the walk is over.
        if order == stage.rules.max_order && stage.light.dome.is_none() {
            return None;
        }
        let [lobe, u, v, chance] = sampler.next_event();
        let bsdf = &stage.surface(hit).bsdf;
        let scattered = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])?;
        for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
            *weight *= factor * scattered.scale;
        }
        if !roulette::survives(&stage.rules, order, 1.0, &mut self.throughput, chance) {
            return None;
        }
        let onward = hit.leave(scattered.direction);
        self.note(&onward, false);
        Some(onward)
    }

    /// The radiance of the sky in a direction, as that of a trace that met nothing; whether there
    /// is sky in that direction.
    pub fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.radiance.fill(0.0);
        self.throughput.fill(1.0);
        self.add_sky(&stage.light);
        true
    }

    fn add_sky(&mut self, light: &Light) {
        let Some(dome) = &light.dome else { return };
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), share) in paths.zip(&*dome.share) {
            *radiance += weight * share * Light::RADIANCE_OF_SHARE as f32;
        }
    }
}
