//! Rate and error of a measurement, for the observer of a run.

use std::io;

use super::convergence::{Measurement, is_energy_balance, relative_errors};
use super::{Progress, SensorProgress};

/// Time of tracing for each second in which errors are computed for an observer.
const COST_OF_ERRORS: f64 = 50.0;

/// Least time between two computations of errors, s.
const BETWEEN_ERRORS: f64 = 1.0;

/// Rays and error of a measurement at the end of its last round.
pub(super) struct Observed {
    /// Rays when this run started, and its time then, s.
    first: (u64, f64),
    /// Rays at the end of the last round, and its time then, s.
    last: (u64, f64),
    relative_error: Option<f64>,
    /// Time of the measurement when its error was computed, s.
    computed_at: f64,
    /// Time that this took, s.
    cost: f64,
}

impl Observed {
    /// State of a measurement that starts, or is resumed, after `seconds`.
    pub(super) fn new(measurement: &mut dyn Measurement, seconds: f64) -> Self {
        let first = (rays(measurement), seconds);
        Self { first, last: first, relative_error: None, computed_at: seconds, cost: 0.0 }
    }

    /// Counts the rays at the end of a round.
    pub(super) fn count_rays(&mut self, measurement: &mut dyn Measurement, seconds: f64) {
        self.last = (rays(measurement), seconds);
    }

    /// Takes the errors that the measurement has computed for itself.
    pub(super) fn take_errors(&mut self, errors: &[(String, f64)]) {
        self.relative_error = largest(errors);
    }

    /// Computes the errors of a measurement after `seconds`, unless the last time was too recent for what it took, or pixels
    /// would be read from a file.
    ///
    /// - `clock`: time of the measurement, s
    ///
    /// # Errors
    /// If a temporary file cannot be read.
    pub(super) fn compute_errors(
        &mut self,
        measurement: &mut dyn Measurement,
        clock: impl Fn() -> f64,
    ) -> io::Result<()> {
        let seconds = clock();
        let is_on_disk = measurement.films().iter().any(|paced| paced.film.bytes_on_disk() > 0);
        let is_recent =
            seconds - self.computed_at < (self.cost * COST_OF_ERRORS).max(BETWEEN_ERRORS);
        if is_on_disk || is_recent {
            return Ok(());
        }
        self.take_errors(&relative_errors(measurement)?);
        self.computed_at = clock();
        self.cost = self.computed_at - seconds;
        Ok(())
    }

    /// Reports a part of the measurement to the observer.
    pub(super) fn report(&self, name: &str, done: f64, seconds_left: f64, progress: &dyn Progress) {
        let (rays, seconds) = (self.last.0 - self.first.0, self.last.1 - self.first.1);
        progress.sensor(&SensorProgress {
            name,
            done,
            seconds_left: Some(seconds_left.max(0.0)).filter(|left| left.is_finite()),
            rays_per_second: (rays > 0 && seconds > 0.0).then(|| rays as f64 / seconds),
            relative_error: self.relative_error,
        });
    }
}

/// Number of rays of a measurement so far.
fn rays(measurement: &mut dyn Measurement) -> u64 {
    measurement.films().iter().map(|paced| paced.film.rays()).sum()
}

/// Largest error of all products but energy balances, if it is finite.
fn largest(errors: &[(String, f64)]) -> Option<f64> {
    let asked = errors.iter().filter(|(name, _)| !is_energy_balance(name));
    asked.map(|(_, error)| *error).filter(|error| error.is_finite()).reduce(f64::max)
}
