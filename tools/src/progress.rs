//! Progress bars on a terminal; in a pipe, forecasts of long runs and, after two seconds without a word, a
//! line that says what is being done.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{MultiProgress, ProgressBar, ProgressDrawTarget, ProgressStyle};
use sunfleck::run::{Forecast, Progress, SensorProgress};

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

    fn sensor(&self, state: &SensorProgress<'_>) {
        let &SensorProgress { name, done, .. } = state;
        self.pulse.update(|work| {
            if work.sensor.as_deref() != Some(name) {
                *work = Work { sensor: Some(name.to_owned()), ..Work::new(&work.stage) };
            }
            work.done = done;
            work.beside = beside(state);
        });
        let mut sensors = self.sensors.lock().unwrap_or_else(PoisonError::into_inner);
        let known = sensors.iter().position(|(known, _)| known == name);
        let index = known.unwrap_or_else(|| {
            let bar = self.all.add(ProgressBar::new(STEPS));
            bar.set_style(style("  {prefix:20!} {wide_bar} {percent:>3} %  {msg:40}"));
            bar.set_prefix(name.to_owned());
            sensors.push((name.to_owned(), bar));
            sensors.len() - 1
        });
        let bar = &sensors[index].1;
        bar.set_position((done.clamp(0.0, 1.0) * STEPS as f64) as u64);
        bar.set_message(beside(state));
        if done >= 1.0 {
            bar.set_message(format!("{} {}", duration(bar.elapsed().as_secs_f64()), beside(state)));
            bar.abandon();
        }
    }

    fn shows_errors(&self) -> bool {
        !self.all.is_hidden()
    }
}

/// Text beside a bar: time left, rate and error so far, as far as they are known.
fn beside(state: &SensorProgress<'_>) -> String {
    let left = state.seconds_left.filter(|_| state.done < 1.0);
    let left = left.map(|left| format!("{} left", duration(left)));
    let rate = state.rays_per_second.map(|rate| format!("{:.1} M rays/s", rate / 1e6));
    let error = state.relative_error.map(|error| format!("error {}", percent(error)));
    [left, rate, error].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Duration with a unit: `8 s`, `3 min 20 s`, `2 h 5 min`.
fn duration(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        3600..172_800 => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
        _ => format!("{} days", whole / 86_400),
    }
}

/// Fraction in percent with two digits that count.
fn percent(fraction: f64) -> String {
    let percent = 100.0 * fraction;
    match percent {
        10.0.. => format!("{percent:.0} %"),
        1.0..10.0 => format!("{percent:.1} %"),
        _ => format!("{percent:.2} %"),
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
    /// Time left, rate and error of the sensor.
    beside: String,
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
            beside: String::new(),
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
        let Self { stage, sensor, done, beside, since, .. } = self;
        if self.spoken.elapsed() < self.silence || stage.is_empty() {
            return None;
        }
        let seconds = since.elapsed().as_secs();
        Some(match sensor {
            None => format!("{stage}: {seconds} s so far"),
            Some(sensor) if *done > 0.0 => {
                let separator = if beside.is_empty() { "" } else { ", " };
                let done = 100.0 * done;
                format!("{sensor}: {done:.1} % done after {seconds} s{separator}{beside}")
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

    use sunfleck::run::SensorProgress;

    use super::{LONGEST_SILENCE, SILENCE, Work, beside};

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
        work.beside = beside(&SensorProgress {
            name: "top",
            done: 0.25,
            seconds_left: Some(3725.0),
            rays_per_second: Some(3.94e6),
            relative_error: Some(0.0123),
        });
        let text = "top: 25.0 % done after 3 s, 1 h 2 min left, 3.9 M rays/s, error 1.2 %";
        assert_eq!(work.word().as_deref(), Some(text));
        work.was_spoken_of();
        work.spoken = ago(3);
        assert_eq!((work.word(), work.silence), (None, 2 * SILENCE));
        (0..20).for_each(|_| work.was_spoken_of());
        assert_eq!(work.silence, LONGEST_SILENCE);
    }
}
