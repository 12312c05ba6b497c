//! Leaf area index from gap fractions, for leaves that are placed at random.

/// Zenith angles of the rings of a LAI-2000, degrees.
pub const LAI_2000_RINGS: [f64; 5] = [7.0, 23.0, 38.0, 53.0, 68.0];

/// Weights `∫ sin θ dθ` of its rings; the last one's reaches to the horizon.
///
/// Source: Welles and Norman (1991), "Instrument for indirect measurement of canopy architecture",
/// Agron. J. 83, 818-825; the last weight is what is missing to 1.
const RING_WEIGHTS: [f64; 5] = [0.034, 0.104, 0.160, 0.218, 0.484];

/// Leaf area index by Beer's law, `-ln P cos θ / G`, and its standard error.
///
/// - `gap`: gap fraction `P` and its standard error
/// - `zenith`: rad
/// - `projection`: mean projection `G` of unit leaf area; 0.5 for leaves of all directions
///
/// Source: Monsi and Saeki (1953).
#[must_use]
pub fn lai_beer((gap, error): (f64, f64), zenith: f64, projection: f64) -> (f64, f64) {
    let scale = zenith.cos() / projection;
    (-gap.ln() * scale, error / gap * scale)
}

/// Leaf area index by Miller's integral, `2 ∫ -ln P(θ) cos θ sin θ dθ` from 0 to π/2, whatever the
/// directions of the leaves, and a bound of its standard error.
///
/// The contact number `-ln P cos θ` is a straight line between the angles given, and constant
/// beyond the first and the last; the integral over these lines is exact. Errors are added up, as
/// if all views erred together.
///
/// - `gaps`: zenith angle (rad, rising), gap fraction and its standard error
/// - returns: NaN without any angle
///
/// Source: Miller (1967), "A formula for average foliage density", Aust. J. Bot. 15, 141-144.
#[must_use]
pub fn lai_miller(gaps: &[(f64, f64, f64)]) -> (f64, f64) {
    let weights = miller_weights(&gaps.iter().map(|gap| gap.0).collect::<Vec<_>>());
    weighted(gaps, &weights)
}

/// Leaf area index as a LAI-2000 computes it, `2 Σ -ln P cos θ w` over its five rings, and a bound of
/// its standard error.
///
/// - `gaps`: gap fraction and its standard error at each of [`LAI_2000_RINGS`]
#[must_use]
pub fn lai_2000(gaps: &[(f64, f64); 5]) -> (f64, f64) {
    let rings: Vec<(f64, f64, f64)> = LAI_2000_RINGS
        .iter()
        .zip(gaps)
        .map(|(ring, &(gap, error))| (ring.to_radians(), gap, error))
        .collect();
    weighted(&rings, &RING_WEIGHTS)
}

/// `2 Σ w · (-ln P cos θ)`, and the same of the errors.
fn weighted(gaps: &[(f64, f64, f64)], weights: &[f64]) -> (f64, f64) {
    if gaps.is_empty() {
        return (f64::NAN, f64::NAN);
    }
    gaps.iter().zip(weights).fold((0.0, 0.0), |(lai, bound), (&(zenith, gap, error), weight)| {
        let (contacts, spread) = lai_beer((gap, error), zenith, 1.0);
        (lai + 2.0 * weight * contacts, bound + 2.0 * weight * spread)
    })
}

/// Weights of a function's values at rising angles in its integral `∫ f sin θ dθ` from 0 to π/2.
fn miller_weights(zeniths: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; zeniths.len()];
    let (Some(first), Some(last)) = (zeniths.first(), zeniths.last()) else { return weights };
    weights[0] += 1.0 - first.cos();
    if let Some(end) = weights.last_mut() {
        *end += last.cos();
    }
    for (index, pair) in zeniths.windows(2).enumerate() {
        let (a, b) = (pair[0], pair[1]);
        let whole = a.cos() - b.cos();
        // ∫ (θ - a) sin θ dθ over the span, and the part of it that the far end has.
        let moment = (b - a).mul_add(-b.cos(), b.sin() - a.sin());
        let far = if b > a { moment / (b - a) } else { 0.5 * whole };
        weights[index] += whole - far;
        weights[index + 1] += far;
    }
    weights
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Leaves of all directions, LAI 3: P = exp(-1.5 / cos θ).
    fn gap(zenith: f64) -> f64 {
        (-1.5 / zenith.cos()).exp()
    }

    #[test]
    fn random_leaves_give_their_area_back_by_every_rule() {
        let (beer, error) = lai_beer((gap(0.6), 0.01 * gap(0.6)), 0.6, 0.5);
        assert!((beer - 3.0).abs() < 1e-12);
        assert!((error - 0.02 * 0.6_f64.cos()).abs() < 1e-12, "{error}");
        let few: Vec<_> = [0.1, 0.5, 1.2].map(|zenith| (zenith, gap(zenith), 0.0)).into();
        assert!((lai_miller(&few).0 - 3.0).abs() < 1e-12);
        let rings = LAI_2000_RINGS.map(|ring| (gap(ring.to_radians()), 0.0));
        assert!((lai_2000(&rings).0 - 3.0).abs() < 1e-12);
    }

    /// Horizontal leaves, LAI 2: P = exp(-2) at all angles, 2 ∫ 2 cos θ sin θ dθ = 2. Straight lines
    /// between many angles come close to the cosine.
    #[test]
    fn millers_integral_needs_no_leaf_angle() {
        let steps = 1000;
        let gaps: Vec<_> = (0..=steps)
            .map(|i| (FRAC_PI_2 * f64::from(i) / f64::from(steps), (-2.0_f64).exp(), 0.0))
            .collect();
        let (lai, _) = lai_miller(&gaps);
        assert!((lai - 2.0).abs() < 1e-6, "{lai}");
    }

    #[test]
    fn weights_integrate_straight_lines_exactly() {
        let zeniths = [0.0, 0.3, 0.9, FRAC_PI_2];
        let integral: f64 = miller_weights(&zeniths).iter().zip(zeniths).map(|(w, x)| w * x).sum();
        // ∫ θ sin θ dθ from 0 to π/2 is 1.
        assert!((integral - 1.0).abs() < 1e-12, "{integral}");
        assert!(lai_miller(&[]).0.is_nan());
    }
}
