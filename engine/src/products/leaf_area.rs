//! Leaf area index from gap fractions, for leaves that are placed at random.

use std::ops::Range;

use crate::statistics::Replicates;

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

/// Sums of gaps and of the samples that they are fractions of, of cells: rings about the vertical, or views.
#[derive(Clone, Copy, Debug)]
pub struct GapSums<'a> {
    /// The sums, shape `[cells, stride]`.
    pub sums: &'a Replicates,
    /// Values of each cell.
    pub stride: usize,
    /// Index of the number of gaps among them.
    pub gaps: usize,
    /// Index of the number of samples among them.
    pub samples: usize,
}

impl GapSums<'_> {
    fn cell(&self, cell: usize) -> (f64, f64) {
        let at = |place: usize| self.sums.sums[cell * self.stride + place];
        (at(self.gaps), at(self.samples))
    }

    /// Returns true if there is any sample.
    fn is_sampled(&self) -> bool {
        (0..self.sums.sums.len() / self.stride).any(|cell| self.cell(cell).1 > 0.0)
    }
}

/// A leaf area index with its name and standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafAreaIndex {
    /// Name of its product.
    pub name: &'static str,
    /// One-sided leaf area per ground area; infinite where no gap was found.
    pub value: f64,
    /// Standard error; NaN where it is unknown.
    pub standard_error: f64,
}

/// A term `factor · ln P` of a leaf area index, where `P` is the weighted mean of the gap fractions of cells.
struct Term {
    /// Cells and their weights.
    cells: Vec<(usize, f64)>,
    factor: f64,
}

/// Leaf area indices from a fisheye's gap fractions by rings of 1° about the vertical; only those whose rings
/// were all seen; none without any ring. Before the first sample, all of them are NaN.
///
/// - `lai_beer`: Beer's law at the hinge angle of 57.5° (ring 55 to 60°), where `G = 0.5` holds
///   whatever the directions of the leaves
/// - `lai_miller`: Miller's integral over rings of 5° up to 75°, see [`lai_of_views`]
/// - `lai_2000`: the rings of a LAI-2000 (0-13, 16-28, 32-43, 47-58, 61-74°)
///
/// The gap fraction of a ring is its mean over solid angle and azimuth. All are effective indices: the
/// logarithm is that of a mean. Errors are linearised, with the covariances of the rings.
///
/// Source: Warren Wilson (1960) for the hinge angle; rings: LI-COR (1992), LAI-2000 manual.
#[must_use]
pub fn lai_of_rings(rings: &GapSums<'_>) -> Vec<LeafAreaIndex> {
    const HINGE: f64 = 57.5;
    if rings.sums.sums.is_empty() {
        return Vec::new();
    }
    let term = |rings: Range<usize>, factor: f64| {
        let weight = |ring: usize| (ring, (ring as f64 + 0.5).to_radians().sin());
        Term { cells: rings.map(weight).collect(), factor }
    };
    let beer = vec![term(55..60, -HINGE.to_radians().cos() / 0.5)];
    let middles: Vec<f64> =
        (0..15).map(|ring| (5.0 * f64::from(ring) + 2.5).to_radians()).collect();
    let miller = (0..15).zip(miller_weights(&middles)).zip(&middles);
    let miller = miller
        .map(|((ring, weight), middle)| term(5 * ring..5 * ring + 5, -2.0 * weight * middle.cos()))
        .collect();
    let five = [0..13, 16..28, 32..43, 47..58, 61..74].into_iter();
    let five = five.zip(LAI_2000_RINGS.iter().zip(RING_WEIGHTS));
    let five =
        five.map(|(ring, (middle, weight))| term(ring, -2.0 * weight * middle.to_radians().cos()));
    let known = [("lai_beer", beer), ("lai_miller", miller), ("lai_2000", five.collect())];
    let nothing = (f64::NAN, f64::NAN);
    let index = |(name, terms): (&'static str, Vec<Term>)| {
        let found = sum_of_logarithms(rings, &terms);
        let (value, standard_error) = if rings.is_sampled() { found? } else { nothing };
        Some(LeafAreaIndex { name, value, standard_error })
    };
    known.into_iter().filter_map(index).collect()
}

