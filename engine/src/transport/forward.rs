use std::ops::Range;

use super::counters::Event;
use super::emission::Emission;
use super::glow::Glow;
use super::roulette::{self, Game};
use super::rows::{Rows, Tracer};
use super::tally::Tally;
use super::{Counter, EnergyCounter, Grain, ReferencePlane, Roulette, Source};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::{Key, Sampler};
use crate::scattering::{Spectrum, multiply};

/// Photon packets of sun and sky, or lines along which surfaces and the sky emit some; every event is
/// shown to every counter. The first of its sums is that of the [`EnergyCounter`].
///
/// Source: LESS manual, section 2.1: packets start in proportion to the power of each source, lose
/// `1 - ρ - τ` at each surface, and go on from a direction sampled from its BSDF.
struct Packets<'a> {
    stage: &'a Stage,
    source: Source,
    grain: Grain,
    emission: Emission,
    counters: Vec<Box<dyn Counter>>,
    /// Shares of a photon.
    whole: Spectrum,
    nothing: Spectrum,
    key: Key,
}

impl<'a> Packets<'a> {
    /// What leaves through the plane counts as reflected.
    fn new(
        stage: &'a Stage,
        (source, grain, plane): (Source, Grain, ReferencePlane),
        counters: impl IntoIterator<Item = Box<dyn Counter>>,
        key: Key,
    ) -> Self {
        let energy = EnergyCounter { surfaces: stage.surfaces.len(), plane };
        let energy: Box<dyn Counter> = Box::new(energy);
        let counters = std::iter::once(energy).chain(counters).collect();
        let emission = Emission::of(stage);
        let [whole, nothing] = [1.0, 0.0].map(|share| Spectrum::new(vec![share; stage.bands]));
        Self { stage, source, grain, emission, counters, whole, nothing, key }
    }
}

impl Tracer for Packets<'_> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        self.counters.iter().map(|counter| (counter.cells(), self.stage.bands)).collect()
    }

    fn prepare(&self) {
        for counter in &self.counters {
            counter.prepare(self.stage);
        }
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64) {
        let is_emitted = self.source == Source::Emitted;
        let glow = is_emitted.then(|| Glow::of(self.stage, &self.emission)).flatten();
        let full = glow.as_ref().map_or(1.0, Glow::full_weight);
        let mut packet = Packet::new(self, full);
        let stream = self.key.index(randomisation);
        for index in samples {
            let mut sampler = Sampler::new(stream, index);
            if let Some(glow) = &glow {
                glow.trace(&mut packet, &mut sampler);
            } else {
                let (ray, weight) = self.emission.start(&mut sampler);
                packet.arrive(ray, &[weight], &mut sampler);
            }
        }
        packet.tally.settle(0..self.stage.bands);
        (packet.tally.into_sums(), packet.rays)
    }

    fn block_bytes(&self, samples: u64) -> u64 {
        let touched = samples * TOUCHED;
        let shapes = self.shapes().into_iter();
        let blocks = shapes.map(|(cells, bands)| Sums::block_bytes(cells, bands, touched));
        blocks.fold(0, u64::saturating_add)
    }

    fn imbalance(&self, sums: &[Sums]) -> Option<f64> {
        sums.first().map(EnergyCounter::imbalance)
    }
}

/// Cells of one counter that a packet touches, on average at most: those in which the light of a
/// bright scene is scattered, and some more.
const TOUCHED: u64 = 16;

/// What photon packets are counted for; what leaves through the plane counts as reflected. The sums
/// are those of [`EnergyCounter`], which always counts, and of each counter, shape `[cells, bands]`.
#[must_use]
pub fn photon_film(
    stage: &Stage,
    of: (Source, Grain, ReferencePlane),
    counters: impl IntoIterator<Item = Box<dyn Counter>>,
    key: Key,
) -> Rows<'_> {
    Rows::new(Packets::new(stage, of, counters, key))
}

/// A photon packet and what the counters saw of it and of those before it; one value is reused for
/// many, so that a packet allocates nothing.
pub(super) struct Packet<'a> {
    pub(super) stage: &'a Stage,
    pub(super) counters: &'a [Box<dyn Counter>],
    pub(super) tally: Tally<'a>,
    /// Outline of its weight: the product of those of all that it was multiplied with.
    pub(super) outline: Vec<f32>,
    /// What the strongest weigh when they start.
    full: f32,
    grain: Grain,
    /// What goes on of a photon: all or nothing.
    pub(super) whole: &'a Spectrum,
    pub(super) nothing: &'a Spectrum,
    /// The band of a photon.
    pub(super) band: Option<usize>,
    pub(super) rays: u64,
}

impl<'a> Packet<'a> {
    /// The strongest weigh `full` when they start.
    fn new(packets: &'a Packets<'a>, full: f32) -> Self {
        let Packets { stage, counters, grain, whole, nothing, .. } = packets;
        let sums = counters.iter().map(|one| Sums::of_block(one.cells(), stage.bands)).collect();
        let outline = vec![0.0; Spectrum::outline_of(stage.bands)];
        let (tally, grain) = (Tally::new(sums), *grain);
        Self { stage, counters, tally, outline, full, grain, whole, nothing, band: None, rays: 0 }
    }

