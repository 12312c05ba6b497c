use glam::DVec3;

use crate::extract::Rules;
use crate::scattering::{Bsdf, Scattered, Spectrum, dot, largest, multiply};

/// How early paths and packets that carry little are played for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roulette {
    /// Below 0.05 of what they started with: where results differ less from path to path than roulette
    /// would make them differ.
    Gentle,
    /// Below 0.5: where each path brings one noisy contribution after the other. Paths in leaves stay
    /// above it for several orders in the near infrared; those off soil or bark fall below at once.
    /// What other shares are worth stands in `README.md`.
    Firm,
}

impl Roulette {
    /// The share of its full weight below which one is played for.
    pub(super) const fn weak(self) -> f32 {
        match self {
            Self::Gentle => 0.05,
            Self::Firm => 0.5,
        }
    }
}

/// Where a path that was scattered `order` times goes on from a surface, and the weight that this takes, what it
/// won included; `None` at its end. `outline` of its throughput is multiplied with that weight's.
pub(super) fn scatter<'a>(
    (bsdf, normal, wo): (&'a Bsdf, DVec3, DVec3),
    (rules, order, weak): (&Rules, u32, f32),
    outline: &mut [f32],
    [lobe, u, v, chance]: [f64; 4],
) -> Option<Scattered<'a>> {
    let power = |lobe: &Spectrum| dot(outline, lobe.outline());
    let scattered = bsdf.sample(normal, wo, power, [lobe, u, v])?;
    multiply(outline, scattered.spectrum.outline(), scattered.scale);
    let gain = survivor_gain(rules, order, weak, outline, chance)?;
    Some(Scattered { scale: scattered.scale * gain, ..scattered })
}

/// Russian roulette: of a path that was scattered `order` times and goes on, what its throughput is to be
/// multiplied with, 1 over its chance to do so. The outline of the throughput already is.
///
/// Beyond `roulette_after` orders a path ends with the probability `roulette_kill` (LESS manual,
/// section 2.1); at any order, one that no band carries `weak` on ends in proportion.
fn survivor_gain(
    rules: &Rules,
    order: u32,
    weak: f32,
    throughput: &mut [f32],
    u: f64,
) -> Option<f32> {
    let strongest = largest(throughput);
    let constant =
        if order > rules.roulette_after { 1.0 - rules.roulette_kill as f32 } else { 1.0 };
    let survival = constant.min(strongest / weak);
    if survival >= 1.0 {
        return Some(1.0);
    }
    if u >= f64::from(survival) {
        return None;
    }
    let gain = 1.0 / survival;
    for weight in throughput {
        *weight *= gain;
    }
    Some(gain)
}

#[cfg(test)]
mod tests {
    use super::{Roulette, survivor_gain};
    use crate::extract::Rules;

    /// Over all outcomes the weight that goes on is the weight that came: exactly, because the
    /// chance to survive times the gain is 1.
    #[test]
    fn roulette_keeps_the_mean_weight() {
        let rules = Rules { seed: 1, roulette_after: 5, roulette_kill: 0.05, max_order: u32::MAX };
        for (order, weight) in [(0, 1.0_f32), (6, 1.0), (1, 0.02), (9, 0.001)] {
            let n = 2_000_000;
            let carried: f64 = (0..n)
                .map(|i| {
                    let mut throughput = [0.0; 8];
                    throughput[..2].copy_from_slice(&[weight, weight / 2.0]);
                    let gain = survivor_gain(
                        &rules,
                        order,
                        Roulette::Firm.weak(),
                        &mut throughput,
                        (f64::from(i) + 0.5) / f64::from(n),
                    );
                    if gain.is_some() { f64::from(throughput[0]) } else { 0.0 }
                })
                .sum::<f64>()
                / f64::from(n);
            assert!(
                (carried / f64::from(weight) - 1.0).abs() < 1e-3,
                "{order} {weight}: {carried}"
            );
        }
    }
}
