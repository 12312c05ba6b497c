//! Progress bars on a terminal; in a pipe, forecasts of long runs and, after two seconds without a word, a
//! line that says what is being done.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

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
    pulse: Pulse,
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
        let pulse = Pulse::default();
        if all.is_hidden() {
            pulse.beat();
        }
        Self { all, stage, sensors: Mutex::default(), pulse }
    }

    /// A line above all others.
    pub(crate) fn heading(&self, text: &str) {
        // Without a terminal there is nobody to tell.
        drop(self.all.println(text));
    }

    /// Takes all lines off the terminal.
    pub(crate) fn clear(&self) {
        self.pulse.update(|work| work.is_over = true);
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
        self.pulse.update(|work| *work = Work::new(name));
    }

    fn forecast(&self, name: &str, forecast: &Forecast) {
        let text = format!("{name}: {forecast}");
        if self.all.is_hidden() {
            // It stands in the log of a batch job, and a run goes on without.
            drop(writeln!(io::stderr().lock(), "{text}"));
            self.pulse.update(Work::was_spoken_of);
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
        self.pulse.update(|work| {
            if work.sensor.as_deref() != Some(name) {
                *work = Work { sensor: Some(name.to_owned()), ..Work::new(&work.stage) };
            }
            work.done = done;
        });
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

/// Time until the first line in a pipe; each further line comes after twice as long.
const SILENCE: Duration = Duration::from_secs(2);

/// Longest time between two lines in a pipe.
const LONGEST_SILENCE: Duration = Duration::from_mins(10);

/// Interval between checks whether a line is due.
const BEAT: Duration = Duration::from_millis(200);

/// Progress of the current stage or sensor.
#[derive(Debug)]
struct Work {
    stage: String,
    sensor: Option<String>,
    /// Part of the sensor's measurement that is done, 0 to 1.
    done: f64,
    since: Instant,
    spoken: Instant,
    silence: Duration,
    is_over: bool,
}

impl Work {
    fn new(stage: &str) -> Self {
        let now = Instant::now();
        Self {
            stage: stage.to_owned(),
            sensor: None,
            done: 0.0,
            since: now,
            spoken: now,
            silence: SILENCE,
            is_over: false,
        }
    }

    /// Notes that something has been said.
    fn was_spoken_of(&mut self) {
        self.spoken = Instant::now();
        self.silence = (2 * self.silence).min(LONGEST_SILENCE);
    }

    /// The line that is due, if one is.
    fn word(&self) -> Option<String> {
        let Self { stage, sensor, done, since, .. } = self;
        if self.spoken.elapsed() < self.silence || stage.is_empty() {
            return None;
        }
        let seconds = since.elapsed().as_secs();
        Some(match sensor {
            None => format!("{stage}: {seconds} s so far"),
            Some(sensor) if *done > 0.0 => {
                format!("{sensor}: {:.1} % done after {seconds} s", 100.0 * done)
            }
            Some(sensor) => format!("{sensor}: first samples, {seconds} s so far"),
        })
    }
}

/// Work that a thread says a word of from time to time.
#[derive(Debug)]
struct Pulse(Arc<Mutex<Work>>);

impl Default for Pulse {
    fn default() -> Self {
        Self(Arc::new(Mutex::new(Work::new(""))))
    }
}

impl Pulse {
    fn update(&self, change: impl FnOnce(&mut Work)) {
        change(&mut lock(&self.0));
    }

    /// Says what is being done whenever a word is due, until the work is over.
    fn beat(&self) {
        let work = Arc::clone(&self.0);
        thread::spawn(move || {
            loop {
                thread::sleep(BEAT);
                let mut work = lock(&work);
                if work.is_over {
                    return;
                }
                if let Some(word) = work.word() {
                    drop(writeln!(io::stderr().lock(), "{word}"));
                    work.was_spoken_of();
                }
            }
        });
    }
}

impl Drop for Pulse {
    fn drop(&mut self) {
        self.update(|work| work.is_over = true);
    }
}

fn lock(work: &Mutex<Work>) -> MutexGuard<'_, Work> {
    work.lock().unwrap_or_else(PoisonError::into_inner)
}

/// `template`, or indicatif's own bar should it not understand it.
fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar())
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::{LONGEST_SILENCE, SILENCE, Work};

    #[test]
    fn a_word_is_due_after_two_seconds_and_then_ever_more_rarely() {
        let ago =
            |seconds| Instant::now().checked_sub(Duration::from_secs(seconds)).expect("a time");
        let mut work = Work { sensor: Some("top".to_owned()), ..Work::new("tracing") };
        assert_eq!(work.word(), None, "it has just begun");
        (work.since, work.spoken) = (ago(3), ago(3));
        assert_eq!(work.word().as_deref(), Some("top: first samples, 3 s so far"));
        work.done = 0.25;
        assert_eq!(work.word().as_deref(), Some("top: 25.0 % done after 3 s"));
        work.was_spoken_of();
        work.spoken = ago(3);
        assert_eq!((work.word(), work.silence), (None, 2 * SILENCE));
        (0..20).for_each(|_| work.was_spoken_of());
        assert_eq!(work.silence, LONGEST_SILENCE);
    }
}
