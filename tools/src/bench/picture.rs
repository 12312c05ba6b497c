use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use sunfleck::document::System;

use super::curve::Curve;
use crate::compare::tables::significant;
use crate::plot::{FAINT, INK, PlotArea, colour, heading, letters, placed};

/// Panels side by side, and their size, px.
const COLUMNS: usize = 2;
const WIDTH: u32 = 560;
const HEIGHT: u32 = 330;
const HEADING: u32 = 66;

/// A panel for each product: run time against relative error, reported (full) and actual (open).
pub(super) fn draw(curves: &[Curve], title: &str) -> anyhow::Result<String> {
    let noisy = |panel: &&[Curve]| panel.iter().any(|curve| curve.fit().is_some());
    let panels: Vec<&[Curve]> = curves.chunk_by(super::error::alike).filter(noisy).collect();
    let rows = panels.len().div_ceil(COLUMNS).max(1);
    let mut svg = String::new();
    {
        let size = (WIDTH * COLUMNS as u32, HEADING + HEIGHT * rows as u32);
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        let (top, body) = root.split_vertically(HEADING);
        let mut systems: Vec<System> = Vec::new();
        for curve in curves {
            if !systems.contains(&curve.system) {
                systems.push(curve.system);
            }
        }
        let title = match title {
            "" => "Run time against error".to_owned(),
            title => format!("{title}: run time against error"),
        };
        heading(&top, &title, &systems)?;
        let note = "dots: error as reported; rings: root mean square against 4 times the samples; dashed: slope -1/2";
        let right = i32::try_from(WIDTH * COLUMNS as u32)? - 20;
        top.draw_text(note, &placed(12, HPos::Right, VPos::Center), (right, 46))?;
        for (curves, area) in panels.iter().zip(body.split_evenly((rows, COLUMNS))) {
            draw_panel(&area, curves)?;
        }
        root.present()?;
    }
    Ok(svg)
}

fn draw_panel(area: &PlotArea<'_>, curves: &[Curve]) -> anyhow::Result<()> {
    let points: Vec<(f64, f64)> = curves
        .iter()
        .flat_map(|curve| &curve.levels)
        .flat_map(|level| [(level.seconds(), level.reported()), (level.seconds(), level.actual())])
        .filter(|(seconds, error)| *seconds > 0.0 && *error > 0.0 && error.is_finite())
        .collect();
    let (x, y) = (decades(points.iter().map(|p| p.0)), decades(points.iter().map(|p| p.1)));
    let title = format!("{}: {}", curves[0].sensor, curves[0].product);
    let mut chart = ChartBuilder::on(area)
        .margin_top(6)
        .margin_bottom(8)
        .margin_left(14)
        .margin_right(24)
        .caption(title, letters(14))
        .x_label_area_size(42)
        .y_label_area_size(66)
        .build_cartesian_2d(
            x.clone().log_scale().with_key_points(round(&x)),
            y.clone().log_scale().with_key_points(round(&y)),
        )?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .label_style(letters(11))
        .axis_desc_style(letters(12))
        .x_labels(8)
        .y_labels(8)
        .x_desc("seconds")
        .y_desc("relative error")
        .x_label_formatter(&|seconds| significant(*seconds, 1))
        .y_label_formatter(&|error| format!("{} %", significant(100.0 * error, 1)))
        .draw()?;
    // Lines of slope -1/2 through the corner of each decade.
    let guides = -8..=8;
    for decade in guides {
        let factor = 10_f64.powi(decade) * (x.start * x.end).sqrt().sqrt();
        let line = (0..=60).filter_map(|step| {
            let seconds = x.start * (x.end / x.start).powf(f64::from(step) / 60.0);
            let error = factor / seconds.sqrt();
            y.contains(&error).then_some((seconds, error))
        });
        let line: Vec<(f64, f64)> = line.collect();
        if line.len() > 1 {
            chart.draw_series(DashedLineSeries::new(line, 3, 4, INK.mix(0.25).into()))?;
        }
    }
    for curve in curves {
        let colour = colour(curve.system);
        let reported = |level: &super::curve::Level| (level.seconds(), level.reported());
        let seen = |point: &(f64, f64)| point.0 > 0.0 && point.1 > 0.0 && point.1.is_finite();
        let dots = curve.levels.iter().map(reported).filter(seen);
        chart.draw_series(dots.map(|at| Circle::new(at, 3, colour.filled())))?;
        let rings = curve.levels.iter().map(|level| (level.seconds(), level.actual())).filter(seen);
        chart.draw_series(rings.map(|at| Circle::new(at, 5, colour)))?;
        if let Some(fit) = curve.fit() {
            let ends = [curve.levels.first(), curve.levels.last()].into_iter().flatten();
            let line = ends.map(|level| (level.seconds(), fit.error(level.seconds())));
            chart.draw_series(LineSeries::new(line, colour.mix(0.6)))?;
        }
    }
    Ok(())
}

/// Numbers to label: decades or, where there are few of them, 1, 2 and 5 of each.
fn round(range: &Range<f64>) -> Vec<f64> {
    let steps: &[f64] = if range.end / range.start > 300.0 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = range.start.log10().floor() as i32..=range.end.log10().ceil() as i32;
    let points =
        decades.flat_map(|decade| steps.iter().map(move |step| step * 10_f64.powi(decade)));
    points.filter(|point| range.contains(point)).collect()
}

/// Range that holds all numbers, and a little room about them.
fn decades(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return 0.1..1.0;
    }
    // At least a decade, so that the axis has a label.
    let middle = (low * high).sqrt();
    let half = (high / low).sqrt().max(10_f64.sqrt()) * 1.3;
    middle / half..middle * half
}
