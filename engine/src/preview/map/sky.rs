//! Sky of a map: the sun and the directions of views about the zenith.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::drawing::{Anchor, DrawnItem, Ink, Paint};
use crate::components::View;
use crate::output::{INK, Letters};

const SUN: [u8; 3] = [240, 170, 0];
const VIEW: [u8; 3] = [150, 0, 70];

/// Directions that are drawn as arrows; more are dots.
const MOST_ARROWS: usize = 6;

/// Draws the sky as a disc: zenith in the middle, horizon on the rim, north up, east to the right. The sun's arrow goes the
/// way of its light, those of views towards their sensors.
pub(super) fn draw(
    centre: DVec2,
    radius: f64,
    sun: Option<DVec3>,
    views: &[View],
    letters: Letters,
) -> Vec<DrawnItem> {
    let thin = Paint::line(Ink::with_opacity(INK, 0.35), 0.8);
    let mut items: Vec<DrawnItem> = [1.0 / 3.0, 2.0 / 3.0]
        .map(|part| DrawnItem::Circle { centre, radius: part * radius, paint: thin })
        .into();
    let rim = Paint::line(Ink::solid(INK), 1.2);
    items.push(DrawnItem::Circle { centre, radius, paint: rim });
    for direction in [DVec2::X, DVec2::Y] {
        items.push(DrawnItem::line(centre - radius * direction, centre + radius * direction, thin));
    }
    let beyond = radius + 0.7 * letters.height() as f64;
    for (name, x, y) in [("N", 0.0, -1.0), ("E", 1.0, 0.0), ("S", 0.0, 1.0), ("W", -1.0, 0.0)] {
        items.push(DrawnItem::text(centre + beyond * DVec2::new(x, y), name, Anchor::Middle));
    }
    let place = |zenith: f64, azimuth: f64| {
        let (sin, cos) = azimuth.sin_cos();
        centre + radius * (zenith / FRAC_PI_2).min(1.0) * DVec2::new(sin, -cos)
    };
    let places = distinct(views.iter().map(|view| place(view.zenith, view.azimuth)));
    let ink = Ink::solid(VIEW);
    for &at in &places {
        if places.len() <= MOST_ARROWS && at.distance(centre) > 12.0 {
            items.extend(DrawnItem::arrow(centre, at, ink, 1.6));
        } else {
            items.push(DrawnItem::Circle { centre: at, radius: 2.2, paint: Paint::fill(ink) });
        }
    }
    if let Some(direction) = sun {
        let at = place(direction.z.clamp(-1.0, 1.0).acos(), direction.x.atan2(direction.y));
        if at.distance(centre) > 24.0 {
            let along = (centre - at).normalize_or_zero();
            items.extend(DrawnItem::arrow(at, centre - 4.0 * along, Ink::solid(SUN), 2.4));
        }
        let paint =
            Paint { fill: Some(Ink::solid([255, 205, 40])), ..Paint::line(Ink::solid(SUN), 1.5) };
        items.push(DrawnItem::Circle { centre: at, radius: 7.0, paint });
    }
    items
}

/// Places on the page that differ by half a pixel or more.
fn distinct(places: impl Iterator<Item = DVec2>) -> Vec<DVec2> {
    let mut cells: Vec<[i64; 2]> =
        places.map(|at| (2.0 * at).round().to_array().map(|value| value as i64)).collect();
    cells.sort_unstable();
    cells.dedup();
    cells.into_iter().map(|[x, y]| 0.5 * DVec2::new(x as f64, y as f64)).collect()
}
