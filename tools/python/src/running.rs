//! Checks and runs, on a thread of their own: the caller's thread shows progress and takes signals.

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sunfleck::document::{Diagnostic, Param, ReadOptions, Severity, read_text};
use sunfleck::output::{SensorArrays, sensor_arrays};
use sunfleck::run::{
    Checkpoint, Forecast, Options, Partition, Progress, SaveRule, SensorProgress, run_text,
};

use crate::arrays;
use crate::errors::{RunError, of_run, of_text};

/// Time between two looks for signals.
const WAIT: Duration = Duration::from_millis(50);

/// Event of a run.
enum Event {
    Stage(String),
    Sensor { name: String, done: f64, error: Option<f64> },
    Warning(String),
}

/// Progress that is told to another thread.
struct Told<'a> {
    events: Sender<Event>,
    is_shown: bool,
    is_cancelled: &'a AtomicBool,
}

impl Told<'_> {
    fn tell(&self, event: Event) {
        // Nobody listens once the caller has failed.
        drop(self.events.send(event));
    }
}

impl Progress for Told<'_> {
    fn stage(&self, name: &str) {
        self.tell(Event::Stage(name.to_owned()));
    }

    fn sensor(&self, state: &SensorProgress<'_>) {
        let SensorProgress { name, done, relative_error, .. } = *state;
        self.tell(Event::Sensor { name: name.to_owned(), done, error: relative_error });
    }

    fn forecast(&self, _: &str, _: &Forecast) {}

    fn warn(&self, warning: &str) {
        self.tell(Event::Warning(warning.to_owned()));
    }

    fn shows_errors(&self) -> bool {
        self.is_shown
    }

    fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Settings of a run beyond the scene.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Settings {
    /// Parameters: numbers or texts.
    set: Vec<(String, PyParam)>,
    variant: Option<String>,
    threads: Option<usize>,
    quality: f64,
    sensors: Vec<String>,
    /// File that a run which is interrupted saves its state to, and which the next one goes on from.
    checkpoint: Option<PathBuf>,
}

#[derive(FromPyObject)]
enum PyParam {
    Number(f64),
    Text(String),
}

impl Settings {
    fn options(self) -> Options {
        let param = |param| match param {
            PyParam::Number(number) => Param::Number(number),
            PyParam::Text(text) => Param::Text(text),
        };
        let set = self.set.into_iter().map(|(name, value)| (name, param(value))).collect();
        let checkpoint = self.checkpoint.map(|file| Checkpoint {
            file,
            saves: SaveRule::Every(60.0),
            share: Partition::ALL,
        });
        Options {
            document: ReadOptions { set, variant: self.variant, ..ReadOptions::default() },
            threads: self.threads,
            quality: self.quality,
            sensors: self.sensors,
            checkpoint,
            ..Options::default()
        }
    }
}

/// Errors and warnings of a scene's text alone: dictionaries of `severity`, `path`, `message`, `help` and the `text` of
/// all that, with its lines.
#[pyfunction]
pub(crate) fn check<'py>(py: Python<'py>, text: &str, name: &str) -> PyResult<Bound<'py, PyList>> {
    let reading =
        read_text(name, text, &ReadOptions::default()).map_err(|error| of_text(&error))?;
    let found = PyList::empty(py);
    for diagnostic in &reading.diagnostics {
        let entry = PyDict::new(py);
        let Diagnostic { severity, path, message, help, .. } = diagnostic;
        entry
            .set_item("severity", if *severity == Severity::Error { "error" } else { "warning" })?;
        entry.set_item("path", path.to_string())?;
        entry.set_item("message", message)?;
        entry.set_item("help", help.as_deref())?;
        entry.set_item("text", reading.source.render(std::slice::from_ref(diagnostic)))?;
        found.append(entry)?;
    }
    Ok(found)
}

/// Runs a scene; returns the arrays of each sensor, and its warnings.
///
/// - `path`: file that the text stands for; paths in it are relative to its folder
/// - `progress`: called with (stage or sensor, fraction that is done, relative error so far), or none
#[pyfunction]
pub(crate) fn run<'py>(
    py: Python<'py>,
    text: String,
    path: PathBuf,
    settings: Settings,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let options = settings.options();
    let is_cancelled = AtomicBool::new(false);
    let (events, received) = channel();
    // The interpreter is released while the thread waits, for which what it holds is to be shared.
    let received = Mutex::new(received);
    let told = Told { events, is_shown: progress.is_some(), is_cancelled: &is_cancelled };
    let outcome = thread::scope(|scope| {
        let work = scope.spawn(move || measured(&path, &text, &options, &told));
        let watched = watch(py, &received, progress);
        if watched.is_err() {
            is_cancelled.store(true, Ordering::Relaxed);
        }
        let ended = py.detach(|| work.join());
        let warnings = watched?;
        let ended = ended.unwrap_or_else(|_| {
            Err(RunError::new_err("the run panicked: this is a fault of sunfleck"))
        });
        ended.map(|(sensors, own)| (sensors, warnings.into_iter().chain(own).collect::<Vec<_>>()))
    });
    let (sensors, warnings) = outcome?;
    let result = PyDict::new(py);
    let list = PyList::empty(py);
    for sensor in sensors {
        list.append(arrays::of_sensor(py, sensor)?)?;
    }
    result.set_item("sensors", list)?;
    result.set_item("warnings", warnings)?;
    Ok(result)
}

/// Arrays of all sensors, and warnings.
fn measured(
    path: &Path,
    text: &str,
    options: &Options,
    progress: &Told<'_>,
) -> PyResult<(Vec<SensorArrays>, Vec<String>)> {
    let report = run_text(path, text, options, progress).map_err(|failure| of_run(&failure))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let arrays =
        sensor_arrays(&report, folder).map_err(|error| RunError::new_err(error.to_string()))?;
    Ok((arrays, report.warnings))
}

/// Tells progress until the run ends; returns its warnings. Signals and errors of `progress` are errors.
fn watch(
    py: Python<'_>,
    events: &Mutex<Receiver<Event>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<String>> {
    let mut warnings = Vec::new();
    loop {
        let event = py.detach(|| events.lock().expect("one thread listens").recv_timeout(WAIT));
        py.check_signals()?;
        let state = match event {
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return Ok(warnings),
            Ok(Event::Warning(warning)) => {
                warnings.push(warning);
                continue;
            }
            Ok(Event::Stage(name)) => (name, None, None),
            Ok(Event::Sensor { name, done, error }) => (name, Some(done), error),
        };
        if let Some(progress) = progress {
            progress.call1(state)?;
        }
    }
}
