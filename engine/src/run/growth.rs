//! One loop for all sensors: more samples until the measurement is good enough.

use std::sync::Arc;
use std::time::Instant;

use super::checkpoint::{Keeper, Section};
use super::forecast::{Pilot, Size};
use super::{Failure, Progress};
use crate::components::Stop;
use crate::document::Diagnostic;
use crate::products::{Extent, Forecast, Product};
use crate::transport::{Film, Partition, ProgressFn, Schedule};

/// What a sensor measures, as it grows.
pub(super) trait Measurement {
    /// All that is traced for it.
    fn films(&mut self) -> Vec<Paced<'_>>;

    /// What it has found so far.
    fn products(&self) -> Vec<Product>;

    /// What its products consist of, but for a few single numbers.
    fn extents(&self) -> Vec<Extent>;

    /// Which of the sensor's measures counts in most cells, if that differs.
    fn largest(&self) -> usize {
        0
    }
}

/// A film and the samples of its own that go with each of the measurement, as a fraction.
pub(super) struct Paced<'a> {
    pub(super) film: &'a mut dyn Film,
    pub(super) pace: (u64, u64),
}

impl<'a> Paced<'a> {
    /// One sample for one.
    pub(super) fn evenly(film: &'a mut dyn Film) -> Self {
        Self { film, pace: (1, 1) }
    }

    fn place(&self, n: u64) -> u64 {
        let (times, over) = self.pace;
        (u128::from(n) * u128::from(times) / u128::from(over)).try_into().unwrap_or(u64::MAX)
    }
}

/// How far a measurement goes.
pub(super) struct Plan {
    /// The first that holds ends it.
    pub(super) until: Vec<Stop>,
    pub(super) schedule: Schedule,
    /// Samples of the randomisations that make up so many of [`Stop::Samples`].
    pub(super) each: Box<dyn Fn(u64) -> u64 + Sync>,
}

/// How a measurement ended.
pub(super) struct Ending {
    pub(super) products: Vec<Product>,
    pub(super) stop: Stop,
    /// Relative errors of products by name, if they were looked at.
    pub(super) errors: Vec<(String, f64)>,
    /// Seconds, those before it was gone on with among them.
    pub(super) seconds: f64,
    /// What its first samples told of it.
    pub(super) forecast: Forecast,
}

/// Samples of a measurement from which on a product that is 0 throughout counts as exactly 0: it may
/// be of something rare.
const BLACK: u64 = 1 << 17;

impl Plan {
    /// Samples that end it.
    fn limit(&self) -> u64 {
        let limits = self.until.iter().filter_map(|stop| match stop {
            Stop::Samples(limit) => Some((self.each)(*limit)),
            _ => None,
        });
        limits.min().unwrap_or(u64::MAX)
    }

    fn needs_errors(&self) -> bool {
        self.until.iter().any(|stop| matches!(stop, Stop::RelError(_) | Stop::RelErrors(_)))
    }

    /// Whether a number of samples ends it, and nothing else can.
    pub(super) fn is_fixed(&self) -> bool {
        self.until.iter().all(|stop| matches!(stop, Stop::Samples(_)))
    }

    /// How much of what each condition asks for is there; at 1 it holds.
    fn part(&self, stop: &Stop, done: u64, seconds: f64, errors: Option<&[(String, f64)]>) -> f64 {
        // The error falls as the root of the number of samples at the slowest.
        let of =
            |error: f64, limit: f64| if error <= limit { 1.0 } else { (limit / error).powi(2) };
        let Some(errors) = errors else {
            return match stop {
                Stop::RelError(_) | Stop::RelErrors(_) => 0.0,
                Stop::Seconds(limit) => seconds / limit,
                Stop::Samples(limit) => done as f64 / (self.each)(*limit) as f64,
            };
        };
        match stop {
            Stop::RelError(limit) => {
                let asked = errors.iter().filter(|(name, _)| !is_ledger(name));
                asked.map(|(_, error)| of(*error, *limit)).fold(1.0, f64::min)
            }
            Stop::RelErrors(limits) => {
                let of_name = |(name, limit): &(String, f64)| {
                    let found = errors.iter().find(|(known, _)| known == name);
                    found.map_or(1.0, |(_, error)| of(*error, *limit))
                };
                limits.iter().map(of_name).fold(1.0, f64::min)
            }
            Stop::Seconds(_) | Stop::Samples(_) => self.part(stop, done, seconds, None),
        }
    }

