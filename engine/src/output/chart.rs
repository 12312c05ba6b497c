//! Values by direction and by height as SVG.

use crate::counts::counted;
use std::io;
use std::ops::Range;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::lines::{Line, Lines, Point};
use super::scale::{range_of, tick};

/// Size of a chart of one panel, px.
const SIZE: (u32, u32) = (760, 480);
/// Height of a row of panels, of which two stand beside each other, and of the titles above them, px.
const ROW: u32 = 300;
const TITLES: u32 = 56;
/// Room for names of lines on the right, px.
const NAMES: u32 = 190;

const INK: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(225, 225, 225);

/// Colours that can be distinguished with any colour vision.
///
/// Source: Okabe and Ito (2008), "Color Universal Design".
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(150, 140, 20),
];

type Panel<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type ChartAxes<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Titles of a chart.
#[derive(Clone, Debug)]
pub(super) struct Heading<'a> {
    pub(super) title: String,
    /// Title of the scene.
    pub(super) scene: &'a str,
    /// Title of the axis of its values, with their unit.
    pub(super) values: String,
    /// Keys and values of its provenance as JSON.
    pub(super) provenance: &'a str,
}

/// Title of the axis of the principal plane in a small panel; its signs are explained beside the panels.
const SMALL_AXIS: &str = "view zenith (°), − forward, + backward";

/// Draws lines with their standard errors; returns the text of an SVG.
///
/// # Errors
/// If it cannot be drawn.
pub(super) fn draw(lines: &Lines, heading: &Heading<'_>) -> io::Result<String> {
    let panels = lines.panels();
    let rows = panels.len().div_ceil(2) as u32;
    let size = if panels.len() > 1 { (SIZE.0, TITLES + rows * ROW) } else { SIZE };
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        root.draw_text(&heading.title, &letters(18), (16, 10)).map_err(failed)?;
        root.draw_text(heading.scene, &letters(13), (16, 32)).map_err(failed)?;
        let (all, names) = root.split_horizontally(SIZE.0 - NAMES);
        let (_, plots) = all.split_vertically(TITLES);
        if let [only] = &panels[..] {
            let panel = ChartPanel { lines, numbers: only, title: "", is_small: false };
            panel.draw(&plots, &heading.values).map_err(failed)?;
        } else {
            let areas = plots.split_evenly((rows as usize, 2));
            for (numbers, area) in panels.iter().zip(&areas) {
                let title = &lines.curves[numbers[0]].band;
                let panel = ChartPanel { lines, numbers, title, is_small: true };
                panel.draw(area, &heading.values).map_err(failed)?;
            }
        }
        draw_names(&names, lines, panels.len() > 1).map_err(failed)?;
        root.present().map_err(failed)?;
    }
    // Behind the opening tag.
    if let Some(place) =
        svg.find("<svg").and_then(|start| Some(start + svg[start..].find('>')? + 1))
    {
        let escaped = heading.provenance.replace('&', "&amp;").replace('<', "&lt;");
        svg.insert_str(place, &format!("\n<metadata id=\"sunfleck\">{escaped}</metadata>"));
    }
    Ok(svg)
}

type DrawError = DrawingAreaErrorKind<io::Error>;

#[expect(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn failed(error: DrawError) -> io::Error {
    io::Error::other(error.to_string())
}

fn letters(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}

/// Some lines on axes of their own.
struct ChartPanel<'a> {
    lines: &'a Lines,
    /// Numbers of the lines.
    numbers: &'a [usize],
    /// Name of what they share.
    title: &'a str,
    /// True of one of several panels.
    is_small: bool,
}

