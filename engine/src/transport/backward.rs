use std::array;
use std::ops::Range;

use glam::DVec3;

use super::history::{BLOCK, Block, History};
use super::roulette::{self, Game};
use super::walk::{Answer, Asks, Walk};
use super::{Part, Roulette, spectra};
use crate::accel::{Hit, Ray};
use crate::extract::{Light, Stage};
use crate::sampling::{Key, Sampler};
use crate::scattering::Spectrum;

/// Backward path tracing: the radiance that arrives along a ray, `L / E` in sr⁻¹, from next-event
/// estimation to the sun at each point of a random walk and from the sky where the walk leaves the
/// scene. The direct light of sun and sky, which the sensor would look into, is left out.
#[derive(Clone, Debug)]
pub(super) struct Path<'a> {
    history: History<'a>,
    /// Outline of the throughput: the product of those of all that it met.
    outline: Vec<f32>,
    /// What the last surface does to the sun's light, `f c`, if the sun is seen from there,
    sunlit: Option<(&'a Spectrum, f32)>,
    /// and to what comes along the ray that the path waits for.
    scattered: Option<(&'a Spectrum, f32)>,
    /// Where that ray goes, if there is one.
    onward: Option<DVec3>,
    sampler: Sampler,
    /// Whether to tell light of different orders apart.
    orders_apart: bool,
    /// Steps of its history until it was scattered for the second time.
    single: usize,
    /// How often it was scattered, and whether first at the ground.
    order: u32,
    met_ground: bool,
    has_met: bool,
}

impl<'a> Path<'a> {
    /// For stages with this many bands; tells light of different orders apart if asked to.
    pub(super) fn new(bands: usize, orders_apart: bool) -> Self {
        Self {
            history: History::default(),
            outline: vec![0.0; Spectrum::outline_of(bands)],
            sunlit: None,
            scattered: None,
            onward: None,
            sampler: Sampler::new(Key::new(0), 0),
            orders_apart,
            single: 0,
            order: 0,
            met_ground: true,
            has_met: false,
        }
    }

    /// The ray towards the sun, if it could bring light.
    fn sunlight(&mut self, stage: &'a Stage, hit: &Hit, wo: DVec3) -> Option<Ray> {
        let beam = stage.light.beam.as_ref()?;
        let towards = beam.towards(&mut self.sampler);
        let scattering = stage.surface(hit).bsdf.eval(hit.normal, wo, towards)?;
        // L = (f π) / π · E_sun cos θ, with E_sun the share over cos θ_sun.
        let cosine = hit.normal.dot(towards).abs();
        let scale = (cosine / towards.z * Light::RADIANCE_OF_SHARE) as f32;
        self.sunlit = Some((scattering, scale));
        Some(hit.leave(towards))
    }

    /// The ray on which the path goes on, if it does.
    fn scatter(&mut self, stage: &'a Stage, hit: &Hit, wo: DVec3) -> Option<Ray> {
        // The last order's light can still come from the sky; without one the walk is over.
        if self.order == stage.rules.max_order && stage.light.dome.is_none() {
            return None;
        }
        // Light of the sky that is scattered once differs little from path to path.
        let is_even = self.order == 1 && stage.light.dome.is_some();
        let roulette = if is_even { Roulette::Gentle } else { Roulette::Firm };
        let surface = (&stage.surface(hit).bsdf, hit.normal, wo);
        let game = Game { rules: &stage.rules, roulette, full: 1.0 };
        let numbers = self.sampler.next_event();
        let scattered = roulette::scatter(surface, (game, self.order), &mut self.outline, numbers)?;
        self.scattered = Some((scattered.spectrum, scattered.scale));
        Some(hit.leave(scattered.direction))
    }

    fn add_sky(&mut self, light: &'a Light) {
        if let Some(dome) = &light.dome {
            self.history.see(&dome.share, Light::RADIANCE_OF_SHARE as f32);
        }
    }
}

impl<'a> Walk<'a> for Path<'a> {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        self.outline.fill(1.0);
        (self.sampler, self.onward) = (sampler, Some(ray.direction));
        (self.sunlit, self.scattered) = (None, None);
        // Light that met nothing at all is uncollided.
        (self.order, self.met_ground, self.has_met) = (0, true, false);
    }

    fn go_on(&mut self, stage: &'a Stage, Answer { is_lit, hit }: Answer<'_>, asks: &mut Asks) {
        if let (Some((spectrum, scale)), true, Some(beam)) =
            (self.sunlit.take(), is_lit, &stage.light.beam)
        {
            self.history.light(spectrum, &beam.share, scale);
        }
        let Some(direction) = self.onward.take() else { return };
        if let Some((spectrum, scale)) = self.scattered.take() {
            self.history.scatter(spectrum, scale);
        }
        let Some(hit) = hit else {
            if self.has_met && direction.z > 0.0 {
                self.add_sky(&stage.light);
            }
            return;
        };
        if stage.is_cut(hit) {
            return;
        }
        self.has_met = true;
        if self.order == stage.rules.max_order {
            return;
        }
        self.order += 1;
        match self.order {
            1 => self.met_ground = stage.is_ground(hit),
            2 => self.single = self.history.len(),
            _ => {}
        }
        let wo = -direction;
        if let Some(ray) = self.sunlight(stage, hit, wo) {
            asks.shadow(ray);
        }
        if let Some(ray) = self.scatter(stage, hit, wo) {
            self.onward = Some(ray.direction);
            asks.onward(ray);
        }
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, stage: &'a Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.history.clear();
        self.add_sky(&stage.light);
        true
    }

    fn spectra(&self) -> usize {
        spectra(self.orders_apart)
    }

    /// The radiance or, with orders apart, the whole and its parts in a row. The differences are exact in
    /// f64, so the parts sum to the whole.
    #[inline(always)]
    fn show(&self, bands: Range<usize>, found: &mut [Block]) {
        let [whole, parts @ ..] = found else { return };
        let steps = self.history.len();
        self.history.light_of(steps, bands.clone(), whole);
        if parts.is_empty() {
            return;
        }
        let mut single = *whole;
        if self.order >= 2 {
            self.history.light_of(self.single, bands, &mut single);
        }
        for (part, values) in Part::ALL.iter().zip(parts) {
            *values = match part {
                Part::Multiple => array::from_fn(|band| whole[band] - single[band]),
                part if *part == Part::of(1, self.met_ground) => single,
                _ => [0.0; BLOCK],
            };
        }
    }
}
