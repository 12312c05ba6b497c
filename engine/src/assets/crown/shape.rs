//! Outlines of crowns: points inside, and the way out.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::stream::Stream;
use crate::document::CrownShape;

/// The lengths that describe an outline, under their names in a scene, m.
pub(super) fn lengths(shape: &CrownShape) -> Vec<(&'static str, f64)> {
    match *shape {
        CrownShape::Ellipsoid { diameter_m, height_m }
        | CrownShape::Cone { diameter_m, height_m }
        | CrownShape::Cylinder { diameter_m, height_m }
        | CrownShape::HalfEllipsoid { diameter_m, height_m } => {
            vec![("shape.diameter_m", diameter_m), ("shape.height_m", height_m)]
        }
        // `widest_m` may be 0: see `check`.
        CrownShape::AsymmetricGaussian { diameter_m, height_m, below_m, above_m, .. } => vec![
            ("shape.diameter_m", diameter_m),
            ("shape.height_m", height_m),
            ("shape.below_m", below_m),
            ("shape.above_m", above_m),
        ],
        CrownShape::Box { size_m: (x, y, z) } => {
            vec![("shape.size_m.0", x), ("shape.size_m.1", y), ("shape.size_m.2", z)]
        }
    }
}

/// Distance from the lowest to the highest point, m.
pub(super) fn height(shape: &CrownShape) -> f64 {
    match *shape {
        CrownShape::Ellipsoid { height_m, .. }
        | CrownShape::Cone { height_m, .. }
        | CrownShape::Cylinder { height_m, .. }
        | CrownShape::HalfEllipsoid { height_m, .. }
        | CrownShape::AsymmetricGaussian { height_m, .. } => height_m,
        CrownShape::Box { size_m: (_, _, height) } => height,
    }
}

/// Heights between which the cross-section changes smoothly, m.
pub(super) fn smooth_between(shape: &CrownShape) -> Vec<f64> {
    let height = height(shape);
    match *shape {
        CrownShape::AsymmetricGaussian { widest_m, .. } => vec![0.0, widest_m, height],
        _ => vec![0.0, height],
    }
}

/// Radius of the cross-section at height `z`, m; of a box, that of the circle of the same area.
pub(super) fn radius(shape: &CrownShape, z: f64) -> f64 {
    match *shape {
        CrownShape::Ellipsoid { diameter_m, height_m } => {
            let part = 2.0 * z / height_m - 1.0;
            0.5 * diameter_m * (1.0 - part * part).max(0.0).sqrt()
        }
        CrownShape::Cone { diameter_m, height_m } => 0.5 * diameter_m * (1.0 - z / height_m),
        CrownShape::Cylinder { diameter_m, .. } => 0.5 * diameter_m,
        CrownShape::HalfEllipsoid { diameter_m, height_m } => {
            let part = z / height_m;
            0.5 * diameter_m * (1.0 - part * part).max(0.0).sqrt()
        }
        CrownShape::AsymmetricGaussian { diameter_m, widest_m, below_m, above_m, .. } => {
            let part = (z - widest_m) / if z < widest_m { below_m } else { above_m };
            0.5 * diameter_m * (-0.5 * part * part).exp()
        }
        CrownShape::Box { size_m: (x, y, _) } => (x * y / PI).sqrt(),
    }
}

/// Returns whether a point is inside the outline or on it.
pub(super) fn contains(shape: &CrownShape, point: DVec3) -> bool {
    let across = match *shape {
        CrownShape::Box { size_m: (x, y, _) } => {
            point.x.abs() <= 0.5 * x && point.y.abs() <= 0.5 * y
        }
        _ => point.truncate().length() <= radius(shape, point.z),
    };
    across && (0.0..=height(shape)).contains(&point.z)
}

/// A point uniform in the cross-section at height `z`, m.
pub(super) fn point_at(shape: &CrownShape, z: f64, random: &mut Stream) -> DVec3 {
    let mut u = || random.uniform();
    match *shape {
        CrownShape::Box { size_m: (x, y, _) } => DVec3::new(x * (u() - 0.5), y * (u() - 0.5), z),
        _ => on_circle(radius(shape, z) * u().sqrt(), u()) + DVec3::Z * z,
    }
}

fn on_circle(radius: f64, turn: f64) -> DVec3 {
    let (sin, cos) = (TAU * turn).sin_cos();
    DVec3::new(radius * cos, radius * sin, 0.0)
}

/// Returns whether [`point`] has the outline's volume in closed form.
pub(super) fn is_simple(shape: &CrownShape) -> bool {
    !matches!(shape, CrownShape::AsymmetricGaussian { .. })
}

