//! Figures: SVG that needs no script, with colours of the page's style sheet.

mod plot;
mod polar;
mod scale;
mod stack;

use maud::{Markup, html};

pub(super) use self::plot::{Across, ErrorStyle, Line, Mark, NORMAL_95, Panel, Plot, Point};
pub(super) use self::polar::{Hemisphere, View, colour_bar, common_range};
pub(super) use self::stack::{Bar, Segment, stack};

/// Number of colours of lines and segments in the style sheet.
pub(super) const COLOURS: usize = 8;

/// A figure with its caption.
pub(super) struct Figure {
    /// Drawing, in as many parts as it has panels.
    pub(super) panels: Vec<Markup>,
    /// Names of the colours.
    pub(super) legend: Vec<String>,
    /// Colour bar of all panels, if they share one.
    pub(super) bar: Option<Markup>,
    /// Name of what is shown.
    pub(super) title: String,
    /// Sentences below it.
    pub(super) caption: Vec<String>,
    /// Address of the table with the values.
    pub(super) data: Option<Link>,
}

/// A link to a file.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) address: String,
    pub(super) name: String,
}

impl Figure {
    pub(super) fn markup(&self) -> Markup {
        html! {
            figure.plot.several[self.panels.len() > 1] {
                div.panels { @for panel in &self.panels { (panel) } }
                @if let Some(bar) = &self.bar { (bar) }
                @if !self.legend.is_empty() {
                    ul.legend {
                        @for (number, name) in self.legend.iter().enumerate() {
                            li { (swatch(number)) " " bdi { (name) } }
                        }
                    }
                }
                figcaption {
                    strong { bdi { (self.title) } "." }
                    @for sentence in &self.caption { " " (sentence) }
                    @if let Some(Link { address, name }) = &self.data {
                        " Data: " a href=(address) { (name) } "."
                    }
                }
            }
        }
    }
}

/// Sample of the line of a colour.
fn swatch(number: usize) -> Markup {
    html! {
        svg.swatch viewBox="0 0 24 10" width="24" height="10" aria-hidden="true" {
            g class=(colour(number)) {
                path.line d="M1 5H23" {}
                (symbol(number, 12.0, 5.0))
            }
        }
    }
}

/// Class of a colour.
pub(super) fn colour(number: usize) -> String {
    format!("c{}", number % COLOURS)
}

/// Symbol of a line's points: its shape differs with its colour.
fn symbol(number: usize, x: f64, y: f64) -> Markup {
    const SIDE: f64 = 2.9;
    let path = match number % 4 {
        0 => return html! { circle.dot cx=(px(x)) cy=(px(y)) r=(SIDE) {} },
        1 => format!("M{} {}h{s}v{s}h-{s}z", px(x - 2.6), px(y - 2.6), s = 5.2),
        2 => format!("M{} {}l{a} {b}h-{c}z", px(x), px(y - 3.4), a = 3.4, b = 6.0, c = 6.8),
        _ => format!("M{} {}l{s} {s}l-{s} {s}l-{s} -{s}z", px(x), px(y - 3.6), s = 3.6),
    };
    html! { path.dot d=(path) {} }
}

/// A coordinate with a tenth of a pixel.
fn px(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or_else(|| text.clone(), str::to_owned)
}
