//! State machine of the packets of one sample.

use glam::DVec3;

use super::counters::{Counter, Event, Visited};
use super::record::{PacketRecord, Recorder, ShadowRay};
use super::source::PacketSource;
use super::thermal_emission::{EmissionLine, ThermalEmission};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::scattering::{Lobe, SurfaceModels, multiply};
use crate::transport::PhotonKind;
use crate::transport::ray_queue::{RayQueue, RayResults};
use crate::transport::roulette::{RouletteThreshold, RussianRoulette, sample_with_roulette};

/// Properties that all packets of a film share.
pub(super) struct PacketSettings<'a> {
    pub(super) stage: &'a Stage,
    pub(super) counters: Vec<Box<dyn Counter>>,
    pub(super) kind: PhotonKind,
    pub(super) source: PacketSource,
    /// Emission of surfaces and the sky; without it packets come from sun and sky.
    pub(super) emission: Option<ThermalEmission<'a>>,
    /// Largest weight of packets that start.
    pub(super) initial: f32,
}

/// State machine of the packets of one sample: one from sun or sky, or one after the other those that start along a
/// line of emission. It queues rays and continues with their results. One value is reused for many samples, so that a
/// packet allocates nothing.
#[derive(Clone, Debug)]
pub(super) struct Packet {
    pub(super) record: PacketRecord,
    pub(super) sampler: Sampler,
    /// Weight in the representative bands.
    pub(super) throughput: Vec<f32>,
    /// Band of a photon.
    pub(super) band: Option<usize>,
    /// Ray of the current flight.
    pub(super) ray: Ray,
    pub(super) visited: Visited,
    /// Number of surfaces that it had left when it started: 1 if a surface emitted it.
    pub(super) first_order: u32,
    /// Line along which packets are emitted.
    pub(super) line: EmissionLine,
    phase: Phase,
}

/// Meaning of the results that a packet waits for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Phase {
    /// End of the packet's flight.
    Flight,
    /// Next surface on the line of emission.
    Line,
    /// Visibility of the sun from the point of emission.
    Sun(ShadowRay),
    /// Shadow rays of counters alone.
    Ended,
}

