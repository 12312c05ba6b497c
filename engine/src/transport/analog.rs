//! Photons as quanta: the slow truth that the estimators of packets are checked against.

use super::counters::Event;
use super::forward::{Packet, fly, show};
use crate::accel::Ray;
use crate::sampling::Sampler;
use crate::scattering::Spectrum;

/// Orders after which a photon ends where nothing is absorbed and nothing gets out; what is left of it counts
/// as removed by the limit of orders.
const MOST_ORDERS: u32 = 1_000_000;

impl<'a> Packet<'a> {
    /// Puts the power of all bands into one, chosen in proportion to the power of each: all photons carry
    /// the same, and each band's power is kept in the mean.
    pub(super) fn start_whole(&mut self, weight: &[(&'a Spectrum, f32)], sampler: &mut Sampler) {
        let power = |band: usize| -> f64 {
            weight.iter().map(|(spectrum, factor)| spectrum[band] * factor).product::<f32>().into()
        };
        let bands = self.stage.bands;
        let total: f64 = (0..bands).map(power).sum();
        let [pick, ..] = sampler.next_event();
        let mut left = pick * total;
        self.band = (0..bands).find(|&band| {
            left -= power(band);
            left < 0.0
        });
        // What is written down counts in this band alone.
        let share = if self.band.is_some() { self.whole } else { self.nothing };
        self.tally.scatter(share, total as f32);
        self.outline.fill(0.0);
        if let Some(band) = self.band {
            self.outline[Spectrum::place(band, bands)] = total as f32;
        }
    }

    /// Follows a photon that has left so many surfaces, until it ends.
    pub(super) fn follow_whole(&mut self, ray: Ray, history: (u32, bool), sampler: &mut Sampler) {
        let band = self.band.unwrap_or_default();
        if self.band.is_some() {
            self.follow_in(band, ray, history, sampler);
        }
        self.tally.settle(band..band + 1);
    }

    /// At each surface a photon is reflected with the probability `ρ`, transmitted with `τ`, and absorbed
    /// otherwise: as a whole, so that nothing is weighed, expected or played for.
    ///
    /// The lobes of a surface are drawn exactly: the weight of a drawn direction, `f |cos θ| / pdf`
    /// over `ρ + τ`, is 1.
    fn follow_in(
        &mut self,
        band: usize,
        mut ray: Ray,
        (left, ground): (u32, bool),
        sampler: &mut Sampler,
    ) {
        let Self { stage, counters, tally, outline, whole, nothing, rays, .. } = self;
        let (stage, counters, whole, nothing) = (*stage, *counters, *whole, *nothing);
        let most = stage.rules.max_order.saturating_add(left);
        let (mut order, mut met_ground) = (left, ground);
        loop {
            let (hit, traced) = fly((stage, counters, tally), &ray, (order, met_ground));
            *rays += traced;
            let Some(hit) = hit else { return };
            let wo = -ray.direction;
            let bsdf = &stage.surface(&hit).bsdf;
            let [lobe, u, v, chance] = sampler.next_event();
            let survives = chance < f64::from(bsdf.scattered(hit.normal, wo)[band]);
            let next = survives
                .then(|| bsdf.sample(hit.normal, wo, |lobe| lobe[band], [lobe, u, v]))
                .flatten();
            let is_reflected = next.as_ref().is_some_and(|next| {
                (hit.normal.dot(wo) >= 0.0) == (hit.normal.dot(next.direction) >= 0.0)
            });
            let share = |is_whole: bool| if is_whole { whole } else { nothing };
            let is_last = order >= most.min(MOST_ORDERS);
            let event = Event::Arrival {
                hit: &hit,
                wo,
                order,
                met_ground,
                is_last,
                outline,
                scattered: share(next.is_some()),
                reflected: share(is_reflected),
                sampler,
            };
            *rays += show((stage, counters, tally), &event);
            let Some(next) = next.filter(|_| !is_last) else { return };
            *rays += show((stage, counters, tally), &Event::Departure);
            met_ground |= stage.is_ground(&hit);
            order += 1;
            ray = hit.leave(next.direction);
        }
    }
}
