//! Russian roulette of paths and packets.

use crate::extract::Rules;
use crate::scattering::{
    BsdfSample, Importance, Interaction, Lobe, LobeSpectrum, largest, multiply,
};

/// Throughput threshold below which Russian roulette starts, as a fraction of the initial throughput.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RouletteThreshold {
    /// 0.05: for results that vary less between paths than roulette would make them vary.
    Low,
    /// 0.7: for paths that bring one noisy contribution after the other. In the near infrared, paths in leaves
    /// stay above it for several orders; those off soil or bark fall below at once. `README.md` lists the
    /// efficiency of other values.
    High,
}

impl RouletteThreshold {
    pub(super) const fn fraction(self) -> f32 {
        match self {
            Self::Low => 0.05,
            Self::High => 0.7,
        }
    }
}

/// Russian roulette: a path survives with probability `p` and is multiplied by `1 / p`.
#[derive(Clone, Copy, Debug)]
pub(super) struct RussianRoulette<'r> {
    pub(super) rules: &'r Rules,
    pub(super) threshold: RouletteThreshold,
    /// Largest initial throughput of paths.
    pub(super) initial: f32,
}

/// Order beyond which the constant roulette ends paths whatever their throughput: each path ends, even where
/// nothing is absorbed and nothing escapes.
const MAX_ORDERS: u32 = 10_000;

/// Minimum probability to end a path at each order beyond [`MAX_ORDERS`].
const FINAL_KILL: f32 = 0.05;

impl RussianRoulette<'_> {
    /// Factor `1 / p` for the throughput of a path that survives after `order` scattering events; `None` for one
    /// that ends. The representative bands of the throughput are already multiplied by it.
    ///
    /// Beyond `roulette_after` orders a path ends with probability `roulette_kill` (LESS manual, section 2.1),
    /// or with a smaller one that lets no survivor exceed the initial throughput: where nothing is absorbed, a
    /// few paths of large weight would dominate the noise. At any order, paths below the threshold in all bands
    /// survive in proportion to their throughput.
    fn survive(&self, order: u32, throughput: &mut [f32], u: f64) -> Option<f32> {
        let Self { rules, threshold, initial } = self;
        let remaining = largest(throughput) / initial;
        let constant = 1.0 - rules.roulette_kill as f32;
        let survival = match order {
            MAX_ORDERS.. => constant.min(1.0 - FINAL_KILL),
            _ if order <= rules.roulette_after => 1.0,
            _ => constant.max(remaining),
        };
        let survival = survival.min(remaining / threshold.fraction());
        if survival >= 1.0 {
            return Some(1.0);
        }
        if u >= f64::from(survival) {
            return None;
        }
        let factor = 1.0 / survival;
        for weight in throughput {
            *weight *= factor;
        }
        Some(factor)
    }
}

/// Samples the direction in which a path continues after `order` scattering events, this one included; `None`
/// at its end. The weight includes the factor of Russian roulette; the representative bands of the throughput
/// are multiplied by it.
#[inline]
pub(super) fn sample_with_roulette(
    surface: &Interaction<'_>,
    roulette: &RussianRoulette<'_>,
    order: u32,
    throughput: &mut [f32],
    [lobe, u, v, survival]: [f64; 4],
) -> Option<BsdfSample> {
    let models = surface.models();
    let sample = surface.sample_f(Importance::Representatives(throughput), [lobe, u, v])?;
    let Lobe { spectrum, scale } = sample.weight;
    let factor = if let LobeSpectrum::Table(id) = spectrum {
        // The common case is compiled on its own, so that its values stay in registers.
        multiply(throughput, models.spectra.representatives(id), scale);
        roulette.survive(order, throughput, survival)?
    } else {
        models.with_representatives(&spectrum, |weight| multiply(throughput, weight, scale));
        roulette.survive(order, throughput, survival)?
    };
    Some(BsdfSample { weight: sample.weight.scaled(factor), ..sample })
}

#[cfg(test)]
mod tests {
    use super::{FINAL_KILL, MAX_ORDERS, RouletteThreshold, RussianRoulette};
    use crate::extract::Rules;

    const RULES: Rules =
        Rules { seed: 1, roulette_after: 5, roulette_kill: 0.05, max_order: u32::MAX };

    fn throughput(weight: f32) -> [f32; 8] {
        [weight, weight / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    /// The mean over all outcomes of the weight that continues is the weight that arrived: the probability to
    /// survive times its factor is 1.
    #[test]
    fn roulette_keeps_the_mean_weight() {
        let roulette =
            RussianRoulette { rules: &RULES, threshold: RouletteThreshold::High, initial: 2.0 };
        for (order, weight) in [(0, 2.0_f32), (6, 2.0), (6, 1.2), (1, 0.04), (9, 0.002)] {
            let n = 2_000_000;
            let carried: f64 = (0..n)
                .map(|i| {
                    let mut throughput = throughput(weight);
                    let factor = roulette.survive(
                        order,
                        &mut throughput,
                        (f64::from(i) + 0.5) / f64::from(n),
                    );
                    if factor.is_some() { f64::from(throughput[0]) } else { 0.0 }
                })
                .sum::<f64>()
                / f64::from(n);
            assert!(
                (carried / f64::from(weight) - 1.0).abs() < 1e-3,
                "{order} {weight}: {carried}"
            );
        }
    }

    /// A path that loses nothing gains nothing, until it has been scattered so often that it may never escape.
    #[test]
    fn no_survivor_exceeds_the_initial_throughput() {
        let roulette =
            RussianRoulette { rules: &RULES, threshold: RouletteThreshold::High, initial: 2.0 };
        for (weight, most) in [(2.0_f32, 2.0_f32), (1.97, 2.0), (1.5, 1.5 / 0.95), (0.4, 1.4)] {
            let mut throughput = throughput(weight);
            roulette.survive(6, &mut throughput, 0.0).expect("u = 0 survives");
            assert!((throughput[0] - most).abs() < 1e-6, "{weight}: {}", throughput[0]);
        }
        assert!(roulette.survive(MAX_ORDERS - 1, &mut throughput(2.0), 0.999_999).is_some());
        assert!(roulette.survive(MAX_ORDERS, &mut throughput(2.0), 0.96).is_none());
    }

    /// Without roulette, or with one that starts later than any path ends, paths still end, and their mean weight
    /// is kept.
    #[test]
    fn paths_without_roulette_end_beyond_all_orders() {
        for rules in [
            Rules { roulette_kill: 0.0, ..RULES },
            Rules { roulette_after: u32::MAX, roulette_kill: 0.5, ..RULES },
        ] {
            let roulette =
                RussianRoulette { rules: &rules, threshold: RouletteThreshold::Low, initial: 2.0 };
            let survival = 1.0 - f64::from(FINAL_KILL).max(rules.roulette_kill);
            assert!(roulette.survive(MAX_ORDERS - 1, &mut throughput(2.0), 0.999_999).is_some());
            let mut weights = throughput(2.0);
            assert!(roulette.survive(MAX_ORDERS, &mut weights, survival + 1e-6).is_none());
            roulette
                .survive(MAX_ORDERS, &mut weights, survival - 1e-6)
                .expect("u below the probability to survive");
            assert!((f64::from(weights[0]) * survival - 2.0).abs() < 1e-6, "{}", weights[0]);
        }
    }
}
