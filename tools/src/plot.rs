//! What all pictures of this program share: colours, letters, axes.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontTransform, TextStyle};
use sunfleck::document::System;

/// A rectangle of a picture.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub(crate) const INK: RGBColor = RGBColor(40, 40, 40);
pub(crate) const FAINT: RGBColor = RGBColor(225, 225, 225);
pub(crate) const SHADE: RGBColor = RGBColor(240, 243, 240);

/// Colours that people of any colour vision tell apart.
///
/// Source: Okabe and Ito (2008), "Color Universal Design".
pub(crate) const fn colour(system: System) -> RGBColor {
    match system {
        System::Backward => RGBColor(0, 114, 178),
        System::Forward => RGBColor(213, 94, 0),
        System::Analog => RGBColor(0, 158, 115),
        System::FirstOrder => RGBColor(204, 121, 167),
    }
}

/// Letters of this height, px.
pub(crate) fn letters(size: i32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&INK)
}

/// The same, placed about their point.
pub(crate) fn placed(size: i32, h: HPos, v: VPos) -> TextStyle<'static> {
    letters(size).pos(Pos::new(h, v))
}

/// The same, turned to read upwards.
pub(crate) fn upwards(size: i32) -> TextStyle<'static> {
    let font = ("sans-serif", size).into_font().transform(FontTransform::Rotate270);
    font.color(&INK).pos(Pos::new(HPos::Center, VPos::Top))
}

/// Title, and below it a coloured dot and a name for each system.
pub(crate) fn heading(area: &Area<'_>, title: &str, systems: &[System]) -> anyhow::Result<()> {
    area.draw_text(title, &placed(18, HPos::Left, VPos::Top), (16, 12))?;
    let mut x = 22;
    for &system in systems {
        let colour = colour(system);
        area.draw(&Circle::new((x, 46), 4, colour.filled()))?;
        area.draw_text(system.name(), &placed(13, HPos::Left, VPos::Center), (x + 9, 46))?;
        x += 30 + 8 * system.name().len() as i32;
    }
    Ok(())
}

/// A number on an axis.
pub(crate) fn tick(value: f64) -> String {
    let size = value.abs();
    if size < 1e-12 {
        return "0".to_owned();
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// `zenith_deg` as `zenith (°)`.
pub(crate) fn axis_title(name: &str) -> String {
    let (name, unit) = match name.rsplit_once('_') {
        Some((name, "deg")) => (name, "°"),
        Some((name, unit @ ("m" | "nm" | "s" | "sr"))) => (name, unit),
        _ => return name.replace('_', " "),
    };
    format!("{} ({unit})", name.replace('_', " "))
}

/// Smallest range that holds all numbers, and some room about them.
pub(crate) fn range_of(values: impl IntoIterator<Item = f64>) -> std::ops::Range<f64> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let room = match 0.07 * (high - low) {
        room if room > 1e-9 * high.abs() => room,
        _ if high == 0.0 => 0.5,
        _ => 0.1 * high.abs(),
    };
    low - room..high + room
}
