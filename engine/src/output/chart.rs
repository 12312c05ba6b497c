//! Values by direction and by height as SVG.

use std::io;

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::lines::{Line, Lines, Point};
use super::scale::{range_of, tick};

/// Size of a chart, px.
const SIZE: (u32, u32) = (760, 480);
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
type Axes<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Title of a chart and of the axis of its values.
#[derive(Clone, Debug)]
pub(super) struct Heading<'a> {
    pub(super) title: String,
    /// Title of the scene.
    pub(super) scene: &'a str,
    /// Name of the quantity.
    pub(super) quantity: &'a str,
    /// Unit of the quantity; `1` for a fraction.
    pub(super) unit: &'a str,
    /// Keys and values of its provenance as JSON.
    pub(super) provenance: &'a str,
}

/// Draws lines with their standard errors; returns the text of an SVG.
///
/// # Errors
/// If it cannot be drawn.
pub(super) fn draw(lines: &Lines, heading: &Heading<'_>) -> io::Result<String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (plot, names) = root.split_horizontally(SIZE.0 - NAMES);
        draw_lines(&plot, lines, heading).map_err(failed)?;
        draw_names(&names, lines).map_err(failed)?;
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

fn draw_lines(area: &Panel<'_>, lines: &Lines, heading: &Heading<'_>) -> Result<(), DrawError> {
    area.draw_text(&heading.title, &letters(18), (16, 10))?;
    area.draw_text(heading.scene, &letters(13), (16, 32))?;
    let all = || lines.curves.iter().flat_map(|line| &line.points);
    let places = range_of(all().map(|point| point.at));
    let values =
        range_of(all().flat_map(|point| [point.value - point.error, point.value + point.error]));
    let unit = match heading.unit {
        "1" => String::new(),
        unit => format!(" ({})", unit.replace("-1", "⁻¹").replace("-2", "⁻²")),
    };
    let value_title = format!("{}{unit}", heading.quantity.replace('_', " "));
    let (x, y) = if lines.is_profile { (values, places) } else { (places, values) };
    let (x_title, y_title) = if lines.is_profile {
        (value_title.as_str(), lines.axis.as_str())
    } else {
        (lines.axis.as_str(), value_title.as_str())
    };
    let mut chart = ChartBuilder::on(area)
        .margin_top(56)
        .margin_left(18)
        .margin_right(16)
        .margin_bottom(8)
        .x_label_area_size(46)
        .y_label_area_size(74)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(FAINT)
        .axis_style(INK)
        .x_desc(x_title)
        .y_desc(y_title)
        .x_label_formatter(&|value| tick(*value))
        .y_label_formatter(&|value| tick(*value))
        .label_style(letters(13))
        .axis_desc_style(letters(14))
        .draw()?;
    for (number, line) in lines.curves.iter().enumerate() {
        draw_line(&mut chart, line, (COLOURS[number % COLOURS.len()], lines.is_profile))?;
    }
    Ok(())
}

fn draw_line(
    chart: &mut Axes<'_, '_>,
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
fn draw_names(area: &Panel<'_>, lines: &Lines) -> Result<(), DrawError> {
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
        area.draw_text(&format!("{} more are in the table", lines.hidden), &style, (0, y))?;
        y += 20;
    }
    if lines.curves.iter().flat_map(|line| &line.points).any(|point| point.error > 0.0) {
        area.draw_text("bars: ± 1 standard error", &style, (0, y + 6))?;
    }
    Ok(())
}
