use std::ops::Range;

use super::counters::{Counter, EnergyCounter, Event, Visited};
use super::source::PacketSource;
use super::tally::Tally;
use super::thermal_emission::ThermalEmission;
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::scattering::{Lobe, SurfaceModels, multiply};
use crate::statistics::Sums;
use crate::transport::films::SampleTracer;
use crate::transport::roulette::{RouletteThreshold, RussianRoulette, sample_with_roulette};
use crate::transport::{LightSource, PhotonKind, ReferencePlane, ReplicateSums};

/// Traces photon packets of sun and sky, or lines along which surfaces and the sky emit some, and reports every
/// event to every counter. The first of its sums is that of the [`EnergyCounter`].
///
/// Source: LESS manual, section 2.1: packets start in proportion to the power of each source, lose
/// `1 - ρ - τ` at each surface, and continue in a direction sampled from its BSDF.
struct PacketTracer<'a> {
    stage: &'a Stage,
    light: LightSource,
    kind: PhotonKind,
    source: PacketSource,
    counters: Vec<Box<dyn Counter>>,
    key: Key,
}

/// Light that packets carry, what they are traced as, and the plane through which light counts as reflected.
#[derive(Clone, Debug)]
pub struct PacketOptions {
    /// Origin of the light.
    pub source: LightSource,
    /// Packets or photons.
    pub kind: PhotonKind,
    /// Light that leaves through it counts as reflected.
    pub plane: ReferencePlane,
}

impl<'a> PacketTracer<'a> {
    fn new(
        stage: &'a Stage,
        options: PacketOptions,
        counters: impl IntoIterator<Item = Box<dyn Counter>>,
        key: Key,
    ) -> Self {
        let PacketOptions { source, kind, plane } = options;
        let energy: Box<dyn Counter> =
            Box::new(EnergyCounter { surfaces: stage.models.surface_count(), plane });
        let counters = std::iter::once(energy).chain(counters).collect();
        Self { stage, light: source, kind, source: PacketSource::new(stage), counters, key }
    }
}

impl SampleTracer for PacketTracer<'_> {
    fn shapes(&self) -> Vec<(usize, usize)> {
        self.counters.iter().map(|counter| (counter.cells(), self.stage.bands)).collect()
    }

    fn prepare(&self) {
        for counter in &self.counters {
            counter.prepare(self.stage);
        }
    }

    fn trace(&self, randomisation: u64, samples: Range<u64>) -> (Vec<Sums>, u64) {
        let is_emitted = self.light == LightSource::Emitted;
        let emission =
            if is_emitted { ThermalEmission::new(self.stage, &self.source) } else { None };
        let initial = emission.as_ref().map_or(1.0, ThermalEmission::largest_weight);
        let mut packet = Packet::new(self, initial);
        let stream = self.key.index(randomisation);
        for index in samples {
            let mut sampler = Sampler::new(stream, index);
            if let Some(emission) = &emission {
                emission.trace(&mut packet, &mut sampler);
            } else {
                let (ray, weight) = self.source.start(&mut sampler);
                packet.trace_from_outside(ray, &[weight], &mut sampler);
            }
        }
        packet.tally.flush(0..self.stage.bands);
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

/// A photon packet, and the contributions of it and of those before it; one value is reused for many, so that a
/// packet allocates nothing.
pub(super) struct Packet<'a> {
    pub(super) stage: &'a Stage,
    pub(super) counters: &'a [Box<dyn Counter>],
    pub(super) tally: Tally<'a>,
    /// Weight in the representative bands.
    pub(super) throughput: Vec<f32>,
    /// Largest weight of packets that start.
    initial: f32,
    kind: PhotonKind,
    /// Band of a photon.
    pub(super) band: Option<usize>,
    pub(super) rays: u64,
}

impl<'a> Packet<'a> {
    fn new(tracer: &'a PacketTracer<'a>, initial: f32) -> Self {
        let PacketTracer { stage, counters, kind, .. } = tracer;
        let (models, bands) = (&stage.models, stage.bands);
        let sums =
            counters.iter().map(|counter| Sums::new_for_block(counter.cells(), bands)).collect();
        Self {
            stage,
            counters,
            tally: Tally::new(models, sums),
            throughput: vec![0.0; models.spectra.representative_bands().lanes()],
            initial,
            kind: *kind,
            band: None,
            rays: 0,
        }
    }

    /// Traces a packet that comes from outside with a weight that is this product.
    pub(super) fn trace_from_outside(&mut self, ray: Ray, weight: &[Lobe], sampler: &mut Sampler) {
        self.start(weight, sampler);
        let event = Event::Start { ray: &ray };
        self.rays += report(self.stage, self.counters, &mut self.tally, &event);
        self.follow(ray, Visited::default(), sampler);
    }

