//! Estimate of the cost of a run, before it is traced and from its first samples.

use std::cmp::Reverse;
use std::iter::successors;
use std::sync::OnceLock;

use glam::UVec2;

use super::advice::{Smaller, smaller};
use super::checkpoint::{CheckpointStore, is_in_memory};
use super::convergence::{Measurement, Start};
use super::sensors::SensorEntity;
use crate::components::ResolvedSensor;
use crate::document::{Diagnostic, FileFormat, ScenePath};
use crate::output;
use crate::products::{Forecast, ProductSize, data_size};
use crate::scratch::ScratchSpace;
use crate::transport::Partition;

/// Memory and files of one sensor, bytes; saturates at `u64::MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CostEstimate {
    /// Memory of its films.
    films: u64,
    /// Size of the temporary files of its films.
    disk: u64,
    /// Further memory while it is traced and products are made.
    beside: u64,
    /// Memory of its products, which are kept until all sensors are measured, with the films that they are computed from.
    products: u64,
    /// Size of all values of its products, if they were all in memory.
    values: u64,
    /// Memory of its section of the checkpoint.
    checkpoint: u64,
    /// Memory to write the files of the largest of its products.
    writing: u64,
    /// Size of its files.
    files: u64,
    /// Index of the measure that takes most of it.
    largest: usize,
    /// True if products are computed from its films when they are written, so that these stay until then.
    is_kept: bool,
}

impl CostEstimate {
    /// Estimate for a measurement, of which a part of the run may be traced.
    ///
    /// - `formats`: file formats of images
    pub(super) fn new(
        measurement: &mut dyn Measurement,
        store: &CheckpointStore,
        formats: &[FileFormat],
    ) -> Self {
        let (mut films, mut beside, mut disk, mut state) = (0, 0, 0, 0);
        for paced in measurement.films() {
            paced.film.restrict(store.share());
            films = sum([films, paced.film.bytes()]);
            beside = sum([beside, paced.film.bytes_beside()]);
            disk = sum([disk, paced.film.bytes_on_disk()]);
            state = sum([state, paced.film.bytes_of_state()]);
        }
        // The last checkpoint stays in memory until the next one is written.
        let state = if store.is_enabled() { state } else { 0 };
        let keeps_state = is_in_memory(state, store.scratch());
        let (checkpoint, saved) = if keeps_state { (state, 0) } else { (0, state) };
        let disk = sum([disk, saved]);
        let beside = sum([beside, checkpoint]);
        let is_whole = store.share() == Partition::ALL;
        let sizes = if is_whole { measurement.product_sizes() } else { Vec::new() };
        let of_all = |of: fn(ProductSize) -> u64| sum(sizes.iter().map(|&extent| of(extent)));
        Self {
            films,
            beside,
            disk,
            products: of_all(ProductSize::memory),
            values: of_all(ProductSize::bytes),
            checkpoint,
            writing: sizes
                .iter()
                .map(|&size| output::memory_of_files(size, formats))
                .max()
                .unwrap_or(0),
            files: sum(sizes.iter().map(|&extent| output::file_size(extent, formats))),
            largest: measurement.largest(),
            is_kept: is_whole && measurement.keeps_films(),
        }
    }

    /// Forecast for a measurement of this duration, s.
    pub(super) fn forecast(self, seconds: f64) -> Forecast {
        Forecast { seconds, memory: self.memory(), files: self.files }
    }

    /// Peak memory of the sensor alone.
    pub(super) fn memory(self) -> u64 {
        peak(&[self])
    }
}

/// First samples of a measurement, from which the time of all of them is estimated.
pub(super) struct PilotRun {
    cost: CostEstimate,
    start: Start,
    /// Number of partitions of the measurement, of which it traces one.
    partitions: u32,
    /// Its duration, s.
    duration: f64,
    forecast: OnceLock<Forecast>,
}

/// Duration of a pilot run, s.
const PILOT_SECONDS: f64 = 1.0;

/// Duration of a pilot run that nothing follows, s.
const PILOT_SECONDS_ALONE: f64 = 0.5;

/// Tiles of an image that a forecast traces at least.
const PILOT_TILES: u32 = 64;

impl PilotRun {
    /// Pilot run of a measurement that starts, or is resumed, at `start`.
    pub(super) const fn new(cost: CostEstimate, start: Start) -> Self {
        Self { cost, start, partitions: 1, duration: PILOT_SECONDS, forecast: OnceLock::new() }
    }

