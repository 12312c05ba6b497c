use std::fmt::Write as _;

use anyhow::Context as _;
use sunfleck::output::{AxisColumns, harmless, number};
use sunfleck::products::Report;

use super::findings::{Finding, Statistics};
use crate::columns::lay_out;

/// Every value of every system: one row each, with a column an axis. Values of pixels have a row and a
/// column of their image, its mean has none.
pub(super) fn values(
    findings: &[Finding<'_>],
    report: &Report,
    pixels: bool,
) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let products = findings.iter().flat_map(|finding| &finding.estimates).map(|one| one.product);
    let axes = AxisColumns::new(products, report);
    let before = ["sensor", "product", "unit"].into_iter();
    let after =
        ["row", "column", "band", "system", "value", "standard_error", "z", "seconds", "rays"];
    let header = before.chain(axes.names()).chain(after).chain(["efficiency_per_s"]);
    writer.write_record(header.map(harmless))?;
    let sets: &[bool] = if pixels { &[false, true] } else { &[false] };
    for finding in findings {
        for (index, estimate) in finding.estimates.iter().enumerate() {
            let cells = axes.cells(estimate.product);
            for &pixels in sets {
                let Some(all) = estimate.values(pixels) else { continue };
                let scores = finding.scores(index, pixels);
                for (row, (value, error)) in all.values.iter().zip(&all.errors).enumerate() {
                    let place = estimate.place(row, pixels, &cells);
                    let z = scores.as_ref().map(|scores| scores[row]);
                    let efficiency = (value / error).powi(2) / estimate.seconds;
                    let named = [finding.sensor, finding.product, finding.unit].map(harmless);
                    let cells = place.cells.iter().map(|cell| harmless(cell));
                    let measured = [
                        harmless(&place.band),
                        estimate.system.name().to_owned(),
                        number(*value),
                        number(*error),
                        z.map_or_else(String::new, known),
                        number(estimate.seconds),
                        estimate.rays.to_string(),
                        known(efficiency),
                    ];
                    writer.write_record(named.into_iter().chain(cells).chain(measured))?;
                }
            }
        }
    }
    text(writer)
}

const SUMMARY: [&str; 12] = [
    "sensor",
    "product",
    "system",
    "values",
    "mean",
    "median rel. error",
    "rms z",
    "max |z|",
    "|z| > 3",
    "seconds",
    "efficiency /s",
    "remark",
];

/// Statistics over the values of a product, or the pixels of an image, with one row per system.
fn rows(findings: &[Finding<'_>], cell: impl Fn(Kind, f64) -> String) -> Vec<Vec<String>> {
    let mut rows = vec![SUMMARY.map(str::to_owned).to_vec()];
    for finding in findings {
        for pixels in [false, true] {
            for (index, estimate) in finding.estimates.iter().enumerate() {
                let Some(statistics) = finding.statistics(index, pixels) else { continue };
                let Statistics { values, mean, relative_error, efficiency, z } = statistics;
                let of_z = |kind, of: fn(&super::findings::Scores) -> f64| {
                    z.as_ref()
                        .filter(|z| z.count > 0)
                        .map_or_else(String::new, |z| cell(kind, of(z)))
                };
                let remark = match (finding.estimates.len(), index == finding.reference) {
                    (1, _) => "no other system measures it".to_owned(),
                    (_, true) => "reference".to_owned(),
                    _ => match z.map_or(0, |z| z.uncounted) {
                        0 => String::new(),
                        count => format!("{count} without a count, not in z"),
                    },
                };
                let what = if pixels { ", pixels" } else { "" };
                rows.push(vec![
                    finding.sensor.to_owned(),
                    format!("{}{what}", finding.product),
                    estimate.system.name().to_owned(),
                    values.to_string(),
                    cell(Kind::Value, mean),
                    cell(Kind::Share, relative_error),
                    of_z(Kind::Score, |z| z.rms),
                    of_z(Kind::Score, |z| z.largest),
                    of_z(Kind::Share, |z| z.beyond_3),
                    cell(Kind::Seconds, estimate.seconds),
                    cell(Kind::Value, efficiency),
                    remark,
                ]);
            }
        }
    }
    rows
}

/// Format of a number.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Value,
    Share,
    Score,
    Seconds,
}

/// The summary as a file.
pub(super) fn summary_csv(findings: &[Finding<'_>]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows(findings, |_, value| known(value)) {
        writer.write_record(row.iter().map(|cell| harmless(cell)))?;
    }
    text(writer)
}

/// The summary for a person.
pub(super) fn summary(findings: &[Finding<'_>]) -> String {
    let mut rows = rows(findings, |kind, value| match kind {
        _ if value.is_nan() => String::new(),
        _ if value.is_infinite() => "exact".to_owned(),
        Kind::Value => significant(value, 5),
        Kind::Share => format!("{} %", significant(100.0 * value, 2)),
        Kind::Score | Kind::Seconds => format!("{value:.2}"),
    });
    // What is the same as in the line above need not be read twice.
    for index in (2..rows.len()).rev() {
        for column in [1, 0] {
            if rows[index][..=column] == rows[index - 1][..=column] {
                rows[index][column].clear();
            }
        }
    }
    lay_out(
        &rows,
        &[true, true, true, false, false, false, false, false, false, false, false, true],
    )
}

/// A number with so many significant digits, as people write it.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor() as i32;
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _infallible = if (-4..6).contains(&exponent) {
        let decimals = usize::try_from(digits - 1 - exponent).unwrap_or(0);
        write!(text, "{value:.decimals$}")
    } else {
        let decimals = usize::try_from(digits - 1).unwrap_or(0);
        write!(text, "{value:.decimals$e}")
    };
    text
}

/// A number in a file; nothing where it is unknown.
pub(crate) fn known(value: f64) -> String {
    if value.is_finite() { number(value) } else { String::new() }
}

/// Files that were written.
pub(crate) fn text(writer: csv::Writer<Vec<u8>>) -> anyhow::Result<String> {
    let bytes = writer.into_inner().context("cannot lay out a table")?;
    String::from_utf8(bytes).context("cannot lay out a table")
}
