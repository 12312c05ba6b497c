//! Frame of a map: its projection, coordinates, scale bar and north arrow.

use glam::{DVec2, DVec3};

use super::drawing::{Anchor, DrawnItem, Ink, Paint};
use crate::geometry::Rectangle;
use crate::output::{INK, Letters};

/// Places of the local frame to places on the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct PageProjection {
    /// Part of the local frame that the map shows, m.
    pub(super) shown: Rectangle,
    /// Upper left and lower right corner on the page, pixels.
    pub(super) frame: [DVec2; 2],
    /// Pixels per metre.
    pub(super) scale: f64,
}

impl PageProjection {
    /// Map of a part of the local frame whose longer side is `side` pixels long.
    pub(super) fn new(shown: Rectangle, corner: DVec2, side: f64) -> Self {
        let scale = side / shown.size().max_element();
        Self { shown, frame: [corner, corner + scale * shown.size()], scale }
    }

    /// Place on the page, pixels.
    pub(super) fn page(&self, place: DVec2) -> DVec2 {
        let Rectangle { min, max } = self.shown;
        self.frame[0] + self.scale * DVec2::new(place.x - min.x, max.y - place.y)
    }
}

/// Smallest of 1, 2 and 5 times a power of ten that is not below a length; 1 without a length.
pub(super) fn round_step(length: f64) -> f64 {
    if !(length.is_finite() && length > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(length.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= length * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

/// A length or a coordinate with as many digits as a step needs.
pub(super) fn metres(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.digits$}");
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        "0".to_owned()
    } else {
        text
    }
}

/// Ticks with coordinates along the western and the southern side; `origin` is added to those of the local frame.
pub(super) fn coordinates(
    projection: &PageProjection,
    origin: DVec3,
    letters: Letters,
) -> Vec<DrawnItem> {
    let PageProjection { shown, frame: [low, high], .. } = *projection;
    let size = shown.size();
    let room = 12.0 * letters.width() as f64;
    let mut items = Vec::new();
    let paint = Paint::line(Ink::solid(INK), 1.0);
    for axis in 0..2 {
        let ticks = ((high - low)[axis] / room).clamp(1.0, 8.0);
        let step = round_step(size[axis] / ticks);
        let (from, to) = (shown.min[axis] + origin[axis], shown.max[axis] + origin[axis]);
        let mut number = (from / step - 1e-9).ceil();
        while number * step <= to + 1e-9 * step {
            let value = number * step;
            let mut at = shown.min;
            at[axis] = value - origin[axis];
            let page = projection.page(at);
            let (end, text, anchor) = if axis == 0 {
                let end = page + DVec2::new(0.0, 6.0);
                (end, end + DVec2::new(0.0, 0.7 * letters.height() as f64), Anchor::Middle)
            } else {
                let end = page - DVec2::new(6.0, 0.0);
                (end, end - DVec2::new(4.0, 0.0), Anchor::End)
            };
            items.push(DrawnItem::line(page, end, paint));
            items.push(DrawnItem::text(text, metres(value, step), anchor));
            number += 1.0;
        }
    }
    items
}

/// Number of letters of the widest coordinate on the western side.
pub(super) fn widest_coordinate(shown: Rectangle, origin: DVec3) -> usize {
    let step = round_step(shown.size().y / 5.0);
    let ends = [shown.min.y, shown.max.y].map(|y| metres(y + origin.y, step).len());
    ends.into_iter().max().unwrap_or(1)
}

/// A scale bar with its left end at a place.
pub(super) fn scale_bar(projection: &PageProjection, at: DVec2) -> Vec<DrawnItem> {
    let mut length = round_step(projection.shown.size().x / 5.0);
    // On a narrow map the next rounder number can be too long.
    while length * projection.scale > 0.5 * (projection.frame[1] - projection.frame[0]).x {
        length /= 2.0;
    }
    let pixels = length * projection.scale;
    let half = DVec2::new(0.5 * pixels, 0.0);
    let thick = DVec2::new(0.0, 6.0);
    let outline = Paint { fill: Some(Ink::solid([255; 3])), ..Paint::line(Ink::solid(INK), 1.0) };
    vec![
        DrawnItem::rectangle(at, at + 2.0 * half + thick, outline),
        DrawnItem::rectangle(at, at + half + thick, Paint::fill(Ink::solid(INK))),
        DrawnItem::text(
            at + 2.0 * half + DVec2::new(8.0, 3.0),
            format!("{} m", metres(length, length)),
            Anchor::Start,
        ),
    ]
}

/// An arrow to the north with its foot at a place.
pub(super) fn north_arrow(at: DVec2, letters: Letters) -> Vec<DrawnItem> {
    let tip = at - DVec2::new(0.0, 2.2 * letters.height() as f64);
    let mut items = DrawnItem::arrow(at, tip, Ink::solid(INK), 2.0);
    let above = tip - DVec2::new(0.0, 0.6 * letters.height() as f64);
    items.push(DrawnItem::text(above, "N", Anchor::Middle));
    items
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round_and_not_below_the_length() {
        let steps = [0.03, 0.2, 0.21, 1.0, 7.0, 34.0, 99.0, 0.0, f64::NAN].map(round_step);
        let known = [0.05, 0.2, 0.5, 1.0, 10.0, 50.0, 100.0, 1.0, 1.0];
        let off = steps.iter().zip(known).map(|(step, known)| (step / known - 1.0).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12, "{steps:?}");
    }

    #[test]
    fn coordinates_have_the_digits_of_their_step() {
        assert_eq!(metres(400_012.5, 0.5), "400012.5");
        assert_eq!(metres(400_012.5, 10.0), "400012");
        assert_eq!(metres(-0.000_1, 0.5), "0");
    }

    #[test]
    fn north_is_up_and_east_is_right() {
        let shown = Rectangle { min: DVec2::new(10.0, 20.0), max: DVec2::new(30.0, 30.0) };
        let projection = PageProjection::new(shown, DVec2::new(5.0, 7.0), 100.0);
        assert_eq!(projection.page(DVec2::new(10.0, 30.0)), DVec2::new(5.0, 7.0));
        assert_eq!(projection.page(DVec2::new(30.0, 20.0)), DVec2::new(105.0, 57.0));
    }
}
