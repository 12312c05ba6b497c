use glam::DVec3;

use crate::extract::Rules;
use crate::scattering::{Bsdf, Scattered, Spectrum, dot, largest, multiply};

/// How early paths and packets that carry little are played for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Roulette {
    /// Below 0.05 of what they started with: where results differ less from path to path than roulette
    /// would make them differ.
    Gentle,
    /// Below 0.7: where each path brings one noisy contribution after the other. Paths in leaves stay
    /// above it for several orders in the near infrared; those off soil or bark fall below at once.
    /// What other shares are worth stands in `README.md`.
    Firm,
}

impl Roulette {
    /// The share of its full weight below which one is played for.
    pub(super) const fn weak(self) -> f32 {
        match self {
            Self::Gentle => 0.05,
            Self::Firm => 0.7,
        }
    }
}

/// What paths and packets play for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Game<'r> {
    pub(super) rules: &'r Rules,
    pub(super) roulette: Roulette,
    /// What the strongest weigh when they start.
    pub(super) full: f32,
}

/// Orders from which on the constant roulette ends paths whatever they weigh: each comes to an end, even where
/// nothing is absorbed and nothing gets out.
const MOST_ORDERS: u32 = 10_000;

/// Minimum probability to end a path at each order from then on, whatever the scene says.
const FINAL_KILL: f32 = 0.05;

impl Game<'_> {
    /// Of a path that was scattered `order` times and goes on, what its throughput is to be multiplied with, 1
    /// over its chance to do so. The outline of the throughput already is.
    ///
    /// Beyond `roulette_after` orders a path ends with the probability `roulette_kill` (LESS manual,
    /// section 2.1), or with a smaller one that leaves those that survive no more than they started with: where
    /// nothing is absorbed, a few of great weight would make all the noise. At any order, one that no band
    /// carries enough on ends in proportion.
    fn gain(&self, order: u32, throughput: &mut [f32], u: f64) -> Option<f32> {
        let Self { rules, roulette, full } = self;
        let share = largest(throughput) / full;
        let constant = 1.0 - rules.roulette_kill as f32;
        let survival = match order {
            MOST_ORDERS.. => constant.min(1.0 - FINAL_KILL),
            _ if order <= rules.roulette_after => 1.0,
            _ => constant.max(share),
        };
        let survival = survival.min(share / roulette.weak());
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
}

/// Where a path that was scattered `order` times goes on from a surface, and the weight that this takes, what it
/// won included; `None` at its end. `outline` of its throughput is multiplied with that weight's.
pub(super) fn scatter<'a>(
    (bsdf, normal, wo): (&'a Bsdf, DVec3, DVec3),
    (game, order): (Game<'_>, u32),
    outline: &mut [f32],
    [lobe, u, v, chance]: [f64; 4],
) -> Option<Scattered<'a>> {
    let power = |lobe: &Spectrum| dot(outline, lobe.outline());
    let scattered = bsdf.sample(normal, wo, power, [lobe, u, v])?;
    multiply(outline, scattered.spectrum.outline(), scattered.scale);
    let gain = game.gain(order, outline, chance)?;
    Some(Scattered { scale: scattered.scale * gain, ..scattered })
}

#[cfg(test)]
mod tests {
    use super::{FINAL_KILL, Game, MOST_ORDERS, Roulette};
    use crate::extract::Rules;

    const RULES: Rules =
        Rules { seed: 1, roulette_after: 5, roulette_kill: 0.05, max_order: u32::MAX };

    fn throughput(weight: f32) -> [f32; 8] {
        [weight, weight / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    /// Over all outcomes the weight that goes on is the weight that came: exactly, because the
    /// chance to survive times the gain is 1.
    #[test]
    fn roulette_keeps_the_mean_weight() {
        let game = Game { rules: &RULES, roulette: Roulette::Firm, full: 2.0 };
        for (order, weight) in [(0, 2.0_f32), (6, 2.0), (6, 1.2), (1, 0.04), (9, 0.002)] {
            let n = 2_000_000;
            let carried: f64 = (0..n)
                .map(|i| {
                    let mut throughput = throughput(weight);
                    let gain =
                        game.gain(order, &mut throughput, (f64::from(i) + 0.5) / f64::from(n));
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

    /// A path that loses nothing wins nothing, until it has been scattered so often that it may never get out.
    #[test]
    fn nothing_grows_beyond_what_it_started_with() {
        let game = Game { rules: &RULES, roulette: Roulette::Firm, full: 2.0 };
        for (weight, most) in [(2.0_f32, 2.0_f32), (1.97, 2.0), (1.5, 1.5 / 0.95), (0.4, 1.4)] {
            let mut throughput = throughput(weight);
            game.gain(6, &mut throughput, 0.0).expect("the luckiest goes on");
            assert!((throughput[0] - most).abs() < 1e-6, "{weight}: {}", throughput[0]);
        }
        assert!(game.gain(MOST_ORDERS - 1, &mut throughput(2.0), 0.999_999).is_some());
        assert!(game.gain(MOST_ORDERS, &mut throughput(2.0), 0.96).is_none());
    }

    /// Without roulette, or with one that starts later than any path ends, paths end all the same, and their
    /// mean weight is kept.
    #[test]
    fn paths_without_roulette_end_beyond_all_orders() {
        for rules in [
            Rules { roulette_kill: 0.0, ..RULES },
            Rules { roulette_after: u32::MAX, roulette_kill: 0.5, ..RULES },
        ] {
            let game = Game { rules: &rules, roulette: Roulette::Gentle, full: 2.0 };
            let survival = 1.0 - f64::from(FINAL_KILL).max(rules.roulette_kill);
            assert!(game.gain(MOST_ORDERS - 1, &mut throughput(2.0), 0.999_999).is_some());
            let mut weights = throughput(2.0);
            assert!(game.gain(MOST_ORDERS, &mut weights, survival + 1e-6).is_none());
            game.gain(MOST_ORDERS, &mut weights, survival - 1e-6).expect("it goes on");
            assert!((f64::from(weights[0]) * survival - 2.0).abs() < 1e-6, "{}", weights[0]);
        }
    }
}
