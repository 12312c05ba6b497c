//! Leaves and their shapes.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::angles::Normals;
use super::apart::Flat;
use super::places::Places;
use super::stream::{Purpose, Stream};
use super::wood::golden_angle;
use super::{CrownError, GeneratedCrown, apart, has_independent_leaves};
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
    crown: &GeneratedCrown,
    count: usize,
    places: &Places<'_>,
    normals: &Normals,
) -> Result<Mesh, CrownError> {
    // All leaves change alike, by the root of what the count's rounding left over.
    let scale = (crown.leaf_area_m2 / (count as f64 * area(&crown.leaf))).sqrt();
    let foliage = Foliage { crown, count, places, normals };
    match crown.leaf {
        LeafShape::Disc { radius_m } => {
            let discs = foliage.discs((scale * radius_m) as f32)?;
            Ok(Mesh { discs, ..Mesh::default() })
        }
        // A square is the rhombus of equal diagonals.
        LeafShape::Square { side_m } => Ok(quads(
            foliage.rhombi([side_m * 2_f64.sqrt(); 2].map(|length| 0.5 * scale * length))?,
        )),
        LeafShape::Rhombus { length_m, width_m } => {
            Ok(quads(foliage.rhombi([length_m, width_m].map(|length| 0.5 * scale * length))?))
        }
        LeafShape::Shoot {
            length_m,
            needles,
            needle_length_m,
            needle_width_m,
            needle_angle_deg,
        } => Ok(quads(foliage.shoots(Needles {
            count: needles,
            twig: scale * length_m,
            length: scale * needle_length_m,
            half_width: 0.5 * scale * needle_width_m,
            angle: needle_angle_deg.to_radians(),
        })?)),
    }
}

/// Leaves of a crown: where they are, and how they are turned.
struct Foliage<'a> {
    crown: &'a GeneratedCrown,
    count: usize,
    places: &'a Places<'a>,
    normals: &'a Normals,
}

impl Foliage<'_> {
    fn leaves(&self) -> impl IndexedParallelIterator<Item = u64> {
        (0..self.count).into_par_iter().map(|leaf| leaf as u64)
    }

    fn center(&self, leaf: u64) -> DVec3 {
        self.places.of(leaf) + DVec3::Z * self.crown.base_m
    }

    fn normal(&self, leaf: u64) -> DVec3 {
        self.normals.draw(&mut Stream::new(self.crown.seed, Purpose::Normal, leaf))
    }

    /// Normal, and two unit vectors across it.
    fn frame(&self, leaf: u64) -> [DVec3; 3] {
        let normal = self.normal(leaf);
        let (right, up) = normal.any_orthonormal_pair();
        let turn = TAU * Stream::new(self.crown.seed, Purpose::Turn, leaf).uniform();
        let along = right * turn.cos() + up * turn.sin();
        [normal, along, normal.cross(along)]
    }

    /// Leaves of one flat piece each.
    fn single_pieces<F, L>(&self, leaf: impl Fn(u64) -> L + Sync) -> Result<Vec<F>, CrownError>
    where
        F: Flat + Send,
        L: Fn(DVec3) -> [F; 1],
    {
        if !has_independent_leaves(self.crown) {
            return apart::place(self.crown, self.count, self.places, leaf);
        }
        let pieces = self.leaves().map(|index| leaf(index)(self.center(index)));
        Ok(pieces.collect::<Vec<_>>().into_flattened())
    }

    fn discs(&self, radius: f32) -> Result<Vec<Disc>, CrownError> {
        self.single_pieces(|leaf| {
            let normal = self.normal(leaf).as_vec3();
            move |center: DVec3| [Disc { center: center.as_vec3(), normal, radius }]
        })
    }

    /// Rhombi with these halves of their diagonals, m.
    fn rhombi(&self, [half_length, half_width]: [f64; 2]) -> Result<Vec<[Vec3; 4]>, CrownError> {
        self.single_pieces(|leaf| {
            let [_, along, across] = self.frame(leaf);
            let (long, wide) = (half_length * along, half_width * across);
            move |center: DVec3| {
                let corners = [center + long, center + wide, center - long, center - wide];
                [corners.map(DVec3::as_vec3)]
            }
        })
    }

    fn shoots(&self, needles: Needles) -> Result<Vec<[Vec3; 4]>, CrownError> {
        let shoot = |leaf| {
            let frame = self.frame(leaf);
            move |center: DVec3| needles.corners(frame, center)
        };
        if !has_independent_leaves(self.crown) {
            return apart::place(self.crown, self.count, self.places, shoot);
        }
        Ok(self.leaves().flat_map_iter(|leaf| shoot(leaf)(self.center(leaf))).collect())
    }
}

/// Needles of a shoot: flat rectangles in a spiral around a twig. Lengths in m.
#[derive(Clone, Copy)]
struct Needles {
    count: u32,
    /// Length of the twig.
    twig: f64,
    length: f64,
    half_width: f64,
    /// Angle between needle and twig, rad.
    angle: f64,
}

impl Needles {
    /// Corners of the needles of a shoot with this normal, twig and vector across it.
    fn corners(
        self,
        [normal, along, across]: [DVec3; 3],
        center: DVec3,
    ) -> impl Iterator<Item = [Vec3; 4]> {
        let (sin, cos) = self.angle.sin_cos();
        (0..self.count).map(move |needle| {
            let part = (f64::from(needle) + 0.5) / f64::from(self.count) - 0.5;
            let (sin_turn, cos_turn) = (golden_angle() * f64::from(needle)).sin_cos();
            let outwards = cos_turn * normal + sin_turn * across;
            let base = center + self.twig * part * along;
            let tip = base + self.length * (cos * along + sin * outwards);
            let wide = self.half_width * along.cross(outwards);
            [base + wide, base - wide, tip - wide, tip + wide].map(DVec3::as_vec3)
        })
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
