use std::path::PathBuf;

use super::Checkpoint;
use crate::products::Forecast;
use crate::scratch::ScratchSpace;
use crate::{document, memory};

/// Settings of a run beyond the scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// Parameters and variant.
    pub document: document::ReadOptions,
    /// Threads; all that the machine has if absent.
    pub threads: Option<usize>,
    /// Factor on all numbers of samples, and its inverse root on relative errors: 1 is the scene as
    /// it is written.
    pub quality: f64,
    /// File that the run saves its state to and resumes from.
    pub checkpoint: Option<Checkpoint>,
    /// Checkpoints of all parts of one run, whose films are united instead of traced.
    pub unite: Vec<PathBuf>,
    /// Memory that the ray engine, and films with results, may take, bytes; all that is free if absent. A run that takes
    /// more is refused before it traces anything.
    pub memory: Option<u64>,
    /// Folder of temporary files, and the memory above which sums of images are kept there.
    pub scratch: ScratchSpace,
    /// True to trace only as much of each sensor as an estimate of its time takes.
    pub forecast: bool,
    /// True to keep the coefficients of sensors of packets in the report, for [`respectrum`](super::respectrum): however
    /// few bands there are, and as long as they fit into memory.
    pub keeps_coefficients: bool,
    /// True to keep the values of each randomisation in the products ([`Product::replicates`](crate::products::Product::replicates)).
    pub keeps_replicates: bool,
    /// Names of the sensors that measure; all if empty.
    pub sensors: Vec<String>,
}

impl Options {
    /// Returns the memory that a run may take, bytes.
    pub(super) fn free_memory(&self) -> u64 {
        self.memory.or_else(memory::free).unwrap_or(u64::MAX)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            document: document::ReadOptions::default(),
            threads: None,
            quality: 1.0,
            checkpoint: None,
            unite: Vec::new(),
            memory: None,
            scratch: ScratchSpace::default(),
            forecast: false,
            keeps_coefficients: false,
            keeps_replicates: false,
            sensors: Vec::new(),
        }
    }
}

/// State of a sensor's measurement while it is traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorProgress<'a> {
    /// Name of the sensor.
    pub name: &'a str,
    /// Fraction of the measurement that is done, 0 to 1.
    pub done: f64,
    /// Time until its end at the pace so far, s; `None` while it is unknown.
    pub seconds_left: Option<f64>,
    /// Rays per second of this run up to the end of the last round of samples.
    pub rays_per_second: Option<f64>,
    /// Largest of the median relative standard errors of its products when they were last computed.
    pub relative_error: Option<f64>,
}

/// Observer of a run; the library itself shows nothing.
pub trait Progress: Sync {
    /// A stage starts.
    fn stage(&self, name: &str);
    /// A part of a sensor's measurement is done.
    fn sensor(&self, state: &SensorProgress<'_>);
    /// A fraction of something other than a measurement is done.
    fn fraction(&self, name: &str, done: f64) {
        self.sensor(&SensorProgress {
            name,
            done,
            seconds_left: None,
            rays_per_second: None,
            relative_error: None,
        });
    }
    /// A sensor will run for long.
    fn forecast(&self, name: &str, forecast: &Forecast);
    /// The run goes on in spite of a problem.
    fn warn(&self, _warning: &str) {}
    /// Returns true if errors are to be computed for [`sensor`](Self::sensor), for which a run then takes up to 2 % of its
    /// time.
    fn shows_errors(&self) -> bool {
        false
    }
    /// Returns true if the run is to end as soon as it can save its state; it fails with
    /// [`Failure::Cancelled`](super::Failure::Cancelled) then.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Observer that ignores everything.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Progress for Unwatched {
    fn stage(&self, _: &str) {}
    fn sensor(&self, _: &SensorProgress<'_>) {}
    fn forecast(&self, _: &str, _: &Forecast) {}
}
