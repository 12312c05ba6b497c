//! Runs of a scene: `run`, `merge`, `respectrum`.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::bail;
use sunfleck::output::Results;
use sunfleck::products::Report;
use sunfleck::run::Partition;
use sunfleck::scratch::ScratchSpace;
use sunfleck::{document, output, run};

use super::{NOTE, print, told, warn};
use crate::arguments::{Merge, Out, Respectrum, Run, Scene, Trace};
use crate::progress::Bars;

pub(super) fn trace(arguments: &Trace) -> anyhow::Result<()> {
    let share = arguments.part.unwrap_or(Partition::ALL);
    let checkpoint = arguments.checkpoint.as_ref().map(|file| run::Checkpoint {
        file: file.clone(),
        every: arguments.every,
        share,
    });
    let forecast = arguments.forecast;
    let keeps_coefficients = arguments.keep_coefficients;
    let options =
        run::Options { checkpoint, forecast, keeps_coefficients, ..run_options(&arguments.run) };
    let scene = &arguments.run.scene;
    if forecast {
        return forecasts(scene, &options);
    }
    if share == Partition::ALL {
        return results(scene, &options, &arguments.run.out, &arguments.run.folder(""));
    }
    let bars = Bars::new();
    let report = run::run_file(&scene.file, &options, &bars);
    bars.clear();
    let report = report?;
    warn(&report.warnings);
    let file = arguments.checkpoint.as_deref().unwrap_or(Path::new(""));
    print(&format!(
        "{}: part {} of {}: {:.3} million rays in {:.1} s; `sunfleck merge` combines all parts\n",
        file.display(),
        share.index + 1,
        share.count,
        report.rays as f64 / 1e6,
        report.seconds
    ))
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
    let bars = Bars::new();
    let report = run::respectrum(&scene, &coefficients, &options, &bars);
    bars.clear();
    let report = report?;
    let work = format!("coefficients evaluated in {:.2} s, no ray traced", report.seconds);
    write_report(&results, &report, &work)
}

pub(super) fn merge(arguments: &Merge) -> anyhow::Result<()> {
    let options = run::Options {
        document: arguments.formats.options(&arguments.scene),
        quality: arguments.quality,
        unite: arguments.files.clone(),
        scratch: ScratchSpace::within(&arguments.folder()),
        ..run::Options::default()
    };
    results(&arguments.scene, &options, &arguments.out, &arguments.folder())
}

/// Prints time, memory and file sizes of each sensor of a scene.
fn forecasts(scene: &Scene, options: &run::Options) -> anyhow::Result<()> {
    let bars = Bars::new();
    let report = run::run_file(&scene.file, options, &bars);
    bars.clear();
    let report = report?;
    warn(&report.warnings);
    let mut text = String::new();
    for sensor in &report.sensors {
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
    print(&text)
}

/// Runs a scene and writes what its sensors measure.
fn results(scene: &Scene, options: &run::Options, into: &Out, folder: &Path) -> anyhow::Result<()> {
    // Better now than after hours of tracing.
    let results = Results::open(folder, "run", &scene.file, into.force)?;
    let bars = Bars::new();
    let report = run::run_file(&scene.file, options, &bars);
    bars.clear();
    let report = report?;
    let work = format!("{:.3} million rays in {:.1} s", report.rays as f64 / 1e6, report.seconds);
    write_report(&results, &report, &work)
}

/// Writes a report and prints its table and what was done for it.
fn write_report(results: &Results, report: &Report, work: &str) -> anyhow::Result<()> {
    warn(&report.warnings);
    let written = results.write(report)?;
    let mut text = output::table(report);
    report.notes.iter().try_for_each(|note| writeln!(text, "{NOTE}{note}"))?;
    writeln!(text, "\n{}: {work}", told(&written))?;
    print(&text)
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
