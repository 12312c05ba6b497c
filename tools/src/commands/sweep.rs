//! `sweep`: a scene at every point of its sweep, and one table.

use std::collections::BTreeSet;

use sunfleck::output::{DerivativeTable, PointTables, Results, SweepTable, Written};
use sunfleck::products::{Night, Report, SweepPoint};
use sunfleck::{output, run};

use super::run::run_options;
use super::{print, warn};
use crate::arguments::Run;
use crate::progress::Bars;

pub(super) fn sweep(arguments: &Run) -> anyhow::Result<()> {
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