    /// Pilot run that nothing follows: of some of the tiles, if it is an image's and ends after a number of samples.
    pub(super) fn alone(
        cost: CostEstimate,
        start: Start,
        measurement: &mut dyn Measurement,
        is_fixed: bool,
    ) -> Self {
        let films = measurement.films();
        let units = films.iter().map(|paced| paced.film.units());
        let units = units.min_by_key(|units| units.x * units.y).unwrap_or(UVec2::ONE);
        let count = if is_fixed { partitions_of(units) } else { 1 };
        let partition = Partition { index: 0, count };
        for paced in films {
            paced.film.restrict(partition);
        }
        let duration = PILOT_SECONDS_ALONE;
        Self { partitions: partition.count, duration, ..Self::new(cost, start) }
    }

    /// Forecast for a measurement whose partition took this time, s.
    pub(super) fn forecast_of(&self, seconds: f64) -> Forecast {
        self.cost.forecast(seconds * f64::from(self.partitions))
    }

    /// Samples of each randomisation per second since the start.
    pub(super) fn pace(&self, samples: f64, seconds: f64) -> f64 {
        (samples - self.start.samples as f64) / (seconds - self.start.seconds).max(1e-6)
    }

    /// Longest time of a round, s.
    pub(super) fn longest_round(&self) -> f64 {
        if self.forecast.get().is_none() { self.duration } else { f64::INFINITY }
    }

    /// Returns whether the pilot run has taken its time and has no forecast yet.
    pub(super) fn is_over(&self, seconds: f64) -> bool {
        seconds - self.start.seconds >= self.duration && self.forecast.get().is_none()
    }

    /// Estimates the cost of the measurement up to `end` samples at the pace so far; `None` if the end is not finite. The
    /// first estimate stays.
    pub(super) fn estimate(&self, samples: f64, seconds: f64, end: f64) -> Option<Forecast> {
        let remaining = (end - self.start.samples as f64) / self.pace(samples, seconds);
        let all = self.start.seconds + remaining;
        all.is_finite().then(|| *self.forecast.get_or_init(|| self.forecast_of(all)))
    }

    /// Estimate, if there is one.
    pub(super) fn forecast(&self) -> Option<Forecast> {
        self.forecast.get().copied()
    }
}

/// Number of partitions of an image of these tiles, one of which is traced for a forecast: enough tiles for all threads, and
/// none of the numbers that would choose those of some columns.
fn partitions_of(tiles: UVec2) -> u32 {
    let least = PILOT_TILES.max(8 * rayon::current_num_threads() as u32);
    let most = (tiles.x * tiles.y / least).max(1);
    let has_common_factor =
        |count: u32| (2..=count).any(|f| count.is_multiple_of(f) && tiles.x.is_multiple_of(f));
    (1..=most).rev().find(|&count| !has_common_factor(count)).unwrap_or(1)
}

fn sum(bytes: impl IntoIterator<Item = u64>) -> u64 {
    bytes.into_iter().fold(0, u64::saturating_add)
}

/// Size of the values of all products and of the largest films, in memory or not, which depends on their shapes alone.
pub(super) fn shapes(costs: impl Iterator<Item = CostEstimate>) -> u64 {
    let (mut films, mut values) = (0, 0);
    for cost in costs {
        films = sum([cost.films, cost.disk]).max(films);
        values = sum([values, cost.values]);
    }
    sum([films, values])
}

/// Peak memory of sensors that are measured one after the other.
fn peak(costs: &[CostEstimate]) -> u64 {
    let (mut most, mut permanent) = (0, 0);
    for &CostEstimate { films, beside, products, checkpoint, is_kept, .. } in costs {
        permanent = sum([permanent, products, checkpoint]);
        most = sum([permanent, films, beside]).max(most);
        permanent = sum([permanent, if is_kept { films } else { 0 }]);
    }
    let writing = costs.iter().map(|cost| cost.writing).max().unwrap_or(0);
    most.max(sum([permanent, writing]))
}

