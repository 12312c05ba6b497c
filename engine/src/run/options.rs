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

/// Observer of a run; the library itself shows nothing.
pub trait Progress: Sync {
    /// A stage starts.
    fn stage(&self, name: &str);
    /// A fraction of a sensor's measurement, 0 to 1, is done.
    fn sensor(&self, name: &str, done: f64);
    /// A sensor will run for long.
    fn forecast(&self, name: &str, forecast: &Forecast);
    /// The run goes on in spite of a problem.
    fn warn(&self, _warning: &str) {}
}

/// Observer that ignores everything.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Progress for Unwatched {
    fn stage(&self, _: &str) {}
    fn sensor(&self, _: &str, _: f64) {}
    fn forecast(&self, _: &str, _: &Forecast) {}
}
