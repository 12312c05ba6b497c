//! One loop for all sensors: more samples until the measurement is good enough.

use std::time::Instant;

use super::Failure;
use super::checkpoint::{Keeper, Section};
use crate::components::Stop;
use crate::document::Diagnostic;
use crate::products::Product;
use crate::transport::{Film, Schedule, Share, Watch};

/// What a sensor measures, as it grows.
pub(super) trait Measurement {
    /// All that is traced for it.
    fn films(&mut self) -> Vec<Paced<'_>>;

    /// What it has found so far.
    fn products(&self) -> Vec<Product>;
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
    watch: Watch<'_>,
) -> Result<Ending, Failure> {
    assert!(!plan.until.is_empty(), "a measurement ends");
    let (mut done, before) = restore(name, measurement, keeper)?;
    let start = Instant::now();
    let elapsed = || before + start.elapsed().as_secs_f64();
    let (first, limit) = (done, plan.limit());
    let mut looks = plan.schedule.looks().take_while(|_| plan.needs_errors()).peekable();
    // What was found where errors were last looked at: the products and how far that was.
    let mut last: Option<(u64, Vec<(String, f64)>)> = None;
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
                keeper.write()?;
            }
        }
        if let Some(stop) = ended {
            watch(1.0);
            let errors = here.map_or_else(Vec::new, <[_]>::to_vec);
            let is_whole = keeper.share() == Share::ALL;
            let products = if is_whole { measurement.products() } else { Vec::new() };
            return Ok(Ending { products, stop: stop.clone(), errors, seconds });
        }
        looks.next_if_eq(&done);
        let goal = looks.peek().map_or(limit, |&look| look.min(limit));
        let pace = (done - first) as f64 / (seconds - before).max(1e-6);
        let goal = next_round(plan, (done, goal), (pace, seconds, keeper.round()), measurement);
        let progress = |at: f64| {
            let seconds = elapsed();
            let part = |stop: &Stop| match &last {
                Some((seen, errors)) if matches!(stop, Stop::RelError(_) | Stop::RelErrors(_)) => {
                    plan.part(stop, *seen, seconds, Some(errors)) * at / *seen as f64
                }
                _ => plan.part(stop, at as u64, seconds, None),
            };
            // Where the next look may decide, nothing is complete before it.
            plan.until.iter().map(part).fold(0.0, f64::max).min(0.999)
        };
        let far = (goal - done) as f64;
        trace(measurement, goal, &|part| watch(progress(done as f64 + part * far)));
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
        let mut state = &*section.state;
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
    let mut state = Vec::new();
    for paced in measurement.films() {
        paced.film.save(&mut state).expect("writing to memory does not fail");
    }
    Section { name: name.to_owned(), done, seconds, state: state.into() }
}

/// Where the next round ends, on the way from what is done to a goal.
fn next_round(
    plan: &Plan,
    (done, goal): (u64, u64),
    (pace, seconds, round): (f64, f64, f64),
    measurement: &mut dyn Measurement,
) -> u64 {
    if measurement.films().iter().any(|paced| paced.film.can_grow().is_err()) {
        return goal;
    }
    // What ends within a block cannot be kept: it comes last, and alone.
    let whole = plan.schedule.last(goal);
    let goal = if whole > done { whole } else { goal };
    if done == 0 {
        // A short round tells how long others take.
        return plan.schedule.next(0).max(2).min(goal);
    }
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
fn trace(measurement: &mut dyn Measurement, to: u64, watch: Watch<'_>) {
    let films = measurement.films();
    let all = films.len() as f64;
    for (index, paced) in films.into_iter().enumerate() {
        let place = paced.place(to);
        paced.film.trace(place, &|part| watch((index as f64 + part) / all));
    }
}

/// Median relative standard error of each product that was asked for, by name; infinite of one that
/// is black for want of samples.
fn relative_errors(measurement: &mut dyn Measurement) -> Vec<(String, f64)> {
    let samples: u64 = measurement.films().iter().map(|paced| paced.film.samples()).sum();
    let of = |product: &Product| {
        let black = if samples < BLACK { f64::INFINITY } else { 0.0 };
        let error = if product.is_black() { Some(black) } else { product.median_relative_error() };
        error.map(|error| (product.name.clone(), error))
    };
    measurement.products().iter().filter_map(of).collect()
}

/// Whether a product is the ledger of the energy, which nobody asks an accuracy of: what roulette took
/// is 0 but for noise.
pub(super) fn is_ledger(product: &str) -> bool {
    matches!(product, "energy" | "emitted_energy")
}
