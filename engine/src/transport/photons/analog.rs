//! Photons as quanta: a slow estimator that packets are checked against.

use super::counters::{Event, Visited};
use super::packet::{Packet, fly, report};
use crate::accel::Ray;
use crate::sampling::Sampler;
use crate::scattering::{Importance, Lobe};

/// Order after which a photon ends where nothing is absorbed and nothing escapes; the rest of its power counts as
/// removed by the limit of orders.
const MAX_ORDERS: u32 = 1_000_000;

impl Packet<'_> {
    /// Puts the power of all bands into one, chosen in proportion to the power of each: all photons carry
    /// the same, and the mean keeps each band's power.
    pub(super) fn start_photon(&mut self, weight: &[Lobe], sampler: &mut Sampler) {
        let models = &self.stage.models;
        let power = |band: usize| -> f64 {
            weight.iter().map(|lobe| models.value(lobe, band)).product::<f32>().into()
        };
        let bands = self.stage.bands;
        let total: f64 = (0..bands).map(power).sum();
        let [pick, ..] = sampler.next_4d();
        let mut left = pick * total;
        self.band = (0..bands).find(|&band| {
            left -= power(band);
            left < 0.0
        });
        // Contributions count in this band alone.
        let share = if self.band.is_some() { Lobe::ONE } else { Lobe::ZERO };
        self.tally.scatter(share.scaled(total as f32));
        self.throughput.fill(0.0);
        if let Some(band) = self.band {
            let representative = models.spectra.representative_bands().of(band);
            self.throughput[representative] = total as f32;
        }
    }

    /// Follows a photon to its end.
    pub(super) fn follow_photon(&mut self, ray: Ray, visited: Visited, sampler: &mut Sampler) {
        let band = self.band.unwrap_or_default();
        if self.band.is_some() {
            self.follow_in(band, ray, visited, sampler);
        }
        self.tally.flush(band..band + 1);
    }

    /// A photon is reflected at each surface with the probability `ρ`, transmitted with `τ`, and absorbed
    /// otherwise: as a whole, without weights, expected values or roulette.
    ///
    /// Directions of diffuse surfaces are sampled exactly: the weight of a sample, `f |cos θ| / pdf` over
    /// `ρ + τ`, is 1. Photons carry the weight of a sample of other models, whose mean is 1.
    fn follow_in(
        &mut self,
        band: usize,
        mut ray: Ray,
        mut visited: Visited,
        sampler: &mut Sampler,
    ) {
        let Self { stage, counters, tally, throughput, rays, .. } = self;
        let (stage, counters) = (*stage, *counters);
        let max_order = stage.rules.max_order.saturating_add(visited.order).min(MAX_ORDERS);
        loop {
            let (hit, traced) = fly(stage, counters, tally, &ray, visited);
            *rays += traced;
            let Some(hit) = hit else { return };
            let surface = stage.interaction(&hit, -ray.direction);
            let [lobe, u, v, survival] = sampler.next_4d();
            let scattered = stage.models.value(&surface.scattered_fraction(), band);
            let survives = survival < f64::from(scattered);
            let sample =
                survives.then(|| surface.sample_f(Importance::Band(band), [lobe, u, v])).flatten();
            let is_reflected = sample.is_some_and(|sample| surface.is_same_side(sample.wi));
            let all_or_nothing = |is_all: bool| if is_all { Lobe::ONE } else { Lobe::ZERO };
            let is_last = visited.order >= max_order;
            let event = Event::Arrival {
                hit: &hit,
                surface,
                visited,
                is_last,
                throughput,
                // A direction below the surface has a weight of 0: it is sampled, not absorbed.
                scattered: all_or_nothing(survives),
                reflected: all_or_nothing(is_reflected),
                sampler,
            };
            *rays += report(stage, counters, tally, &event);
            let Some(sample) = sample.filter(|_| !is_last) else { return };
            if !surface.is_diffuse() {
                let weight = stage.models.value(&sample.weight, band) / scattered;
                tally.scatter(Lobe::ONE.scaled(weight));
            }
            *rays += report(stage, counters, tally, &Event::Departure);
            visited.leave(stage.is_ground(&hit));
            ray = hit.leave(sample.wi);
        }
    }
}
