use std::ops::Range;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sunfleck::document::System;

use super::curves::Curves;
use super::findings::Finding;
use crate::plot::{
    FAINT, INK, PlotArea, SHADE, axis_title, colour, heading, letters, placed, range_of, tick,
    upwards,
};

/// Size of the picture, px: the heading, and a row for each finding.
const WIDTH: u32 = 1120;
const HEADING: u32 = 66;
const ROW: u32 = 270;

/// Width of the panel of values, and of the room for names of curves beside it.
const VALUES: u32 = 690;
const NAMES: u32 = 130;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A row for each finding of several systems: on the left the values with their standard errors, on the
/// right the differences to the reference in standard errors. What one system alone measures is named
/// below, or drawn if there is nothing else.
pub(super) fn draw(findings: &[Finding<'_>], title: &str) -> anyhow::Result<String> {
    let (mut drawn, mut single): (Vec<_>, Vec<_>) =
        findings.iter().partition(|finding| finding.estimates.len() > 1);
    if drawn.is_empty() {
        (drawn, single) = (single, drawn);
    }
    let alone: Vec<String> =
        single.iter().map(|one| format!("{}: {}", one.sensor, one.product)).collect();
    let alone = lines(&alone);
    let foot = if alone.is_empty() { 0 } else { 34 + LINE * alone.len() as u32 };
    let body = ROW * drawn.len() as u32;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, HEADING + body + foot));
        let root = root.into_drawing_area();
        root.fill(&WHITE)?;
        let (top, rest) = root.split_vertically(HEADING);
        let (rows, bottom) = rest.split_vertically(body);
        let mut systems: Vec<System> = Vec::new();
        for estimate in drawn.iter().flat_map(|finding| &finding.estimates) {
            if !systems.contains(&estimate.system) {
                systems.push(estimate.system);
            }
        }
        let title = if title.is_empty() { "Transport systems compared" } else { title };
        heading(&top, title, &systems)?;
        for (finding, row) in drawn.iter().zip(rows.split_evenly((drawn.len(), 1))) {
            draw_row(&row, finding)?;
        }
        if !alone.is_empty() {
            let style = placed(12, HPos::Left, VPos::Top);
            bottom.draw_text("Measured by one system alone:", &style, (16, 8))?;
            for (line, y) in alone.iter().zip((26..).step_by(LINE as usize)) {
                bottom.draw_text(line, &style, (16, y))?;
            }
        }
        root.present()?;
    }
    Ok(svg)
}

fn draw_row(row: &PlotArea<'_>, finding: &Finding<'_>) -> anyhow::Result<()> {
    let (left, right) = row.split_horizontally(VALUES);
    let curves = Curves::new(finding.estimates[finding.reference].product);
    draw_values(&left, finding, &curves)?;
    if finding.estimates.len() == 1 {
        let centre = (i32::try_from(WIDTH - VALUES)? / 2, i32::try_from(ROW)? / 2);
        let style = placed(13, HPos::Center, VPos::Center);
        Ok(right.draw_text("no other system measures it", &style, centre)?)
    } else if finding.estimates.iter().any(|one| one.product.image.is_some()) {
        draw_histogram(&right, finding)
    } else {
        draw_scores(&right, finding, &curves)
    }
}

/// Height of a line of text, px, and how many letters one holds.
const LINE: u32 = 17;
const LETTERS: usize = 150;

/// Words with commas between them, in lines.
fn lines(words: &[String]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in words {
        match lines.last_mut() {
            Some(line) if line.chars().count() + word.chars().count() < LETTERS => {
                line.push_str(",  ");
                line.push_str(word);
            }
            _ => lines.push(word.clone()),
        }
    }
    lines
}

