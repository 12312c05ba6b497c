//! Execution of the commands.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;

use anyhow::{Context as _, bail};
use sunfleck::output::{DerivativeTable, PointTables, Results, SweepTable, Written};
use sunfleck::products::{Night, Report, SweepPoint};
use sunfleck::run::Partition;
use sunfleck::scratch::ScratchSpace;
use sunfleck::{document, output, run};

use crate::arguments::{
    Bench, Check, Command, Fmt, Keys, Merge, OtherBench, Out, Respectrum, Run, Scene, Trace, Verify,
};
use crate::progress::Bars;
use crate::{bench, compare, describe, import_less, verify};

/// Heading of what a scene defines and does not use.
const SKIPPED: &str = "skipped: ";

/// Heading of a value that was assumed without a key in the scene.
const NOTE: &str = "note: ";

/// Runs a command.
pub(crate) fn execute(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Run(arguments) => trace(arguments),
        Command::Respectrum(arguments) => respectrum(arguments),
        Command::Merge(arguments) => merge(arguments),
        Command::Sweep(arguments) => sweep(arguments),
        Command::Compare(arguments) => print(&compare::compare(arguments)?),
        Command::Check(arguments) => check(arguments),
        Command::Expand(scene) => expand(scene),
        Command::Fmt(arguments) => fmt(arguments),
        Command::Schema => print(&document::json_schema()),
        Command::Keys(Keys { name: None }) => print(&document::keys_page()),
        Command::Keys(Keys { name: Some(name) }) => match document::keys_about(name) {
            Ok(text) => print(&text),
            Err(error) => bail!(error),
        },
        Command::ImportLess(arguments) => {
            print(&import_less::import(&arguments.folder, &arguments.out())?)
        }
        Command::Verify(arguments) => verify(arguments),
        Command::Bench(Bench { other: Some(OtherBench::Rays(arguments)), .. }) => {
            print(&bench::rays(arguments)?)
        }
        Command::Bench(Bench { error, .. }) => match error {
            Some(arguments) => print(&bench::error(arguments)?),
            None => bail!("name a scene: sunfleck bench SCENE"),
        },
    }
}

/// Message of a command that failed.
pub(crate) fn message(error: &anyhow::Error) -> String {
    let mut text = error.to_string();
    for cause in error.chain().skip(1) {
        // Some errors name their cause themselves.
        let cause = cause.to_string();
        if !text.ends_with(cause.strip_prefix("error: ").unwrap_or(&cause)) {
            text = format!("{text}: {cause}");
        }
    }
    // The engine shows each diagnostic with its own heading and excerpt.
    let headed = ["error: ", "warning: "].iter().any(|heading| text.starts_with(heading));
    if headed { text.trim_end().to_owned() } else { format!("error: {text}") }
}

