//! Runs of a scene: `run`, `merge`, `respectrum`.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::bail;
use serde_json::json;
use sunfleck::output::Results;
use sunfleck::products::Report;
use sunfleck::run::{Failure, Partition, SaveRule};
use sunfleck::scratch::ScratchSpace;
use sunfleck::{document, output, run};

use super::{NOTE, quoted, told};
use crate::arguments::{Merge, Out, Respectrum, Run, Scene, Trace};
use crate::console::{Console, forecast_event};

pub(super) fn trace(arguments: &Trace) -> anyhow::Result<()> {
    let share = arguments.part.unwrap_or(Partition::ALL);
    let folder = arguments.run.folder("");
    let keeps_coefficients = arguments.keep_coefficients;
    let forecast = arguments.forecast;
    let (file, saves) = match &arguments.checkpoint {
        Some(file) => (file.clone(), SaveRule::Every(arguments.every)),
        None => (checkpoint_beside(&folder), SaveRule::WhenCancelled),
    };
    let checkpoint =
        (!forecast && !keeps_coefficients).then_some(run::Checkpoint { file, saves, share });
    let options =
        run::Options { checkpoint, forecast, keeps_coefficients, ..run_options(&arguments.run) };
    let (scene, console) = (&arguments.run.scene, arguments.run.console);
    if forecast {
        return forecasts(scene, &options, console);
    }
    if share == Partition::ALL {
        return results(scene, &options, &arguments.run.out, &folder, console);
    }
    let report = report_of(scene, &options, console)?;
    console.warn(&report.warnings);
    let file = arguments.checkpoint.as_deref().unwrap_or(Path::new(""));
    console.event(&json!({ "event": "saved", "checkpoint": file, "seconds": report.seconds }));
    console.say(&format!(
        "{}: part {} of {}: {:.3} million rays in {:.1} s; `sunfleck merge` combines all parts\n",
        file.display(),
        share.index + 1,
        share.count,
        report.rays as f64 / 1e6,
        report.seconds
    ))
}

/// Checkpoint of a run that is cancelled: beside the folder of its results.
fn checkpoint_beside(folder: &Path) -> PathBuf {
    // `.` has no name of its own.
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let mut name = folder.file_name().unwrap_or("run".as_ref()).to_owned();
    name.push(".checkpoint");
    let place = folder.with_file_name(name);
    let here = std::env::current_dir().unwrap_or_default();
    place.strip_prefix(&here).map(Path::to_owned).unwrap_or(place)
}

/// Runs a scene and shows its progress.
fn report_of(scene: &Scene, options: &run::Options, console: Console) -> anyhow::Result<Report> {
    let observer = console.observer();
    let report = run::run_file(&scene.file, options, &observer);
    observer.clear();
    report.map_err(|failure| cancelled(failure, console))
}

/// Error of a run; if it was cancelled, with the command that resumes it.
fn cancelled(failure: Failure, console: Console) -> anyhow::Error {
    let Failure::Cancelled { sensor, done, saved } = &failure else { return failure.into() };
    let command = saved.as_ref().map(|file| resuming(std::env::args_os(), file));
    console.event(&json!({
        "event": "cancelled", "sensor": sensor, "done": done, "checkpoint": saved, "resume": command,
    }));
    match command {
        Some(command) => anyhow::anyhow!("{failure}; resume with\n  {command}"),
        None => anyhow::anyhow!("{failure}, and nothing could be kept"),
    }
}

/// Command line that resumes a run from a checkpoint.
fn resuming(arguments: impl Iterator<Item = OsString>, checkpoint: &Path) -> String {
    let mut arguments: Vec<String> =
        arguments.map(|argument| argument.to_string_lossy().into_owned()).collect();
    if let Some(program) = arguments.first_mut() {
        "sunfleck".clone_into(program);
    }
    if !arguments.iter().any(|argument| argument.starts_with("--checkpoint")) {
        arguments.extend(["--checkpoint".to_owned(), checkpoint.display().to_string()]);
    }
    arguments.iter().map(|argument| quoted(argument)).collect::<Vec<_>>().join(" ")
}

