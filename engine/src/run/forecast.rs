//! What a run will take, told before it takes it.

use std::sync::OnceLock;

use sysinfo::{MemoryRefreshKind, ProcessRefreshKind, ProcessesToUpdate, System};

use super::checkpoint::Keeper;
use super::growth::Measurement;
use crate::components::Sensor;
use crate::document::Diagnostic;
use crate::output;
use crate::products::{Extent, Forecast, data_size};
use crate::transport::Share;

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
        let is_whole = keeper.share() == Share::ALL;
        let extents = if is_whole { measurement.extents() } else { Vec::new() };
        let of_all = |of: fn(Extent) -> u64| sum(extents.iter().map(|&extent| of(extent)));
        Self {
            films,
            beside,
            products: of_all(Extent::memory),
            kept,
            writing: extents.iter().map(|extent| extent.memory_of_files()).max().unwrap_or(0),
            files: of_all(output::file_size),
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

/// A problem if sensors take more memory than there is: at that which takes most.
pub(super) fn check(sensors: &[(String, Sensor)], sizes: &[Size], free: u64) -> Option<Diagnostic> {
    let needed = peak(sizes);
    let largest = (0..sizes.len()).max_by_key(|&index| sizes[index].memory())?;
    if needed <= free {
        return None;
    }
    let own = sizes[largest].memory();
    // What it may take beside the others, as a share of what it takes.
    let share = free.saturating_sub(needed.saturating_sub(own)) as f64 / own as f64;
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|&index| std::cmp::Reverse(sizes[index].memory()));
    let each = |&index: &usize| {
        format!("sensors.{} {}", sensors[index].0, data_size(sizes[index].memory()))
    };
    let shown: Vec<String> = order.iter().take(SHOWN).map(each).collect();
    let others = match sizes.len().saturating_sub(SHOWN) {
        0 => String::new(),
        others => format!(", and {others} more"),
    };
    let message = format!(
        "films and results take {} of memory, and {} are free: {}{others}",
        data_size(needed),
        data_size(free),
        shown.join(", ")
    );
    let (name, sensor) = &sensors[largest];
    let (key, help) = advice(sensor, share);
    Some(Diagnostic::error(format!("sensors.{name}{key}"), message).help(help))
}

/// Sensors of which a person is told what they take.
const SHOWN: usize = 5;

/// The key that decides how much memory a sensor takes, and what to write there for it to take such a
/// share.
fn advice(sensor: &Sensor, share: f64) -> (&'static str, String) {
    // A little less, for what does not shrink along.
    let of = |count: f64| (0.99 * share * count).floor();
    let split = "or measure in fewer bands, or each sensor in a scene of its own";
    match sensor {
        Sensor::Image(image) => {
            let scale = (0.99 * share).sqrt();
            let size = (image.size.as_dvec2() * scale).floor();
            let help = if size.min_element() < 1.0 {
                format!("write fewer pixels, {split}")
            } else {
                format!("write `size_px: ({}, {})`, {split}", size.x, size.y)
            };
            (".size_px", help)
        }
        Sensor::Directions(directions) => {
            let views = directions.views.len();
            let help = match of(views as f64) {
                0.0 => format!("write fewer views, {split}"),
                fit => format!("{fit} of its {views} views would fit; write so many, {split}"),
            };
            (".views", help)
        }
        Sensor::Photons(_) => {
            let percent = of(100.0);
            let help = format!(
                "measure on wider pixels, in thicker layers or in fewer cells: {percent} % of what it counts in would fit; {split}"
            );
            (".measure", help)
        }
    }
}

/// Memory that this process can still take, bytes: what the system has left, and what the control
/// groups of this process allow it. `None` if nothing tells.
pub(super) fn free_memory() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    let free = Some(system.available_memory()).filter(|free| *free > 0);
    let id = sysinfo::get_current_pid().ok()?;
    let own = ProcessesToUpdate::Some(&[id]);
    system.refresh_processes_specifics(own, false, ProcessRefreshKind::nothing());
    let limits = system.process(id).and_then(sysinfo::Process::cgroup_limits);
    // Files that the group has read count as used, but give way.
    let allowed = limits.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    free.into_iter().chain(allowed).min()
}