impl Packet {
    /// A packet through a stage.
    pub(super) fn new(stage: &Stage) -> Self {
        let lanes = stage.models.spectra.representative_bands().lanes();
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::NEG_Z, from: None };
        Self {
            record: PacketRecord::default(),
            sampler: Sampler::new(Key::new(0), 0),
            throughput: vec![0.0; lanes],
            band: None,
            ray,
            visited: Visited::default(),
            first_order: 0,
            line: EmissionLine::new(ray),
            phase: Phase::Ended,
        }
    }

    /// Weights and contributions of the packets of the last sample.
    pub(super) const fn record(&self) -> &PacketRecord {
        &self.record
    }

    /// Starts the first packet of a sample.
    pub(super) fn start(
        &mut self,
        settings: &PacketSettings<'_>,
        sampler: Sampler,
        queue: &mut RayQueue,
    ) {
        self.record.clear();
        self.sampler = sampler;
        let PacketSettings { source, emission, .. } = settings;
        let is_flying = if let Some(emission) = emission {
            self.line = EmissionLine::new(source.start_anywhere(&mut self.sampler));
            self.start_from_outside(settings, self.line.ray, &emission.sky_weight(), queue)
        } else {
            let (ray, weight) = source.start(&mut self.sampler);
            self.start_from_outside(settings, ray, &[weight], queue)
        };
        self.phase = self.after_flight(settings, is_flying, queue);
    }

    /// Continues with the results of the queued rays and queues the next ones; none at the end of the sample.
    pub(super) fn advance(
        &mut self,
        settings: &PacketSettings<'_>,
        results: RayResults<'_>,
        queue: &mut RayQueue,
    ) {
        self.record.take_results(results.occluded);
        self.phase = match self.phase {
            Phase::Flight => {
                self.line.take_flight(results.hit);
                let is_flying = self.end_flight(settings, results.hit, queue);
                self.after_flight(settings, is_flying, queue)
            }
            Phase::Line => self.cross_surface(settings, results.hit, queue),
            Phase::Sun(shadow_ray) => {
                let is_sunlit = !self.record.is_occluded(shadow_ray);
                self.emit(settings, is_sunlit, queue)
            }
            Phase::Ended => Phase::Ended,
        };
    }

    /// Ends a packet, unless it is flying, and starts the next one of the sample.
    fn after_flight(
        &mut self,
        settings: &PacketSettings<'_>,
        is_flying: bool,
        queue: &mut RayQueue,
    ) -> Phase {
        if is_flying {
            return Phase::Flight;
        }
        self.end(settings);
        if settings.emission.is_some() { self.emit_next(settings, queue) } else { Phase::Ended }
    }

    /// Records the end of a packet.
    pub(super) fn end(&mut self, settings: &PacketSettings<'_>) {
        let is_photon = settings.kind == PhotonKind::Photon;
        self.record.end(is_photon.then(|| self.band.unwrap_or_default()));
    }

    /// Starts a packet that comes from outside with a weight that is this product; returns whether it flies.
    fn start_from_outside(
        &mut self,
        settings: &PacketSettings<'_>,
        ray: Ray,
        weight: &[Lobe],
        queue: &mut RayQueue,
    ) -> bool {
        self.set_weight(settings, weight);
        report(settings, &mut self.record, queue, &Event::Start { ray: &ray });
        self.take_off(settings, ray, Visited::default(), queue)
    }

    /// Sets the initial weight. A photon takes all of it in one band.
    pub(super) fn set_weight(&mut self, settings: &PacketSettings<'_>, weight: &[Lobe]) {
        self.record.start();
        if settings.kind == PhotonKind::Photon {
            return self.set_photon_weight(settings, weight);
        }
        self.throughput.fill(1.0);
        for &lobe in weight {
            multiply_by_lobe(&mut self.throughput, &settings.stage.models, lobe);
            self.record.scatter(lobe);
        }
    }

    /// Queues the first flight of a packet that has left these surfaces; returns whether there is one.
    pub(super) fn take_off(
        &mut self,
        settings: &PacketSettings<'_>,
        ray: Ray,
        visited: Visited,
        queue: &mut RayQueue,
    ) -> bool {
        if settings.kind == PhotonKind::Photon && self.band.is_none() {
            return false;
        }
        self.line.follow_packet(&ray);
        self.first_order = visited.order;
        (self.ray, self.visited) = (ray, visited);
        queue.push_closest(ray);
        true
    }

    /// Ends a flight at a hit and queues the next one; returns whether there is one.
    fn end_flight(
        &mut self,
        settings: &PacketSettings<'_>,
        hit: Option<&Hit>,
        queue: &mut RayQueue,
    ) -> bool {
        let Self { record, ray, visited, .. } = self;
        let stage = settings.stage;
        let distance = hit.map_or(f64::INFINITY, |hit| hit.distance);
        report(settings, record, queue, &Event::Flight { ray, distance });
        let Some(hit) = hit else {
            report(settings, record, queue, &Event::Escape { ray, visited: *visited });
            return false;
        };
        if stage.is_cut(hit) {
            report(settings, record, queue, &Event::Buried);
            return false;
        }
        let next = match settings.kind {
            PhotonKind::Packet(threshold) => self.scatter_packet(settings, hit, threshold, queue),
            PhotonKind::Photon => self.scatter_photon(settings, hit, queue),
        };
        let Some(direction) = next else { return false };
        report(settings, &mut self.record, queue, &Event::Departure);
        self.visited.leave(stage.is_ground(hit));
        self.ray = hit.leave(direction);
        queue.push_closest(self.ray);
        true
    }

    /// Scatters a packet at a surface; returns its next direction, if it continues.
    fn scatter_packet(
        &mut self,
        settings: &PacketSettings<'_>,
        hit: &Hit,
        threshold: RouletteThreshold,
        queue: &mut RayQueue,
    ) -> Option<DVec3> {
        let Self { record, sampler, throughput, visited, first_order, .. } = self;
        let PacketSettings { stage, initial, .. } = settings;
        let surface = stage.interaction(hit, -self.ray.direction);
        let is_last = visited.order >= stage.rules.max_order.saturating_add(*first_order);
        let event = Event::Arrival {
            hit,
            surface,
            visited: *visited,
            is_last,
            throughput,
            scattered: surface.scattered_fraction(),
            reflected: surface.reflected_fraction(),
            sampler,
        };
        report(settings, record, queue, &event);
        if is_last {
            return None;
        }
        let roulette = RussianRoulette { rules: &stage.rules, threshold, initial: *initial };
        let order = visited.order + 1 - *first_order;
        let u = sampler.next_4d();
        let sample = sample_with_roulette(&surface, &roulette, order, throughput, u)?;
        record.scatter(sample.weight);
        Some(sample.wi)
    }
}

/// Multiplies the representative bands of a throughput by a lobe.
pub(super) fn multiply_by_lobe(throughput: &mut [f32], models: &SurfaceModels, lobe: Lobe) {
    models.with_representatives(&lobe.spectrum, |weight| multiply(throughput, weight, lobe.scale));
}

/// Reports an event to every counter.
pub(super) fn report(
    settings: &PacketSettings<'_>,
    record: &mut PacketRecord,
    queue: &mut RayQueue,
    event: &Event<'_>,
) {
    for (sums, counter) in settings.counters.iter().enumerate() {
        counter.count(settings.stage, event, &mut Recorder::new(record, queue, sums));
    }
}
