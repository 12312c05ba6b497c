use sunfleck::document::System;
use sunfleck::output::{AxisCells, ProductCells};
use sunfleck::products::{Product, Report, SensorReport};

use super::plan::Plan;

/// One quantity that one sensor measures, as each system finds it.
#[derive(Debug)]
pub(crate) struct Finding<'a> {
    pub(crate) sensor: &'a str,
    pub(crate) product: &'a str,
    pub(crate) unit: &'a str,
    /// In the order in which systems were named; never empty.
    pub(crate) estimates: Vec<Estimate<'a>>,
    /// Index of the estimate that the others are compared with.
    pub(crate) reference: usize,
}

/// Estimate of one system.
#[derive(Debug)]
pub(crate) struct Estimate<'a> {
    pub(crate) system: System,
    pub(crate) product: &'a Product,
    /// Wall time and rays of all that the sensor measures.
    pub(crate) seconds: f64,
    pub(crate) rays: u64,
}

/// Values of a product, or of the pixels of its image; shape of both alike.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    pub(crate) values: Vec<f64>,
    pub(crate) errors: Vec<f64>,
}

/// Statistics over many values of one estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Statistics {
    /// Values other than NaN.
    pub(crate) values: usize,
    pub(crate) mean: f64,
    /// Median of standard error over value.
    pub(crate) relative_error: f64,
    /// `1 / (relative variance · seconds)` at that median, s⁻¹.
    pub(crate) efficiency: f64,
    /// Scores against the reference; `None` for the reference itself.
    pub(crate) z: Option<Scores>,
}

/// Statistics over many z-scores. Without bias their mean square is 1, and 0.3 % of them lie beyond 3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scores {
    /// Number of z-scores.
    pub(crate) count: usize,
    /// Number of values that nothing was counted for, whose error is unknown, and that have no z-score.
    pub(crate) uncounted: usize,
    pub(crate) rms: f64,
    /// The largest |z|.
    pub(crate) largest: f64,
    /// Fraction of |z| > 3.
    pub(crate) beyond_3: f64,
}

impl<'a> Finding<'a> {
    /// Findings of all products that the systems measured, in the order in which they first occur.
    pub(crate) fn all(plan: &'a Plan, report: &'a Report, reference: System) -> Vec<Self> {
        let mut findings: Vec<Self> = Vec::new();
        for (member, sensor) in plan.members.iter().zip(&report.sensors) {
            for product in &sensor.products {
                let estimate = Estimate::new(member.system, sensor, product);
                let known = findings
                    .iter_mut()
                    .find(|one| one.sensor == member.sensor && one.product == product.name);
                match known {
                    Some(finding) => finding.estimates.push(estimate),
                    None => findings.push(Self {
                        sensor: &member.sensor,
                        product: &product.name,
                        unit: &product.unit,
                        estimates: vec![estimate],
                        reference: 0,
                    }),
                }
            }
        }
        for finding in &mut findings {
            let named = finding.estimates.iter().position(|one| one.system == reference);
            finding.reference = named.unwrap_or(0);
        }
        // Sensors together: a system may measure what those before it did not.
        let order = |name: &str| plan.members.iter().position(|member| member.sensor == name);
        findings.sort_by_key(|finding| order(finding.sensor));
        findings
    }

    /// z-scores of an estimate against the reference, NaN where either has no value or counted nothing;
    /// `None` for the reference itself. Those of the pixels if `pixels` is true.
    pub(crate) fn scores(&self, index: usize, pixels: bool) -> Option<Vec<f64>> {
        if index == self.reference {
            return None;
        }
        let pairs = self.pairs(index, pixels)?;
        let score = |(a, b): (f64, f64), (c, d): (f64, f64)| {
            if is_uncounted((a, b), (c, d)) { f64::NAN } else { z_score((a, b), (c, d)) }
        };
        Some(pairs.into_iter().map(|[this, other]| score(this, other)).collect())
    }

    /// Values and errors of an estimate and of the reference side by side.
    fn pairs(&self, index: usize, pixels: bool) -> Option<Vec<[(f64, f64); 2]>> {
        let of = |index: usize| self.estimates[index].values(pixels);
        let (this, other) = (of(index)?, of(self.reference)?);
        let estimates = |all: &Values| -> Vec<(f64, f64)> {
            all.values.iter().copied().zip(all.errors.iter().copied()).collect()
        };
        let pairs = estimates(&this).into_iter().zip(estimates(&other));
        Some(pairs.map(|(this, other)| [this, other]).collect())
    }

    /// Number of values of an estimate that have no z-score because it or the reference counted nothing.
    fn uncounted(&self, index: usize, pixels: bool) -> usize {
        if index == self.reference {
            return 0;
        }
        let pairs = self.pairs(index, pixels).unwrap_or_default();
        pairs.into_iter().filter(|[this, other]| is_uncounted(*this, *other)).count()
    }

    /// Text for a title that says how many values have no z-score; empty if all have one.
    pub(crate) fn left_out(&self, pixels: bool) -> String {
        let counts = (0..self.estimates.len()).map(|index| self.uncounted(index, pixels));
        match counts.sum() {
            0 => String::new(),
            count => format!("; {count} without a count left out"),
        }
    }

    /// Statistics over an estimate's values, or over its pixels; `None` if there are no pixels.
    pub(crate) fn statistics(&self, index: usize, pixels: bool) -> Option<Statistics> {
        let estimate = &self.estimates[index];
        let all = estimate.values(pixels)?;
        let finite: Vec<f64> = all.values.iter().copied().filter(|v| v.is_finite()).collect();
        let relative_error = all.relative_error();
        Some(Statistics {
            values: finite.len(),
            mean: finite.iter().sum::<f64>() / finite.len() as f64,
            relative_error,
            efficiency: 1.0 / (relative_error.powi(2) * estimate.seconds),
            z: self.scores(index, pixels).map(|scores| Scores {
                uncounted: self.uncounted(index, pixels),
                ..Scores::new(&scores)
            }),
        })
    }
}

