//! What a run will take, told before it takes it.

use std::cmp::Reverse;
use std::iter::successors;
use std::sync::OnceLock;

use super::advice::{Smaller, smaller};
use super::checkpoint::Keeper;
use super::growth::Measurement;
use crate::components::Sensor;
use crate::document::Diagnostic;
use crate::output;
use crate::products::{Extent, Forecast, data_size};
use crate::transport::Partition;

/// What one sensor takes, bytes; `u64::MAX` of more than can be counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    /// Its films.
    films: u64,
    /// What it takes beside them while it is traced and products are made of them.
    beside: u64,
    /// Its products, which are kept until all sensors are measured.
    products: u64,
    /// What is kept of it for the checkpoint.
    kept: u64,
    /// What writing the files of the largest of its products takes.
    writing: u64,
    /// Its files.
    files: u64,
    /// The measure that takes most of it.
    largest: usize,
}

impl Size {
    /// Of a measurement, of which a share may be traced.
    pub(super) fn of(measurement: &mut dyn Measurement, keeper: &Keeper) -> Self {
        let (mut films, mut beside) = (0, 0);
        for paced in measurement.films() {
            paced.film.restrict(keeper.share());
            films = sum([films, paced.film.bytes()]);
            beside = sum([beside, paced.film.bytes_beside()]);
        }
        // What the last checkpoint holds is there until the next is written.
        let kept = if keeper.keeps() { films } else { 0 };
        let beside = sum([beside, kept]);
        let is_whole = keeper.share() == Partition::ALL;
        let extents = if is_whole { measurement.extents() } else { Vec::new() };
        let of_all = |of: fn(Extent) -> u64| sum(extents.iter().map(|&extent| of(extent)));
        Self {
            films,
            beside,
            products: of_all(Extent::memory),
            kept,
            writing: extents.iter().map(|extent| extent.memory_of_files()).max().unwrap_or(0),
            files: of_all(output::file_size),
            largest: measurement.largest(),
        }
    }

    /// Of a measurement that takes so long.
    pub(super) fn forecast(self, seconds: f64) -> Forecast {
        Forecast { seconds, memory: self.memory(), files: self.files }
    }

    /// The most memory that it takes, were it alone.
    pub(super) fn memory(self) -> u64 {
        peak(&[self])
    }
}

/// The first samples of a measurement, which tell how long all of them will take.
pub(super) struct Pilot {
    size: Size,
    /// Samples of each randomisation that were there before, and their seconds.
    first: f64,
    before: f64,
    told: OnceLock<Forecast>,
}

/// Seconds of a pilot.
const PILOT: f64 = 1.0;

impl Pilot {
    /// Of a measurement of which so many samples, of so many seconds, were there before.
    pub(super) const fn new(size: Size, (first, before): (u64, f64)) -> Self {
        Self { size, first: first as f64, before, told: OnceLock::new() }
    }

    /// Samples of each randomisation in a second.
    pub(super) fn pace(&self, at: f64, seconds: f64) -> f64 {
        (at - self.first) / (seconds - self.before).max(1e-6)
    }

    /// Seconds that a round may take.
    pub(super) fn round(&self) -> f64 {
        if self.told.get().is_none() { PILOT } else { f64::INFINITY }
    }

    /// Whether it is time to tell.
    pub(super) fn is_over(&self, seconds: f64) -> bool {
        seconds - self.before >= PILOT && self.told.get().is_none()
    }

    /// Tells, from where it is, how long it will be to an end, if there is one in sight.
    pub(super) fn tell(&self, (at, seconds): (f64, f64), end: f64) -> Option<Forecast> {
        let all = self.before + (end - self.first) / self.pace(at, seconds);
        all.is_finite().then(|| *self.told.get_or_init(|| self.size.forecast(all)))
    }

    /// What it has told.
    pub(super) fn told(&self) -> Option<Forecast> {
        self.told.get().copied()
    }
}

fn sum(bytes: impl IntoIterator<Item = u64>) -> u64 {
    bytes.into_iter().fold(0, u64::saturating_add)
}

/// The most memory that sensors take which are measured one after the other.
fn peak(sizes: &[Size]) -> u64 {
    let (mut most, mut kept) = (0, 0);
    for &Size { films, beside, products, kept: own, .. } in sizes {
        kept = sum([kept, products, own]);
        most = sum([kept, films, beside]).max(most);
    }
    let writing = sizes.iter().map(|size| size.writing).max().unwrap_or(0);
    most.max(sum([kept, writing]))
}

/// A problem if sensors take more memory than there is: at that which takes most, with what would fit;
/// `size` is that of a sensor in place of it.
pub(super) fn check(
    sensors: &[(String, Sensor)],
    mut sizes: Vec<Size>,
    free: u64,
    size: impl Fn(&str, &Sensor) -> Size,
) -> Option<Diagnostic> {
    let needed = peak(&sizes);
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&index| Reverse(sizes[index].memory()));
    let largest = *order.first().filter(|_| needed > free)?;
    let each =
        |&index: &usize| format!("`{}` {}", sensors[index].0, data_size(sizes[index].memory()));
    let mut shown: Vec<String> = order.iter().take(SHOWN).map(each).collect();
    if let others @ 1.. = sizes.len().saturating_sub(SHOWN) {
        shown.push(format!("{others} more"));
    }
    let message = format!(
        "films and results take {} of memory, and {} are free: {}",
        data_size(needed),
        data_size(free),
        shown.join(", ")
    );
    let (name, sensor) = &sensors[largest];
    let path = format!("sensors.{name}");
    let alone = if sizes.len() > 1 { ", or each sensor in a scene of its own" } else { "" };
    // What it may take beside the others, as a share of what it takes; small films are kept in another
    // way, so that memory is not in proportion.
    let Size { largest: measure, .. } = sizes[largest];
    let own = sizes[largest].memory();
    let share = free.saturating_sub(needed.saturating_sub(own)) as f64 / own as f64;
    let shares = successors(Some(0.99 * share), |share| Some(0.8 * share));
    let candidates = shares.map_while(|share| smaller(sensor, measure, share)).take(TRIES);
    for Smaller { sensor, key, text } in candidates {
        sizes[largest] = size(name, &sensor);
        if peak(&sizes) <= free {
            let help = format!("write {text}, or measure in fewer bands{alone}");
            return Some(Diagnostic::error(path + &key, message).help(help));
        }
    }
    let help = format!("measure less there, or in fewer bands{alone}");
    Some(Diagnostic::error(path, message).help(help))
}

/// Sensors of which a person is told what they take.
const SHOWN: usize = 5;

/// Sizes that are tried for one that fits.
const TRIES: usize = 40;
