//! `sweep`: a scene at every point of its sweep, and one table.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::json;
use sunfleck::counts::counted;
use sunfleck::output::{DerivativeTable, PointTables, PointWarnings, Results, SweepTable, Written};
use sunfleck::products::{Night, Report, SweepPoint};
use sunfleck::{output, run};

use super::run::run_options;
use crate::arguments::Run;
use crate::console::Console;

pub(super) fn sweep(arguments: &Run) -> anyhow::Result<()> {
    let folder = arguments.folder("_sweep");
    let (scene, console) = (&arguments.scene.file, arguments.console);
    let results = Results::open(&folder, "sweep", scene, arguments.out.force)?;
    let observer = console.observer();
    let sweep = run::SweepRun::read(scene, &run_options(arguments), &observer);
    observer.clear();
    let mut sweep = sweep?;
    let points = sweep.points().to_vec();
    let tables = PointTables::open(&folder, &points)?;
    let mut done = Done { tables, console, shown: BTreeSet::new(), ran: 0, dark: 0 };
    for (group, places) in sweep.groups().to_vec().into_iter().enumerate() {
        let of_group: Vec<SweepPoint> = places.iter().map(|&place| points[place].clone()).collect();
        let heading = heading(places[0], &of_group, points.len());
        let run = done.run_group(&mut sweep, group, &of_group, &heading, &results);
        run.map_err(|error| cancelled(error, &folder, console))?;
    }
    let Done { tables, ran, dark, .. } = done;
    let distinct: usize = sweep.groups().iter().map(Vec::len).sum();
    let table = SweepTable::new(&points, &tables)?;
    let daily = output::daily_sums(&sweep.days(), &points, &tables)?;
    let derivatives = DerivativeTable::new(sweep.differences(), &points, &tables)?;
    let (daily, of) = (daily.as_ref(), derivatives.as_ref());
    let report = Report { warnings: tables.warnings(&points)?, ..sweep.report() };
    let written = results.write_sweep(&report, &points, &table, daily, of)?;
    let derivatives = derivatives.map(|table| derivatives_text(&table, &written));
    console.written(&written);
    console.say(&format!(
        "{}: {} run, {}{} kept; geometry built {}\n{}",
        written.folder.join("sweep.csv").display(),
        counted(ran, "point"),
        if dark > 0 { format!("{dark} without light, ") } else { String::new() },
        distinct - ran - dark,
        match sweep.builds() {
            1 => "once".to_owned(),
            builds => format!("{builds} times"),
        },
        derivatives.unwrap_or_default()
    ))
}

/// Tables of the points that are done, and what was said about them.
struct Done {
    tables: PointTables,
    console: Console,
    /// Warnings that were shown.
    shown: BTreeSet<String>,
    /// Number of points that were run.
    ran: usize,
    /// Number of points without light.
    dark: usize,
}

impl Done {
    /// Runs those points of a group that have no table yet, and writes their tables.
    fn run_group(
        &mut self,
        sweep: &mut run::SweepRun,
        group: usize,
        points: &[SweepPoint],
        heading: &str,
        results: &Results,
    ) -> anyhow::Result<()> {
        let finished: Vec<bool> = points.iter().map(|point| self.tables.contains(point)).collect();
        if !finished.contains(&false) {
            return Ok(());
        }
        for point in points {
            warn_night(point, self.console);
        }
        let observer = self.console.observer();
        observer.heading(heading);
        let report = sweep.report();
        sweep.run(group, &observer, |part, reports| -> anyhow::Result<()> {
            let (points, finished) = (&points[part.clone()], &finished[part]);
            let unfinished: Vec<usize> =
                (0..points.len()).filter(|&index| !finished[index]).collect();
            observer.clear();
            self.warn_once(&reports, points);
            if self.ran + self.dark == 0 {
                // From now on the folder says which scene its points are of.
                results.write_texts(&report, &[])?;
            }
            self.tables.write(&reports, points, &unfinished)?;
            let of_night = unfinished.iter().filter(|&&index| points[index].darkness().is_some());
            let of_night = of_night.count();
            self.ran += unfinished.len() - of_night;
            self.dark += of_night;
            Ok(())
        })?;
        observer.clear();
        Ok(())
    }

    /// Shows the warnings of points that no point before them had; those about nights have been shown.
    fn warn_once(&mut self, reports: &[Report], points: &[SweepPoint]) {
        let mut warnings = PointWarnings::default();
        for (report, point) in reports.iter().zip(points) {
            let is_of_night =
                |text: &&String| point.night.as_ref().is_some_and(|night| night.text() == *text);
            for text in report.warnings.iter().filter(|text| !is_of_night(text)) {
                warnings.add(point, text.clone());
            }
        }
        warnings.retain(|text| self.shown.insert(text.to_owned()));
        self.console.warn(&warnings.texts().collect::<Vec<_>>());
    }
}

/// Error of a sweep; if it was cancelled, with what is kept.
fn cancelled(error: anyhow::Error, folder: &Path, console: Console) -> anyhow::Error {
    if !error.downcast_ref::<run::Failure>().is_some_and(run::Failure::is_cancelled) {
        return error;
    }
    console.event(&json!({ "event": "cancelled", "folder": folder }));
    anyhow::anyhow!(
        "{error}; the points before it are kept in {}, and the same command goes on from there",
        folder.display()
    )
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
    format!("{}: {}{without}\n", file.display(), counted(table.len(), "derivative"))
}

/// Heading of the bars of a group of points, the first of which has this place among all.
fn heading(first: usize, group: &[SweepPoint], all: usize) -> String {
    match group {
        [point] => format!("point {} of {all}: {}", first + 1, point.name()),
        _ => format!("{} points of {all}, on the same paths", group.len()),
    }
}

/// Says what a sun below the horizon means at a point of a sweep.
fn warn_night(point: &SweepPoint, console: Console) {
    match &point.night {
        Some(Night::Dark(why)) => {
            console.warn(&[format!("at {}: nothing is traced: {why}", point.name())]);
        }
        Some(Night::WithoutSun(what)) => console.warn(&[format!("at {}: {what}", point.name())]),
        None => {}
    }
}
