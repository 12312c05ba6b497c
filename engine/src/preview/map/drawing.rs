//! Shapes on a page, which `svg` and `raster` turn into files.

use glam::DVec2;

use crate::output::Letters;

/// Colour with opacity, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ink {
    pub(super) colour: [u8; 3],
    pub(super) opacity: f32,
}

/// Outline and filling of a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Paint {
    pub(super) fill: Option<Ink>,
    pub(super) stroke: Option<Stroke>,
}

/// Line around a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stroke {
    pub(super) ink: Ink,
    /// Width, pixels.
    pub(super) width: f64,
    pub(super) is_dashed: bool,
}

/// Horizontal position of a text at its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Picture of pixels on the page, red, green, blue and opacity, shape `[rows, columns, 4]`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PixelLayer {
    /// Upper left corner and extent on the page, pixels.
    pub(super) corner: DVec2,
    pub(super) extent: DVec2,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) rgba: Vec<u8>,
    /// True if colours change evenly between the middles of its pixels.
    pub(super) is_smooth: bool,
}

/// Part of a drawing; places in pixels from the upper left corner of the page.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum DrawnItem {
    Circle {
        centre: DVec2,
        radius: f64,
        paint: Paint,
    },
    /// Rings or lines; rings are filled by the even-odd rule.
    Path {
        lines: Vec<Vec<DVec2>>,
        is_closed: bool,
        paint: Paint,
    },
    Pixels(PixelLayer),
    /// A line of text; its place is the middle of its height.
    Text {
        at: DVec2,
        text: String,
        anchor: Anchor,
    },
}

/// A page.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) letters: Letters,
    /// Rectangle that `clipped` items are cut to: upper left and lower right corner.
    pub(super) frame: [DVec2; 2],
    /// Items inside the frame, lowest first.
    pub(super) clipped: Vec<DrawnItem>,
    /// Items above those, anywhere on the page.
    pub(super) over: Vec<DrawnItem>,
}

impl Ink {
    pub(super) const fn solid(colour: [u8; 3]) -> Self {
        Self { colour, opacity: 1.0 }
    }

    pub(super) const fn with_opacity(colour: [u8; 3], opacity: f32) -> Self {
        Self { colour, opacity }
    }
}

impl Paint {
    pub(super) const fn fill(ink: Ink) -> Self {
        Self { fill: Some(ink), stroke: None }
    }

    pub(super) const fn line(ink: Ink, width: f64) -> Self {
        Self { fill: None, stroke: Some(Stroke { ink, width, is_dashed: false }) }
    }

    pub(super) const fn dashes(ink: Ink, width: f64) -> Self {
        Self { fill: None, stroke: Some(Stroke { ink, width, is_dashed: true }) }
    }
}

impl DrawnItem {
    /// A straight line.
    pub(super) fn line(from: DVec2, to: DVec2, paint: Paint) -> Self {
        Self::Path { lines: vec![vec![from, to]], is_closed: false, paint }
    }

    /// An upright rectangle between two opposite corners.
    pub(super) fn rectangle(low: DVec2, high: DVec2, paint: Paint) -> Self {
        let corners = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        Self::Path { lines: vec![corners], is_closed: true, paint }
    }

    pub(super) fn text(at: DVec2, text: impl Into<String>, anchor: Anchor) -> Self {
        Self::Text { at, text: text.into(), anchor }
    }

    /// An arrow: its shaft and its head.
    pub(super) fn arrow(from: DVec2, to: DVec2, ink: Ink, width: f64) -> Vec<Self> {
        let along = (to - from).normalize_or_zero();
        let head = 5.0 * width;
        let base = to - along * head;
        let barb = along.perp() * 0.5 * head;
        let tip = vec![vec![to, base + barb, base - barb]];
        vec![
            Self::line(from, base, Paint::line(ink, width)),
            Self::Path { lines: tip, is_closed: true, paint: Paint::fill(ink) },
        ]
    }
}
