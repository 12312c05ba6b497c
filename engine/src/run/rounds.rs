//! Time control of a measurement: samples are added in rounds until a stop criterion holds.

use std::io;
use std::time::Instant;

use super::checkpoint::{CheckpointStore, FilmState, SaveRule, Section};
use super::convergence::{Convergence, ErrorCheck, Measurement, PacedFilm, Start, relative_errors};
use super::cost::{CostEstimate, PilotRun};
use super::observed::Observed;
use super::{Failure, Progress};
use crate::components::StopCriterion;
use crate::document::{Diagnostic, FileFormat, ScenePath};
use crate::products::{Forecast, Product};
use crate::scratch::ScratchSpace;
use crate::transport::{Partition, ProgressFn};

/// End of a measurement.
pub(super) struct MeasurementEnd {
    pub(super) products: Vec<Product>,
    pub(super) criterion: StopCriterion,
    /// Relative errors of products by name, if they were checked.
    pub(super) errors: Vec<(String, f64)>,
    /// Time of the measurement, including the time before it was resumed, s.
    pub(super) seconds: f64,
    /// Estimate of its cost after its first samples.
    pub(super) forecast: Forecast,
}

/// A measurement on its way.
struct Rounds<'a> {
    name: &'a str,
    convergence: &'a Convergence,
    progress: &'a dyn Progress,
    is_pilot_only: bool,
    pilot: PilotRun,
    start: Start,
    clock: Instant,
    /// Samples of each randomisation so far.
    done: u64,
    check: Option<ErrorCheck>,
    observed: Observed,
}

/// Adds samples until one of the criteria holds. Resumes the measurement if `store` holds it, and saves it there.
///
/// # Errors
/// Errors of the checkpoint.
///
/// # Panics
/// If there is no criterion.
pub(super) fn measure_until(
    name: &str,
    measurement: &mut dyn Measurement,
    formats: &[FileFormat],
    convergence: &Convergence,
    store: &mut CheckpointStore,
    progress: &dyn Progress,
    is_pilot_only: bool,
) -> Result<MeasurementEnd, Failure> {
    assert!(!convergence.until.is_empty(), "a measurement has a stop criterion");
    let cost = CostEstimate::new(measurement, store, formats);
    let start = restore(name, measurement, store)?;
    let pilot = if is_pilot_only {
        PilotRun::alone(cost, start, measurement, convergence.is_fixed())
    } else {
        PilotRun::new(cost, start)
    };
    let mut rounds = Rounds {
        name,
        convergence,
        progress,
        is_pilot_only,
        pilot,
        start,
        clock: Instant::now(),
        done: start.samples,
        check: None,
        observed: Observed::new(measurement, start.seconds),
    };
    let needs_errors = convergence.needs_errors();
    let mut checks = convergence.schedule.evaluations().take_while(|_| needs_errors).peekable();
    loop {
        let done = rounds.done;
        while checks.next_if(|&check| check < done).is_some() {}
        if checks.peek() == Some(&done) {
            let errors = relative_errors(measurement).map_err(Failure::Pixels)?;
            rounds.check = Some(ErrorCheck { samples: done, errors });
        }
        rounds.update_errors(measurement).map_err(Failure::Pixels)?;
        let seconds = rounds.seconds();
        let criterion = rounds.criterion_that_holds(seconds);
        let all = || store.is_complete().then_some(StopCriterion::Samples(done));
        let criterion = criterion.or_else(all);
        rounds.save(measurement, store, seconds, criterion.is_some())?;
        if let Some(criterion) = criterion {
            rounds.observed.report(name, 1.0, 0.0, progress);
            let is_whole = store.share() == Partition::ALL && !is_pilot_only;
            let products = if is_whole { measurement.products() } else { Ok(Vec::new()) };
            let products = products.map_err(Failure::Pixels)?;
            let errors = rounds.errors().map_or_else(Vec::new, <[_]>::to_vec);
            let forecast =
                rounds.pilot.forecast().unwrap_or_else(|| rounds.pilot.forecast_of(seconds));
            return Ok(MeasurementEnd { products, criterion, errors, seconds, forecast });
        }
        if progress.is_cancelled() {
            return Err(rounds.cancelled(measurement, store, seconds)?);
        }
        let can_grow = measurement.films().iter().all(|paced| paced.film.can_grow().is_ok());
        if let Some(forecast) = rounds.forecast(seconds, can_grow) {
            let (products, errors) = (Vec::new(), Vec::new());
            let criterion = convergence.until[0].clone();
            return Ok(MeasurementEnd { products, criterion, errors, seconds, forecast });
        }
        checks.next_if_eq(&done);
        let limit = convergence.limit();
        let goal = checks.peek().map_or(limit, |&check| check.min(limit));
        let longest = store.longest_round(seconds);
        let goal = rounds.next_goal(goal, seconds, can_grow, longest);
        rounds.trace(measurement, goal, can_grow).map_err(Failure::Pixels)?;
    }
}

