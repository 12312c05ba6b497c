//! Outlines of crowns: points inside, and the way out.

use std::f64::consts::TAU;

use glam::DVec3;

use super::stream::Stream;
use crate::document::CrownShape;

/// The lengths that describe an outline, under their names in a scene, m.
pub(super) fn lengths(shape: &CrownShape) -> Vec<(&'static str, f64)> {
    match *shape {
        CrownShape::Ellipsoid { diameter_m, height_m }
        | CrownShape::Cone { diameter_m, height_m }
        | CrownShape::Cylinder { diameter_m, height_m } => {
            vec![("shape.diameter_m", diameter_m), ("shape.height_m", height_m)]
        }
        CrownShape::Box { size_m: (x, y, z) } => {
            vec![("shape.size_m.0", x), ("shape.size_m.1", y), ("shape.size_m.2", z)]
        }
    }
}

/// From the lowest to the highest point, m.
pub(super) fn height(shape: &CrownShape) -> f64 {
    match *shape {
        CrownShape::Ellipsoid { height_m, .. }
        | CrownShape::Cone { height_m, .. }
        | CrownShape::Cylinder { height_m, .. } => height_m,
        CrownShape::Box { size_m: (_, _, height) } => height,
    }
}

/// A point uniform in the outline's volume, m; its lowest point is at z = 0, its axis at x = y = 0.
pub(super) fn point(shape: &CrownShape, random: &mut Stream) -> DVec3 {
    let mut u = || random.uniform();
    let on_circle = |radius: f64, turn: f64| {
        let (sin, cos) = (TAU * turn).sin_cos();
        DVec3::new(radius * cos, radius * sin, 0.0)
    };
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
        CrownShape::Box { size_m: (x, y, z) } => {
            DVec3::new(x * (u() - 0.5), y * (u() - 0.5), z * u())
        }
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
            let (start, d) = (z / scale.z - 1.0, direction / scale);
            let (a, half_b, c) = (d.length_squared(), start * d.z, start * start - 1.0);
            ((half_b * half_b - a * c).max(0.0).sqrt() - half_b) / a
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