fn trace(arguments: &Trace) -> anyhow::Result<()> {
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

fn respectrum(arguments: &Respectrum) -> anyhow::Result<()> {
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

fn merge(arguments: &Merge) -> anyhow::Result<()> {
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

/// Text about files that were written: their number, their folder, and the results that they replace.
pub(crate) fn told(written: &Written) -> String {
    let replaced = written.replaced.as_ref().map_or_else(String::new, |old| format!(" ({old})"));
    format!("{} files in {}{replaced}", written.files.len(), written.folder.display())
}

fn sweep(arguments: &Run) -> anyhow::Result<()> {
    let folder = arguments.folder("_sweep");
    let scene = &arguments.scene.file;
    let results = Results::open(&folder, "sweep", scene, arguments.out.force)?;
    let bars = Bars::new();
    let sweep = run::SweepRun::read(scene, &run_options(arguments), &bars);
    bars.clear();
    let mut sweep = sweep?;
    let (points, sweep_report) = (sweep.points().to_vec(), sweep.report());
    let mut tables = PointTables::open(&folder, &points)?;
    let distinct: usize = sweep.groups().iter().map(Vec::len).sum();
    let (mut shown, mut ran, mut dark) = (BTreeSet::new(), 0, 0);
    let mut is_first = true;
    for (group, places) in sweep.groups().to_vec().into_iter().enumerate() {
        let of_group: Vec<SweepPoint> = places.iter().map(|&place| points[place].clone()).collect();
        let finished: Vec<bool> = of_group.iter().map(|point| tables.contains(point)).collect();
        if !finished.contains(&false) {
            continue;
        }
        of_group.iter().for_each(warn_night);
        let bars = Bars::new();
        bars.heading(&heading(places[0], &of_group, points.len()));
        sweep.run(group, &bars, |part, reports| -> anyhow::Result<()> {
            let (group, finished) = (&of_group[part.clone()], &finished[part]);
            let unfinished: Vec<usize> =
                (0..group.len()).filter(|&index| !finished[index]).collect();
            bars.clear();
            for (report, point) in reports.iter().zip(group) {
                warn_once(report, point, &mut shown);
            }
            if is_first {
                // From now on the folder says which scene its points are of.
                results.write_texts(&sweep_report, &[])?;
            }
            is_first = false;
            tables.write(&reports, group, &unfinished)?;
            let of_night = unfinished.iter().filter(|&&index| group[index].darkness().is_some());
            let of_night = of_night.count();
            (ran, dark) = (ran + unfinished.len() - of_night, dark + of_night);
            Ok(())
        })?;
        bars.clear();
    }
    let table = SweepTable::new(&points, &tables)?;
    let daily = output::daily_sums(&sweep.days(), &points, &tables)?;
    let derivatives = DerivativeTable::new(sweep.differences(), &points, &tables)?;
    let (daily, of) = (daily.as_ref(), derivatives.as_ref());
    let written = results.write_sweep(&sweep.report(), &points, &table, daily, of)?;
    let derivatives = derivatives.map(|table| derivatives_text(&table, &written));
    print(&format!(
        "{}: {ran} {} run, {}{} kept; geometry built {}\n{}",
        written.folder.join("sweep.csv").display(),
        if ran == 1 { "point" } else { "points" },
        if dark > 0 { format!("{dark} without light, ") } else { String::new() },
        distinct - ran - dark,
        match sweep.builds() {
            1 => "once".to_owned(),
            builds => format!("{builds} times"),
        },
        derivatives.unwrap_or_default()
    ))
}

/// Text about derivatives that were written.
fn derivatives_text(table: &DerivativeTable, written: &Written) -> String {
    let file = written.folder.join(output::DERIVATIVES);
    let left_out: Vec<&str> = table.left_out().collect();
    let without = match &left_out[..] {
        [] => String::new(),
        names => {
            format!("; {} have none: they are not linear in what is counted", names.join(", "))
        }
    };
    format!("{}: {} derivatives{without}\n", file.display(), table.len())
}

/// Heading of the bars of a group of points, the first of which has this place among all.
fn heading(first: usize, group: &[SweepPoint], all: usize) -> String {
    match group {
        [point] => format!("point {} of {all}: {}", first + 1, point.name()),
        _ => format!("{} points of {all}, on the same paths", group.len()),
    }
}

/// Shows the warnings of a point that no point before it had; the one about its night has been shown.
fn warn_once(report: &Report, point: &SweepPoint, shown: &mut BTreeSet<String>) {
    let is_of_night =
        |text: &String| point.night.as_ref().is_some_and(|night| night.text() == text);
    for text in report.warnings.iter().filter(|text| !is_of_night(text)) {
        if shown.insert(text.clone()) {
            warn(&[format!("at {}: {text}", point.name())]);
        }
    }
}

/// Says what a sun below the horizon means at a point of a sweep.
fn warn_night(point: &SweepPoint) {
    match &point.night {
        Some(Night::Dark(why)) => warn(&[format!("at {}: nothing is traced: {why}", point.name())]),
        Some(Night::WithoutSun(what)) => warn(&[format!("at {}: {what}", point.name())]),
        None => {}
    }
}

fn run_options(arguments: &Run) -> run::Options {
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

fn check(arguments: &Check) -> anyhow::Result<()> {
    let scene = &arguments.scene;
    let options = run::Options { document: scene.options(), ..run::Options::default() };
    let bars = Bars::new();
    let checked = run::describe_file(&scene.file, &options, &bars);
    bars.clear();
    let run::Checked { warnings, facts } = checked?;
    if arguments.json {
        return print(&describe::json(facts.as_ref(), &warnings)?);
    }
    let (notes, warnings): (Vec<String>, Vec<String>) =
        warnings.into_iter().partition(|text| text.starts_with(NOTE));
    warn(&warnings);
    let found = match warnings.iter().filter(|text| !text.starts_with(SKIPPED)).count() {
        0 => "no errors".to_owned(),
        1 => "no errors, 1 warning".to_owned(),
        n => format!("no errors, {n} warnings"),
    };
    let facts = facts.as_ref().map(describe::text).unwrap_or_default();
    let notes = notes.iter().flat_map(|note| [note.as_str(), "\n"]).collect::<String>();
    print(&format!("{facts}{notes}{}: {found}\n", scene.file.display()))
}

fn expand(scene: &Scene) -> anyhow::Result<()> {
    let reading = document::read_file(&scene.file, &scene.options())?;
    if !reading.is_sound() {
        bail!(reading.render());
    }
    print(&reading.expanded())
}

fn fmt(arguments: &Fmt) -> anyhow::Result<()> {
    let mut changed = String::new();
    for file in &arguments.files {
        let (text, formatted) = document::format_file(file)?;
        if text == formatted {
            continue;
        }
        writeln!(changed, "{}", file.display())?;
        if !arguments.check {
            output::replace(file, &formatted)?;
        }
    }
    print(&changed)?;
    if arguments.check && !changed.is_empty() {
        bail!("not formatted: run `sunfleck fmt` on these files");
    }
    Ok(())
}

fn verify(arguments: &Verify) -> anyhow::Result<()> {
    if !verify::verify(&arguments.only, arguments.json, print)? {
        bail!("this program gives wrong results on this machine: see the checks that failed");
    }
    Ok(())
}

pub(crate) fn warn(warnings: &[String]) {
    let mut stderr = io::stderr().lock();
    for warning in warnings {
        let headed = ["warning: ", SKIPPED].iter().any(|heading| warning.starts_with(heading));
        let heading = if headed { "" } else { "warning: " };
        // A warning that cannot be shown is no reason to lose the results.
        drop(writeln!(stderr, "{heading}{}", warning.trim_end()));
    }
}

/// Prints `text`; a reader that has gone away (`| head`) has seen enough.
fn print(text: &str) -> anyhow::Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(error).context("cannot print the results")
        }
        _ => Ok(()),
    }
}