    /// Traces a packet that a surface emits with the weight `black_body · emitted · scale`.
    pub(super) fn trace_from_surface(
        &mut self,
        emission: &SurfaceEmission<'_>,
        black_body: [Lobe; 2],
        sampler: &mut Sampler,
    ) {
        let &SurfaceEmission { hit, ray, emitted, scale } = emission;
        let [bands, radiance] = black_body;
        let (emitted, is_packet) = (emitted.scaled(scale), self.kind != PhotonKind::Photon);
        if is_packet {
            self.start(&black_body, sampler);
            multiply_by_lobe(&mut self.throughput, &self.stage.models, emitted);
        } else {
            self.start(&[bands, radiance, emitted], sampler);
        }
        // A photon carries all that is emitted in its band.
        let emitted_of_weight = if is_packet { emitted } else { Lobe::ONE };
        self.rays += report(
            self.stage,
            self.counters,
            &mut self.tally,
            &Event::Emission {
                hit,
                ray: &ray,
                emitted: emitted_of_weight,
                scale,
                band: self.band,
                throughput: &self.throughput,
                sampler,
            },
        );
        self.tally.scatter(emitted_of_weight);
        // It has left a surface once, and has not been scattered.
        let visited = Visited { order: 1, has_met_ground: self.stage.is_ground(hit) };
        self.follow(ray, visited, sampler);
    }

    /// Sets the initial weight. A photon takes all of it in one band.
    fn start(&mut self, weight: &[Lobe], sampler: &mut Sampler) {
        self.tally.start();
        if self.kind == PhotonKind::Photon {
            return self.start_photon(weight, sampler);
        }
        self.throughput.fill(1.0);
        for &lobe in weight {
            multiply_by_lobe(&mut self.throughput, &self.stage.models, lobe);
            self.tally.scatter(lobe);
        }
    }

    /// Follows a packet to its end.
    fn follow(&mut self, ray: Ray, visited: Visited, sampler: &mut Sampler) {
        let PhotonKind::Packet(threshold) = self.kind else {
            return self.follow_photon(ray, visited, sampler);
        };
        self.follow_packet(ray, visited, threshold, sampler);
        if self.tally.is_full() {
            self.tally.flush(0..self.stage.bands);
        }
    }

    fn follow_packet(
        &mut self,
        mut ray: Ray,
        mut visited: Visited,
        threshold: RouletteThreshold,
        sampler: &mut Sampler,
    ) {
        let Self { stage, counters, tally, throughput, rays, initial, .. } = self;
        let (stage, counters) = (*stage, *counters);
        let roulette = RussianRoulette { rules: &stage.rules, threshold, initial: *initial };
        let first = visited.order;
        let max_order = stage.rules.max_order.saturating_add(first);
        loop {
            let (hit, traced) = fly(stage, counters, tally, &ray, visited);
            *rays += traced;
            let Some(hit) = hit else { return };
            let surface = stage.interaction(&hit, -ray.direction);
            let is_last = visited.order >= max_order;
            let event = Event::Arrival {
                hit: &hit,
                surface,
                visited,
                is_last,
                throughput,
                scattered: surface.scattered_fraction(),
                reflected: surface.reflected_fraction(),
                sampler,
            };
            *rays += report(stage, counters, tally, &event);
            if is_last {
                return;
            }
            let order = visited.order + 1 - first;
            let u = sampler.next_4d();
            let sample = sample_with_roulette(&surface, &roulette, order, throughput, u);
            let Some(sample) = sample else { return };
            tally.scatter(sample.weight);
            *rays += report(stage, counters, tally, &Event::Departure);
            visited.leave(stage.is_ground(&hit));
            ray = hit.leave(sample.wi);
        }
    }
}

/// Emission of a surface along a ray.
pub(super) struct SurfaceEmission<'h> {
    pub(super) hit: &'h Hit,
    pub(super) ray: Ray,
    /// Fraction of a black body's radiance.
    pub(super) emitted: Lobe,
    /// Weight of a packet over that radiance.
    pub(super) scale: f32,
}

/// Multiplies the representative bands of a throughput by a lobe.
fn multiply_by_lobe(throughput: &mut [f32], models: &SurfaceModels, lobe: Lobe) {
    models.with_representatives(&lobe.spectrum, |weight| multiply(throughput, weight, lobe.scale));
}

/// Traces the flight of a packet; returns what it meets, if it does not end, and the number of rays.
pub(super) fn fly(
    stage: &Stage,
    counters: &[Box<dyn Counter>],
    tally: &mut Tally<'_>,
    ray: &Ray,
    visited: Visited,
) -> (Option<Hit>, u64) {
    let hit = stage.geometry.closest(ray);
    let distance = hit.as_ref().map_or(f64::INFINITY, |hit| hit.distance);
    let mut report = |event: Event<'_>| report(stage, counters, &mut *tally, &event);
    let flight = 1 + report(Event::Flight { ray, distance });
    match hit {
        None => (None, flight + report(Event::Escape { ray, visited })),
        Some(hit) if stage.is_cut(&hit) => (None, flight + report(Event::Buried)),
        Some(hit) => (Some(hit), flight),
    }
}

/// Reports an event to every counter; returns the number of rays that they traced.
pub(super) fn report(
    stage: &Stage,
    counters: &[Box<dyn Counter>],
    tally: &mut Tally<'_>,
    event: &Event<'_>,
) -> u64 {
    let mut rays = 0;
    for (sums, counter) in counters.iter().enumerate() {
        tally.select(sums);
        rays += counter.count(stage, event, tally);
    }
    rays
}
