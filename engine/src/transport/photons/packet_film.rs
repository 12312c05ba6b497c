//! Film of photon packets.

use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::counters::{Counter, EnergyCounter};
use super::packet::{Packet, PacketSettings};
use super::source::PacketSource;
use super::tally::Tally;
use super::thermal_emission::ThermalEmission;
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::scattering::SurfaceModels;
use crate::statistics::Sums;
use crate::transport::films::{ReplicateRow, SampleTracer};
use crate::transport::ray_queue::RayRounds;
use crate::transport::{LightSource, PhotonKind, ReferencePlane, ReplicateSums};

/// Traces photon packets of sun and sky, or lines along which surfaces and the sky emit some, and reports every
/// event to every counter. The first of its sums is that of the [`EnergyCounter`].
///
/// Source: LESS manual, section 2.1: packets start in proportion to the power of each source, lose
/// `1 - ρ - τ` at each surface, and continue in a direction sampled from its BSDF.
struct PacketTracer<'a> {
    settings: PacketSettings<'a>,
    key: Key,
    /// Maximum number of samples whose rays are traced together.
    batch: usize,
    /// Batches that no thread uses: what they allocated is kept from block to block.
    idle: Mutex<Vec<PacketBatch>>,
}

/// Packets whose rays are traced together.
#[derive(Debug)]
struct PacketBatch {
    packets: Vec<Packet>,
    rounds: RayRounds,
}

/// Light that packets carry, what they are traced as, and the plane through which light counts as reflected.
#[derive(Clone, Debug)]
pub struct PacketOptions {
    /// Origin of the light.
    pub source: LightSource,
    /// Index of the sun among the beams of the stage: packets start at one alone.
    pub beam: usize,
    /// Packets or photons.
    pub kind: PhotonKind,
    /// Light that leaves through it counts as reflected.
    pub plane: ReferencePlane,
}

/// Samples of a batch: enough that the ray engine is seldom short of work when some have ended, few enough that
/// their records stay in the cache.
const BATCH: usize = 128;

impl<'a> PacketTracer<'a> {
    fn new(
        stage: &'a Stage,
        options: PacketOptions,
        counters: impl IntoIterator<Item = Box<dyn Counter>>,
        key: Key,
    ) -> Self {
        let PacketOptions { source: light, beam, kind, plane } = options;
        let energy: Box<dyn Counter> =
            Box::new(EnergyCounter { surfaces: stage.models.surface_count(), plane });
        let counters = std::iter::once(energy).chain(counters).collect();
        let source = PacketSource::new(stage, beam);
        let emission = match light {
            LightSource::Emitted => ThermalEmission::new(stage, &source),
            LightSource::Reflected => None,
        };
        let initial = emission.as_ref().map_or(1.0, ThermalEmission::largest_weight);
        let settings = PacketSettings { stage, counters, kind, source, emission, initial };
        Self { settings, key, batch: BATCH, idle: Mutex::default() }
    }

    fn empty_sums(&self) -> Vec<Sums> {
        self.shapes().into_iter().map(|(cells, bands)| Sums::new_sparse(cells, bands)).collect()
    }

    fn idle(&self) -> MutexGuard<'_, Vec<PacketBatch>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl SampleTracer for PacketTracer<'_> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        let PacketSettings { stage, counters, .. } = &self.settings;
        counters.iter().map(|counter| (counter.cells(), stage.bands)).collect()
    }

    fn empty_row(&self) -> ReplicateRow {
        ReplicateRow { sums: self.empty_sums(), coefficients: None }
    }

    fn prepare(&self) {
        for counter in &self.settings.counters {
            counter.prepare(self.settings.stage);
        }
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (ReplicateRow, u64) {
        let stage = self.settings.stage;
        let mut tally = Tally::new(&stage.models, self.empty_sums(), stage.keeps_coefficients);
        let idle = self.idle().pop();
        let new = || PacketBatch::new(self.batch, stage);
        let mut batch = idle.unwrap_or_else(new);
        let stream = self.key.index(randomisation);
        let samplers = samples.map(|index| Sampler::new(stream, index));
        let rays = batch.trace(&self.settings, samplers, &mut tally);
        self.idle().push(batch);
        (tally.into_row(), rays)
    }

    fn finish(&self) {
        *self.idle() = Vec::new();
    }

    fn models(&self) -> Option<&SurfaceModels> {
        Some(&self.settings.stage.models)
    }

    fn block_bytes(&self, samples: u64) -> u64 {
        let touched = samples * TOUCHED;
        let shapes = self.shapes().into_iter();
        let blocks = shapes.map(|(cells, bands)| Sums::sparse_bytes(cells, bands, touched));
        blocks.fold(0, u64::saturating_add)
    }

    fn imbalance(&self, rows: &[&ReplicateRow]) -> Option<f64> {
        let weights = EnergyCounter::balance_weights;
        let balances = ReplicateRow::combined(rows, 0, self.models(), 2, weights);
        balances.iter().map(EnergyCounter::imbalance).reduce(f64::max)
    }
}