    /// Samples after which one of the conditions will hold, were all to go on at a pace from what was done
    /// at first, and errors from where they were last looked at; infinite if nothing tells.
    pub(super) fn end(
        &self,
        (first, before): (u64, f64),
        pace: f64,
        last: Option<&(u64, Vec<(String, f64)>)>,
    ) -> f64 {
        let end = |stop: &Stop| match (stop, last) {
            (Stop::Seconds(limit), _) => first as f64 + pace * (limit - before),
            (Stop::Samples(limit), _) => (self.each)(*limit) as f64,
            (_, Some((seen, errors))) => *seen as f64 / self.part(stop, *seen, 0.0, Some(errors)),
            (_, None) => f64::INFINITY,
        };
        self.until.iter().map(end).fold(f64::INFINITY, f64::min)
    }
}

/// Adds samples until one of the conditions holds; goes on with what `keeper` has read of the sensor of
/// this name, and keeps there what is traced.
///
/// # Errors
/// Of the checkpoint.
///
/// # Panics
/// If there is no condition.
pub(super) fn grow(
    name: &str,
    measurement: &mut dyn Measurement,
    plan: &Plan,
    keeper: &mut Keeper,
    (progress, pilot_alone): (&dyn Progress, bool),
) -> Result<Ending, Failure> {
    assert!(!plan.until.is_empty(), "a measurement ends");
    let size = Size::of(measurement, keeper);
    let (mut done, before) = restore(name, measurement, keeper)?;
    let start = Instant::now();
    let elapsed = || before + start.elapsed().as_secs_f64();
    let (first, limit) = (done, plan.limit());
    let mut looks = plan.schedule.evaluations().take_while(|_| plan.needs_errors()).peekable();
    // What was found where errors were last looked at: the products and how far that was.
    let mut last: Option<(u64, Vec<(String, f64)>)> = None;
    let pilot = Pilot::new(size, (done, before));
    let end = |at: f64, seconds: f64, last: Option<&(u64, Vec<(String, f64)>)>| {
        plan.end((first, before), pilot.pace(at, seconds), last)
    };
    let tell = |(at, seconds): (f64, f64), end: f64| {
        if let Some(forecast) = pilot.tell((at, seconds), end)
            && forecast.is_long()
            && !pilot_alone
        {
            progress.forecast(name, &forecast);
        }
    };
    loop {
        while looks.next_if(|&look| look < done).is_some() {}
        if looks.peek() == Some(&done) {
            last = Some((done, relative_errors(measurement)));
        }
        let seconds = elapsed();
        let here = last.as_ref().filter(|(at, _)| *at == done).map(|(_, errors)| &**errors);
        let ended =
            plan.until.iter().find(|stop| done > 0 && plan.part(stop, done, seconds, here) >= 1.0);
        let is_end_of_block = plan.schedule.last(done) == done;
        if keeper.keeps() && is_end_of_block && done > 0 {
            // Behind the last end of a block nothing can be gone on with.
            let is_last = ended.is_some() || plan.schedule.last(limit) == done;
            if is_last || keeper.is_due() {
                keeper.hold(section(name, measurement, done, seconds));
                if let Some(warning) = keeper.save() {
                    progress.warn(&warning);
                }
            }
        }
        if let Some(stop) = ended {
            progress.sensor(name, 1.0);
            let errors = here.map_or_else(Vec::new, <[_]>::to_vec);
            let is_whole = keeper.share() == Partition::ALL;
            let products = if is_whole { measurement.products() } else { Vec::new() };
            let forecast = pilot.told().unwrap_or_else(|| size.forecast(seconds));
            return Ok(Ending { products, stop: stop.clone(), errors, seconds, forecast });
        }
        let can_grow = measurement.films().iter().all(|paced| paced.film.can_grow().is_ok());
        // In the middle of a round, what is done is not like what is left.
        let knows = last.is_some() || !plan.needs_errors();
        if done > first && knows && (pilot.is_over(seconds) || pilot_alone && !can_grow) {
            tell((done as f64, seconds), end(done as f64, seconds, last.as_ref()));
        }
        if let Some(forecast) = pilot.told().filter(|_| pilot_alone) {
            let (products, errors, stop) = (Vec::new(), Vec::new(), plan.until[0].clone());
            return Ok(Ending { products, stop, errors, seconds, forecast });
        }
        looks.next_if_eq(&done);
        let goal = looks.peek().map_or(limit, |&look| look.min(limit));
        let goal = if done == 0 && (can_grow || pilot_alone) {
            // A short round tells how long others take.
            plan.schedule.next(0).max(2).min(goal)
        } else if can_grow {
            let round = keeper.round().min(pilot.round());
            next_round(plan, (done, goal), (pilot.pace(done as f64, seconds), seconds, round))
        } else {
            goal
        };
        let far = (goal - done) as f64;
        trace(measurement, goal, &|part| {
            let (at, seconds) = (done as f64 + part * far, elapsed());
            let end = end(at, seconds, last.as_ref());
            // Where the next look may decide, nothing is complete before it.
            progress.sensor(name, (at / end).min(0.999));
            if !can_grow && pilot.is_over(seconds) {
                tell((at, seconds), end);
            }
        });
        done = goal;
    }
}