    /// Follows one that comes from outside with the weight of this product.
    pub(super) fn arrive(
        &mut self,
        ray: Ray,
        weight: &[(&'a Spectrum, f32)],
        sampler: &mut Sampler,
    ) {
        self.start(weight, sampler);
        let event = Event::Start { ray: &ray };
        self.rays += show((self.stage, self.counters, &mut self.tally), &event);
        self.follow(ray, (0, false), sampler);
    }

    /// Follows one that a surface emits with the weight of this product.
    pub(super) fn emerge(
        &mut self,
        hit: &Hit,
        ray: Ray,
        weight: &[(&'a Spectrum, f32)],
        sampler: &mut Sampler,
    ) {
        self.start(weight, sampler);
        let event = Event::Emission { hit, ray: &ray, outline: &self.outline, sampler };
        self.rays += show((self.stage, self.counters, &mut self.tally), &event);
        // It has left a surface once, and has not been scattered.
        self.follow(ray, (1, self.stage.is_ground(hit)), sampler);
    }

    /// Gives it its weight. A photon takes all of it in one band.
    fn start(&mut self, weight: &[(&'a Spectrum, f32)], sampler: &mut Sampler) {
        self.tally.start();
        if self.grain == Grain::Photon {
            return self.start_whole(weight, sampler);
        }
        self.outline.fill(1.0);
        for &(spectrum, factor) in weight {
            multiply(&mut self.outline, spectrum.outline(), factor);
            self.tally.scatter(spectrum, factor);
        }
    }

    /// Follows one that has left so many surfaces, until it ends.
    fn follow(&mut self, ray: Ray, history: (u32, bool), sampler: &mut Sampler) {
        let Grain::Packet(roulette) = self.grain else {
            return self.follow_whole(ray, history, sampler);
        };
        self.follow_weighed(ray, history, roulette, sampler);
        if self.tally.is_full() {
            self.tally.settle(0..self.stage.bands);
        }
    }

    fn follow_weighed(
        &mut self,
        mut ray: Ray,
        (left, ground): (u32, bool),
        roulette: Roulette,
        sampler: &mut Sampler,
    ) {
        let Self { stage, counters, tally, outline, rays, .. } = self;
        let (stage, counters) = (*stage, *counters);
        let game = Game { rules: &stage.rules, roulette, full: self.full };
        let most = stage.rules.max_order.saturating_add(left);
        let (mut order, mut met_ground) = (left, ground);
        loop {
            let (hit, traced) = fly((stage, counters, tally), &ray, (order, met_ground));
            *rays += traced;
            let Some(hit) = hit else { return };
            let wo = -ray.direction;
            let bsdf = &stage.surface(&hit).bsdf;
            let is_last = order >= most;
            let event = Event::Arrival {
                hit: &hit,
                wo,
                order,
                met_ground,
                is_last,
                outline,
                scattered: bsdf.scattered(hit.normal, wo),
                reflected: bsdf.reflected(hit.normal, wo),
                sampler,
            };
            *rays += show((stage, counters, tally), &event);
            if is_last {
                return;
            }
            let surface = (bsdf, hit.normal, wo);
            let played = (game, order + 1 - left);
            let next = roulette::scatter(surface, played, outline, sampler.next_event());
            let Some(next) = next else { return };
            tally.scatter(next.spectrum, next.scale);
            *rays += show((stage, counters, tally), &Event::Departure);
            met_ground |= stage.is_ground(&hit);
            order += 1;
            ray = hit.leave(next.direction);
        }
    }
}

/// What events are shown to.
type Watchers<'t, 'a> = (&'a Stage, &'a [Box<dyn Counter>], &'t mut Tally<'a>);

/// Lets a packet of this history fly; returns what it meets, if it does not end, and the number of rays that
/// this took.
pub(super) fn fly<'a>(
    (stage, counters, tally): Watchers<'_, 'a>,
    ray: &Ray,
    (order, met_ground): (u32, bool),
) -> (Option<Hit>, u64) {
    let hit = stage.geometry.closest(ray);
    let distance = hit.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
    let mut show = |event: Event<'_, 'a>| show((stage, counters, &mut *tally), &event);
    let flight = 1 + show(Event::Flight { ray, distance });
    match hit {
        None => (None, flight + show(Event::Escape { ray, order, met_ground })),
        Some(hit) if stage.is_cut(&hit) => (None, flight + show(Event::Buried)),
        Some(hit) => (Some(hit), flight),
    }
}

/// Shows an event to every counter; returns the number of rays that this took.
pub(super) fn show<'a>((stage, counters, tally): Watchers<'_, 'a>, event: &Event<'_, 'a>) -> u64 {
    let mut rays = 0;
    for (sums, counter) in counters.iter().enumerate() {
        tally.turn_to(sums);
        rays += counter.count(stage, event, tally);
    }
    rays
}
