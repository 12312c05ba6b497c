//! What a command says while it works and when it is done: text, nothing but warnings, or a line of JSON for each step.

use std::io::{self, Write as _};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use clap::Args;
use serde_json::{Value, json};
use sunfleck::output::Written;
use sunfleck::run::{Forecast, Progress, SensorProgress};

use crate::commands;
use crate::interrupt;
use crate::progress::Bars;

/// Manner in which a command speaks.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct Console {
    /// Print only warnings and errors
    #[arg(long, conflicts_with = "json")]
    quiet: bool,

    /// Print a line of JSON for each step, for other programs; its key `event` names the step
    #[arg(long)]
    json: bool,
}

impl Console {
    /// Text for a person.
    pub(crate) const TEXT: Self = Self { quiet: false, json: false };

    /// Observer of a run that shows its progress in this manner.
    pub(crate) fn observer(self) -> Observer {
        let shows = if self.json {
            Shows::Lines(Mutex::new(None))
        } else if self.quiet {
            Shows::Nothing
        } else {
            Shows::Bars(Bars::new())
        };
        Observer { shows }
    }

    /// Prints text for a person.
    pub(crate) fn say(self, text: &str) -> anyhow::Result<()> {
        if self.quiet || self.json { Ok(()) } else { commands::print(text) }
    }

    /// Prints an event for a program.
    pub(crate) fn event(self, event: &Value) {
        if self.json {
            print_event(event);
        }
    }

    /// Shows warnings.
    pub(crate) fn warn(self, warnings: &[String]) {
        if self.json {
            for text in warnings {
                print_event(&json!({ "event": "warning", "text": text.trim_end() }));
            }
        } else {
            commands::warn(warnings);
        }
    }

    /// Prints the event of files that were written.
    pub(crate) fn written(self, written: &Written) {
        let Written { folder, files, .. } = written;
        self.event(&json!({ "event": "written", "folder": folder, "files": files }));
    }
}

/// Observer of a run that may be cancelled by a signal.
#[derive(Debug)]
pub(crate) struct Observer {
    shows: Shows,
}

#[derive(Debug)]
enum Shows {
    Bars(Bars),
    /// Lines of JSON, with the sensor of the last one and its time.
    Lines(Mutex<Option<(String, Instant)>>),
    Nothing,
}

/// Least time between two lines about the same sensor.
const BETWEEN_LINES: Duration = Duration::from_millis(500);

impl Observer {
    /// Shows a line above all bars.
    pub(crate) fn heading(&self, text: &str) {
        match &self.shows {
            Shows::Bars(bars) => bars.heading(text),
            Shows::Lines(_) => print_event(&json!({ "event": "heading", "text": text })),
            Shows::Nothing => {}
        }
    }

    /// Removes all bars; from now on a signal ends the process without delay.
    pub(crate) fn clear(&self) {
        interrupt::set_ends_by_itself(false);
        if let Shows::Bars(bars) = &self.shows {
            bars.clear();
        }
    }
}

impl Progress for Observer {
    fn stage(&self, name: &str) {
        interrupt::set_ends_by_itself(false);
        match &self.shows {
            Shows::Bars(bars) => bars.stage(name),
            Shows::Lines(_) => print_event(&json!({ "event": "stage", "stage": name })),
            Shows::Nothing => {}
        }
    }

    fn sensor(&self, state: &SensorProgress<'_>) {
        interrupt::set_ends_by_itself(state.done < 1.0);
        match &self.shows {
            Shows::Bars(bars) => bars.sensor(state),
            Shows::Lines(last) => {
                let mut last = last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                let is_recent = last.as_ref().is_some_and(|(sensor, time)| {
                    sensor == state.name && time.elapsed() < BETWEEN_LINES
                });
                if is_recent && state.done < 1.0 {
                    return;
                }
                *last = Some((state.name.to_owned(), Instant::now()));
                print_event(&event_of(state));
            }
            Shows::Nothing => {}
        }
    }

    fn forecast(&self, name: &str, forecast: &Forecast) {
        match &self.shows {
            Shows::Bars(bars) => bars.forecast(name, forecast),
            Shows::Lines(_) => print_event(&forecast_event(name, forecast)),
            Shows::Nothing => {}
        }
    }

    fn warn(&self, warning: &str) {
        match &self.shows {
            Shows::Bars(bars) => bars.warn(warning),
            Shows::Lines(_) => print_event(&json!({ "event": "warning", "text": warning })),
            Shows::Nothing => commands::warn(&[warning.to_owned()]),
        }
    }

    fn shows_errors(&self) -> bool {
        match &self.shows {
            Shows::Bars(bars) => bars.shows_errors(),
            Shows::Lines(_) => true,
            Shows::Nothing => false,
        }
    }

    fn is_cancelled(&self) -> bool {
        interrupt::is_cancelled()
    }
}

fn event_of(state: &SensorProgress<'_>) -> Value {
    json!({
        "event": "sensor",
        "sensor": state.name,
        "done": state.done,
        "seconds_left": state.seconds_left,
        "rays_per_second": state.rays_per_second,
        "relative_error": state.relative_error,
    })
}

/// Event of an estimate of what a sensor takes.
pub(crate) fn forecast_event(name: &str, forecast: &Forecast) -> Value {
    json!({
        "event": "forecast",
        "sensor": name,
        "seconds": forecast.seconds,
        "memory_bytes": forecast.memory,
        "file_bytes": forecast.files,
    })
}

/// Prints a line of JSON; a reader that has gone away misses it.
fn print_event(event: &Value) {
    let mut stdout = io::stdout().lock();
    drop(writeln!(stdout, "{event}").and_then(|()| stdout.flush()));
}
