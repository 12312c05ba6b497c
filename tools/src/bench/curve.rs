use sunfleck::document::System;

use crate::compare::findings::{Values, median};

/// Run time against error of one product, measured by one system.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) sensor: String,
    /// `brf`, or `brf, pixels`.
    pub(super) product: String,
    pub(super) system: System,
    /// One for each number of samples, upwards.
    pub(super) levels: Vec<Level>,
}

/// All repeats of one number of samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Level {
    /// Factor on the scene's number of samples.
    pub(super) quality: f64,
    pub(super) repeats: Vec<Repeat>,
}

/// One measurement beside the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Repeat {
    pub(super) seconds: f64,
    /// `√(Σ standard error² / Σ truth²)`.
    pub(super) reported: f64,
    /// `Σ (value - truth)² / Σ truth²`, less what the truth's own error makes of it.
    pub(super) square: f64,
    /// Median of standard error over value, as in `until: RelError(..)`.
    pub(super) median: f64,
}

impl Repeat {
    /// Compares the values that both have; `None` where there are none, or all are 0.
    pub(super) fn new(seconds: f64, found: &Values, truth: &Values) -> Option<Self> {
        let (mut squares, mut errors, mut off, mut of_truth) = (0.0, 0.0, 0.0, 0.0);
        let mut relative = Vec::new();
        let known = |error: f64| if error.is_finite() { error } else { 0.0 };
        let found = found.values.iter().zip(&found.errors);
        for ((value, error), (truth, truth_error)) in
            found.zip(truth.values.iter().zip(&truth.errors))
        {
            if !(value.is_finite() && truth.is_finite()) {
                continue;
            }
            squares += truth * truth;
            errors += known(*error).powi(2);
            off += (value - truth).powi(2);
            of_truth += known(*truth_error).powi(2);
            if value.abs() > 0.0 {
                relative.push(known(*error) / value.abs());
            }
        }
        (squares > 0.0).then(|| Self {
            seconds,
            reported: (errors / squares).sqrt(),
            square: (off - of_truth) / squares,
            median: median(relative),
        })
    }
}

impl Level {
    fn median_of(&self, of: impl Fn(&Repeat) -> f64) -> f64 {
        median(self.repeats.iter().map(of).collect())
    }

    pub(super) fn seconds(&self) -> f64 {
        self.median_of(|repeat| repeat.seconds)
    }

    pub(super) fn reported(&self) -> f64 {
        self.median_of(|repeat| repeat.reported)
    }

    pub(super) fn median(&self) -> f64 {
        self.median_of(|repeat| repeat.median)
    }

    /// Root of the mean square deviation from the truth; NaN where the truth is no better.
    pub(super) fn actual(&self) -> f64 {
        let squares = self.repeats.iter().map(|repeat| repeat.square);
        let square = squares.sum::<f64>() / self.repeats.len() as f64;
        if square > 0.0 { square.sqrt() } else { f64::NAN }
    }
}

/// `error = factor · seconds^slope`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    pub(super) slope: f64,
    /// Standard error of the slope.
    pub(super) slope_error: f64,
    /// Logarithm of the error after 1 s.
    log_factor: f64,
}

/// Errors below this are the rounding of f32, not noise.
const EXACT: f64 = 3e-7;

impl Fit {
    /// Fits the logarithms by least squares; `None` for fewer than three points, for points at one time, or for
    /// a value without noise.
    pub(super) fn new(points: &[(f64, f64)]) -> Option<Self> {
        let points: Vec<(f64, f64)> = points
            .iter()
            .filter(|&&(seconds, error)| seconds > 0.0 && error > EXACT && error.is_finite())
            .map(|(seconds, error)| (seconds.ln(), error.ln()))
            .collect();
        let n = points.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
        let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
        let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
        let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        if points.len() < 3 || xx <= 1e-6 {
            return None;
        }
        let slope = xy / xx;
        let rest: f64 = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2)).sum();
        let slope_error = (rest / (n - 2.0) / xx).sqrt();
        Some(Self { slope, slope_error, log_factor: y - slope * x })
    }

    /// The error after so many seconds.
    pub(super) fn error(&self, seconds: f64) -> f64 {
        (self.log_factor + self.slope * seconds.ln()).exp()
    }

    /// Seconds to an error; `None` if it does not fall.
    pub(super) fn seconds(&self, error: f64) -> Option<f64> {
        (self.slope < 0.0).then(|| ((error.ln() - self.log_factor) / self.slope).exp())
    }
}