/// A point uniform in the volume of a simple outline, m; its lowest point is at z = 0, its axis at
/// x = y = 0.
///
/// # Panics
/// If the outline is not simple.
pub(super) fn point(shape: &CrownShape, random: &mut Stream) -> DVec3 {
    let mut u = || random.uniform();
    match *shape {
        CrownShape::Ellipsoid { diameter_m, height_m } => {
            // Shells of a ball hold volume like r³, and zones of a sphere area like height.
            let (r, z) = (u().cbrt(), 2.0 * u() - 1.0);
            let ring = on_circle(0.5 * diameter_m * r * (1.0 - z * z).sqrt(), u());
            ring + DVec3::Z * (0.5 * height_m * (1.0 + r * z))
        }
        CrownShape::Cone { diameter_m, height_m } => {
            // The part above a cross-section holds volume like its height³.
            let below_tip = u().cbrt();
            let ring = on_circle(0.5 * diameter_m * below_tip * u().sqrt(), u());
            ring + DVec3::Z * (height_m * (1.0 - below_tip))
        }
        CrownShape::Cylinder { diameter_m, height_m } => {
            let ring = on_circle(0.5 * diameter_m * u().sqrt(), u());
            ring + DVec3::Z * (height_m * u())
        }
        CrownShape::HalfEllipsoid { diameter_m, height_m } => {
            let (r, z) = (u().cbrt(), u());
            let ring = on_circle(0.5 * diameter_m * r * (1.0 - z * z).sqrt(), u());
            ring + DVec3::Z * (height_m * r * z)
        }
        CrownShape::Box { size_m: (x, y, z) } => {
            DVec3::new(x * (u() - 0.5), y * (u() - 0.5), z * u())
        }
        CrownShape::AsymmetricGaussian { .. } => unreachable!("its volume has no simple inverse"),
    }
}

/// Distance from the point at height `z` on the axis, inside the outline, to the outline, m.
pub(super) fn way_out(shape: &CrownShape, z: f64, direction: DVec3) -> f64 {
    let across = direction.truncate().length();
    let caps = |height: f64| match direction.z {
        down if down < 0.0 => z / -down,
        up if up > 0.0 => (height - z) / up,
        _ => f64::INFINITY,
    };
    match *shape {
        CrownShape::Ellipsoid { diameter_m, height_m } => {
            // |s + t d| = 1 in the frame where the ellipsoid is the unit sphere.
            let scale = DVec3::new(0.5 * diameter_m, 0.5 * diameter_m, 0.5 * height_m);
            out_of_ball(z / scale.z - 1.0, direction / scale)
        }
        CrownShape::HalfEllipsoid { diameter_m, height_m } => {
            let scale = DVec3::new(0.5 * diameter_m, 0.5 * diameter_m, height_m);
            out_of_ball(z / scale.z, direction / scale).min(caps(height_m))
        }
        CrownShape::AsymmetricGaussian { diameter_m, height_m, .. } => {
            // The way out is the first crossing: the outline may bend inwards.
            let farthest = (0.5 * diameter_m / across).min(caps(height_m));
            let is_out = |way: f64| across * way > radius(shape, z + direction.z * way);
            let step = farthest / 256.0;
            let Some(first) = (1..=256).map(|i| step * f64::from(i)).find(|&way| is_out(way))
            else {
                return farthest;
            };
            let (mut inside, mut outside) = (first - step, first);
            for _ in 0..40 {
                let middle = 0.5 * (inside + outside);
                *(if is_out(middle) { &mut outside } else { &mut inside }) = middle;
            }
            inside
        }
        CrownShape::Cone { diameter_m, height_m } => {
            // Radius falls by `slope` per metre: t across = slope (height - z - t up).
            let slope = 0.5 * diameter_m / height_m;
            let closing = across + slope * direction.z;
            let side = if closing > 0.0 { slope * (height_m - z) / closing } else { f64::INFINITY };
            side.min(caps(height_m))
        }
        CrownShape::Cylinder { diameter_m, height_m } => {
            (0.5 * diameter_m / across).min(caps(height_m))
        }
        CrownShape::Box { size_m: (x, y, height) } => {
            (0.5 * x / direction.x.abs()).min(0.5 * y / direction.y.abs()).min(caps(height))
        }
    }
}

/// Way from the point at height `start` on the axis of the unit ball, along `d`, to its surface.
fn out_of_ball(start: f64, d: DVec3) -> f64 {
    let (a, half_b, c) = (d.length_squared(), start * d.z, start * start - 1.0);
    ((half_b * half_b - a * c).max(0.0).sqrt() - half_b) / a
}
