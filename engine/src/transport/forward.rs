use std::ops::Range;

use super::counters::Event;
use super::emission::Emission;
use super::glow::Glow;
use super::{
    Counter, EnergyCounter, RANDOMISATIONS, ReferencePlane, Source, Watch, blocks, roulette,
};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::film::{Spread, Sums};
use crate::sampling::{Key, Sampler};

/// What photon tracing counted: the spread of each counter's sums over the randomisations, per
/// packet, shape `[cells, bands]`.
#[derive(Clone, Debug)]
pub struct PhotonOutcome {
    /// One for each counter.
    pub spreads: Vec<Spread>,
    /// That of [`EnergyCounter`], which always counts.
    pub energy: Spread,
    /// Largest share over all bands of what came that the other terms of the ledger do not account for.
    pub imbalance: f64,
    /// Packets traced.
    pub packets: u64,
    /// Rays traced.
    pub rays: u64,
}

/// What any number of packets took and did with their energy.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ledger {
    /// Rays traced.
    pub rays: u64,
    /// Largest share of the incident energy that is not accounted for, over all randomisations and
    /// bands: rounding, or a bug.
    pub imbalance: f64,
}

/// Packets of a block. Small enough to share the work out evenly, large enough that folding the
/// blocks' sums costs nothing beside tracing them.
const BLOCK: u64 = 2048;

/// Blocks whose results may wait in memory.
const BATCH: usize = 16;

