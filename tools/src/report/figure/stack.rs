//! Stacked bars: parts of a whole.

use maud::{Markup, html};

use super::{colour, px};
use crate::report::words::cut;

const WIDTH: f64 = 400.0;
const LEFT: f64 = 74.0;
const ROW: f64 = 26.0;

/// A bar and its parts.
#[derive(Clone, Debug)]
pub(crate) struct Bar {
    pub(crate) name: String,
    pub(crate) segments: Vec<Segment>,
}

/// A part of a bar.
#[derive(Clone, Debug)]
pub(crate) struct Segment {
    /// Number of its colour.
    pub(crate) colour: usize,
    pub(crate) size: f64,
    /// Text inside it, if there is room.
    pub(crate) label: String,
    pub(crate) tooltip: String,
}

/// Draws bars one below the other; the longest is as wide as the drawing.
pub(crate) fn stack(bars: &[Bar], alternative: &str) -> Markup {
    let length = |bar: &Bar| bar.segments.iter().map(|one| one.size.max(0.0)).sum::<f64>();
    let longest = bars.iter().map(length).fold(0.0, f64::max);
    let scale = if longest > 0.0 { (WIDTH - LEFT - 6.0) / longest } else { 0.0 };
    let height = ROW * bars.len() as f64 + 8.0;
    html! {
        svg.stack viewBox={ "0 0 " (WIDTH) " " (height) } role="img" aria-label=(cut(alternative, 300)) {
            @for (row, bar) in bars.iter().enumerate() {
                @let top = 4.0 + ROW * row as f64;
                text x=(px(LEFT - 6.0)) y=(px(top + 16.0)) text-anchor="end" { (cut(&bar.name, 11)) }
                @for (segment, left) in placed(bar, scale) {
                    @let width = segment.size * scale;
                    g class=(colour(segment.colour)) {
                        title { (segment.tooltip) }
                        rect.part x=(px(left)) y=(px(top)) width=(format!("{width:.2}")) height=(px(ROW - 4.0)) {}
                        @if width > 7.5 * segment.label.chars().count() as f64 {
                            text.inside x=(px(left + 0.5 * width)) y=(px(top + 15.5)) text-anchor="middle" { (segment.label) }
                        }
                    }
                }
            }
        }
    }
}

/// Segments with their left ends.
fn placed(bar: &Bar, scale: f64) -> Vec<(&Segment, f64)> {
    let mut left = LEFT;
    let mut all = Vec::new();
    for segment in bar.segments.iter().filter(|segment| segment.size > 0.0) {
        all.push((segment, left));
        left += segment.size * scale;
    }
    all
}
