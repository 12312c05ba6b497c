use std::array;
use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

use glam::DVec3;

use super::history::{History, LitBands};
use super::tracer::PathTracer;
use crate::accel::{Hit, Ray};
use crate::extract::{DiscPoint, Light, Stage};
use crate::sampling::{Key, Sampler};
use crate::scattering::{Interaction, Lobe};
use crate::transport::band_blocks::{BLOCK, Block};
use crate::transport::ray_queue::{RayQueue, RayResults};
use crate::transport::roulette::{RouletteThreshold, RussianRoulette, sample_with_roulette};
use crate::transport::scattering_order::{ScatteringOrder, spectrum_count};

/// Backward path tracer with next-event estimation: the radiance that arrives along a ray, `L / E` in sr⁻¹.
/// Each point of a random walk adds the sun's light, and the sky adds its light where the walk leaves the
/// scene. Direct light of sun and sky, which the sensor would look into, is left out.
///
/// `reference.rs` is the same estimator as one plain loop, but for its Russian roulette.
#[derive(Clone, Debug)]
pub(in crate::transport) struct BackwardPath {
    history: History,
    /// Throughput in the representative bands.
    throughput: Vec<f32>,
    /// Suns whose shadow rays are queued, in their order.
    next_events: Vec<NextEvent>,
    /// Pending weight of the continuation ray.
    continuation: Option<Lobe>,
    /// Direction of the continuation ray, if one is queued.
    direction: Option<DVec3>,
    sampler: Sampler,
    /// True if light of different orders is kept apart.
    separates_orders: bool,
    /// Length of the history before the second scattering.
    single: usize,
    /// Number of scattering events, and whether the first was at the ground.
    order: u32,
    has_met_ground: bool,
    has_hit: bool,
}

/// Pending light of a sun, if the shadow ray meets nothing.
#[derive(Clone, Copy, Debug)]
struct NextEvent {
    /// Index of the sun among the beams of the stage.
    beam: usize,
    f: Lobe,
}

impl BackwardPath {
    /// A path through a stage.
    pub(in crate::transport) fn new(stage: &Stage, separates_orders: bool) -> Self {
        let lanes = stage.models.spectra.representative_bands().lanes();
        Self {
            history: History::default(),
            throughput: vec![0.0; lanes],
            next_events: Vec::new(),
            continuation: None,
            direction: None,
            sampler: Sampler::new(Key::new(0), 0),
            separates_orders,
            single: 0,
            order: 0,
            // Light that meets nothing at all is uncollided; the first hit overwrites this.
            has_met_ground: true,
            has_hit: false,
        }
    }

    /// Queues shadow rays towards those suns from which the surface would scatter light.
    fn sample_suns(
        &mut self,
        stage: &Stage,
        hit: &Hit,
        surface: &Interaction<'_>,
        queue: &mut RayQueue,
    ) {
        let beams = &stage.light.beams;
        let point = DiscPoint::sample(beams, &mut self.sampler);
        for (index, beam) in beams.iter().enumerate() {
            let wi = beam.towards(point);
            let Some(f) = surface.f(wi) else { continue };
            // L = f E_sun |cos θ| with `surface.f` = π f, and E_sun the share over the cosine of the sun's zenith.
            let cosine = hit.normal.dot(wi).abs();
            let scale = (cosine / wi.z * FRAC_1_PI) as f32;
            self.next_events.push(NextEvent { beam: index, f: f.scaled(scale) });
            queue.push_shadow(hit.leave(wi));
        }
    }

    /// Continuation ray, if the path survives Russian roulette.
    fn scatter(&mut self, stage: &Stage, hit: &Hit, surface: &Interaction<'_>) -> Option<Ray> {
        // Light of the last order can still come from the sky; without a sky the path ends.
        if self.order == stage.rules.max_order && stage.light.dome.is_none() {
            return None;
        }
        // Sky light that is scattered once varies little between paths.
        let has_low_variance = self.order == 1 && stage.light.dome.is_some();
        let threshold =
            if has_low_variance { RouletteThreshold::Low } else { RouletteThreshold::High };
        let roulette = RussianRoulette { rules: &stage.rules, threshold, initial: 1.0 };
        let u = self.sampler.next_4d();
        let sample = sample_with_roulette(surface, &roulette, self.order, &mut self.throughput, u)?;
        self.continuation = Some(sample.weight);
        Some(hit.leave(sample.wi))
    }

    fn add_sky(&mut self, light: &Light) {
        if let Some(dome) = &light.dome {
            self.history.see(dome.share, FRAC_1_PI as f32);
        }
    }
}

impl PathTracer for BackwardPath {
    fn start(&mut self, ray: &Ray, sampler: Sampler) {
        self.history.clear();
        self.throughput.fill(1.0);
        (self.sampler, self.direction) = (sampler, Some(ray.direction));
        self.next_events.clear();
        self.continuation = None;
        // Light that meets nothing at all is uncollided; the first hit overwrites `has_met_ground`.
        (self.order, self.has_met_ground, self.has_hit) = (0, true, false);
    }

    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, queue: &mut RayQueue) {
        for (NextEvent { beam, f }, &is_occluded) in
            self.next_events.drain(..).zip(results.occluded)
        {
            if !is_occluded {
                let beam = &stage.light.beams[beam];
                self.history.light(f, beam.share, 1.0, LitBands::from(&beam.bands));
            }
        }
        let Some(direction) = self.direction.take() else { return };
        if let Some(weight) = self.continuation.take() {
            self.history.scatter(weight);
        }
        let Some(hit) = results.hit else {
            if self.has_hit && direction.z > 0.0 {
                self.add_sky(&stage.light);
            }
            return;
        };
        if stage.is_cut(hit) {
            return;
        }
        self.has_hit = true;
        if self.order == stage.rules.max_order {
            return;
        }
        self.order += 1;
        match self.order {
            1 => self.has_met_ground = stage.is_ground(hit),
            2 => self.single = self.history.len(),
            _ => {}
        }
        let surface = stage.interaction(hit, -direction);
        self.sample_suns(stage, hit, &surface, queue);
        if let Some(ray) = self.scatter(stage, hit, &surface) {
            self.direction = Some(ray.direction);
            queue.push_closest(ray);
        }
    }

    fn has_hit(&self) -> bool {
        self.has_hit
    }

    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool {
        if direction.z <= 0.0 {
            return false;
        }
        self.history.clear();
        self.add_sky(&stage.light);
        true
    }

    fn spectrum_count(&self) -> usize {
        spectrum_count(self.separates_orders)
    }

    /// The radiance or, with separate orders, the whole and its parts in a row. The differences are exact in
    /// f64, so the parts sum to the whole.
    #[inline(always)]
    fn write_radiance(&self, stage: &Stage, bands: Range<usize>, radiance: &mut [Block]) {
        let [whole, parts @ ..] = radiance else { return };
        let history = &self.history;
        history.radiance(&stage.models, history.len(), bands.clone(), whole);
        if parts.is_empty() {
            return;
        }
        let mut single = *whole;
        if self.order >= 2 {
            history.radiance(&stage.models, self.single, bands, &mut single);
        }
        for (part, values) in ScatteringOrder::ALL.iter().zip(parts) {
            *values = match part {
                ScatteringOrder::Multiple => array::from_fn(|band| whole[band] - single[band]),
                part if *part == ScatteringOrder::from_order(1, self.has_met_ground) => single,
                _ => [0.0; BLOCK],
            };
        }
    }
}
