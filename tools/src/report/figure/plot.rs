//! Lines of values with their standard errors, in one panel or several with the same axes.

use std::ops::Range;

use maud::{Markup, html};
use sunfleck::output::{are_unlike, range_of};

use super::scale::{Scale, Tick};
use super::{colour, px, symbol};
use crate::report::words::{cut, measured};

/// Size of a panel, units of the drawing.
const SIZE: (f64, f64) = (400.0, 262.0);
/// Margins of the axes.
const LEFT: f64 = 72.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 44.0;
/// Number of names along an axis that have room beside each other; more are written aslant.
const LEVEL_NAMES: usize = 6;
/// Maximum number of points of a line that have a symbol and a text.
const SYMBOLS: usize = 60;
/// Width of the interval that holds 95 % of a normal distribution, standard errors.
pub(crate) const NORMAL_95: f64 = 1.96;

/// What values are drawn against.
#[derive(Clone, Debug)]
pub(crate) enum Across {
    Numbers,
    /// Numbers on a logarithmic axis.
    Logarithm,
    /// Names of the points 0, 1, ..
    Labels(Vec<String>),
}

/// How standard errors are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ErrorStyle {
    /// Areas of 1 and 1.96 standard errors about a line.
    Areas,
    /// Bars of 1.96 standard errors.
    Bars,
}

/// Panels of lines with common axes.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    pub(crate) x_title: String,
    pub(crate) y_title: String,
    pub(crate) across: Across,
    /// True if values are drawn to the right, and their places upwards.
    pub(crate) is_profile: bool,
    pub(crate) errors: ErrorStyle,
    pub(crate) panels: Vec<Panel>,
    /// Values that lines across the panels stand at.
    pub(crate) guides: Vec<f64>,
}

/// Lines about one subject.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    pub(crate) title: String,
    /// Panels of the same number have the same range of values, unless these are so unlike in size that some would not be
    /// legible.
    pub(crate) scale: usize,
    /// Title of the axis that values are drawn against, if it differs from that of the plot.
    pub(crate) x_title: Option<String>,
    pub(crate) lines: Vec<Line>,
    pub(crate) marks: Vec<Mark>,
}

/// Values that belong together.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) name: String,
    /// Number of its colour.
    pub(crate) colour: usize,
    pub(crate) points: Vec<Point>,
}

/// A value with its standard error, NaN if it has none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) at: f64,
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// A place on the axis that values are drawn against.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Mark {
    pub(crate) at: f64,
    /// Empty of a mark that the caption explains.
    pub(crate) name: String,
    /// Number of the colour of the line that it belongs to; `None` of one for all lines.
    pub(crate) colour: Option<usize>,
}

impl Point {
    fn spread(&self, errors: f64) -> f64 {
        if self.error.is_finite() { errors * self.error } else { 0.0 }
    }
}

impl Panel {
    /// Largest absolute value; 0 without values.
    pub(crate) fn peak(&self) -> f64 {
        let points = self.lines.iter().flat_map(|line| &line.points);
        points.map(|point| point.value.abs()).filter(|size| size.is_finite()).fold(0.0, f64::max)
    }
}

impl Plot {
    /// Numbers of the panels that have the same range of values as a panel.
    fn alike(&self, number: usize) -> Vec<usize> {
        let scale = self.panels[number].scale;
        let same: Vec<usize> =
            (0..self.panels.len()).filter(|&at| self.panels[at].scale == scale).collect();
        let peaks = same.iter().map(|&at| self.panels[at].peak());
        if self.guides.is_empty() && are_unlike(peaks) { vec![number] } else { same }
    }

    /// Range of the values of some panels with their errors.
    fn range(&self, panels: &[usize]) -> Range<f64> {
        let lines = panels.iter().flat_map(|&at| &self.panels[at].lines);
        let ends = lines.flat_map(|line| &line.points).flat_map(|point| {
            let spread = point.spread(NORMAL_95);
            [point.value - spread, point.value + spread]
        });
        range_of(ends.chain(self.guides.iter().copied()))
    }

