//! A measured value and its expected value.

use serde_json::json;

use super::measured::Estimate;

/// Maximum error of an estimate in standard errors. These have at most 31 degrees of freedom, so that one of
/// 10 000 estimates exceeds it.
const MOST_ERRORS: f64 = 4.5;

/// Relative tolerance for the rounding of f32 along a path, where there is no spread.
const ROUNDING: f64 = 1e-5;

/// A measured quantity and its expected value.
#[derive(Clone, Debug)]
pub(super) struct Finding {
    pub(super) quantity: String,
    expected: f64,
    measured: f64,
    /// NaN where the quantity is no estimate.
    standard_error: f64,
    limit: Limit,
}

/// Tolerance of a quantity.
#[derive(Clone, Copy, Debug)]
enum Limit {
    /// [`MOST_ERRORS`] plus this fraction of the expected value; the standard error is at most `error` of it.
    Estimate { share: f64, error: f64 },
    /// Fraction of the expected value, or absolute error if that is 0.
    Share(f64),
}

impl Finding {
    /// An estimate that is `expected` within its error. The relative error must be at most `error`, so that the
    /// check is not passed by chance.
    pub(super) fn estimate(
        quantity: impl Into<String>,
        expected: f64,
        found: Estimate,
        error: f64,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            expected,
            measured: found.value,
            standard_error: found.error,
            limit: Limit::Estimate { share: ROUNDING, error },
        }
    }

    /// Adds a tolerance for a scene whose exact value differs by the fraction `share` from the expected one.
    pub(super) fn with_tolerance(self, share: f64) -> Self {
        let Limit::Estimate { error, .. } = self.limit else { return self };
        Self { limit: Limit::Estimate { share, error }, ..self }
    }

    /// A number without noise, within a share of what is expected (of 1, if that is 0).
    pub(super) fn within(
        quantity: impl Into<String>,
        expected: f64,
        measured: f64,
        share: f64,
    ) -> Self {
        let (quantity, standard_error) = (quantity.into(), f64::NAN);
        Self { quantity, expected, measured, standard_error, limit: Limit::Share(share) }
    }

    /// A number that is to be this and no other.
    pub(super) fn exact(quantity: impl Into<String>, expected: f64, measured: f64) -> Self {
        Self::within(quantity, expected, measured, 0.0)
    }

    fn deviation(&self) -> f64 {
        self.measured - self.expected
    }

    fn relative(&self) -> f64 {
        self.deviation() / if self.expected.abs() > 0.0 { self.expected.abs() } else { 1.0 }
    }

    fn z(&self) -> f64 {
        self.deviation() / self.standard_error
    }

    pub(super) fn holds(&self) -> bool {
        match self.limit {
            Limit::Share(share) => self.relative().abs() <= share,
            Limit::Estimate { share, error } => {
                let allowed = MOST_ERRORS * self.standard_error + share * self.expected.abs();
                self.deviation().abs() <= allowed
                    && self.standard_error <= error * self.expected.abs()
            }
        }
    }

    /// One line for a person.
    pub(super) fn line(&self, width: usize) -> String {
        let Self { quantity, expected, measured, standard_error, limit } = self;
        let head = format!("{quantity:width$}  {measured:<11.7}");
        match *limit {
            Limit::Estimate { share, error } => {
                let scene = if share > ROUNDING {
                    format!(" + {} %", 100.0 * share)
                } else {
                    String::new()
                };
                format!(
                    "{head} ± {standard_error:.7}  expected {expected:.7}{scene}  z = {:+.2} \
                     (at most {MOST_ERRORS}; error at most {} %)",
                    self.z(),
                    100.0 * error,
                )
            }
            Limit::Share(share) => {
                let limit =
                    if share > 0.0 { format!("at most {share:.0e}") } else { "exactly".to_owned() };
                let off = self.relative();
                format!("{head}              expected {expected:.7}  off by {off:.1e} ({limit})")
            }
        }
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let mut object = json!({
            "quantity": self.quantity,
            "expected": self.expected,
            "measured": self.measured,
            "relative_deviation": self.relative(),
            "holds": self.holds(),
        });
        match self.limit {
            Limit::Estimate { share, error } => {
                object["standard_error"] = json!(self.standard_error);
                object["z"] = json!(self.z());
                object["most_z"] = json!(MOST_ERRORS);
                object["most_relative_deviation_beside"] = json!(share);
                object["most_relative_error"] = json!(error);
            }
            Limit::Share(share) => object["most_relative_deviation"] = json!(share),
        }
        object
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(value: f64, error: f64) -> Estimate {
        Estimate { value, error }
    }

    #[test]
    fn estimates_hold_within_their_error_if_that_is_small_enough() {
        let of = |value, error| Finding::estimate("a", 2.0, found(value, error), 0.01).holds();
        assert!(of(2.0, 0.0) && of(2.04, 0.01) && of(1.96, 0.01));
        assert!(!of(2.05, 0.01), "5 standard errors");
        assert!(!of(2.05, 0.05), "too coarse to tell");
        assert!(!of(f64::NAN, 0.01) && !of(2.0, f64::NAN));
        let nearly = Finding::estimate("a", 2.0, found(2.05, 0.01), 0.01).with_tolerance(0.005);
        assert!(nearly.holds());
    }

    #[test]
    fn numbers_without_noise_hold_within_their_share() {
        assert!(Finding::within("a", 2.0, 2.0 + 1e-9, 1e-9).holds());
        assert!(!Finding::within("a", 2.0, 2.0 + 3e-9, 1e-9).holds());
        assert!(Finding::exact("a", 0.0, 0.0).holds());
        assert!(!Finding::exact("a", 0.0, 1.0).holds());
        assert!(!Finding::within("a", 1.0, f64::NAN, 1.0).holds());
    }
}