impl PacketBatch {
    fn new(packets: usize, stage: &Stage) -> Self {
        let packets = (0..packets).map(|_| Packet::new(stage)).collect();
        Self { packets, rounds: RayRounds::default() }
    }

    /// Traces the packets of all samples and adds them to a tally, sample by sample; returns the number of rays.
    fn trace(
        &mut self,
        settings: &PacketSettings<'_>,
        mut samplers: impl Iterator<Item = Sampler>,
        tally: &mut Tally<'_>,
    ) -> u64 {
        let Self { packets, rounds } = self;
        let (before, bands) = (rounds.rays(), settings.stage.bands);
        loop {
            let started = rounds.trace(
                settings.stage,
                packets,
                |packet, queue| {
                    let sampler = samplers.next();
                    sampler.map(|sampler| packet.start(settings, sampler, queue)).is_some()
                },
                |packet, results, queue| packet.advance(settings, results, queue),
            );
            if started == 0 {
                return rounds.rays() - before;
            }
            for packet in &packets[..started] {
                packet.record().replay(tally, bands);
            }
        }
    }
}

/// Bound of the mean number of cells of one counter that a packet touches: those in which the light of a
/// bright scene is scattered, and some more.
const TOUCHED: u64 = 16;

/// A film of photon packets. Its sums are those of [`EnergyCounter`], which always counts, and of each counter,
/// shape `[cells, bands]`.
#[must_use]
pub fn photon_film(
    stage: &Stage,
    options: PacketOptions,
    counters: impl IntoIterator<Item = Box<dyn Counter>>,
    key: Key,
) -> ReplicateSums<'_> {
    ReplicateSums::new(PacketTracer::new(stage, options, counters, key))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::components::View;
    use crate::run::{Options, stage_file};
    use crate::transport::photons::{AlbedoCounter, ViewCounter};
    use crate::transport::{OrthographicCamera, RouletteThreshold};

    /// Sums and the number of rays of a block whose samples are traced in batches.
    fn trace(
        stage: &Stage,
        source: LightSource,
        kind: PhotonKind,
        batch: usize,
    ) -> (Vec<Sums>, u64) {
        let plane = ReferencePlane::new(None, stage);
        let key = Key::new(stage.rules.seed);
        let cameras = [0.0, 0.3, 0.9].map(|zenith| {
            let view = View { zenith, azimuth: 1.0 };
            OrthographicCamera::from_plane(view, &plane, stage)
        });
        let views = ViewCounter::new(cameras.to_vec()).with_roulette(source, key);
        let albedo = AlbedoCounter { plane: plane.clone() };
        let counters: [Box<dyn Counter>; 2] = [Box::new(views), Box::new(albedo)];
        let options = PacketOptions { source, beam: 0, kind, plane };
        let tracer = PacketTracer { batch, ..PacketTracer::new(stage, options, counters, key) };
        tracer.prepare();
        let (row, rays) = tracer.trace(3, 0..300);
        (row.sums, rays)
    }

    /// Scene: the crowns of `products.ron`, whose leaves, bark and soil are warmer in the sun.
    /// Expected: each kind of packet gives the same bits, whichever samples are traced together.
    #[test]
    fn sums_do_not_depend_on_the_size_of_batches() {
        let scene = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/products.ron"));
        let stage = stage_file(scene, &Options::default()).expect("the scene is complete").stage;
        let packet = PhotonKind::Packet(RouletteThreshold::Low);
        for source in [LightSource::Reflected, LightSource::Emitted] {
            for kind in [packet, PhotonKind::Photon] {
                let (one_by_one, rays) = trace(&stage, source, kind, 1);
                assert!(one_by_one.iter().all(|sums| sums.values().iter().any(|sum| *sum > 0.0)));
                for batch in [7, 256] {
                    assert_eq!(trace(&stage, source, kind, batch), (one_by_one.clone(), rays));
                }
            }
        }
    }
}