pub(super) fn respectrum(arguments: &Respectrum) -> anyhow::Result<()> {
    let found = &arguments.results;
    let coefficients = found.join(output::COEFFICIENTS);
    let origin = output::ResultsOrigin::read(found).filter(|_| coefficients.is_file());
    let Some(output::ResultsOrigin { scene, variant, set }) = origin else {
        bail!(
            "{} holds no coefficients: name the folder of the results of `sunfleck run SCENE --keep-coefficients`",
            found.display()
        )
    };
    let document = document::ReadOptions {
        set: set.into_iter().chain(arguments.settings.clone()).collect(),
        variant: arguments.variant.clone().or(variant),
        ..document::ReadOptions::default()
    };
    let options = run::Options { document, ..run::Options::default() };
    let folder = arguments.out();
    let results = Results::open(&folder, "respectrum", &scene, arguments.force)?;
    let observer = arguments.console.observer();
    let report = run::respectrum(&scene, &coefficients, &options, &observer);
    observer.clear();
    let report = report?;
    let work = format!("coefficients evaluated in {:.2} s, no ray traced", report.seconds);
    write_report(&results, &report, &work, arguments.console)
}

pub(super) fn merge(arguments: &Merge) -> anyhow::Result<()> {
    let options = run::Options {
        document: arguments.formats.options(&arguments.scene),
        quality: arguments.quality,
        unite: arguments.files.clone(),
        scratch: ScratchSpace::within(&arguments.folder()),
        ..run::Options::default()
    };
    let (folder, console) = (arguments.folder(), arguments.console);
    results(&arguments.scene, &options, &arguments.out, &folder, console)
}

/// Prints time, memory and file sizes of each sensor of a scene.
fn forecasts(scene: &Scene, options: &run::Options, console: Console) -> anyhow::Result<()> {
    let report = report_of(scene, options, console)?;
    console.warn(&report.warnings);
    let mut text = String::new();
    for sensor in &report.sensors {
        console.event(&forecast_event(&sensor.name, &sensor.forecast));
        writeln!(text, "{}: {}", sensor.name, sensor.forecast)?;
    }
    if let [_, _, ..] = &report.sensors[..] {
        let all = report.sensors.iter().map(|sensor| sensor.forecast);
        let all = all.reduce(|all, one| run::Forecast {
            seconds: all.seconds + one.seconds,
            memory: all.memory.max(one.memory),
            files: all.files + one.files,
        });
        all.iter().try_for_each(|all| writeln!(text, "all: {all}"))?;
    }
    console.say(&text)
}

/// Runs a scene and writes what its sensors measure.
fn results(
    scene: &Scene,
    options: &run::Options,
    into: &Out,
    folder: &Path,
    console: Console,
) -> anyhow::Result<()> {
    // Better now than after hours of tracing.
    let results = Results::open(folder, "run", &scene.file, into.force)?;
    let report = report_of(scene, options, console)?;
    let work = format!("{:.3} million rays in {:.1} s", report.rays as f64 / 1e6, report.seconds);
    write_report(&results, &report, &work, console)
}

/// Writes a report and prints its table and what was done for it.
pub(super) fn write_report(
    results: &Results,
    report: &Report,
    work: &str,
    console: Console,
) -> anyhow::Result<()> {
    console.warn(&report.warnings);
    let written = results.write(report)?;
    for note in &report.notes {
        console.event(&json!({ "event": "note", "text": note }));
    }
    console.written(&written);
    let mut text = output::table(report);
    report.notes.iter().try_for_each(|note| writeln!(text, "{NOTE}{note}"))?;
    writeln!(text, "\n{}: {work}", told(&written))?;
    console.say(&text)
}

/// Options of a run.
pub(super) fn run_options(arguments: &Run) -> run::Options {
    run::Options {
        document: arguments.formats.options(&arguments.scene),
        threads: arguments.threads.map(Into::into),
        quality: arguments.quality,
        memory: arguments.memory,
        // Beside the results: a folder for temporary files may be in memory.
        scratch: ScratchSpace::within(&arguments.folder("")),
        sensors: arguments.sensors.clone(),
        ..run::Options::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_that_resumes_a_run_is_one_that_a_shell_reads() {
        let line = ["/usr/bin/sunfleck", "run", "my scene.ron", "--set", "sza=60"];
        let arguments = || line.iter().map(OsString::from);
        let expected = "sunfleck run 'my scene.ron' --set sza=60 --checkpoint out/a.checkpoint";
        assert_eq!(resuming(arguments(), Path::new("out/a.checkpoint")), expected);
        let with_file = arguments().chain(["--checkpoint=c".into()]);
        let expected = "sunfleck run 'my scene.ron' --set sza=60 --checkpoint=c";
        assert_eq!(resuming(with_file, Path::new("c")), expected);
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