impl ChartPanel<'_> {
    fn draw(&self, area: &Panel<'_>, value_title: &str) -> Result<(), DrawError> {
        let Lines { axis, is_profile, curves, sun, .. } = self.lines;
        // Panels beside each other have the same places.
        let places = range_of(curves.iter().flat_map(|line| &line.points).map(|point| point.at));
        let own = self.numbers.iter().flat_map(|&number| &curves[number].points);
        let ends = own.flat_map(|point| [point.value - point.error, point.value + point.error]);
        let values = range_of(ends);
        let sun = sun.filter(|sun| places.contains(sun));
        let short = match sun {
            Some(_) if self.is_small => SMALL_AXIS,
            _ => axis,
        };
        let (x, y) = if *is_profile {
            (values.clone(), places.clone())
        } else {
            (places.clone(), values.clone())
        };
        let (x_title, y_title) =
            if *is_profile { (value_title, short) } else { (short, value_title) };
        let size = if self.is_small { 12 } else { 14 };
        let mut chart = ChartBuilder::on(area)
            .caption(self.title, letters(if self.is_small { 14 } else { 1 }))
            .margin_left(18)
            .margin_right(16)
            .margin_bottom(8)
            .x_label_area_size(46)
            .y_label_area_size(if self.is_small { 62 } else { 74 })
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(FAINT)
            .axis_style(INK)
            .x_desc(x_title)
            .y_desc(y_title)
            .x_labels(if self.is_small { 5 } else { 10 })
            .y_labels(if self.is_small { 6 } else { 10 })
            .x_label_formatter(&|value| tick(*value))
            .y_label_formatter(&|value| tick(*value))
            .label_style(letters(size - 1))
            .axis_desc_style(letters(size))
            .draw()?;
        if let Some(sun) = sun.filter(|_| !is_profile) {
            draw_sun(&mut chart, (sun, &values), sun > 0.5 * (places.start + places.end))?;
        }
        for &number in self.numbers {
            let colour = COLOURS[number % COLOURS.len()];
            draw_line(&mut chart, &curves[number], (colour, *is_profile))?;
        }
        Ok(())
    }
}

/// Marks the zenith angle of the sun.
///
/// - `is_right`: true in the right half, where the name stands on the left of the mark
fn draw_sun(
    chart: &mut ChartAxes<'_, '_>,
    (sun, values): (f64, &Range<f64>),
    is_right: bool,
) -> Result<(), DrawError> {
    let ends = vec![(sun, values.start), (sun, values.end)];
    chart.draw_series(DashedLineSeries::new(ends, 5, 4, INK.stroke_width(1)))?;
    let (side, gap) = if is_right { (HPos::Right, -5) } else { (HPos::Left, 5) };
    let style = letters(13).pos(Pos::new(side, VPos::Top));
    let name = EmptyElement::at((sun, values.end)) + Text::new("sun (hot spot)", (gap, 3), style);
    chart.draw_series([name])?;
    Ok(())
}

fn draw_line(
    chart: &mut ChartAxes<'_, '_>,
    line: &Line,
    (colour, is_profile): (RGBColor, bool),
) -> Result<(), DrawError> {
    let at =
        |point: &Point, value: f64| if is_profile { (value, point.at) } else { (point.at, value) };
    let middles = line.points.iter().map(|point| at(point, point.value));
    chart.draw_series(LineSeries::new(middles.clone(), colour.stroke_width(2)))?;
    chart.draw_series(middles.map(|middle| Circle::new(middle, 2, colour.filled())))?;
    let bars = line.points.iter().filter(|point| point.error > 0.0);
    chart.draw_series(bars.map(|point| {
        let ends = [point.value - point.error, point.value + point.error];
        PathElement::new(ends.map(|value| at(point, value)).to_vec(), colour.stroke_width(1))
    }))?;
    Ok(())
}

/// Draws the name of each line in its colour.
fn draw_names(area: &Panel<'_>, lines: &Lines, has_panels: bool) -> Result<(), DrawError> {
    let style = letters(13).pos(Pos::new(HPos::Left, VPos::Center));
    let mut y = 66;
    for (number, line) in lines.curves.iter().enumerate().filter(|(_, line)| !line.name.is_empty())
    {
        let colour = COLOURS[number % COLOURS.len()];
        area.draw(&PathElement::new(vec![(0, y), (16, y)], colour.stroke_width(3)))?;
        area.draw_text(&line.name, &style, (22, y))?;
        y += 20;
    }
    if lines.hidden > 0 {
        area.draw_text(
            &format!("{} in the table", counted(lines.hidden, "more line")),
            &style,
            (0, y),
        )?;
        y += 20;
    }
    if lines.curves.iter().flat_map(|line| &line.points).any(|point| point.error > 0.0) {
        area.draw_text("bars: ± 1 standard error", &style, (0, y + 6))?;
        y += 20;
    }
    if has_panels {
        let mut notes = vec!["bands differ in size:", "each has its own axis"];
        if lines.sun.is_some() {
            notes.extend([
                "",
                "principal plane:",
                "+ backward scattering",
                "(side of the sun)",
                "− forward scattering",
            ]);
        }
        for (note, line) in notes.iter().zip(0..) {
            area.draw_text(note, &style, (0, y + 10 + 18 * line))?;
        }
    }
    Ok(())
}