impl Rounds<'_> {
    /// Time of the measurement so far, s.
    fn seconds(&self) -> f64 {
        self.start.seconds + self.clock.elapsed().as_secs_f64()
    }

    /// Errors of the samples so far, if they were checked.
    fn errors(&self) -> Option<&[(String, f64)]> {
        let check = self.check.as_ref().filter(|check| check.samples == self.done);
        check.map(|check| &*check.errors)
    }

    fn criterion_that_holds(&self, seconds: f64) -> Option<StopCriterion> {
        let holds = |criterion: &&StopCriterion| {
            self.convergence.fraction(criterion, self.done, seconds, self.errors()) >= 1.0
        };
        self.convergence.until.iter().find(holds).filter(|_| self.done > 0).cloned()
    }

    /// Samples at which the measurement will end, at the pace from its start to `samples` after `seconds`.
    fn expected_end(&self, samples: f64, seconds: f64) -> f64 {
        let pace = self.pilot.pace(samples, seconds);
        self.convergence.expected_end(&self.start, pace, self.check.as_ref())
    }

    /// Saves the measurement at the end of a block of samples, if that is due.
    fn save(
        &self,
        measurement: &mut dyn Measurement,
        store: &mut CheckpointStore,
        seconds: f64,
        is_end: bool,
    ) -> Result<(), Failure> {
        if store.collects() {
            let has_coefficients = |paced: PacedFilm<'_>| paced.film.has_coefficients_alone();
            if is_end && measurement.films().into_iter().all(has_coefficients) {
                store.set_section(self.section(measurement, store, seconds)?);
            }
            return Ok(());
        }
        if store.saves() == Some(SaveRule::WhenCancelled) {
            // What takes longer to keep than to trace again is not kept.
            let mut films = measurement.films();
            let bytes = films.iter_mut().map(|paced| paced.film.bytes_of_state()).sum::<u64>();
            if is_end && seconds > WORTH_KEEPING && bytes < LARGEST_KEPT && self.can_save() {
                store.set_section(self.section(measurement, store, seconds)?);
            }
            return Ok(());
        }
        if !store.is_enabled() || !self.can_save() {
            return Ok(());
        }
        let schedule = &self.convergence.schedule;
        // A run cannot be resumed behind the last end of a block.
        let is_last = is_end || schedule.last(self.convergence.limit()) == self.done;
        if is_last || store.is_due() {
            store.set_section(self.section(measurement, store, seconds)?);
            if let Some(warning) = store.save() {
                self.progress.warn(&warning);
            }
        }
        Ok(())
    }

    /// Returns whether the samples so far are whole blocks, which alone can be resumed.
    fn can_save(&self) -> bool {
        self.done > 0 && self.convergence.schedule.last(self.done) == self.done
    }

    /// Saves the measurement, if it can be resumed, and what was saved of sensors before it; returns the failure of the run.
    fn cancelled(
        &self,
        measurement: &mut dyn Measurement,
        store: &mut CheckpointStore,
        seconds: f64,
    ) -> Result<Failure, Failure> {
        if self.can_save() && store.saves().is_some() {
            store.set_section(self.section(measurement, store, seconds)?);
        }
        let done = self.done as f64 / self.expected_end(self.done as f64, seconds);
        let (sensor, saved) = (self.name.to_owned(), store.save_cancelled()?);
        Ok(Failure::Cancelled { sensor, done: done.clamp(0.0, 1.0), saved })
    }

    /// State of the measurement.
    fn section(
        &self,
        measurement: &mut dyn Measurement,
        store: &CheckpointStore,
        seconds: f64,
    ) -> Result<Section, Failure> {
        let state = state(measurement, store.scratch()).map_err(Failure::Pixels)?;
        Ok(Section { name: self.name.to_owned(), samples: self.done, seconds, state })
    }

    /// Ends the pilot run if it is over; returns its forecast if the run is to end with it.
    fn forecast(&self, seconds: f64, can_grow: bool) -> Option<Forecast> {
        // In the middle of a round, past samples are not like those to come.
        let knows_errors = self.check.is_some() || !self.convergence.needs_errors();
        let is_over = self.pilot.is_over(seconds) || self.is_pilot_only && !can_grow;
        if self.done > self.start.samples && knows_errors && is_over {
            let done = self.done as f64;
            self.report_forecast(done, seconds, self.expected_end(done, seconds));
        }
        self.pilot.forecast().filter(|_| self.is_pilot_only)
    }

    /// Estimates the cost of the measurement, and reports it if it is long.
    fn report_forecast(&self, samples: f64, seconds: f64, end: f64) {
        if let Some(forecast) = self.pilot.estimate(samples, seconds, end)
            && forecast.is_long()
            && !self.is_pilot_only
        {
            self.progress.forecast(self.name, &forecast);
        }
    }

    /// Samples at which the next round ends on the way to a goal; `longest` is the time of the longest round, s.
    fn next_goal(&self, goal: u64, seconds: f64, can_grow: bool, longest: f64) -> u64 {
        let schedule = &self.convergence.schedule;
        if self.done == 0 && (can_grow || self.is_pilot_only) {
            // The time of a short round gives that of longer ones.
            return schedule.next(0).max(2).min(goal);
        }
        if !can_grow {
            return goal;
        }
        // A round that ends within a block cannot be saved: it comes last, and alone.
        let whole = schedule.last(goal);
        let goal = if whole > self.done { whole } else { goal };
        let time = self.convergence.until.iter().filter_map(|criterion| match criterion {
            StopCriterion::Seconds(limit) => Some(*limit - seconds),
            _ => None,
        });
        let time = time.fold(longest.min(self.pilot.longest_round()), f64::min);
        if time.is_infinite() {
            return goal;
        }
        let pace = self.pilot.pace(self.done as f64, seconds);
        // Without a pace yet, the round has one block.
        let aim = (self.done as f64 + pace * time).min(4.0 * self.done as f64) as u64;
        let end = schedule.last(aim);
        let end = if end > self.done { end } else { schedule.next(self.done) };
        end.min(goal)
    }

    /// Traces a round.
    fn trace(
        &mut self,
        measurement: &mut dyn Measurement,
        goal: u64,
        can_grow: bool,
    ) -> io::Result<()> {
        let (done, added) = (self.done as f64, (goal - self.done) as f64);
        trace(measurement, goal, &|fraction| {
            let (samples, seconds) = (done + fraction * added, self.seconds());
            let end = self.expected_end(samples, seconds);
            // The next check may decide: nothing is complete before it.
            let done = (samples / end).min(0.999);
            let left = (end - samples) / self.pilot.pace(samples, seconds);
            self.observed.report(self.name, done, left, self.progress);
            if !can_grow && self.pilot.is_over(seconds) {
                self.report_forecast(samples, seconds, end);
            }
        })?;
        self.done = goal;
        let seconds = self.seconds();
        self.observed.count_rays(measurement, seconds);
        Ok(())
    }

    /// Updates the errors that the observer shows.
    fn update_errors(&mut self, measurement: &mut dyn Measurement) -> io::Result<()> {
        if !self.progress.shows_errors() || self.done == 0 || self.is_pilot_only {
            return Ok(());
        }
        let check = self.check.as_ref().filter(|check| check.samples == self.done);
        if let Some(check) = check {
            self.observed.take_errors(&check.errors);
            return Ok(());
        }
        let (start, clock) = (self.start.seconds, self.clock);
        let seconds = || start + clock.elapsed().as_secs_f64();
        self.observed.compute_errors(measurement, seconds)
    }
}