/// Returns an error if sensors take more memory than is free: at the sensor that takes most, with a smaller one that
/// would fit. `cost` estimates that of a sensor.
pub(super) fn check_memory(
    sensors: &[SensorEntity],
    free: u64,
    cost: impl Fn(&str, &ResolvedSensor) -> CostEstimate,
) -> Option<Diagnostic> {
    let mut costs: Vec<CostEstimate> =
        sensors.iter().map(|one| cost(&one.name, &one.sensor)).collect();
    let needed = peak(&costs);
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by_key(|&index| Reverse(costs[index].memory()));
    let largest = *order.first().filter(|_| needed > free)?;
    let each =
        |&index: &usize| format!("`{}` {}", sensors[index].name, data_size(costs[index].memory()));
    let mut shown: Vec<String> = order.iter().take(SHOWN).map(each).collect();
    if let others @ 1.. = costs.len().saturating_sub(SHOWN) {
        shown.push(format!("{others} more"));
    }
    let message = format!(
        "films and results take {} of memory, and {} are free: {}",
        data_size(needed),
        data_size(free),
        shown.join(", ")
    );
    let SensorEntity { name, sensor, .. } = &sensors[largest];
    let path = ScenePath::from("sensors").name(name);
    let alone = if costs.len() > 1 { ", or each sensor in a scene of its own" } else { "" };
    // Fraction of its memory that is free beside the others. Small films are stored in another way, so that memory is
    // not proportional to the number of cells.
    let CostEstimate { largest: measure, .. } = costs[largest];
    let memory = costs[largest].memory();
    let fraction = free.saturating_sub(needed.saturating_sub(memory)) as f64 / memory as f64;
    let mut tried = |fraction: f64| {
        let Smaller { sensor, path, text } = smaller(sensor, &path, measure, fraction)?;
        costs[largest] = cost(name, &sensor);
        Some((peak(&costs) <= free, path, text))
    };
    // The whole does not fit.
    let (mut too_large, mut advised) = (1.0, None);
    for fraction in successors(Some(0.99 * fraction), |f| Some(0.8 * f)).take(MOST_TRIES) {
        let Some((fits, path, text)) = tried(fraction) else { break };
        if fits {
            advised = Some((fraction, path, text));
            break;
        }
        too_large = fraction;
    }
    if let Some((mut fitting, mut path, mut text)) = advised {
        for _ in 0..REFINEMENTS {
            let middle = 0.5 * (fitting + too_large);
            match tried(middle) {
                Some((true, larger, advice)) => (fitting, path, text) = (middle, larger, advice),
                Some((false, ..)) | None => too_large = middle,
            }
        }
        let help = format!("write {text}, or measure in fewer bands{alone}");
        return Some(Diagnostic::error(path, message).help(help));
    }
    let help = format!("measure less there, or in fewer bands{alone}");
    Some(Diagnostic::error(path, message).help(help))
}

/// Returns an error if the temporary files of sensors take more of the disk than is free, at the sensor that takes most.
pub(super) fn check_disk(
    sensors: &[SensorEntity],
    scratch: &ScratchSpace,
    cost: impl Fn(&str, &ResolvedSensor) -> CostEstimate,
) -> Option<Diagnostic> {
    let sizes: Vec<u64> = sensors.iter().map(|one| cost(&one.name, &one.sensor).disk).collect();
    let needed = sum(sizes.iter().copied());
    // Nothing is asked of a disk that nothing is written to.
    let free = Some(needed).filter(|needed| *needed > 0).and_then(|_| scratch.free())?;
    if needed <= free {
        return None;
    }
    let largest = (0..sizes.len()).max_by_key(|&index| sizes[index])?;
    let message = format!(
        "sums of images take {} of temporary files, and {} are free in {}",
        data_size(needed),
        data_size(free),
        scratch.folder.display()
    );
    let path = ScenePath::from("sensors").name(&sensors[largest].name);
    let help = "write the results to another disk (`--out`), or measure fewer pixels or bands";
    Some(Diagnostic::error(path, message).help(help))
}

/// Number of sensors whose memory a message lists.
const SHOWN: usize = 5;

/// Number of halvings of the range between a sensor that fits and one that does not.
const REFINEMENTS: u32 = 5;

/// Number of smaller sensors that are tried.
const MOST_TRIES: usize = 40;

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    /// Tiles of a forecast lie in as many columns of an image as can be, and are a small part of a large one.
    #[test]
    fn the_tiles_of_a_forecast_are_those_of_all_columns() {
        for (columns, rows) in
            [(1, 1), (63, 64), (64, 64), (61, 70), (60, 210), (500, 500), (1, 32)]
        {
            let count = partitions_of(UVec2::new(columns, rows));
            let partition = Partition { index: 0, count };
            let owned = (0..columns * rows).filter(|&tile| partition.owns(tile as usize));
            let shown: BTreeSet<u32> = owned.clone().map(|tile| tile % columns).collect();
            let most = owned.count().min(columns as usize);
            assert_eq!(shown.len(), most, "{columns} x {rows}: {count}");
        }
        assert!(partitions_of(UVec2::new(500, 500)) > 100);
    }
}
