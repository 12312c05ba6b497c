//! Progress bars on a terminal; in a pipe, forecasts of long runs alone.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use sunfleck::run::{Forecast, Progress};

/// Steps of a bar from 0 to 1.
const STEPS: u64 = 1000;

/// A line for the stage at work, and a bar for each sensor that has begun.
#[derive(Debug)]
pub(crate) struct Bars {
    all: MultiProgress,
    stage: ProgressBar,
    sensors: Mutex<Vec<(String, ProgressBar)>>,
}

impl Bars {
    pub(crate) fn new() -> Self {
        let target = if io::stderr().is_terminal() {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let all = MultiProgress::with_draw_target(target);
        let stage = all.add(ProgressBar::new_spinner());
        stage.set_style(style("{spinner} {msg}"));
        stage.enable_steady_tick(Duration::from_millis(100));
        Self { all, stage, sensors: Mutex::default() }
    }

    /// A line above all others.
    pub(crate) fn heading(&self, text: &str) {
        // Without a terminal there is nobody to tell.
        drop(self.all.println(text));
    }

    /// Takes all lines off the terminal.
    pub(crate) fn clear(&self) {
        self.stage.finish_and_clear();
        let sensors = self.sensors.lock().unwrap_or_else(PoisonError::into_inner);
        for (_, bar) in sensors.iter() {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Bars {
    fn stage(&self, name: &str) {
        self.stage.set_message(name.to_owned());
    }

    fn forecast(&self, name: &str, forecast: &Forecast) {
        let text = format!("{name}: {forecast}");
        if self.all.is_hidden() {
            // It stands in the log of a batch job, and a run goes on without.
            drop(writeln!(io::stderr().lock(), "{text}"));
        } else {
            self.heading(&text);
        }
    }

    fn warn(&self, warning: &str) {
        let text = format!("warning: {warning}");
        if self.all.is_hidden() {
            drop(writeln!(io::stderr().lock(), "{text}"));
        } else {
            self.heading(&text);
        }
    }

    fn sensor(&self, name: &str, done: f64) {
        let mut sensors = self.sensors.lock().unwrap_or_else(PoisonError::into_inner);
        let known = sensors.iter().position(|(known, _)| known == name);
        let index = known.unwrap_or_else(|| {
            let bar = self.all.add(ProgressBar::new(STEPS));
            bar.set_style(style(
                "  {msg:20!} {bar:40} {percent:>3} %  {elapsed_precise}  {eta} left",
            ));
            bar.set_message(name.to_owned());
            sensors.push((name.to_owned(), bar));
            sensors.len() - 1
        });
        let bar = &sensors[index].1;
        bar.set_position((done.clamp(0.0, 1.0) * STEPS as f64) as u64);
        if done >= 1.0 {
            bar.set_style(style("  {msg:20!} {bar:40} {percent:>3} %  {elapsed_precise}"));
            bar.abandon();
        }
    }
}

/// `template`, or indicatif's own bar should it not understand it.
fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}