    /// A drawing for each panel.
    pub(crate) fn draw(&self) -> Vec<Markup> {
        let points =
            || self.panels.iter().flat_map(|panel| &panel.lines).flat_map(|line| &line.points);
        let places = match &self.across {
            Across::Labels(labels) => -0.5..labels.len() as f64 - 0.5,
            Across::Numbers => padded(points().map(|point| point.at), 0.02),
            Across::Logarithm => {
                let logs = padded(points().map(|point| point.at.ln()), 0.02);
                logs.start.exp()..logs.end.exp()
            }
        };
        let numbers = 0..self.panels.len();
        numbers
            .map(|number| {
                let values = self.range(&self.alike(number));
                self.panel(&self.panels[number], &places, &values)
            })
            .collect()
    }

    /// Text about axes of values that differ from panel to panel.
    pub(crate) fn scale_note(&self) -> Option<String> {
        let has_own = (0..self.panels.len()).any(|at| self.alike(at).len() < self.panels.len());
        has_own.then(|| "Panels have axes of their own: mind their numbers.".to_owned())
    }

    /// Text about the size of the errors.
    pub(crate) fn error_note(&self) -> Option<String> {
        let widest = |panel: &Panel| {
            let points = panel.lines.iter().flat_map(|line| &line.points);
            points.map(|point| point.spread(NORMAL_95)).fold(0.0, f64::max)
        };
        if self.panels.iter().map(widest).fold(0.0, f64::max) == 0.0 {
            return None;
        }
        let drawn = match self.errors {
            ErrorStyle::Areas => "Areas are ± 1 (darker) and ± 1.96 standard errors",
            ErrorStyle::Bars => "Bars are ± 1.96 standard errors (95 %)",
        };
        let is_small = self.panels.iter().enumerate().all(|(number, panel)| {
            let values = self.range(&self.alike(number));
            widest(panel) < 0.012 * (values.end - values.start)
        });
        let small = if is_small { ", here smaller than the symbols" } else { "" };
        Some(format!("{drawn}{small}."))
    }

    /// Height of the margin below the axes.
    fn bottom(&self) -> f64 {
        match &self.across {
            Across::Labels(labels) if labels.len() > LEVEL_NAMES => BOTTOM + 40.0,
            _ => BOTTOM,
        }
    }

    fn panel(&self, panel: &Panel, places: &Range<f64>, values: &Range<f64>) -> Markup {
        let floor = SIZE.1 - self.bottom();
        let (across, up) = (LEFT..SIZE.0 - RIGHT, floor..TOP);
        let is_log = matches!(self.across, Across::Logarithm);
        let (place, value) = if self.is_profile {
            (Scale::new(places.clone(), up, is_log), Scale::new(values.clone(), across, false))
        } else {
            (Scale::new(places.clone(), across, is_log), Scale::new(values.clone(), up, false))
        };
        let frame = Frame { plot: self, place, value, floor };
        let place_title = panel.x_title.as_ref().unwrap_or(&self.x_title);
        let (x_title, y_title) = if self.is_profile {
            (&self.y_title, place_title)
        } else {
            (place_title, &self.y_title)
        };
        let names: Vec<&str> = panel
            .lines
            .iter()
            .map(|line| line.name.as_str())
            .filter(|name| !name.is_empty())
            .collect();
        let names =
            if names.is_empty() { String::new() } else { format!("; lines: {}", names.join(", ")) };
        let alternative = format!("{} {y_title} against {x_title}{names}", panel.title);
        html! {
            svg viewBox={ "0 0 " (SIZE.0) " " (SIZE.1) } role="img" aria-label=(cut(alternative.trim(), 300)) {
                @if !panel.title.is_empty() {
                    text.head x=(px(LEFT)) y="16" { (cut(&panel.title, 52)) }
                }
                (frame.axes())
                text.name x=(px(0.5 * (LEFT + SIZE.0 - RIGHT))) y=(px(SIZE.1 - 6.0)) text-anchor="middle" { (cut(x_title, 60)) }
                text.name transform={ "translate(11 " (px(0.5 * (TOP + floor))) ") rotate(-90)" } text-anchor="middle" { (cut(y_title, 38)) }
                @for mark in &panel.marks { (frame.mark(mark)) }
                @for line in &panel.lines { (frame.line(line)) }
            }
        }
    }
}

