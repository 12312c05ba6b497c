use std::ops::Range;

use super::counters::Event;
use super::emission::Emission;
use super::{Counter, RANDOMISATIONS, Watch, blocks, roulette};
use crate::extract::Stage;
use crate::film::{Spread, Sums};
use crate::sampling::{Key, Sampler};

/// What photon tracing counted: the spread of each counter's sums over the randomisations, per
/// packet, shape `[cells, bands]`.
#[derive(Clone, Debug)]
pub struct PhotonOutcome {
    /// One for each counter.
    pub spreads: Vec<Spread>,
    /// Packets traced.
    pub packets: u64,
    /// Rays traced.
    pub rays: u64,
}

/// Packets of a block. Small enough to share the work out evenly, large enough that folding the
/// blocks' sums costs nothing beside tracing them.
const BLOCK: u64 = 2048;

/// Blocks whose results may wait in memory.
const BATCH: usize = 16;

/// Traces at least `packets` photon packets from sun and sky and shows every event to every counter.
///
/// Source: LESS manual, section 2.1: packets start in proportion to the power of each source, lose
/// `1 - ρ - τ` at each surface, and go on from a direction sampled from its BSDF.
#[must_use]
pub fn trace_photons(
    stage: &Stage,
    counters: &[Box<dyn Counter + '_>],
    packets: u64,
    key: Key,
    watch: Watch<'_>,
) -> PhotonOutcome {
    let each = packets.div_ceil(RANDOMISATIONS.into()).max(1);
    let mut spreads: Vec<Spread> =
        counters.iter().map(|counter| Spread::new(counter.cells() * stage.bands)).collect();
    let rays = trace_packets(stage, counters, 0..each, key, watch, |_, sums| {
        for (spread, sums) in spreads.iter_mut().zip(sums) {
            let per_packet: Vec<f64> = sums.values().iter().map(|sum| sum / each as f64).collect();
            spread.push(&per_packet);
        }
    });
    PhotonOutcome { spreads, packets: each * u64::from(RANDOMISATIONS), rays }
}

/// Traces packets `indices` of every randomisation and hands each one's sums over, in order; returns
/// the number of rays.
pub(super) fn trace_packets(
    stage: &Stage,
    counters: &[Box<dyn Counter + '_>],
    indices: Range<u64>,
    key: Key,
    watch: Watch<'_>,
    mut finish: impl FnMut(usize, Vec<Sums>),
) -> u64 {
    let emission = Emission::of(stage);
    let per_randomisation = (indices.end - indices.start).div_ceil(BLOCK) as usize;
    let count = per_randomisation * RANDOMISATIONS as usize;
    let mut rays = 0;
    let mut current: Vec<Sums> = Vec::new();
    blocks::in_order(
        count,
        BATCH,
        |block| {
            let randomisation = (block / per_randomisation) as u64;
            let start = indices.start + (block % per_randomisation) as u64 * BLOCK;
            let range = start..(start + BLOCK).min(indices.end);
            trace_block(stage, &emission, counters, key.index(randomisation), range)
        },
        |block, (sums, traced)| {
            rays += traced;
            if current.is_empty() {
                current = sums;
            } else {
                for (total, part) in current.iter_mut().zip(&sums) {
                    total.merge(part);
                }
            }
            if (block + 1) % per_randomisation == 0 {
                finish(block / per_randomisation, std::mem::take(&mut current));
            }
            watch((block + 1) as f64 / count as f64);
        },
    );
    rays
}

fn trace_block(
    stage: &Stage,
    emission: &Emission,
    counters: &[Box<dyn Counter + '_>],
    randomisation: Key,
    indices: Range<u64>,
) -> (Vec<Sums>, u64) {
    let mut sums: Vec<Sums> =
        counters.iter().map(|counter| Sums::new(counter.cells(), stage.bands)).collect();
    let mut weight = vec![0.0; stage.lanes()];
    let mut before = vec![0.0; stage.lanes()];
    let mut rays = 0;
    for index in indices {
        let mut sampler = Sampler::new(randomisation, index);
        let mut ray = emission.start(&mut sampler, &mut weight);
        let mut show = |event: Event<'_>| -> u64 {
            counters
                .iter()
                .zip(&mut sums)
                .map(|(counter, sums)| counter.count(stage, &event, sums))
                .sum()
        };
        rays += show(Event::Start { ray: &ray, weight: &weight });
        let mut order = 0;
        let mut met_ground = false;
        loop {
            rays += 1;
            let hit = stage.geometry.closest(&ray);
            let distance = hit.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
            rays += show(Event::Flight { ray: &ray, distance, weight: &weight });
            let Some(hit) = hit else {
                rays += show(Event::Escape { ray: &ray, order, met_ground, weight: &weight });
                break;
            };
            let wo = -ray.direction;
            let bsdf = &stage.surface(&hit).bsdf;
            rays += show(Event::Arrival { hit: &hit, wo, order, met_ground, weight: &weight });
            met_ground |= stage.is_ground(&hit);
            before.copy_from_slice(&weight);
            let scattered = bsdf.scattered(hit.normal, wo);
            for (weight, share) in before.iter_mut().zip(scattered) {
                *weight *= share;
            }
            let [lobe, u, v, chance] = sampler.next_event();
            let next = bsdf.sample(hit.normal, wo, &weight, [lobe, u, v]);
            let lives = order < stage.rules.max_order
                && next.is_some_and(|next| {
                    for (weight, factor) in weight.iter_mut().zip(next.spectrum) {
                        *weight *= factor * next.scale;
                    }
                    roulette::survives(&stage.rules, order + 1, &mut weight, chance)
                });
            if !lives {
                weight.fill(0.0);
            }
            rays += show(Event::Roulette { expected: &before, kept: &weight });
            let Some(next) = next.filter(|_| lives) else { break };
            order += 1;
            ray = hit.leave(next.direction);
        }
    }
    (sums, rays)
}
