use glam::DVec3;

use super::walk::{Answer, Ask, Walk};
use super::{Part, Roulette, roulette, spectra};
use crate::accel::{Hit, Ray};
use crate::extract::{Light, Stage};
use crate::film::Sums;
use crate::sampling::{Key, Sampler};

/// Backward path tracing: the radiance that arrives along a ray, `L / E` in sr⁻¹, from next-event
/// estimation to the sun at each point of a random walk and from the sky where the walk leaves the
/// scene. The direct light of sun and sky, which the sensor would look into, is left out.
#[derive(Clone, Debug)]
pub(super) struct Path {
    throughput: Vec<f32>,
    radiance: Vec<f32>,
    /// What the sun adds if it is seen.
    light: Vec<f32>,
    sampler: Sampler,
    /// Where the ray goes that the path waits for, if there is one.
    onward: Option<DVec3>,
    /// Whether to tell light of different orders apart.
    orders_apart: bool,
    /// Radiance when it was scattered for the second time.
    single: Vec<f32>,
    /// How often it was scattered, and whether first at the ground.
    order: u32,
    met_ground: bool,
    has_met: bool,
}

impl Path {
    /// For stages with this many lanes; tells light of different orders apart if asked to.
    pub(super) fn new(lanes: usize, orders_apart: bool) -> Self {
        let dark = vec![0.0; lanes];
        Self {
            throughput: dark.clone(),
            radiance: dark.clone(),
            light: dark.clone(),
            sampler: Sampler::new(Key::new(0), 0),
            onward: None,
            orders_apart,
            single: dark,
            order: 0,
            met_ground: true,
            has_met: false,
        }
    }

    /// The ray towards the sun, if it could bring light, and that light if nothing is in its way.
    fn sunlight(&mut self, stage: &Stage, hit: &Hit, wo: DVec3) -> Option<Ray> {
        let beam = stage.light.beam.as_ref()?;
        let towards = beam.towards(&mut self.sampler);
        let scattering = stage.surface(hit).bsdf.eval(hit.normal, wo, towards)?;
        // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
        let cosine = hit.normal.dot(towards).abs();
        let scale = (cosine / towards.z * Light::RADIANCE_OF_SHARE) as f32;
        let paths = self.light.iter_mut().zip(&self.throughput);
        for ((light, weight), (sun, f)) in paths.zip(beam.share.iter().zip(scattering)) {
            *light = weight * sun * f * scale;
        }
        Some(hit.leave(towards))
    }

    /// The ray on which the path goes on, if it does; the throughput is then that ray's.
    fn scatter(&mut self, stage: &Stage, hit: &Hit, wo: DVec3) -> Option<Ray> {
        // The last order's light can still come from the sky; without one the walk is over.
        if self.order == stage.rules.max_order && stage.light.dome.is_none() {
            return None;
        }
        let [lobe, u, v, chance] = self.sampler.next_event();
        let bsdf = &stage.surface(hit).bsdf;
        let scattered = bsdf.sample(hit.normal, wo, &self.throughput, [lobe, u, v])?;
        for (weight, factor) in self.throughput.iter_mut().zip(scattered.spectrum) {
            *weight *= factor * scattered.scale;
        }
        // Light of the sky that is scattered once differs little from path to path.
        let is_even = self.order == 1 && stage.light.dome.is_some();
        let weak = if is_even { Roulette::Gentle } else { Roulette::Firm }.weak();
        roulette::survives(&stage.rules, self.order, weak, &mut self.throughput, chance)
            .then(|| hit.leave(scattered.direction))
    }

    fn add_sky(&mut self, light: &Light) {
        let Some(dome) = &light.dome else { return };
        let paths = self.radiance.iter_mut().zip(&self.throughput);
        for ((radiance, weight), share) in paths.zip(&*dome.share) {
            *radiance += weight * share * Light::RADIANCE_OF_SHARE as f32;
        }
    }
}

impl Walk for Path {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.radiance.fill(0.0);
        self.throughput.fill(1.0);
        (self.sampler, self.onward) = (sampler, Some(ray.direction));
        // Light that met nothing at all is uncollided.
        (self.order, self.met_ground, self.has_met) = (0, true, false);
    }

    fn go_on(&mut self, stage: &Stage, Answer { is_lit, hit }: Answer) -> Ask {
        if is_lit {
            for (radiance, light) in self.radiance.iter_mut().zip(&self.light) {
                *radiance += light;
            }
        }
        let Some(direction) = self.onward else { return Ask::END };
        let Some(hit) = hit else {
            if self.has_met && direction.z > 0.0 {
                self.add_sky(&stage.light);
            }
            return Ask::END;
        };
        if stage.is_cut(&hit) {
            return Ask::END;
        }
        self.has_met = true;
        if self.order == stage.rules.max_order {
            return Ask::END;
        }
        self.order += 1;
        match self.order {
            1 => self.met_ground = stage.is_ground(&hit),
            2 if self.orders_apart => self.single.copy_from_slice(&self.radiance),
            _ => {}
        }
        let wo = -direction;
        let shadow = self.sunlight(stage, &hit, wo);
        let onward = self.scatter(stage, &hit, wo);
        self.onward = onward.map(|ray| ray.direction);
        Ask { shadow, onward }
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.radiance.fill(0.0);
        self.throughput.fill(1.0);
        self.add_sky(&stage.light);
        true
    }

    fn values(&self) -> &[f32] {
        &self.radiance
    }

    /// Adds the radiance or, with orders apart, the whole and its parts in a row. The differences are
    /// exact in f64, so the parts sum to the whole.
    fn add_to(&self, sums: &mut Sums, cell: usize) {
        if !self.orders_apart {
            return sums.add(cell, &self.radiance, 1.0);
        }
        let bands = sums.bands() / spectra(true);
        sums.add_with(cell, |channel| {
            let (spectrum, lane) = (channel / bands, channel % bands);
            let whole = f64::from(self.radiance[lane]);
            let single = if self.order < 2 { whole } else { f64::from(self.single[lane]) };
            match spectrum.checked_sub(1).map(|part| Part::ALL[part]) {
                None => whole,
                Some(Part::Multiple) => whole - single,
                Some(part) if part == Part::of(1, self.met_ground) => single,
                Some(_) => 0.0,
            }
        });
    }
}