/// Range of numbers with a share of it added at both ends.
fn padded(numbers: impl Iterator<Item = f64>, share: f64) -> Range<f64> {
    let finite = numbers.filter(|number| number.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low >= high {
        return range_of([low]);
    }
    let room = share * (high - low);
    low - room..high + room
}

/// Axes of a panel.
struct Frame<'a> {
    plot: &'a Plot,
    place: Scale,
    value: Scale,
    /// Lower end of the axes.
    floor: f64,
}

impl Frame<'_> {
    fn axes(&self) -> Markup {
        let places = match &self.plot.across {
            Across::Labels(labels) => labels
                .iter()
                .enumerate()
                .map(|(at, name)| Tick {
                    at: at as f64,
                    text: cut(
                        name,
                        if labels.len() > LEVEL_NAMES { 13 } else { 66 / labels.len().max(4) },
                    ),
                })
                .collect(),
            _ => self.place.ticks(6),
        };
        let values = self.value.ticks(5);
        let (x, y) = if self.plot.is_profile { (values, places) } else { (places, values) };
        let (x_scale, y_scale) = if self.plot.is_profile {
            (&self.value, &self.place)
        } else {
            (&self.place, &self.value)
        };
        html! {
            path.grid d=(y.iter().map(|tick| format!("M{LEFT} {}H{}", px(y_scale.at(tick.at)), SIZE.0 - RIGHT)).collect::<Vec<_>>().concat()) {}
            @if !self.plot.guides.is_empty() {
                path.mark d=(self.plot.guides.iter().map(|value| format!("M{LEFT} {}H{}", px(self.value.at(*value)), SIZE.0 - RIGHT)).collect::<Vec<_>>().concat()) {}
            }
            path.axis d=(format!("M{LEFT} {TOP}V{}H{}", self.floor, SIZE.0 - RIGHT)) {}
            path.axis d=(x.iter().map(|tick| format!("M{} {}v4", px(x_scale.at(tick.at)), self.floor)).collect::<Vec<_>>().concat()) {}
            @let is_aslant = self.plot.bottom() > BOTTOM;
            @for tick in &x {
                @let (at, below) = (px(x_scale.at(tick.at) + 3.0), px(self.floor + 13.0));
                @if is_aslant { text transform={ "translate(" (at) " " (below) ") rotate(-38)" } text-anchor="end" { (tick.text) } }
                @else { text x=(px(x_scale.at(tick.at))) y=(px(self.floor + 17.0)) text-anchor="middle" { (tick.text) } }
            }
            @for tick in &y {
                text x=(px(LEFT - 6.0)) y=(px(y_scale.at(tick.at) + 4.0)) text-anchor="end" { (tick.text) }
            }
        }
    }

    fn mark(&self, mark: &Mark) -> Markup {
        let x = self.place.at(mark.at);
        // The name stands on the side where there is room.
        let (anchor, aside) = if x > 0.6 * SIZE.0 { ("end", -5.0) } else { ("start", 5.0) };
        html! {
            g class=[mark.colour.map(colour)] { path.mark d=(format!("M{} {TOP}V{}", px(x), self.floor)) {} }
            text.note x=(px(x + aside)) y=(px(TOP + 10.0)) text-anchor=(anchor) { (mark.name) }
        }
    }

    /// Place of a value on the drawing.
    fn at(&self, at: f64, value: f64) -> (f64, f64) {
        let (place, value) = (self.place.at(at), self.value.at(value));
        if self.plot.is_profile { (value, place) } else { (place, value) }
    }

    fn line(&self, line: &Line) -> Markup {
        let is_labelled = matches!(self.plot.across, Across::Labels(_));
        // A gap of the data is a gap of the line.
        let runs: Vec<&[Point]> = line
            .points
            .split(|point| !(point.value.is_finite() && point.at.is_finite()))
            .filter(|run| !run.is_empty())
            .collect();
        let joined = |points: &[Point]| {
            let point = |point: &Point| {
                let (x, y) = self.at(point.at, point.value);
                format!("{} {}", px(x), px(y))
            };
            format!("M{}", points.iter().map(point).collect::<Vec<_>>().join("L"))
        };
        let has_areas = self.plot.errors == ErrorStyle::Areas && !is_labelled;
        let number = line.colour;
        html! {
            g class=(colour(number)) {
                @for run in &runs {
                    @if has_areas && run.len() > 1 {
                        path.wide d=(self.area(run, NORMAL_95)) {}
                        path.near d=(self.area(run, 1.0)) {}
                    }
                    @if !is_labelled && run.len() > 1 { path.line d=(joined(run)) {} }
                    @if !has_areas || run.len() == 1 { (self.bars(run)) }
                }
                (self.symbols(line, &runs))
            }
        }
    }

    /// Outline of values with so many errors added and taken away.
    fn area(&self, points: &[Point], errors: f64) -> String {
        let side = |sign: f64| {
            points
                .iter()
                .map(move |point| self.at(point.at, point.value + sign * point.spread(errors)))
        };
        let outline = side(1.0).chain(side(-1.0).collect::<Vec<_>>().into_iter().rev());
        let corners = outline.map(|(x, y)| format!("{} {}", px(x), px(y)));
        format!("M{}z", corners.collect::<Vec<_>>().join(" "))
    }

    fn bars(&self, points: &[Point]) -> Markup {
        let bar = |point: &Point| {
            let spread = point.spread(NORMAL_95);
            let (a, b) =
                (self.at(point.at, point.value - spread), self.at(point.at, point.value + spread));
            format!("M{} {}L{} {}", px(a.0), px(a.1), px(b.0), px(b.1))
        };
        html! { path.bar d=(points.iter().filter(|point| point.spread(1.0) > 0.0).map(bar).collect::<Vec<_>>().concat()) {} }
    }

    /// A symbol with a text for each point, or for some of very many.
    fn symbols(&self, line: &Line, runs: &[&[Point]]) -> Markup {
        let count: usize = runs.iter().map(|run| run.len()).sum();
        let step = count.div_ceil(SYMBOLS).max(1);
        let is_dense = count > SYMBOLS;
        let points = runs.iter().flat_map(|run| run.iter()).step_by(step);
        html! {
            @for point in points {
                @let (x, y) = self.at(point.at, point.value);
                g.pt {
                    title { (self.tooltip(line, point)) }
                    @if !is_dense { (symbol(line.colour, x, y)) }
                    circle.hit cx=(px(x)) cy=(px(y)) r="7" {}
                }
            }
        }
    }

    fn tooltip(&self, line: &Line, point: &Point) -> String {
        let place = match &self.plot.across {
            Across::Labels(labels) => {
                labels.get(point.at.round().max(0.0) as usize).map_or("", String::as_str).to_owned()
            }
            _ => format!("{}: {}", self.plot.x_title, sunfleck::output::tick(point.at)),
        };
        let name =
            if line.name.is_empty() { String::new() } else { format!("{}, ", cut(&line.name, 60)) };
        format!("{name}{}: {}", cut(&place, 60), measured(point.value, point.error))
    }
}
