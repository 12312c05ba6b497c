use std::ops::Range;

use glam::DVec3;

use super::Roulette;
use super::history::{Block, History};
use super::roulette::{self, Game};
use super::walk::{Answer, Asks, Walk};
use crate::accel::{Hit, Ray};
use crate::extract::{Stage, Thermal};
use crate::sampling::{Key, Sampler};
use crate::scattering::Spectrum;

/// A random walk from the sensor that gathers what surfaces and the sky emit, W m⁻² sr⁻¹ nm⁻¹; 0 in
/// bands that hold no emission.
///
/// At each point the surface adds `(1 - ρ - τ) B(T)` with the reflectance of the side that is seen,
/// and the sky adds its radiance where the walk leaves the scene. Nothing of the sun is in it. `T` is
/// the sunlit temperature where the sun is visible from the point, on whichever side.
#[derive(Clone, Debug)]
pub(super) struct ThermalPath<'a> {
    history: History<'a>,
    /// Outline of the throughput: the product of those of all that it met.
    outline: Vec<f32>,
    sampler: Sampler,
    /// Where the ray goes that the path waits for.
    direction: DVec3,
    order: u32,
    has_met: bool,
    rays: u64,
}

impl<'a> ThermalPath<'a> {
    pub(super) fn new(stage: &Stage) -> Self {
        Self {
            history: History::default(),
            outline: vec![0.0; Spectrum::outline_of(stage.bands)],
            sampler: Sampler::new(Key::new(0), 0),
            direction: DVec3::ZERO,
            order: 0,
            has_met: false,
            rays: 0,
        }
    }

    /// The ray on which the path goes on, if it does.
    fn scatter(&mut self, stage: &'a Stage, thermal: &'a Thermal, hit: &Hit) -> Option<Ray> {
        let bsdf = &stage.surface(hit).bsdf;
        let wo = -self.direction;
        let (black, rays) = thermal.black_body(stage, hit, &mut self.sampler);
        self.rays += rays;
        self.history.light(bsdf.absorbed(hit.normal, wo), black, 1.0);
        if self.order == stage.rules.max_order {
            return None;
        }
        self.order += 1;
        // What surfaces emit differs little from path to path.
        let game = Game { rules: &stage.rules, roulette: Roulette::Gentle, full: 1.0 };
        let numbers = self.sampler.next_event();
        let surface = (bsdf, hit.normal, wo);
        let scattered = roulette::scatter(surface, (game, self.order), &mut self.outline, numbers)?;
        self.history.scatter(scattered.spectrum, scattered.scale);
        Some(hit.leave(scattered.direction))
    }
}

impl<'a> Walk<'a> for ThermalPath<'a> {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        (self.sampler, self.direction) = (sampler, ray.direction);
        (self.order, self.has_met) = (0, false);
    }

    fn go_on(&mut self, stage: &'a Stage, Answer { hit, .. }: Answer<'_>, asks: &mut Asks) {
        let Some(thermal) = &stage.thermal else { return };
        if !self.has_met {
            self.outline.copy_from_slice(thermal.bands.outline());
            self.history.scatter(&thermal.bands, 1.0);
        }
        let Some(hit) = hit else {
            if self.has_met && self.direction.z > 0.0 {
                self.history.see(&thermal.sky, 1.0);
            }
            return;
        };
        if stage.is_cut(hit) {
            return;
        }
        self.has_met = true;
        if let Some(ray) = self.scatter(stage, thermal, hit) {
            self.direction = ray.direction;
            asks.onward(ray);
        }
    }

    fn has_met(&self) -> bool {
        self.has_met
    }

    fn see_sky(&mut self, stage: &'a Stage, direction: DVec3) -> bool {
        let Some(thermal) = &stage.thermal else { return false };
        self.history.clear();
        self.history.see(&thermal.sky, 1.0);
        direction.z > 0.0
    }

    #[inline(always)]
    fn show(&self, bands: Range<usize>, found: &mut [Block]) {
        let [found, ..] = found else { return };
        self.history.light_of(self.history.len(), bands, found);
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
