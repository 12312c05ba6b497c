use std::fmt::Write as _;

use anyhow::Context as _;
use sunfleck::output::harmless;
use sunfleck::products::Report;
use sunfleck::run;

use super::curve::{Curve, Level, Repeat};
use super::picture;
use crate::arguments::ErrorBench;
use crate::columns::lay_out;
use crate::commands::{self, warn};
use crate::compare::findings::{Estimate, Finding, Values};
use crate::compare::plan::{Member, Plan};
use crate::compare::tables::{known, significant, text};
use crate::progress::Bars;

/// Number of samples of the reference estimate, relative to the longest run.
const TRUTH: f64 = 4.0;

/// Runs the scene with doubled numbers of samples, again and again; writes `bench.csv`,
/// `bench_fits.csv`, `bench.svg` and `summary.json`; returns a table as text.
pub(crate) fn error(arguments: &ErrorBench) -> anyhow::Result<String> {
    let measured = &arguments.measured;
    let results = measured.results("bench")?;
    let mut session = run::Session::read(&measured.scene.file, &measured.options())?;
    let plan = Plan::new(session.scene(), &measured.sensors, &measured.systems())?;
    warn(&plan.warnings);
    // The first run is the longest, and the machine warm after it.
    let truth = traced(&mut session, &plan, (0, TRUTH), "what the others are compared with")?;
    warn(&truth.warnings);
    let truths = Truth::all(&plan, &truth);
    let (mut curves, mut samples) = (Vec::new(), Vec::new());
    for truth in &truths {
        curves.extend(truth.curves(arguments.doublings));
    }
    for repeat in 1..=arguments.repeats {
        for level in 0..=arguments.doublings {
            let heading = format!(
                "repeat {repeat} of {}, {level} of {} doublings",
                arguments.repeats, arguments.doublings
            );
            let quality = quality(level, arguments.doublings);
            let number = repeat as usize * 100 + level as usize;
            let report = traced(&mut session, &plan, (number, quality), &heading)?;
            samples.push(report.sensors.iter().map(|sensor| sensor.samples).collect::<Vec<_>>());
            let findings = Finding::all(&plan, &report, plan.members[0].system);
            for (truth, curves) in truths.iter().zip(curves.chunk_by_mut(alike)) {
                truth.measure(&findings, curves, level as usize);
            }
        }
    }
    warn(&too_few(&plan, &samples, arguments.doublings));
    curves.retain(|curve| curve.levels.iter().all(|level| !level.repeats.is_empty()));
    let files = [
        ("bench.csv", levels(&curves, measured.quality)?),
        ("bench_fits.csv", fits(&curves)?),
        ("bench.svg", picture::draw(&curves, &truth.scene)?),
    ];
    let written = results.write_texts(&truth, &files)?;
    let mut text = summary(&curves);
    writeln!(text, "\n{}", commands::told(&written)).context("cannot lay out the summary")?;
    Ok(text)
}

/// Notes on sensors with too few samples for that many doublings; `samples` are those of each run, rising within
/// a repeat.
fn too_few(plan: &Plan, samples: &[Vec<u64>], doublings: u32) -> Vec<String> {
    let (Some(least), Some(most)) = (samples.first(), samples.get(doublings as usize)) else {
        return Vec::new();
    };
    let members = plan.members.iter().zip(least.iter().zip(most));
    let few = members.filter(|(_, (least, most))| **most < (*least << doublings) / 2);
    let text = |(member, (_, most)): (&Member, (&u64, &u64))| {
        let (sensor, system) = (&member.sensor, member.system.name());
        format!(
            "sensors.{sensor}: {most} samples of {system} cannot be halved {doublings} times; take a larger --quality"
        )
    };
    few.map(text).collect()
}

/// Factor on the number of samples.
fn quality(level: u32, doublings: u32) -> f64 {
    (f64::from(level) - f64::from(doublings)).exp2()
}

fn traced(
    session: &mut run::Session,
    plan: &Plan,
    (number, quality): (usize, f64),
    heading: &str,
) -> anyhow::Result<Report> {
    let bars = Bars::new();
    bars.heading(heading);
    let report = session.run(&plan.again(number), quality, &bars);
    bars.clear();
    Ok(report?)
}

/// Returns true if two curves are of the same product.
pub(super) fn alike(a: &Curve, b: &Curve) -> bool {
    (&a.sensor, &a.product) == (&b.sensor, &b.product)
}

/// Reference estimate of a product: the one with the smallest error among the longest runs.
struct Truth<'a> {
    finding: Finding<'a>,
    pixels: bool,
    values: Values,
}

impl<'a> Truth<'a> {
    /// Reference estimates of all products, and of the pixels of images.
    fn all(plan: &'a Plan, report: &'a Report) -> Vec<Self> {
        let mut truths = Vec::new();
        for pixels in [false, true] {
            for finding in Finding::all(plan, report, plan.members[0].system) {
                let variance = |values: &Values| -> f64 {
                    values.errors.iter().filter(|error| error.is_finite()).map(|e| e * e).sum()
                };
                let all = finding.estimates.iter().filter_map(|one| one.values(pixels));
                let best = all.min_by(|a, b| variance(a).total_cmp(&variance(b)));
                truths.extend(best.map(|values| Self { finding, pixels, values }));
            }
        }
        truths.sort_by(|a, b| {
            let place = |one: &Self| {
                plan.members.iter().position(|member| member.sensor == one.finding.sensor)
            };
            place(a).cmp(&place(b))
        });
        truths
    }