/// Leaf area indices from the gap fractions of views of several zenith angles, of each its mean over azimuths;
/// NaN if one of them has none.
///
/// - `lai_miller`: Miller's integral, `2 ∫ -ln P(θ) cos θ sin θ dθ` from 0 to π/2, whatever the directions of
///   the leaves; from two zenith angles. The contact number `-ln P cos θ` is a straight line between the
///   angles, and constant beyond the first and the last; the integral over these lines is exact.
/// - `lai_2000`: as a LAI-2000 computes it, `2 Σ -ln P cos θ w` over its five rings, where views have all of
///   the angles [`LAI_2000_RINGS`]
///
/// Errors are linearised, with the covariances of the views.
///
/// - `zeniths`: of each view, rad
///
/// Source: Miller (1967), "A formula for average foliage density", Aust. J. Bot. 15, 141-144.
#[must_use]
pub fn lai_of_views(zeniths: &[f64], views: &GapSums<'_>) -> Vec<LeafAreaIndex> {
    let mut order: Vec<usize> = (0..zeniths.len()).collect();
    order.sort_by(|&a, &b| zeniths[a].total_cmp(&zeniths[b]));
    let groups: Vec<&[usize]> =
        order.chunk_by(|&a, &b| (zeniths[a] - zeniths[b]).abs() < 1e-9).collect();
    let angles: Vec<f64> = groups.iter().map(|group| zeniths[group[0]]).collect();
    let term = |group: usize, weight: f64| Term {
        cells: groups[group].iter().map(|&view| (view, 1.0)).collect(),
        factor: -2.0 * weight * angles[group].cos(),
    };
    let index = |name, terms: Vec<Term>| {
        let found = sum_of_logarithms(views, &terms);
        let (value, standard_error) = found.unwrap_or((f64::NAN, f64::NAN));
        LeafAreaIndex { name, value, standard_error }
    };
    let mut found = Vec::new();
    if groups.len() > 1 {
        let weights = miller_weights(&angles).into_iter().enumerate();
        found.push(index("lai_miller", weights.map(|(group, w)| term(group, w)).collect()));
    }
    let ring =
        |degrees: f64| angles.iter().position(|angle| (angle.to_degrees() - degrees).abs() < 1e-6);
    let five: Option<Vec<Term>> = LAI_2000_RINGS
        .into_iter()
        .zip(RING_WEIGHTS)
        .map(|(degrees, weight)| Some(term(ring(degrees)?, weight)))
        .collect();
    found.extend(five.map(|terms| index("lai_2000", terms)));
    found
}

