//! Colours, letters and axes of all charts of this program.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontTransform, TextStyle};
use sunfleck::document::System;
pub(crate) use sunfleck::output::{axis_title, range_of, tick};

/// A rectangle of a picture.
pub(crate) type PlotArea<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub(crate) const INK: RGBColor = RGBColor(40, 40, 40);
pub(crate) const FAINT: RGBColor = RGBColor(225, 225, 225);
pub(crate) const SHADE: RGBColor = RGBColor(240, 243, 240);

/// Colours that can be distinguished with any colour vision.
///
/// Source: Okabe and Ito (2008), "Color Universal Design".
pub(crate) const fn colour(system: System) -> RGBColor {
    match system {
        System::Backward => RGBColor(0, 114, 178),
        System::Forward => RGBColor(213, 94, 0),
        System::Analog => RGBColor(0, 158, 115),
        System::FirstOrder => RGBColor(204, 121, 167),
        System::Reference => RGBColor(86, 180, 233),
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
pub(crate) fn heading(area: &PlotArea<'_>, title: &str, systems: &[System]) -> anyhow::Result<()> {
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