impl<'a> Estimate<'a> {
    fn new(system: System, sensor: &SensorReport, product: &'a Product) -> Self {
        Self { system, product, seconds: sensor.seconds, rays: sensor.rays }
    }

    /// Values of the product, or those of its pixels.
    pub(crate) fn values(&self, pixels: bool) -> Option<Values> {
        let product = self.product;
        if !pixels {
            let (values, errors) = (product.values.clone(), product.standard_error.clone());
            return Some(Values { values, errors });
        }
        let wide = |values: &[f32]| values.iter().map(|&value| value.into()).collect();
        // A temporary file that cannot be read any more leaves nothing to compare.
        let pixels = product.image.as_ref()?.load().ok()?;
        Some(Values { values: wide(&pixels.values), errors: wide(&pixels.standard_error) })
    }

    /// Cells of the axes of a value and of its row and column, if it is that of a pixel; and its band.
    pub(crate) fn place(&self, index: usize, pixels: bool, cells: &ProductCells) -> AxisCells {
        match &self.product.image {
            Some(image) if pixels => {
                let (pixel, band) = (index / image.bands.len(), index % image.bands.len());
                let mut cells = vec![String::new(); cells.columns()];
                cells.extend([pixel / image.width, pixel % image.width].map(|at| at.to_string()));
                AxisCells { cells, band: image.bands[band].clone() }
            }
            _ => {
                let mut place = cells.row(index);
                place.cells.extend([String::new(), String::new()]);
                place
            }
        }
    }
}

impl Values {
    /// Median of the relative errors of all values other than 0; NaN if there is none.
    fn relative_error(&self) -> f64 {
        let pairs = self.values.iter().zip(&self.errors);
        let relative = pairs
            .filter(|(value, error)| value.abs() > 0.0 && error.is_finite())
            .map(|(value, error)| error / value.abs());
        median(relative.collect())
    }
}

/// The middle one; NaN of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

impl Scores {
    fn new(z: &[f64]) -> Self {
        let z: Vec<f64> = z.iter().copied().filter(|z| !z.is_nan()).collect();
        let count = z.len() as f64;
        Self {
            count: z.len(),
            uncounted: 0,
            rms: (z.iter().map(|z| z * z).sum::<f64>() / count).sqrt(),
            largest: z.iter().map(|z| z.abs()).fold(f64::NAN, f64::max),
            beyond_3: z.iter().filter(|z| z.abs() > 3.0).count() as f64 / count,
        }
    }
}

/// Weights of light are f32: relative differences below this are their rounding.
const ROUNDING: f64 = 1e-6;

/// Returns whether one of two estimates counted nothing and the other something: 0 without an error is what an
/// analog count has where few photons could arrive and none did, and its error is unknown.
fn is_uncounted(a: (f64, f64), b: (f64, f64)) -> bool {
    let is_nothing = |(value, error): (f64, f64)| value == 0.0 && (error == 0.0 || error.is_nan());
    is_nothing(a) != is_nothing(b) && !a.0.is_nan() && !b.0.is_nan()
}

/// Difference of two independent estimates in standard errors of it; NaN if either is unknown.
fn z_score((a, error_a): (f64, f64), (b, error_b): (f64, f64)) -> f64 {
    let difference = a - b;
    if difference == 0.0 {
        return 0.0;
    }
    let known = |error: f64| if error.is_nan() { 0.0 } else { error };
    difference / known(error_a).hypot(known(error_b)).hypot(ROUNDING * a.abs().max(b.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_scores_are_differences_over_the_errors_of_both() {
        let z = z_score((1.5, 0.3), (1.0, 0.4));
        assert!((z - 1.0).abs() < 1e-9, "{z}");
        assert_eq!(z_score((0.0, 0.0), (0.0, 0.0)).to_bits(), 0.0_f64.to_bits());
        assert!(z_score((f64::NAN, 0.1), (1.0, 0.1)).is_nan());
        // Exact in both, but for f32.
        assert!(z_score((1.0, 0.0), (1.0 + 1e-7, 0.0)).abs() < 0.2);
        assert!(z_score((1.0, 0.0), (1.1, 0.0)).abs() > 1e4);
    }

    #[test]
    fn a_count_of_nothing_has_no_known_error() {
        assert!(is_uncounted((0.0, 0.0), (0.3, 0.01)));
        assert!(is_uncounted((0.3, 0.01), (0.0, f64::NAN)));
        // Nothing in both agrees, and a value of 0 with an error is an estimate.
        assert!(!is_uncounted((0.0, 0.0), (0.0, 0.0)));
        assert!(!is_uncounted((0.0, 0.1), (0.3, 0.01)));
        assert!(!is_uncounted((0.0, 0.0), (f64::NAN, 0.0)));
    }

    #[test]
    fn scores_leave_out_what_has_no_value() {
        let scores = Scores::new(&[1.0, -4.0, f64::NAN, 0.0, 2.0]);
        assert_eq!(scores.count, 4);
        assert!((scores.rms - (21.0_f64 / 4.0).sqrt()).abs() < 1e-12);
        assert!((scores.largest - 4.0).abs() < 1e-12 && (scores.beyond_3 - 0.25).abs() < 1e-12);
    }

    #[test]
    fn the_median_of_none_is_unknown() {
        assert!(median(Vec::new()).is_nan());
        assert!((median(vec![3.0, 1.0, 2.0, 10.0]) - 2.5).abs() < 1e-12);
    }
}
