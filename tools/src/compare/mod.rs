//! One world, measured by each transport system that can: values side by side, their differences in
//! standard errors, and what they cost.

mod curves;
pub(crate) mod findings;
mod picture;
pub(crate) mod plan;
pub(crate) mod tables;

use std::fmt::Write as _;

use anyhow::{Context as _, bail};
use sunfleck::run;

use self::findings::Finding;
use self::plan::Plan;
use crate::arguments::Compare;
use crate::commands::{self, warn};
use crate::progress::Bars;

/// Runs the scene, writes `compare.csv`, `compare_summary.csv`, `compare.svg` and `summary.json`; returns
/// the summary for a person.
pub(crate) fn compare(arguments: &Compare) -> anyhow::Result<String> {
    let measured = &arguments.measured;
    let results = measured.results("compare")?;
    let (systems, reference) = (measured.systems(), arguments.reference());
    if !systems.contains(&reference) {
        bail!("the reference `{}` is not among the systems: add it to --systems", reference.name());
    }
    let mut session = run::Session::read(&measured.scene.file, &measured.options())?;
    let plan = Plan::new(session.scene(), &measured.sensors, &systems)?;
    warn(&plan.warnings);
    let bars = Bars::new();
    let report = session.run(&plan.scene, 1.0, &bars);
    bars.clear();
    let report = report?;
    warn(&report.warnings);
    let findings = Finding::all(&plan, &report, reference);
    let files = [
        ("compare.csv", tables::values(&findings, &report, arguments.pixels)?),
        ("compare_summary.csv", tables::summary_csv(&findings)?),
        ("compare.svg", picture::draw(&findings, &report.scene)?),
    ];
    let written = results.write_texts(&report, &files)?;
    let mut text = tables::summary(&findings);
    writeln!(
        text,
        "\n{}: {:.3} million rays in {:.1} s",
        commands::told(&written),
        report.rays as f64 / 1e6,
        report.seconds
    )
    .context("cannot lay out the summary")?;
    Ok(text)
}
