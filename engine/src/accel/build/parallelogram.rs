//! Detection of parallelograms: pairs of triangles that are traced as one primitive.

use std::num::NonZeroU32;

use glam::Vec3;
use rayon::prelude::*;

use crate::components::Mesh;

/// Triangle with an area, or parallelogram of two triangles.
#[derive(Clone, Copy)]
pub(super) struct PlanarPrimitive {
    pub first: u32,
    /// Second triangle of a parallelogram, which is never triangle 0.
    pub second: Option<NonZeroU32>,
}

/// Planar primitives of a mesh, in the order of their first triangles.
pub(super) fn planar_primitives(mesh: &Mesh) -> Vec<PlanarPrimitive> {
    let seconds = pairs(mesh);
    let triangles = seconds.par_iter().enumerate();
    triangles
        .filter_map(|(triangle, &second)| {
            let first = triangle as u32;
            match second {
                TAKEN => None,
                ALONE => has_area(mesh.corners(triangle))
                    .then_some(PlanarPrimitive { first, second: None }),
                second => Some(PlanarPrimitive { first, second: NonZeroU32::new(second) }),
            }
        })
        .collect()
}

/// Corners of a triangle, or the first three of a parallelogram.
pub(super) fn corners(mesh: &Mesh, first: u32, second: Option<u32>) -> [Vec3; 3] {
    second
        .and_then(|second| parallelogram(mesh, first as usize, second as usize))
        .map_or_else(|| mesh.corners(first as usize), |(corners, _)| corners)
}

/// Tolerance of a parallelogram's fourth corner, as a fraction of the shorter edge, where rounding to
/// six decimals would allow more.
const MAX_SKEW: f64 = 1.0 / 4096.0;

/// Mark of a triangle that is not part of a parallelogram.
const ALONE: u32 = u32::MAX;
/// Mark of the second triangle of a parallelogram.
const TAKEN: u32 = u32::MAX - 1;

/// Second triangle of each triangle that a parallelogram begins with, or [`ALONE`] or [`TAKEN`]; both belong to one
/// part of the mesh. Shape `[triangles]`.
fn pairs(mesh: &Mesh) -> Vec<u32> {
    let mut uses = vec![0_u8; mesh.vertices.len()];
    for &corner in mesh.triangles.iter().flatten() {
        uses[corner as usize] = uses[corner as usize].saturating_add(1);
    }
    let part = |triangle: u32| mesh.parts.partition_point(|part| part.triangles.end <= triangle);
    let fits = |first: u32, second: u32| {
        part(first) == part(second)
            && parallelogram(mesh, first as usize, second as usize).is_some_and(|(_, fourth)| {
                // If it is not the fourth corner exactly, a ray could pass between this
                // parallelogram and a neighbour that uses the true corner.
                fourth.is_exact || uses[fourth.vertex as usize] == 1
            })
    };
    let mut seconds = vec![ALONE; mesh.triangles.len()];
    let join = |seconds: &mut Vec<u32>, first: u32, second: u32| {
        let free = |triangle: u32| seconds[triangle as usize] == ALONE;
        if free(first) && free(second) && fits(first, second) {
            seconds[first as usize] = second;
            seconds[second as usize] = TAKEN;
        }
    };
    // Most files write the two triangles of a leaf one after the other.
    for second in 1..mesh.triangles.len() as u32 {
        join(&mut seconds, second - 1, second);
    }
    for (first, second) in neighbours(mesh, &seconds) {
        join(&mut seconds, first, second);
    }
    seconds
}

/// Pairs of triangles that share an edge and are not part of a parallelogram yet: the lower number first, sorted.
fn neighbours(mesh: &Mesh, seconds: &[u32]) -> Vec<(u32, u32)> {
    let mut edges: Vec<([u32; 2], u32)> = mesh
        .triangles
        .par_iter()
        .enumerate()
        .filter(|&(index, _)| seconds[index] == ALONE)
        .flat_map_iter(|(index, corners)| {
            (0..3).map(move |k| {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                ([a.min(b), a.max(b)], index as u32)
            })
        })
        .collect();
    edges.par_sort_unstable();
    let mut pairs: Vec<_> = edges
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0)
        .map(|pair| (pair[0].1, pair[1].1))
        .collect();
    drop(edges);
    pairs.par_sort_unstable();
    pairs
}

/// Fourth corner of a parallelogram.
struct Fourth {
    vertex: u32,
    /// `true` if it equals `b + c - a` without rounding.
    is_exact: bool,
}

/// Corners of the parallelogram that two triangles form within rounding: the apex of the first, then the
/// diagonal in the orientation of the first, then the fourth corner.
fn parallelogram(mesh: &Mesh, first: usize, second: usize) -> Option<([Vec3; 3], Fourth)> {
    let (triangle, other) = (mesh.triangles[first], mesh.triangles[second]);
    let (turn, vertex) = (0..3).find_map(|i| {
        let (b, c) = (triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
        (0..3).find(|&k| other[k] == c && other[(k + 1) % 3] == b).map(|k| (i, other[(k + 2) % 3]))
    })?;
    let corners = [0, 1, 2].map(|k| mesh.vertices[triangle[(turn + k) % 3] as usize]);
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let fourth = mesh.vertices[vertex as usize].as_dvec3();
    let ideal = b + c - a;
    // Corners are rounded to f32, and before that, in a text file, to six decimals as a rule.
    let rounding = f64::from(f32::EPSILON) * (a.abs() + b.abs() + c.abs()) + 4.0 * 0.5e-6;
    let shortest = (b - a).length().min((c - a).length());
    let off = (ideal - fourth).abs();
    let is_close = off.cmple(rounding).all() && off.max_element() <= MAX_SKEW * shortest;
    let is_exact = ideal == fourth;
    (has_area(corners) && is_close).then_some((corners, Fourth { vertex, is_exact }))
}

fn has_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).length_squared() > 0.0
}
