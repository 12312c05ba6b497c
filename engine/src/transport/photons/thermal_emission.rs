use std::mem::replace;

use glam::DVec3;

use super::counters::{Event, Visited};
use super::packet::{Packet, PacketSettings, Phase, multiply_by_lobe, report};
use super::source::PacketSource;
use crate::accel::{Hit, Ray};
use crate::extract::{Stage, Thermal};
use crate::sampling::Sampler;
use crate::scattering::{Lobe, SpectrumId};
use crate::transport::PhotonKind;
use crate::transport::ray_queue::RayQueue;

/// Photon packets that surfaces and the sky emit, in absolute units.
///
/// Lines of uniform measure cross the scene from above, each with the étendue
/// `π A g / N`, where `g` is the power of a sky through all faces of the scene over that through its
/// rectangle `A`. Along a line the sky sends its radiance down; at every point where the line
/// crosses a surface, either side sends `(1 - ρ - τ) B(T)` away from it along the line. A line of
/// uniform measure meets an element of area in proportion to its cosine: so the density of points
/// of emission is even over area, directions follow Lambert's law, and no surface's area need be known.
///
/// The packet that is emitted along the line meets the next surface of the line: one ray finds both.
///
/// Weights are radiance times `π g`: their sum over the number of lines is a flux density over the
/// rectangle, W m⁻² nm⁻¹.
///
/// Source: Santaló (1976), "Integral geometry and geometric probability": the measure of lines through
/// an element of area.
#[derive(Clone, Debug)]
pub(super) struct ThermalEmission<'a> {
    stage: &'a Stage,
    thermal: &'a Thermal,
    /// Flux density of a radiance of 1.
    scale: f32,
}

impl<'a> ThermalEmission<'a> {
    /// Emission of a stage; `None` where nothing emits.
    pub(super) fn new(stage: &'a Stage, source: &PacketSource) -> Option<Self> {
        let thermal = stage.thermal.as_ref()?;
        Some(Self { stage, thermal, scale: source.sky_etendue() as f32 })
    }

    /// Weight of a packet from the warmest black body, in the band of its largest radiance.
    pub(super) fn largest_weight(&self) -> f32 {
        let surfaces = self.thermal.surfaces.iter().flat_map(|body| [body.sunlit, body.shaded]);
        let spectra = &self.stage.models.spectra;
        let largest = surfaces.chain([self.thermal.sky]).map(|radiance| spectra.largest(radiance));
        largest.fold(f32::MIN_POSITIVE, f32::max) * self.scale
    }

    /// Weight of a packet that the sky sends along a line, as a product.
    pub(super) fn sky_weight(&self) -> [Lobe; 2] {
        [self.thermal.bands.into(), Lobe::from(self.thermal.sky).scaled(self.scale)]
    }

    /// Shadow ray towards the sun, where the temperature at a point depends on it.
    fn sun_ray(&self, hit: &Hit, sampler: &mut Sampler) -> Option<Ray> {
        self.thermal.sun_rays(self.stage, hit, sampler).next()
    }
}

/// Line along which packets are emitted.
#[derive(Clone, Copy, Debug)]
pub(super) struct EmissionLine {
    /// Continuation of the line.
    pub(super) ray: Ray,
    /// Surface that was crossed last.
    crossing: Option<Hit>,
    /// Black body there.
    black_body: SpectrumId,
    /// Number of directions in which the surface has still to emit a packet.
    directions_left: u32,
    /// Next surface on the line.
    next: NextCrossing,
}

/// Next surface on a line of emission, which the packet that is emitted along the line meets first.
#[derive(Clone, Copy, Debug)]
enum NextCrossing {
    Unknown,
    /// The packet that flies is on the line.
    Pending,
    Known(Option<Hit>),
}

impl EmissionLine {
    /// A line that starts along a ray.
    pub(super) const fn new(ray: Ray) -> Self {
        Self {
            ray,
            crossing: None,
            black_body: SpectrumId::ZERO,
            directions_left: 0,
            next: NextCrossing::Unknown,
        }
    }

    /// Expects the next surface where a packet ends its first flight, if that is along the line.
    pub(super) fn follow_packet(&mut self, flight: &Ray) {
        if *flight == self.ray {
            self.next = NextCrossing::Pending;
        }
    }

    /// Takes the end of a packet's flight, if it was on the line.
    pub(super) fn take_flight(&mut self, hit: Option<&Hit>) {
        if matches!(self.next, NextCrossing::Pending) {
            self.next = NextCrossing::Known(hit.copied());
        }
    }

