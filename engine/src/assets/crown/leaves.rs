//! Leaves: how they lean, and their shapes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::stream::{Purpose, Stream};
use super::{CrownSpec, shape};
use crate::components::{Disc, Mesh};
use crate::document::{LeafAngle, LeafShape};

/// The lengths that describe a leaf, under their names in a scene, m.
pub(super) fn lengths(leaf: &LeafShape) -> Vec<(&'static str, f64)> {
    match *leaf {
        LeafShape::Disc { radius_m } => vec![("leaf.radius_m", radius_m)],
        LeafShape::Square { side_m } => vec![("leaf.side_m", side_m)],
        LeafShape::Rhombus { length_m, width_m } => {
            vec![("leaf.length_m", length_m), ("leaf.width_m", width_m)]
        }
    }
}

/// One-sided area of a leaf, m².
pub(super) fn area(leaf: &LeafShape) -> f64 {
    match *leaf {
        LeafShape::Disc { radius_m } => PI * radius_m * radius_m,
        LeafShape::Square { side_m } => side_m * side_m,
        LeafShape::Rhombus { length_m, width_m } => 0.5 * length_m * width_m,
    }
}

/// `count` leaves of the crown.
pub(super) fn grow(crown: &CrownSpec, count: usize) -> Mesh {
    // All leaves change alike, by the root of what the count's rounding left over.
    let scale = (crown.leaf_area_m2 / (count as f64 * area(&crown.leaf))).sqrt();
    let leaves = (0..count as u64).into_par_iter();
    let diagonals = match crown.leaf {
        LeafShape::Disc { radius_m } => {
            let radius = (scale * radius_m) as f32;
            let disc = |leaf| {
                let (center, normal) = place(crown, leaf);
                Disc { center: center.as_vec3(), normal: normal.as_vec3(), radius }
            };
            return Mesh { discs: leaves.map(disc).collect(), ..Mesh::default() };
        }
        // A square is the rhombus of equal diagonals.
        LeafShape::Square { side_m } => [side_m * 2_f64.sqrt(); 2],
        LeafShape::Rhombus { length_m, width_m } => [length_m, width_m],
    };
    let [half_length, half_width] = diagonals.map(|diagonal| 0.5 * scale * diagonal);
    let corners = |leaf| -> [Vec3; 4] {
        let (center, normal) = place(crown, leaf);
        let (right, up) = normal.any_orthonormal_pair();
        let turn = TAU * Stream::new(crown.seed, Purpose::Turn, leaf).uniform();
        let along = right * turn.cos() + up * turn.sin();
        let across = normal.cross(along);
        let (long, wide) = (half_length * along, half_width * across);
        [center + long, center + wide, center - long, center - wide].map(DVec3::as_vec3)
    };
    let vertices = leaves.clone().map(corners).collect::<Vec<_>>().into_flattened();
    // Two triangles that share a diagonal: what a ray engine can take as one parallelogram.
    let triangles = (0..count as u32).into_par_iter().map(|leaf| {
        let first = 4 * leaf;
        [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    });
    let triangles = triangles.collect::<Vec<_>>().into_flattened();
    Mesh { vertices, triangles, ..Mesh::default() }
}

/// Centre and unit normal of a leaf.
fn place(crown: &CrownSpec, leaf: u64) -> (DVec3, DVec3) {
    let mut random = Stream::new(crown.seed, Purpose::Position, leaf);
    let center = shape::point(&crown.shape, &mut random) + DVec3::Z * crown.base_m;
    let normal = normal(&crown.leaf_angle, &mut Stream::new(crown.seed, Purpose::Normal, leaf));
    (center, normal)
}

/// Unit normal of a leaf, to either side with probability 1/2.
pub(super) fn normal(distribution: &LeafAngle, random: &mut Stream) -> DVec3 {
    let side = if random.uniform() < 0.5 { 1.0 } else { -1.0 };
    let (sin_azimuth, cos_azimuth) = (TAU * random.uniform()).sin_cos();
    let (sin, cos) = match distribution {
        LeafAngle::Spherical => {
            let cos = 1.0 - random.uniform();
            ((1.0 - cos * cos).sqrt(), cos)
        }
        other => inclination(other, random).sin_cos(),
    };
    side * DVec3::new(sin * cos_azimuth, sin * sin_azimuth, cos)
}

/// Angle between normal and zenith, 0 to π/2, of a distribution `g(θ) = (2/π)(1 + f(θ))` with
/// |f| ≤ 1, by rejection: every second angle is taken on average.
fn inclination(distribution: &LeafAngle, random: &mut Stream) -> f64 {
    loop {
        let theta = FRAC_PI_2 * random.uniform();
        let density = match distribution {
            // Spherical leaves have their exact inverse above; this is g(θ) = sin θ all the same.
            LeafAngle::Spherical => 2.0 * theta.sin(),
            LeafAngle::Uniform => return theta,
            LeafAngle::Planophile => 1.0 + (2.0 * theta).cos(),
            LeafAngle::Erectophile => 1.0 - (2.0 * theta).cos(),
            LeafAngle::Plagiophile => 1.0 - (4.0 * theta).cos(),
            LeafAngle::Extremophile => 1.0 + (4.0 * theta).cos(),
        };
        if 2.0 * random.uniform() < density {
            return theta;
        }
    }
}