impl Curve {
    /// Fit of the errors that the runs report.
    pub(super) fn fit(&self) -> Option<Fit> {
        let points: Vec<(f64, f64)> =
            self.levels.iter().map(|level| (level.seconds(), level.reported())).collect();
        Fit::new(&points)
    }

    /// Deviation from the truth over the error that is reported, root mean square of all runs: 1 where
    /// errors are what they say.
    pub(super) fn calibration(&self) -> f64 {
        let runs = self.levels.iter().flat_map(|level| &level.repeats);
        let ratios: Vec<f64> = runs
            .filter(|run| run.reported > EXACT)
            .map(|run| run.square / run.reported.powi(2))
            .collect();
        (ratios.iter().sum::<f64>() / ratios.len() as f64).max(0.0).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_with_no_error() {
        let points: Vec<(f64, f64)> =
            (0..6).map(|k| f64::from(1 << k)).map(|t| (t, 0.04 / t.sqrt())).collect();
        let fit = Fit::new(&points).expect("noise");
        assert!((fit.slope + 0.5).abs() < 1e-12 && fit.slope_error < 1e-12, "{fit:?}");
        assert!((fit.seconds(0.01).expect("noise") - 16.0).abs() < 1e-9);
        assert!((fit.error(4.0) - 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_slope_has_the_error_of_the_textbook() {
        // Residuals +d, -2d, +d about a line through x = -1, 0, 1: their squares sum to 6 d², over one
        // degree of freedom and Σx² = 2.
        let d: f64 = 0.1;
        let at = |x: f64, off: f64| (x.exp(), (x * -0.5 + off - 3.0).exp());
        let fit = Fit::new(&[at(-1.0, d), at(0.0, -2.0 * d), at(1.0, d)]).expect("noise");
        assert!((fit.slope + 0.5).abs() < 1e-12);
        assert!((fit.slope_error - (3.0 * d * d).sqrt()).abs() < 1e-12, "{fit:?}");
    }

    #[test]
    fn what_has_no_noise_has_no_slope() {
        assert_eq!(Fit::new(&[(1.0, 0.0), (2.0, 0.0), (4.0, 1e-9), (8.0, 0.0)]), None);
        assert_eq!(Fit::new(&[(1.0, 0.1), (1.0, 0.2), (1.0, 0.1)]), None);
    }

    #[test]
    fn errors_are_relative_to_the_truth_and_its_own_error_is_taken_off() {
        let found = Values { values: vec![1.3, f64::NAN, 4.0], errors: vec![0.3, 0.1, 0.4] };
        let truth = Values { values: vec![1.0, 2.0, 4.0], errors: vec![0.1, 0.1, 0.0] };
        let repeat = Repeat::new(2.0, &found, &truth).expect("noise");
        assert!((repeat.reported - (0.25_f64 / 17.0).sqrt()).abs() < 1e-12, "{repeat:?}");
        assert!((repeat.square - (0.09 - 0.01) / 17.0).abs() < 1e-12, "{repeat:?}");
        assert!((repeat.median - 0.5 * (0.3 / 1.3 + 0.1)).abs() < 1e-12, "{repeat:?}");
        let black = Values { values: vec![0.0], errors: vec![0.0] };
        assert_eq!(Repeat::new(1.0, &black, &black), None);
    }
}