/// Traces at least `packets` photon packets of sun and sky, or lines along which surfaces and the
/// sky emit some, and shows every event to every counter; what leaves through the plane counts as
/// reflected.
///
/// Source: LESS manual, section 2.1: packets start in proportion to the power of each source, lose
/// `1 - ρ - τ` at each surface, and go on from a direction sampled from its BSDF.
#[must_use]
pub fn trace_photons(
    stage: &Stage,
    (source, plane): (Source, ReferencePlane),
    counters: &[Box<dyn Counter + '_>],
    packets: u64,
    key: Key,
    watch: Watch<'_>,
) -> PhotonOutcome {
    let each = packets.div_ceil(RANDOMISATIONS.into()).max(1);
    let energy = EnergyCounter { surfaces: stage.surfaces.len(), plane };
    let empty = |cells: usize| Spread::new(cells * stage.bands);
    let mut of_energy = empty(energy.cells());
    let mut spreads: Vec<Spread> = counters.iter().map(|counter| empty(counter.cells())).collect();
    let Ledger { rays, imbalance } = trace_packets(
        stage,
        source,
        (&energy, counters),
        0..each,
        key,
        watch,
        |_, energy, sums| {
            let spreads = std::iter::once(&mut of_energy).chain(&mut spreads);
            for (spread, sums) in spreads.zip(std::iter::once(energy).chain(sums)) {
                let per_packet: Vec<f64> =
                    sums.values().iter().map(|sum| sum / each as f64).collect();
                spread.push(&per_packet);
            }
        },
    );
    let packets = each * u64::from(RANDOMISATIONS);
    PhotonOutcome { spreads, energy: of_energy, imbalance, packets, rays }
}

/// Traces packets `indices` of every randomisation and hands each one's sums over, in order: its
/// number, that of the energy, and those of the other counters.
pub(super) fn trace_packets(
    stage: &Stage,
    source: Source,
    (energy, counters): (&EnergyCounter, &[Box<dyn Counter + '_>]),
    indices: Range<u64>,
    key: Key,
    watch: Watch<'_>,
    mut finish: impl FnMut(usize, &Sums, &[Sums]),
) -> Ledger {
    let mut all: Vec<&dyn Counter> = vec![energy];
    all.extend(counters.iter().map(|counter| &**counter as &dyn Counter));
    let emission = Emission::of(stage);
    let glow = (source == Source::Emitted).then(|| Glow::of(stage, &emission)).flatten();
    let per_randomisation = (indices.end - indices.start).div_ceil(BLOCK) as usize;
    let count = per_randomisation * RANDOMISATIONS as usize;
    let mut ledger = Ledger::default();
    let mut current: Vec<Sums> = Vec::new();
    blocks::in_order(
        count,
        BATCH,
        |block| {
            let randomisation = (block / per_randomisation) as u64;
            let start = indices.start + (block % per_randomisation) as u64 * BLOCK;
            let full = glow.as_ref().map_or(1.0, Glow::full_weight);
            let mut packet = Packet::new(stage, &all, full);
            for index in start..(start + BLOCK).min(indices.end) {
                let mut sampler = Sampler::new(key.index(randomisation), index);
                if let Some(glow) = &glow {
                    glow.trace(&mut packet, &mut sampler);
                } else {
                    let ray = emission.start(&mut sampler, &mut packet.weight);
                    packet.arrive(ray, &mut sampler);
                }
            }
            (packet.sums, packet.rays)
        },
        |block, (sums, rays)| {
            ledger.rays += rays;
            if current.is_empty() {
                current = all.iter().map(|one| Sums::new(one.cells(), stage.bands)).collect();
            }
            for (total, part) in current.iter_mut().zip(&sums) {
                total.merge(part);
            }
            if (block + 1) % per_randomisation == 0 {
                let sums = std::mem::take(&mut current);
                ledger.imbalance = ledger.imbalance.max(EnergyCounter::imbalance(&sums[0]));
                finish(block / per_randomisation, &sums[0], &sums[1..]);
            }
            watch((block + 1) as f64 / count as f64);
        },
    );
    ledger
}

/// A photon packet and what the counters saw of it and of those before it; one value is reused for
/// many, so that a packet allocates nothing.
pub(super) struct Packet<'a> {
    pub(super) stage: &'a Stage,
    counters: &'a [&'a dyn Counter],
    sums: Vec<Sums>,
    /// Its weight when it starts, and then what is left of it; shape `[lanes]`.
    pub(super) weight: Vec<f32>,
    before: Vec<f32>,
    /// What the strongest packets weigh when they start.
    full: f32,
    pub(super) rays: u64,
}

impl<'a> Packet<'a> {
    fn new(stage: &'a Stage, counters: &'a [&'a dyn Counter], full: f32) -> Self {
        let dark = vec![0.0; stage.lanes()];
        let empty = |counter: &&dyn Counter| Sums::of_block(counter.cells(), stage.bands);
        let sums = counters.iter().map(empty).collect();
        Self { stage, counters, sums, weight: dark.clone(), before: dark, full, rays: 0 }
    }

    /// Follows one of this weight that comes from outside.
    pub(super) fn arrive(&mut self, ray: Ray, sampler: &mut Sampler) {
        self.rays += show(
            (self.stage, self.counters, &mut self.sums),
            &Event::Start { ray: &ray, weight: &self.weight },
        );
        self.follow(ray, (0, false), sampler);
    }

    /// Follows one of this weight that a surface emits.
    pub(super) fn emerge(&mut self, hit: &Hit, ray: Ray, sampler: &mut Sampler) {
        self.rays += show(
            (self.stage, self.counters, &mut self.sums),
            &Event::Emission { hit, ray: &ray, weight: &self.weight },
        );
        // It has left a surface once, and has not been scattered.
        self.follow(ray, (1, self.stage.is_ground(hit)), sampler);
    }

    /// Follows one that has left so many surfaces, until it ends.
    fn follow(&mut self, mut ray: Ray, (left, ground): (u32, bool), sampler: &mut Sampler) {
        let Self { stage, counters, sums, weight, before, full, rays } = self;
        let (stage, full, most) = (*stage, *full, self.stage.rules.max_order.saturating_add(left));
        let mut show = |event: Event<'_>| show((stage, counters, sums), &event);
        let (mut order, mut met_ground) = (left, ground);
        loop {
            *rays += 1;
            let hit = stage.geometry.closest(&ray);
            let distance = hit.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
            *rays += show(Event::Flight { ray: &ray, distance, weight });
            let Some(hit) = hit else {
                *rays += show(Event::Escape { ray: &ray, order, met_ground, weight });
                return;
            };
            if stage.is_cut(&hit) {
                *rays += show(Event::Buried { weight });
                return;
            }
            let wo = -ray.direction;
            let bsdf = &stage.surface(&hit).bsdf;
            let is_last = order >= most;
            *rays += show(Event::Arrival { hit: &hit, wo, order, met_ground, is_last, weight });
            met_ground |= stage.is_ground(&hit);
            before.copy_from_slice(weight);
            let scattered = bsdf.scattered(hit.normal, wo);
            for (weight, share) in before.iter_mut().zip(scattered) {
                *weight *= share;
            }
            let [lobe, u, v, chance] = sampler.next_event();
            let next = bsdf.sample(hit.normal, wo, weight, [lobe, u, v]);
            let lives = !is_last
                && next.is_some_and(|next| {
                    for (weight, factor) in weight.iter_mut().zip(next.spectrum) {
                        *weight *= factor * next.scale;
                    }
                    roulette::survives(&stage.rules, order + 1 - left, full, weight, chance)
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

/// Shows an event to every counter; returns the number of rays that this took.
fn show((stage, counters, sums): (&Stage, &[&dyn Counter], &mut [Sums]), event: &Event<'_>) -> u64 {
    counters.iter().zip(sums).map(|(counter, sums)| counter.count(stage, event, sums)).sum()
}