/// Time of a measurement that is kept for a run that may be cancelled at a later sensor, s.
const WORTH_KEEPING: f64 = 10.0;

/// Size of the largest state that is kept for that, bytes.
const LARGEST_KEPT: u64 = 32 << 20;

/// Restores the films from a checkpoint.
fn restore(
    name: &str,
    measurement: &mut dyn Measurement,
    store: &CheckpointStore,
) -> Result<Start, Failure> {
    let mut start = Start { samples: 0, seconds: 0.0 };
    for (share, section) in store.restored(name) {
        let restored = section.state.read(|state| {
            measurement.films().into_iter().try_for_each(|paced| {
                let samples = paced.samples(section.samples);
                paced.film.restore(share, samples, state)
            })
        });
        match restored {
            Ok(true) => {}
            Err(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
                return Err(Failure::Pixels(error));
            }
            Ok(false) | Err(_) => return Err(misfit(name)),
        }
        start = Start { samples: section.samples, seconds: start.seconds + section.seconds };
    }
    measurement.films().into_iter().for_each(|paced| paced.film.restrict(store.share()));
    Ok(start)
}

/// Error of a checkpoint with the right hashes and the wrong contents.
fn misfit(name: &str) -> Failure {
    Failure::Problems(vec![Diagnostic::error(
        ScenePath::from("sensors").name(name),
        "the checkpoint holds something else than this sensor: this is a bug of sunfleck",
    )])
}

/// State of films, in memory or in a temporary file.
fn state(measurement: &mut dyn Measurement, scratch: &ScratchSpace) -> io::Result<FilmState> {
    let films = measurement.films();
    let bytes = films.iter().map(|paced| paced.film.bytes_of_state()).sum();
    FilmState::save(bytes, scratch, |out| films.iter().try_for_each(|paced| paced.film.save(out)))
}

/// Traces all films to a number of samples of the measurement.
pub(super) fn trace(
    measurement: &mut dyn Measurement,
    to: u64,
    watch: ProgressFn<'_>,
) -> io::Result<()> {
    let films = measurement.films();
    let all = films.len() as f64;
    for (index, paced) in films.into_iter().enumerate() {
        let samples = paced.samples(to);
        paced.film.trace(samples, &|fraction| watch((index as f64 + fraction) / all))?;
    }
    Ok(())
}