    /// Point and direction of the next packet that the last surface emits: against the line, then along it.
    fn next_emission(&mut self, stage: &Stage) -> Option<(Hit, DVec3)> {
        let hit = self.crossing?;
        while self.directions_left > 0 {
            self.directions_left -= 1;
            let direction =
                if self.directions_left > 0 { -self.ray.direction } else { self.ray.direction };
            // Nothing is below the ground.
            let is_above = (hit.normal.dot(direction) >= 0.0) == (hit.normal.z >= 0.0);
            if !stage.is_ground(&hit) || is_above {
                return Some((hit, direction));
            }
        }
        None
    }
}

impl Packet {
    /// Continues the line of emission at the next surface, which emits as soon as its temperature is known.
    pub(super) fn cross_surface(
        &mut self,
        settings: &PacketSettings<'_>,
        hit: Option<&Hit>,
        queue: &mut RayQueue,
    ) -> Phase {
        let (Some(emission), Some(hit)) = (&settings.emission, hit) else {
            return Phase::Ended;
        };
        self.line.ray = hit.leave(self.line.ray.direction);
        if emission.stage.is_cut(hit) {
            // The line crosses more of the ground beyond it.
            queue.push_closest(self.line.ray);
            return Phase::Line;
        }
        self.line.crossing = Some(*hit);
        match emission.sun_ray(hit, &mut self.sampler) {
            Some(ray) => Phase::Sun(self.record.push_shadow(ray, queue)),
            None => self.emit(settings, false, queue),
        }
    }

    /// Starts to emit from the last surface on the line.
    pub(super) fn emit(
        &mut self,
        settings: &PacketSettings<'_>,
        is_sunlit: bool,
        queue: &mut RayQueue,
    ) -> Phase {
        if let (Some(emission), Some(hit)) = (&settings.emission, &self.line.crossing) {
            self.line.black_body = emission.thermal.black_body(hit, is_sunlit);
            self.line.directions_left = 2;
        }
        self.emit_next(settings, queue)
    }

    /// Starts the next packet from the last surface or, after all of them, continues the line.
    pub(super) fn emit_next(
        &mut self,
        settings: &PacketSettings<'_>,
        queue: &mut RayQueue,
    ) -> Phase {
        while let Some((hit, direction)) = self.line.next_emission(settings.stage) {
            if self.start_from_surface(settings, &hit, direction, queue) {
                return Phase::Flight;
            }
            self.end(settings);
        }
        if let NextCrossing::Known(hit) = replace(&mut self.line.next, NextCrossing::Unknown) {
            return self.cross_surface(settings, hit.as_ref(), queue);
        }
        queue.push_closest(self.line.ray);
        Phase::Line
    }

    /// Starts a packet that a surface emits with the weight `black_body · emitted · scale`; returns whether it flies.
    fn start_from_surface(
        &mut self,
        settings: &PacketSettings<'_>,
        hit: &Hit,
        direction: DVec3,
        queue: &mut RayQueue,
    ) -> bool {
        let PacketSettings { stage, emission, kind, .. } = settings;
        let Some(ThermalEmission { thermal, scale, .. }) = emission else { return false };
        let ray = hit.leave(direction);
        let emitted = stage.interaction(hit, direction).absorbed_fraction().scaled(*scale);
        let [bands, radiance] = [thermal.bands.into(), self.line.black_body.into()];
        let is_packet = *kind != PhotonKind::Photon;
        if is_packet {
            self.set_weight(settings, &[bands, radiance]);
            multiply_by_lobe(&mut self.throughput, &stage.models, emitted);
        } else {
            self.set_weight(settings, &[bands, radiance, emitted]);
        }
        // A photon carries all that is emitted in its band.
        let emitted_of_weight = if is_packet { emitted } else { Lobe::ONE };
        let event = Event::Emission {
            hit,
            ray: &ray,
            emitted: emitted_of_weight,
            scale: *scale,
            band: self.band,
            throughput: &self.throughput,
            sampler: &self.sampler,
        };
        report(settings, &mut self.record, queue, &event);
        self.record.scatter(emitted_of_weight);
        // It has left a surface once, and has not been scattered.
        let visited = Visited { order: 1, has_met_ground: stage.is_ground(hit) };
        self.take_off(settings, ray, visited, queue)
    }
}
