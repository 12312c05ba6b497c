//! Photons as quanta: the slow truth that the estimators of packets are checked against.

use super::counters::Event;
use super::forward::{Packet, fly, show};
use crate::accel::Ray;
use crate::sampling::Sampler;

/// Puts the power of all bands into one, chosen in proportion to the power of each: all photons carry
/// the same, and each band's power is kept in the mean.
pub(super) fn take_one_band(weight: &mut [f32], sampler: &mut Sampler) {
    let total: f64 = weight.iter().copied().map(f64::from).sum();
    let [pick, ..] = sampler.next_event();
    let mut left = pick * total;
    let chosen = weight.iter().position(|&power| {
        left -= f64::from(power);
        left < 0.0
    });
    weight.fill(0.0);
    if let Some(band) = chosen {
        weight[band] = total as f32;
    }
}

impl Packet<'_> {
    /// Follows a photon that has left so many surfaces, until it ends. At each surface it is reflected
    /// with the probability `ρ`, transmitted with `τ`, and absorbed otherwise: as a whole, so that
    /// nothing is weighed, expected or played for.
    ///
    /// The lobes of a surface are drawn exactly: the weight of a drawn direction, `f |cos θ| / pdf`
    /// over `ρ + τ`, is 1.
    pub(super) fn follow_whole(
        &mut self,
        mut ray: Ray,
        (left, ground): (u32, bool),
        sampler: &mut Sampler,
    ) {
        let Some(band) = self.weight.iter().position(|&power| power > 0.0) else { return };
        let Self { stage, counters, sums, weight, before, dark, rays, .. } = self;
        let (stage, counters) = (*stage, *counters);
        let most = stage.rules.max_order.saturating_add(left);
        let mut show = |event: Event<'_>| show((stage, counters, sums), &event);
        let (mut order, mut met_ground) = (left, ground);
        // Share of the photon that goes on: all of it in its band, or nothing.
        let (all, whole, nothing) = (&*weight, &mut *before, &**dark);
        whole.fill(0.0);
        whole[band] = 1.0;
        let whole = &*whole;
        loop {
            let (hit, traced) = fly(stage, &mut show, &ray, (order, met_ground), all);
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
            let is_last = order >= most;
            *rays += show(Event::Arrival {
                hit: &hit,
                wo,
                order,
                met_ground,
                is_last,
                weight: all,
                scattered: share(next.is_some()),
                reflected: share(is_reflected),
                sampler,
            });
            let Some(next) = next else { return };
            if is_last {
                *rays += show(Event::Roulette { expected: all, kept: nothing });
                return;
            }
            met_ground |= stage.is_ground(&hit);
            order += 1;
            ray = hit.leave(next.direction);
        }
    }
}
