use std::ops::Range;

use super::counters::Event;
use super::emission::Emission;
use super::glow::Glow;
use super::rows::{Rows, Tracer};
use super::{Counter, EnergyCounter, Grain, ReferencePlane, Source, analog, roulette};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::{Key, Sampler};
use crate::scattering::dot;

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
        Self { stage, source, grain, emission: Emission::of(stage), counters, key }
    }
}

impl Tracer for Packets<'_> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        self.counters.iter().map(|counter| (counter.cells(), self.stage.bands)).collect()
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64) {
        let is_emitted = self.source == Source::Emitted;
        let glow = is_emitted.then(|| Glow::of(self.stage, &self.emission)).flatten();
        let full = glow.as_ref().map_or(1.0, Glow::full_weight);
        let mut packet = Packet::new(self.stage, &self.counters, (full, self.grain));
        let stream = self.key.index(randomisation);
        for index in samples {
            let mut sampler = Sampler::new(stream, index);
            if let Some(glow) = &glow {
                glow.trace(&mut packet, &mut sampler);
            } else {
                let ray = self.emission.start(&mut sampler, &mut packet.weight);
                packet.arrive(ray, &mut sampler);
            }
        }
        (packet.sums, packet.rays)
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
    pub(super) sums: Vec<Sums>,
    /// Its weight when it starts, and then what is left of it; shape `[lanes]`.
    pub(super) weight: Vec<f32>,
    pub(super) before: Vec<f32>,
    /// Nothing at all.
    pub(super) dark: Vec<f32>,
    /// A packet that weighs less is played for.
    weak: f32,
    grain: Grain,
    pub(super) rays: u64,
}

impl<'a> Packet<'a> {
    /// The strongest weigh `full` when they start.
    fn new(
        stage: &'a Stage,
        counters: &'a [Box<dyn Counter>],
        (full, grain): (f32, Grain),
    ) -> Self {
        let dark = vec![0.0; stage.lanes()];
        let sums = counters.iter().map(|one| Sums::of_block(one.cells(), stage.bands)).collect();
        let (weight, before) = (dark.clone(), dark.clone());
        let weak = match grain {
            Grain::Packet(roulette) => full * roulette.weak(),
            Grain::Photon => 0.0,
        };
        Self { stage, counters, sums, weight, before, dark, weak, grain, rays: 0 }
    }

    /// Follows one of this weight that comes from outside.
    pub(super) fn arrive(&mut self, ray: Ray, sampler: &mut Sampler) {
        self.take_grain(sampler);
        self.rays += show(
            (self.stage, self.counters, &mut self.sums),
            &Event::Start { ray: &ray, weight: &self.weight },
        );
        self.follow(ray, (0, false), sampler);
    }

    /// Follows one of this weight that a surface emits.
    pub(super) fn emerge(&mut self, hit: &Hit, ray: Ray, sampler: &mut Sampler) {
        self.take_grain(sampler);
        self.rays += show(
            (self.stage, self.counters, &mut self.sums),
            &Event::Emission { hit, ray: &ray, weight: &self.weight, sampler },
        );
        // It has left a surface once, and has not been scattered.
        self.follow(ray, (1, self.stage.is_ground(hit)), sampler);
    }

    /// A photon takes all of the weight in one band.
    fn take_grain(&mut self, sampler: &mut Sampler) {
        if self.grain == Grain::Photon {
            analog::take_one_band(&mut self.weight, sampler);
        }
    }

    /// Follows one that has left so many surfaces, until it ends.
    fn follow(&mut self, mut ray: Ray, (left, ground): (u32, bool), sampler: &mut Sampler) {
        if self.grain == Grain::Photon {
            return self.follow_whole(ray, (left, ground), sampler);
        }
        let Self { stage, counters, sums, weight, before, weak, rays, .. } = self;
        let (stage, weak, most) = (*stage, *weak, self.stage.rules.max_order.saturating_add(left));
        let mut show = |event: Event<'_>| show((stage, counters, sums), &event);
        let (mut order, mut met_ground) = (left, ground);
        loop {
            let (hit, traced) = fly(stage, &mut show, &ray, (order, met_ground), weight);
            *rays += traced;
            let Some(hit) = hit else { return };
            let wo = -ray.direction;
            let bsdf = &stage.surface(&hit).bsdf;
            let is_last = order >= most;
            let scattered = bsdf.scattered(hit.normal, wo);
            let reflected = bsdf.reflected(hit.normal, wo);
            *rays += show(Event::Arrival {
                hit: &hit,
                wo,
                order,
                met_ground,
                is_last,
                weight,
                scattered,
                reflected,
                sampler,
            });
            met_ground |= stage.is_ground(&hit);
            before.copy_from_slice(weight);
            for (weight, share) in before.iter_mut().zip(scattered.iter()) {
                *weight *= share;
            }
            let [lobe, u, v, chance] = sampler.next_event();
            let next = bsdf.sample(hit.normal, wo, |lobe| dot(weight, lobe), [lobe, u, v]);
            let lives = !is_last
                && next.is_some_and(|next| {
                    for (weight, factor) in weight.iter_mut().zip(next.spectrum.iter()) {
                        *weight *= factor * next.scale;
                    }
                    roulette::survivor_gain(&stage.rules, order + 1 - left, weak, weight, chance)
                        .is_some()
                });
            if !lives {
                weight.fill(0.0);
            }
            *rays += show(Event::Roulette { expected: before, kept: weight });
            let Some(next) = next.filter(|_| lives) else { return };
            order += 1;
            ray = hit.leave(next.direction);
        }
    }
}

/// Lets a packet of this history and weight fly; returns what it meets, if it does not end, and the number
/// of rays that this took.
pub(super) fn fly(
    stage: &Stage,
    show: &mut impl FnMut(Event<'_>) -> u64,
    ray: &Ray,
    (order, met_ground): (u32, bool),
    weight: &[f32],
) -> (Option<Hit>, u64) {
    let hit = stage.geometry.closest(ray);
    let distance = hit.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
    let flight = 1 + show(Event::Flight { ray, distance, weight });
    match hit {
        None => (None, flight + show(Event::Escape { ray, order, met_ground, weight })),
        Some(hit) if stage.is_cut(&hit) => (None, flight + show(Event::Buried { weight })),
        Some(hit) => (Some(hit), flight),
    }
}

/// Shows an event to every counter; returns the number of rays that this took.
pub(super) fn show(
    (stage, counters, sums): (&Stage, &[Box<dyn Counter + '_>], &mut [Sums]),
    event: &Event<'_>,
) -> u64 {
    counters.iter().zip(sums).map(|(counter, sums)| counter.count(stage, event, sums)).sum()
}