/// Takes in what was traced before; returns the samples of each randomisation and the seconds so far.
fn restore(
    name: &str,
    measurement: &mut dyn Measurement,
    keeper: &Keeper,
) -> Result<(u64, f64), Failure> {
    let (mut done, mut seconds) = (0, 0.0);
    for (share, section) in keeper.before(name) {
        let mut state = section.state.as_slice();
        for paced in measurement.films() {
            let place = paced.place(section.done);
            let restored = paced.film.restore(share, place, &mut state);
            restored.map_err(|_short| misfit(name))?;
        }
        if !state.is_empty() {
            return Err(misfit(name));
        }
        (done, seconds) = (section.done, seconds + section.seconds);
    }
    measurement.films().into_iter().for_each(|paced| paced.film.restrict(keeper.share()));
    Ok((done, seconds))
}

/// Of what a checkpoint with the right hashes cannot hold.
fn misfit(name: &str) -> Failure {
    Failure::Problems(vec![Diagnostic::error(
        format!("sensors.{name}"),
        "the checkpoint holds something else than this sensor: this is a bug of sunfleck",
    )])
}

fn section(name: &str, measurement: &mut dyn Measurement, done: u64, seconds: f64) -> Section {
    let bytes: u64 = measurement.films().iter().map(|paced| paced.film.bytes()).sum();
    let mut state = Vec::with_capacity(bytes as usize);
    for paced in measurement.films() {
        paced.film.save(&mut state).expect("writing to memory does not fail");
    }
    Section { name: name.to_owned(), done, seconds, state: Arc::new(state) }
}

/// Where the next round ends, on the way from what is done to a goal.
fn next_round(
    plan: &Plan,
    (done, goal): (u64, u64),
    (pace, seconds, round): (f64, f64, f64),
) -> u64 {
    // What ends within a block cannot be kept: it comes last, and alone.
    let whole = plan.schedule.last(goal);
    let goal = if whole > done { whole } else { goal };
    let time = plan.until.iter().filter_map(|stop| match stop {
        Stop::Seconds(limit) => Some(*limit - seconds),
        _ => None,
    });
    let time = time.fold(round, f64::min);
    if time.is_infinite() {
        return goal;
    }
    // A pace of nothing yet is that of one block.
    let aim = (done as f64 + pace * time).min(4.0 * done as f64) as u64;
    let place = plan.schedule.last(aim);
    let place = if place > done { place } else { plan.schedule.next(done) };
    place.min(goal)
}

/// Brings all films to the same place.
pub(super) fn trace(measurement: &mut dyn Measurement, to: u64, watch: ProgressFn<'_>) {
    let films = measurement.films();
    let all = films.len() as f64;
    for (index, paced) in films.into_iter().enumerate() {
        let place = paced.place(to);
        paced.film.trace(place, &|part| watch((index as f64 + part) / all));
    }
}

/// Median relative standard error of each product that was asked for, by name; infinite of one that
/// is black, or a logarithm of nothing, for want of samples.
pub(super) fn relative_errors(measurement: &mut dyn Measurement) -> Vec<(String, f64)> {
    let samples: u64 = measurement.films().iter().map(|paced| paced.film.samples()).sum();
    let of = |product: &Product| {
        let black = if samples < BLACK { f64::INFINITY } else { 0.0 };
        let is_unknown = product.is_black() || product.is_unbounded();
        let error = if is_unknown { Some(black) } else { product.median_relative_error() };
        error.map(|error| (product.name.clone(), error))
    };
    measurement.products().iter().filter_map(of).collect()
}

/// Whether a product is the ledger of the energy, which nobody asks an accuracy of: what roulette took
/// is 0 but for noise.
pub(super) fn is_ledger(product: &str) -> bool {
    matches!(product, "energy" | "emitted_energy")
}
