//! Photons as quanta: a slow estimator that packets are checked against.

use glam::DVec3;

use super::counters::Event;
use super::packet::{Packet, PacketSettings, report};
use crate::accel::Hit;
use crate::scattering::{Importance, Lobe};
use crate::transport::ray_queue::RayQueue;

/// Order after which a photon ends where nothing is absorbed and nothing escapes; the rest of its power counts as
/// removed by the limit of orders.
const MAX_ORDERS: u32 = 1_000_000;

impl Packet {
    /// Puts the power of all bands into one, chosen in proportion to the power of each: all photons carry
    /// the same, and the mean keeps each band's power.
    pub(super) fn set_photon_weight(&mut self, settings: &PacketSettings<'_>, weight: &[Lobe]) {
        let stage = settings.stage;
        let (models, bands) = (&stage.models, stage.bands);
        let power = |band: usize| -> f64 {
            weight.iter().map(|lobe| models.value(lobe, band)).product::<f32>().into()
        };
        let total: f64 = (0..bands).map(power).sum();
        let [pick, ..] = self.sampler.next_4d();
        let mut left = pick * total;
        self.band = (0..bands).find(|&band| {
            left -= power(band);
            left < 0.0
        });
        // Contributions count in this band alone.
        let share = if self.band.is_some() { Lobe::ONE } else { Lobe::ZERO };
        self.record.scatter(share.scaled(total as f32));
        self.throughput.fill(0.0);
        if let Some(band) = self.band {
            let representative = models.spectra.representative_bands().of(band);
            self.throughput[representative] = total as f32;
        }
    }

    /// Scatters a photon at a surface; returns its next direction, if it continues.
    ///
    /// It is reflected with the probability `ρ`, transmitted with `τ`, and absorbed otherwise: as a whole, without
    /// weights, expected values or roulette.
    ///
    /// Directions of diffuse surfaces are sampled exactly: the weight of a sample, `f |cos θ| / pdf` over
    /// `ρ + τ`, is 1. Photons carry the weight of a sample of other models, whose mean is 1.
    pub(super) fn scatter_photon(
        &mut self,
        settings: &PacketSettings<'_>,
        hit: &Hit,
        queue: &mut RayQueue,
    ) -> Option<DVec3> {
        let Self { record, sampler, throughput, visited, first_order, .. } = self;
        let stage = settings.stage;
        let band = self.band?;
        let surface = stage.interaction(hit, -self.ray.direction);
        let [lobe, u, v, survival] = sampler.next_4d();
        let scattered = stage.models.value(&surface.scattered_fraction(), band);
        let survives = survival < f64::from(scattered);
        let sample =
            survives.then(|| surface.sample_f(Importance::Band(band), [lobe, u, v])).flatten();
        let is_reflected = sample.is_some_and(|sample| surface.is_same_side(sample.wi));
        let all_or_nothing = |is_all: bool| if is_all { Lobe::ONE } else { Lobe::ZERO };
        let max_order = stage.rules.max_order.saturating_add(*first_order).min(MAX_ORDERS);
        let is_last = visited.order >= max_order;
        let event = Event::Arrival {
            hit,
            surface,
            visited: *visited,
            is_last,
            throughput,
            // A direction below the surface has a weight of 0: it is sampled, not absorbed.
            scattered: all_or_nothing(survives),
            reflected: all_or_nothing(is_reflected),
            sampler,
        };
        report(settings, record, queue, &event);
        let sample = sample.filter(|_| !is_last)?;
        if !surface.is_diffuse() {
            let weight = stage.models.value(&sample.weight, band) / scattered;
            record.scatter(Lobe::ONE.scaled(weight));
        }
        Some(sample.wi)
    }
}
