//! The algorithm in its plainest form: a naive path tracer, one loop without batches, lanes or lobes that are
//! evaluated later. Read it first; [`System::Reference`](crate::components::System::Reference) runs it, and
//! tests compare the other systems with it.

use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

use glam::DVec3;

use super::band_blocks::Block;
use super::paths::PathTracer;
use super::ray_queue::{RayQueue, RayResults};
use crate::accel::{Hit, Ray};
use crate::extract::{DiscPoint, Stage};
use crate::sampling::{Key, Sampler};
use crate::scattering::{Importance, Lobe};

/// Radiance that arrives against a ray from the surface that it meets first, over the total irradiance of the
/// scene: `L / E`, sr⁻¹, shape `[bands]`. Adds the number of rays.
///
/// `first` is the closest hit of the ray. The light of the sun is found by next-event estimation at each
/// surface, that of the sky where the path leaves the scene.
fn radiance(
    stage: &Stage,
    ray: &Ray,
    first: &Hit,
    sampler: &mut Sampler,
    rays: &mut u64,
) -> Vec<f64> {
    let spectrum = |id| stage.models.spectra.lanes(id);
    let mut radiance = vec![0.0; stage.bands];
    let mut throughput = vec![1.0; stage.bands];
    let (mut hit, mut direction) = (Some(*first), ray.direction);
    for order in 1.. {
        // The path leaves the scene: upwards it meets the sky, of radiance E_sky / π.
        let Some(surface_hit) = hit else {
            if direction.z > 0.0 {
                add_sky(stage, &mut radiance, &throughput);
            }
            break;
        };
        // Light ends at the faces along which isolated ground is cut out of the earth, and after the last order.
        if stage.is_cut(&surface_hit) || order > stage.rules.max_order {
            break;
        }
        let surface = stage.interaction(&surface_hit, -direction);
        // Next-event estimation: L = f E_sun |cos θ| if nothing occludes the sun, with E_sun perpendicular to it.
        let point = DiscPoint::sample(&stage.light.beams, sampler);
        for sun in &stage.light.beams {
            let wi = sun.towards(point);
            if let Some(f) = surface.f(wi) {
                *rays += 1;
                if !stage.geometry.occluded(&surface_hit.leave(wi)) {
                    let (share, cosine) = (spectrum(sun.share), surface_hit.normal.dot(wi).abs());
                    add(&mut radiance, &throughput, |band| {
                        let is_lit = sun.bands.contains(&band);
                        let perpendicular =
                            if is_lit { f64::from(share[band]) / wi.z } else { 0.0 };
                        value(stage, &f, band) * FRAC_1_PI * perpendicular * cosine
                    });
                }
            }
        }
        // The path continues in a direction sampled from the BSDF: T ← T f |cos θ| / pdf.
        let [lobe, u, v, survival] = sampler.next_4d();
        let weights: Vec<f32> = throughput.iter().map(|&weight: &f64| weight as f32).collect();
        let importance = stage.models.spectra.representative_bands().values_of(&weights);
        let sample = surface.sample_f(Importance::Representatives(&importance), [lobe, u, v]);
        let Some(sample) = sample else { break };
        for (band, weight) in throughput.iter_mut().enumerate() {
            *weight *= value(stage, &sample.weight, band);
        }
        // Russian roulette: beyond a few orders a path survives with a probability and is divided by it.
        if order > ROULETTE_AFTER {
            let largest = throughput.iter().copied().fold(0.0, f64::max);
            let probability = largest.min(MAX_SURVIVAL);
            if survival >= probability {
                break;
            }
            for weight in &mut throughput {
                *weight /= probability;
            }
        }
        direction = sample.wi;
        *rays += 1;
        hit = stage.geometry.closest(&surface_hit.leave(direction));
    }
    radiance
}

/// Orders of scattering without Russian roulette.
const ROULETTE_AFTER: u32 = 5;

/// Largest probability to survive Russian roulette: every path ends, even where nothing is absorbed.
const MAX_SURVIVAL: f64 = 0.95;

/// Adds the radiance of the sky, if there is one.
fn add_sky(stage: &Stage, radiance: &mut [f64], throughput: &[f64]) {
    if let Some(sky) = &stage.light.dome {
        let share = stage.models.spectra.lanes(sky.share);
        add(radiance, throughput, |band| f64::from(share[band]) * FRAC_1_PI);
    }
}

/// `L ← L + T S`, band by band.
fn add(radiance: &mut [f64], throughput: &[f64], source: impl Fn(usize) -> f64) {
    for (band, (radiance, throughput)) in radiance.iter_mut().zip(throughput).enumerate() {
        *radiance += throughput * source(band);
    }
}

fn value(stage: &Stage, lobe: &Lobe, band: usize) -> f64 {
    stage.models.value(lobe, band).into()
}

/// A path of the reference integrator, in the films of the other systems.
#[derive(Clone, Debug)]
pub(super) struct ReferencePath {
    ray: Ray,
    sampler: Sampler,
    radiance: Vec<f64>,
    has_hit: bool,
    rays: u64,
}

impl ReferencePath {
    pub(super) fn new() -> Self {
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z, from: None };
        let sampler = Sampler::new(Key::new(0), 0);
        Self { ray, sampler, radiance: Vec::new(), has_hit: false, rays: 0 }
    }
}

impl PathTracer for ReferencePath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        (self.ray, self.sampler, self.has_hit) = (*ray, sampler, false);
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, _: &mut RayQueue) {
        let Some(hit) = results.hit.filter(|hit| !stage.is_cut(hit)) else { return };
        self.has_hit = true;
        self.radiance = radiance(stage, &self.ray, hit, &mut self.sampler, &mut self.rays);
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        self.radiance = vec![0.0; stage.bands];
        add_sky(stage, &mut self.radiance, &vec![1.0; stage.bands]);
        direction.z > 0.0
    }

    fn write_radiance(&self, _: &Stage, bands: Range<usize>, radiance: &mut [Block]) {
        let [radiance, ..] = radiance else { return };
        radiance[..bands.len()].copy_from_slice(&self.radiance[bands]);
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