    fn product(&self) -> String {
        format!("{}{}", self.finding.product, if self.pixels { ", pixels" } else { "" })
    }

    /// An empty curve for each system.
    fn curves(&self, doublings: u32) -> impl Iterator<Item = Curve> {
        let level = move |level| Level { quality: quality(level, doublings), repeats: Vec::new() };
        self.finding.estimates.iter().map(move |estimate| Curve {
            sensor: self.finding.sensor.to_owned(),
            product: self.product(),
            system: estimate.system,
            levels: (0..=doublings).map(level).collect(),
        })
    }

    /// Takes a run in.
    fn measure(&self, findings: &[Finding<'_>], curves: &mut [Curve], level: usize) {
        let is_same = |finding: &&Finding<'_>| {
            (finding.sensor, finding.product) == (self.finding.sensor, self.finding.product)
        };
        let Some(finding) = findings.iter().find(is_same) else { return };
        for curve in curves {
            let found = |one: &&Estimate<'_>| one.system == curve.system;
            let estimate = finding.estimates.iter().find(found);
            let repeat = estimate.and_then(|estimate| {
                Repeat::new(estimate.seconds, &estimate.values(self.pixels)?, &self.values)
            });
            curve.levels[level].repeats.extend(repeat);
        }
    }
}

/// A row for each number of samples.
fn levels(curves: &[Curve], quality: f64) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "sensor",
        "product",
        "system",
        "quality",
        "seconds",
        "reported_relative_error",
        "actual_relative_error",
        "median_relative_error",
    ])?;
    for curve in curves {
        for level in &curve.levels {
            writer.write_record([
                &harmless(&curve.sensor),
                &harmless(&curve.product),
                curve.system.name(),
                &known(quality * level.quality),
                &known(level.seconds()),
                &known(level.reported()),
                &known(level.actual()),
                &known(level.median()),
            ])?;
        }
    }
    text(writer)
}

/// A row for each product and system.
fn fits(curves: &[Curve]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "sensor",
        "product",
        "system",
        "slope",
        "slope_error",
        "seconds_to_1_percent",
        "seconds_to_0.1_percent",
        "actual_over_reported",
    ])?;
    for curve in curves {
        let fit = curve.fit();
        let cell = |value: Option<f64>| value.map_or_else(String::new, known);
        writer.write_record([
            &curve.sensor,
            &curve.product,
            curve.system.name(),
            &cell(fit.map(|fit| fit.slope)),
            &cell(fit.map(|fit| fit.slope_error)),
            &cell(fit.and_then(|fit| fit.seconds(0.01))),
            &cell(fit.and_then(|fit| fit.seconds(0.001))),
            &known(curve.calibration()),
        ])?;
    }
    text(writer)
}

fn summary(curves: &[Curve]) -> String {
    let titles = [
        "sensor",
        "product",
        "system",
        "seconds",
        "rel. error",
        "actual/reported",
        "slope",
        "to 1 %",
        "to 0.1 %",
    ];
    let mut rows = vec![titles.map(str::to_owned).to_vec()];
    for (index, curve) in curves.iter().enumerate() {
        let fit = curve.fit();
        let seconds =
            |error: f64| fit.and_then(|fit| fit.seconds(error)).map_or_else(String::new, duration);
        let before = index.checked_sub(1).map(|before| &curves[before]);
        let is_new = |same: bool, name: &String| if same { String::new() } else { name.clone() };
        let same_sensor = before.is_some_and(|before| before.sensor == curve.sensor);
        let Some(last) = curve.levels.last() else { continue };
        rows.push(vec![
            is_new(same_sensor, &curve.sensor),
            is_new(before.is_some_and(|before| alike(before, curve)), &curve.product),
            curve.system.name().to_owned(),
            significant(last.seconds(), 3),
            match last.reported() {
                error if fit.is_none() && error < 1e-6 => "exact".to_owned(),
                error => format!("{} %", significant(100.0 * error, 2)),
            },
            fit.map_or_else(String::new, |_| format!("{:.2}", curve.calibration())),
            fit.map_or_else(String::new, |fit| {
                format!("{:.2} ± {:.2}", fit.slope, fit.slope_error)
            }),
            seconds(0.01),
            seconds(0.001),
        ]);
    }
    lay_out(&rows, &[true, true, true, false, false, false, false, false, false])
}

/// Seconds as people say them.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", significant(s, 2)),
        s if s < 7200.0 => format!("{} min", significant(s / 60.0, 2)),
        s if s < 172_800.0 => format!("{} h", significant(s / 3600.0, 2)),
        s => format!("{} d", significant(s / 86_400.0, 2)),
    }
}