fn draw_values(area: &PlotArea<'_>, finding: &Finding<'_>, curves: &Curves) -> anyhow::Result<()> {
    let unit = match finding.unit {
        "" | "1" => String::new(),
        unit => format!(" ({})", unit.replace("-1", "⁻¹").replace("-2", "⁻²")),
    };
    let title = format!("{}: {}{unit}", finding.sensor, finding.product);
    let spread = finding.estimates.iter().flat_map(|estimate| {
        let product = estimate.product;
        curves.shown().flat_map(|(_, index)| {
            let (value, error) = (product.values[index], product.standard_error[index]);
            let error = if error.is_finite() { error } else { 0.0 };
            [value - error, value + error]
        })
    });
    let names = if curves.lines.len() > 1 { NAMES } else { 20 };
    let mut chart = panel(area, &title, curves, (range_of(spread), names), &tick)?;
    let count = finding.estimates.len();
    for (number, estimate) in finding.estimates.iter().enumerate() {
        let colour = colour(estimate.system);
        let aside = curves.aside(number, count);
        for curve in &curves.lines {
            let points: Vec<(f64, f64, f64)> = curve
                .points
                .iter()
                .map(|&(x, index)| {
                    let error = estimate.product.standard_error[index];
                    let error = if error.is_finite() { error } else { 0.0 };
                    (x + aside, estimate.product.values[index], error)
                })
                .filter(|(_, value, _)| value.is_finite())
                .collect();
            if curves.labels.is_none() {
                let line = points.iter().map(|&(x, y, _)| (x, y));
                chart.draw_series(LineSeries::new(line, colour.mix(0.3)))?;
            }
            chart.draw_series(points.iter().map(|&(x, y, error)| {
                ErrorBar::new_vertical(x, y - error, y, y + error, colour.filled(), 5)
            }))?;
        }
    }
    name_curves(area, &chart, curves, finding.estimates[finding.reference].product)
}

/// Writes the name of each curve behind its end, none over another.
fn name_curves(
    area: &PlotArea<'_>,
    chart: &Chart<'_, '_>,
    curves: &Curves,
    product: &sunfleck::products::Product,
) -> anyhow::Result<()> {
    if curves.lines.len() < 2 {
        return Ok(());
    }
    let (left, top) = area.get_base_pixel();
    let mut ends: Vec<(i32, &str)> = Vec::new();
    let mut edge = 0;
    for curve in &curves.lines {
        let Some(&(_, index)) = curve.points.last() else { continue };
        let value = product.values[index];
        if !value.is_finite() {
            continue;
        }
        let at = chart.backend_coord(&(curves.range.end, value));
        edge = at.0 - left + 8;
        ends.push((at.1 - top, &curve.name));
    }
    ends.sort_unstable();
    let mut free = i32::MIN;
    for (y, name) in ends {
        let y = y.max(free);
        area.draw_text(name, &placed(11, HPos::Left, VPos::Center), (edge, y))?;
        free = y + 13;
    }
    Ok(())
}

fn draw_scores(area: &PlotArea<'_>, finding: &Finding<'_>, curves: &Curves) -> anyhow::Result<()> {
    let scores: Vec<(usize, Vec<f64>)> = (0..finding.estimates.len())
        .filter_map(|index| Some((index, finding.scores(index, false)?)))
        .collect();
    let finite = scores.iter().flat_map(|(_, z)| z).filter(|z| z.is_finite());
    let most = finite.fold(3.6, |most: f64, z| most.max(1.1 * z.abs())).min(LARGEST);
    let reference = finding.estimates[finding.reference].system.name();
    let title = format!("difference to {reference} (standard errors){}", finding.left_out(false));
    let mut chart = panel(area, &title, curves, (-most..most, 20), &tick)?;
    chart.draw_series([band(curves.range.clone(), -3.0..3.0)])?;
    chart.draw_series(LineSeries::new(
        [(curves.range.start, 0.0), (curves.range.end, 0.0)],
        INK.mix(0.5),
    ))?;
    for (number, (index, z)) in scores.iter().enumerate() {
        let colour = colour(finding.estimates[*index].system);
        let aside = curves.aside(number, scores.len());
        let points = curves.shown().filter(|&(_, index)| !z[index].is_nan());
        chart.draw_series(points.map(|(x, index)| {
            let at = (x + aside, z[index].clamp(-most, most));
            Circle::new(at, 3, colour.mix(0.85).filled())
        }))?;
    }
    Ok(())
}

/// z-scores beyond this are drawn at it.
const LARGEST: f64 = 12.0;

/// Columns of the histogram, from -5 to 5.
const COLUMNS: usize = 40;

