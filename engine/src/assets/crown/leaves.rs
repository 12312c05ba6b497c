//! Leaves and their shapes.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::angles::Normals;
use super::places::Places;
use super::stream::{Purpose, Stream};
use super::wood::golden_angle;
use super::{CrownError, CrownSpec, apart};
use crate::components::{Disc, Mesh};
use crate::document::LeafShape;

/// The lengths that describe a leaf, under their names in a scene, m.
pub(super) fn lengths(leaf: &LeafShape) -> Vec<(&'static str, f64)> {
    match *leaf {
        LeafShape::Disc { radius_m } => vec![("leaf.radius_m", radius_m)],
        LeafShape::Square { side_m } => vec![("leaf.side_m", side_m)],
        LeafShape::Rhombus { length_m, width_m } => {
            vec![("leaf.length_m", length_m), ("leaf.width_m", width_m)]
        }
        LeafShape::Shoot { length_m, needle_length_m, needle_width_m, .. } => vec![
            ("leaf.length_m", length_m),
            ("leaf.needle_length_m", needle_length_m),
            ("leaf.needle_width_m", needle_width_m),
        ],
    }
}

/// One-sided area of a leaf or of all needles of a shoot, m².
pub(super) fn area(leaf: &LeafShape) -> f64 {
    match *leaf {
        LeafShape::Disc { radius_m } => PI * radius_m * radius_m,
        LeafShape::Square { side_m } => side_m * side_m,
        LeafShape::Rhombus { length_m, width_m } => 0.5 * length_m * width_m,
        LeafShape::Shoot { needles, needle_length_m, needle_width_m, .. } => {
            f64::from(needles) * needle_length_m * needle_width_m
        }
    }
}

/// Flat pieces that a leaf is made of.
pub(super) fn pieces(leaf: &LeafShape) -> u32 {
    match *leaf {
        LeafShape::Shoot { needles, .. } => needles,
        _ => 1,
    }
}

/// `count` leaves of the crown.
///
/// # Errors
/// Leaves that find no place apart from the others.
pub(super) fn grow(
    crown: &CrownSpec,
    count: usize,
    places: &Places<'_>,
    normals: &Normals,
) -> Result<Mesh, CrownError> {
    // All leaves change alike, by the root of what the count's rounding left over.
    let scale = (crown.leaf_area_m2 / (count as f64 * area(&crown.leaf))).sqrt();
    let leaves = (0..count as u64).into_par_iter();
    let center = |leaf| places.of(leaf) + DVec3::Z * crown.base_m;
    let normal = |leaf| normals.draw(&mut Stream::new(crown.seed, Purpose::Normal, leaf));
    // Normal, and two unit vectors across it.
    let frame = |leaf| {
        let normal = normal(leaf);
        let (right, up) = normal.any_orthonormal_pair();
        let turn = TAU * Stream::new(crown.seed, Purpose::Turn, leaf).uniform();
        let along = right * turn.cos() + up * turn.sin();
        (normal, along, normal.cross(along))
    };
    let rhombi = |[length, width]: [f64; 2]| -> Result<Vec<[Vec3; 4]>, CrownError> {
        let (half_length, half_width) = (0.5 * scale * length, 0.5 * scale * width);
        let rhombus = |leaf| {
            let (_, along, across) = frame(leaf);
            let (long, wide) = (half_length * along, half_width * across);
            move |center: DVec3| {
                let corners = [center + long, center + wide, center - long, center - wide];
                [corners.map(DVec3::as_vec3)]
            }
        };
        if !crown.has_independent_leaves() {
            return apart::place(crown, count, places, rhombus);
        }
        let rhombi = leaves.clone().map(|leaf| rhombus(leaf)(center(leaf)));
        Ok(rhombi.collect::<Vec<_>>().into_flattened())
    };
    match crown.leaf {
        LeafShape::Disc { radius_m } => {
            let radius = (scale * radius_m) as f32;
            let disc = |leaf| {
                let normal = normal(leaf).as_vec3();
                move |center: DVec3| [Disc { center: center.as_vec3(), normal, radius }]
            };
            let discs = if crown.has_independent_leaves() {
                let discs = leaves.map(|leaf| disc(leaf)(center(leaf)));
                discs.collect::<Vec<_>>().into_flattened()
            } else {
                apart::place(crown, count, places, disc)?
            };
            Ok(Mesh { discs, ..Mesh::default() })
        }
        // A square is the rhombus of equal diagonals.
        LeafShape::Square { side_m } => Ok(quads(rhombi([side_m * 2_f64.sqrt(); 2])?)),
        LeafShape::Rhombus { length_m, width_m } => Ok(quads(rhombi([length_m, width_m])?)),
        LeafShape::Shoot {
            length_m,
            needles,
            needle_length_m,
            needle_width_m,
            needle_angle_deg,
        } => {
            let (sin, cos) = needle_angle_deg.to_radians().sin_cos();
            let half_width = 0.5 * scale * needle_width_m;
            let shoot = |leaf| {
                let (normal, along, across) = frame(leaf);
                move |center: DVec3| {
                    (0..needles).map(move |needle| -> [Vec3; 4] {
                        let part = (f64::from(needle) + 0.5) / f64::from(needles) - 0.5;
                        let (sin_turn, cos_turn) = (golden_angle() * f64::from(needle)).sin_cos();
                        let outwards = cos_turn * normal + sin_turn * across;
                        let base = center + scale * length_m * part * along;
                        let tip = base + scale * needle_length_m * (cos * along + sin * outwards);
                        let wide = half_width * along.cross(outwards);
                        [base + wide, base - wide, tip - wide, tip + wide].map(DVec3::as_vec3)
                    })
                }
            };
            Ok(quads(if crown.has_independent_leaves() {
                leaves.flat_map_iter(|leaf| shoot(leaf)(center(leaf))).collect()
            } else {
                apart::place(crown, count, places, shoot)?
            }))
        }
    }
}

/// Parallelograms by their corners.
fn quads(corners: Vec<[Vec3; 4]>) -> Mesh {
    let vertices = corners.into_flattened();
    // Two triangles that share a diagonal: what a ray engine can take as one parallelogram.
    let triangles = (0..vertices.len() as u32 / 4).into_par_iter().map(|quad| {
        let first = 4 * quad;
        [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    });
    let triangles = triangles.collect::<Vec<_>>().into_flattened();
    Mesh { vertices, triangles, ..Mesh::default() }
}