/// `Σ c ln P` over terms with its standard error by the delta method; `None` if one of them was not seen.
///
/// Source: Cochran (1977), "Sampling techniques", section 6.4: the linearised error of ratios.
fn sum_of_logarithms(gaps: &GapSums<'_>, terms: &[Term]) -> Option<(f64, f64)> {
    let mut sum = 0.0;
    let mut slopes = Vec::new();
    for Term { cells, factor } in terms {
        let seen = cells.iter().filter(|(cell, _)| gaps.cell(*cell).1 > 0.0);
        let all: f64 = seen.clone().map(|(_, weight)| weight).sum();
        if all == 0.0 {
            return None;
        }
        let fraction = |(cell, weight): &(usize, f64)| {
            let (gaps, samples) = gaps.cell(*cell);
            weight / all * gaps / samples
        };
        let gap = seen.clone().map(fraction).sum::<f64>();
        sum += factor * gap.ln();
        for (cell, weight) in seen {
            let (count, samples) = gaps.cell(*cell);
            let slope = factor / gap * weight / all / samples;
            slopes.push((cell * gaps.stride + gaps.gaps, slope));
            slopes.push((cell * gaps.stride + gaps.samples, -slope * count / samples));
        }
    }
    Some((sum, gaps.sums.standard_error(&slopes)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    /// Leaves of all directions, LAI 3: P = exp(-1.5 / cos θ).
    fn gap(zenith: f64) -> f64 {
        (-1.5 / zenith.cos()).exp()
    }

    /// Indices of views at these zenith angles whose gap fractions are known exactly.
    fn exact(gaps: &[(f64, f64)]) -> Vec<LeafAreaIndex> {
        let zeniths: Vec<f64> = gaps.iter().map(|gap| gap.0).collect();
        let sums = gaps.iter().flat_map(|gap| [gap.1, 1.0]).collect();
        let sums = &Replicates { sums, deviations: Vec::new() };
        lai_of_views(&zeniths, &GapSums { sums, stride: 2, gaps: 0, samples: 1 })
    }

    #[test]
    fn random_leaves_give_their_area_back_by_every_rule() {
        let (beer, error) = lai_beer((gap(0.6), 0.01 * gap(0.6)), 0.6, 0.5);
        assert!((beer - 3.0).abs() < 1e-12);
        assert!((error - 0.02 * 0.6_f64.cos()).abs() < 1e-12, "{error}");
        let few = exact(&[0.1, 0.5, 1.2].map(|zenith| (zenith, gap(zenith))));
        assert_eq!(few.len(), 1);
        assert!(few[0].name == "lai_miller" && (few[0].value - 3.0).abs() < 1e-12);
        let rings = exact(&LAI_2000_RINGS.map(|ring| (ring.to_radians(), gap(ring.to_radians()))));
        assert!(rings[1].name == "lai_2000" && (rings[1].value - 3.0).abs() < 1e-12);
    }

    /// Horizontal leaves, LAI 2: P = exp(-2) at all angles, 2 ∫ 2 cos θ sin θ dθ = 2. Straight lines
    /// between many angles come close to the cosine.
    #[test]
    fn millers_integral_needs_no_leaf_angle() {
        let steps = 1000;
        let gaps: Vec<_> = (0..=steps)
            .map(|i| (FRAC_PI_2 * f64::from(i) / f64::from(steps), (-2.0_f64).exp()))
            .collect();
        let lai = exact(&gaps)[0].value;
        assert!((lai - 2.0).abs() < 1e-6, "{lai}");
    }

    #[test]
    fn weights_integrate_straight_lines_exactly() {
        let zeniths = [0.0, 0.3, 0.9, FRAC_PI_2];
        let integral: f64 = miller_weights(&zeniths).iter().zip(zeniths).map(|(w, x)| w * x).sum();
        // ∫ θ sin θ dθ from 0 to π/2 is 1.
        assert!((integral - 1.0).abs() < 1e-12, "{integral}");
        assert!(exact(&[]).is_empty());
    }

    /// Of two views of one zenith angle that err apart, their mean knows more; together, it does not.
    #[test]
    fn errors_of_views_that_err_apart_cancel() {
        let error = |deviations: [[f64; 2]; 2]| {
            let rows = deviations.map(|[a, b]| [0.5 + a, 1.0, 0.5 + b, 1.0, 0.25, 1.0]);
            let rows: Vec<&[f64]> = rows.iter().map(<[f64; 6]>::as_slice).collect();
            let sums = &Replicates::from_randomisations(&rows);
            let views = GapSums { sums, stride: 2, gaps: 0, samples: 1 };
            lai_of_views(&[0.2, 0.2, 1.0], &views)[0].standard_error
        };
        assert!(error([[0.01, -0.01], [-0.01, 0.01]]) < 1e-12);
        let weight = miller_weights(&[0.2, 1.0])[0];
        // The error of both is 0.01, and of their logarithm twice that.
        let expected = 2.0 * weight * 0.2_f64.cos() * 0.01 / 0.5;
        assert!((error([[0.01, 0.01], [-0.01, -0.01]]) - expected).abs() < 1e-12);
    }

    #[test]
    fn names_are_known_before_the_first_sample() {
        let sums = &Replicates { sums: vec![0.0; 180], deviations: Vec::new() };
        let indices = lai_of_rings(&GapSums { sums, stride: 2, gaps: 0, samples: 1 });
        let names: Vec<&str> = indices.iter().map(|index| index.name).collect();
        assert_eq!(names, ["lai_beer", "lai_miller", "lai_2000"]);
        assert!(indices.iter().all(|index| index.value.is_nan()));
    }
}