/// Histogram of the pixels' z-scores beside the normal distribution.
fn draw_histogram(area: &PlotArea<'_>, finding: &Finding<'_>) -> anyhow::Result<()> {
    let width = 10.0 / COLUMNS as f64;
    let density = |z: &[f64]| -> Vec<f64> {
        let mut columns = vec![0.0; COLUMNS];
        let known: Vec<f64> = z.iter().copied().filter(|z| !z.is_nan()).collect();
        for z in &known {
            let column = ((z.clamp(-4.999, 4.999) + 5.0) / width) as usize;
            columns[column.min(COLUMNS - 1)] += 1.0 / (known.len() as f64 * width);
        }
        columns
    };
    let spreads: Vec<(usize, Vec<f64>)> = (0..finding.estimates.len())
        .filter_map(|index| Some((index, density(&finding.scores(index, true)?))))
        .collect();
    let most = spreads.iter().flat_map(|(_, d)| d).copied().fold(0.42, f64::max) * 1.08;
    let reference = finding.estimates[finding.reference].system.name();
    let title =
        format!("pixels: difference to {reference} (standard errors){}", finding.left_out(true));
    let mut chart = frame(area, &title, (-5.0..5.0, 0.0..most), (20, 40))?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(letters(11))
        .x_desc("z, and the normal distribution (dashed)")
        .axis_desc_style(letters(12))
        .x_label_formatter(&|value| tick(*value))
        .y_label_formatter(&|value| tick(*value))
        .draw()?;
    let normal = (-100..=100).map(|i| f64::from(i) / 20.0);
    let normal = normal.map(|z| (z, (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt()));
    chart.draw_series(DashedLineSeries::new(normal, 4, 3, INK.stroke_width(1)))?;
    for (index, columns) in spreads {
        let colour = colour(finding.estimates[index].system);
        let steps = columns.iter().enumerate().flat_map(|(column, &height)| {
            let left = -5.0 + column as f64 * width;
            [(left, height), (left + width, height)]
        });
        chart.draw_series(LineSeries::new(steps, colour.stroke_width(2)))?;
    }
    Ok(())
}

fn band(x: Range<f64>, y: Range<f64>) -> Rectangle<(f64, f64)> {
    Rectangle::new([(x.start, y.start), (x.end, y.end)], SHADE.filled())
}

/// Letters of an upright label, and room above it, px.
const LONGEST: usize = 16;
const ABOVE_LABELS: u32 = 12;

/// Leaves out the middle of a long label: labels differ at their ends.
fn shortened(label: &str) -> String {
    let count = label.chars().count();
    if count <= LONGEST {
        return label.to_owned();
    }
    let head: String = label.chars().take(6).collect();
    let tail: String = label.chars().skip(count - (LONGEST - 7)).collect();
    format!("{head}…{tail}")
}

/// A panel with its title.
fn frame<'a, 'b>(
    area: &'a PlotArea<'b>,
    title: &str,
    (x, y): (Range<f64>, Range<f64>),
    (right, below): (u32, u32),
) -> anyhow::Result<Chart<'a, 'b>> {
    Ok(ChartBuilder::on(area)
        .margin_top(6)
        .margin_bottom(8)
        .margin_left(14)
        .margin_right(right)
        .caption(title, letters(14))
        .x_label_area_size(below)
        .y_label_area_size(58)
        .build_cartesian_2d(x, y)?)
}

/// The same with axes for curves.
fn panel<'a, 'b>(
    area: &'a PlotArea<'b>,
    title: &str,
    curves: &Curves,
    (y, right): (Range<f64>, u32),
    format: &dyn Fn(f64) -> String,
) -> anyhow::Result<Chart<'a, 'b>> {
    let low = y.start;
    let names = curves.labels.iter().flatten().map(|label| label.chars().count());
    let longest = names.max().unwrap_or(0);
    let is_slanted = longest * curves.labels.as_ref().map_or(0, Vec::len) > 80;
    let below = if is_slanted { ABOVE_LABELS + 6 * longest.min(LONGEST) as u32 } else { 40 };
    let mut chart = frame(area, title, (curves.range.clone(), y), (right, below))?;
    let (x_format, y_format) = (|value: &f64| tick(*value), |value: &f64| format(*value));
    let mut mesh = chart.configure_mesh();
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(letters(11))
        .axis_desc_style(letters(12))
        .y_labels(6)
        .x_label_formatter(&x_format)
        .y_label_formatter(&y_format);
    let Some(labels) = &curves.labels else {
        mesh.x_desc(axis_title(&curves.axis)).x_labels(9).draw()?;
        return Ok(chart);
    };
    mesh.disable_x_mesh().x_labels(0).draw()?;
    let (left, top) = area.get_base_pixel();
    for (place, label) in labels.iter().enumerate() {
        let at = chart.backend_coord(&(place as f64, low));
        let at = (at.0 - left, at.1 - top + 7);
        if is_slanted {
            let short = shortened(label);
            let style =
                upwards(10).pos(plotters::style::text_anchor::Pos::new(HPos::Right, VPos::Center));
            area.draw_text(&short, &style, at)?;
        } else {
            area.draw_text(label, &placed(11, HPos::Center, VPos::Top), at)?;
        }
    }
    Ok(chart)
}
