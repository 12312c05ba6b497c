//! Leaf area index from gap fractions, for leaves that are placed at random.

use crate::transport::GAP_RINGS;

/// Zenith angles of the rings of a LAI-2000, degrees.
pub const LAI_2000_RINGS: [f64; 5] = [7.0, 23.0, 38.0, 53.0, 68.0];

/// Weights `∫ sin θ dθ` of its rings, cut at 15.0, 30.5, 45.4 and 61.1°; the last reaches to the horizon.
///
/// Source: Welles and Norman (1991), "Instrument for indirect measurement of canopy architecture",
/// Agron. J. 83, 818-825. The last one is what is missing to 1: much software has 0.494 there, with
/// which leaves of all directions come out 1 % too large.
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

/// Leaf area indices from a fisheye's gap fractions by rings about the vertical, each with its name
/// and standard error; only those whose rings were all seen.
///
/// - `lai_beer`: Beer's law at the hinge angle of 57.5° (ring 55 to 60°), where `G = 0.5` holds
///   whatever the directions of the leaves
/// - `lai_miller`: Miller's integral over rings of 5° up to 75°, see [`lai_miller`]
/// - `lai_2000`: the rings that a LAI-2000 sees (0-13, 16-28, 32-43, 47-58, 61-74°), see [`lai_2000`]
///
/// The gap fraction of a ring is its mean over solid angle and azimuth. All are effective indices: the
/// logarithm is that of a mean. Errors are linearised and know how the rings err together.
///
/// - `zones`: gaps and samples, shape `[randomisations, 90, 2]`
///
/// Source: Warren Wilson (1960) for the hinge angle; rings: LI-COR (1992), LAI-2000 manual.
#[must_use]
pub fn lai_of_rings(zones: &[f64]) -> Vec<(&'static str, f64, f64)> {
    const HINGE: f64 = 57.5;
    let beer = vec![(55..60, -HINGE.to_radians().cos() / 0.5)];
    let middles: Vec<f64> =
        (0..15).map(|ring| (5.0 * f64::from(ring) + 2.5).to_radians()).collect();
    let miller = (0..15).zip(miller_weights(&middles)).zip(&middles);
    let miller = miller
        .map(|((ring, weight), middle)| (5 * ring..5 * ring + 5, -2.0 * weight * middle.cos()))
        .collect();
    let rings = [0..13, 16..28, 32..43, 47..58, 61..74].into_iter();
    let rings = rings.zip(LAI_2000_RINGS.iter().zip(RING_WEIGHTS));
    let rings =
        rings.map(|(ring, (middle, weight))| (ring, -2.0 * weight * middle.to_radians().cos()));
    [("lai_beer", beer), ("lai_miller", miller), ("lai_2000", rings.collect())]
        .into_iter()
        .filter_map(|(name, terms)| {
            let (lai, error) = sum_of_logarithms(zones, &terms)?;
            Some((name, lai, error))
        })
        .collect()
}

/// `Σ c ln P` over rings with its standard error; `None` if one of them was not seen.
///
/// Source: Cochran (1977), "Sampling techniques", section 6.4: the linearised error of ratios.
fn sum_of_logarithms(zones: &[f64], terms: &[(std::ops::Range<usize>, f64)]) -> Option<(f64, f64)> {
    let rows: Vec<&[f64]> = zones.chunks_exact(2 * GAP_RINGS).collect();
    let count = rows.len() as f64;
    let total = |column: usize| rows.iter().map(|row| row[column]).sum::<f64>();
    let mut sum = 0.0;
    let mut deviations = vec![0.0; rows.len()];
    for (rings, factor) in terms {
        let seen: Vec<(usize, f64, f64, f64)> = rings
            .clone()
            .map(|ring| (ring, total(2 * ring), total(2 * ring + 1)))
            .filter(|(_, _, samples)| *samples > 0.0)
            .map(|(ring, gaps, samples)| {
                (ring, (ring as f64 + 0.5).to_radians().sin(), gaps / samples, samples / count)
            })
            .collect();
        let weight: f64 = seen.iter().map(|ring| ring.1).sum();
        if seen.is_empty() {
            return None;
        }
        let gap = seen.iter().map(|ring| ring.1 * ring.2).sum::<f64>() / weight;
        sum += factor * gap.ln();
        for (deviation, row) in deviations.iter_mut().zip(&rows) {
            for &(ring, own, gap_of_ring, samples) in &seen {
                let excess = row[2 * ring] - gap_of_ring * row[2 * ring + 1];
                *deviation += factor / gap * own / weight * excess / samples;
            }
        }
    }
    let squares: f64 = deviations.iter().map(|deviation| deviation * deviation).sum();
    Some((sum, (squares / (count * (count - 1.0))).sqrt()))
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
