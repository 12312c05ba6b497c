//! Triangles with an area, two at a time where they form a parallelogram.

use std::num::NonZeroU32;

use glam::Vec3;
use rayon::prelude::*;

use crate::components::Mesh;

/// The planar primitives of a mesh, in the order of their first triangles: each one's triangle, and
/// the second one of a parallelogram.
pub(super) fn primitives(mesh: &Mesh) -> Vec<(u32, Option<NonZeroU32>)> {
    let seconds = pairs(mesh);
    let triangles = seconds.par_iter().enumerate();
    triangles
        .filter_map(|(first, &second)| match second {
            TAKEN => None,
            ALONE => has_area(mesh.corners(first)).then_some((first as u32, None)),
            second => Some((first as u32, NonZeroU32::new(second))),
        })
        .collect()
}

/// The corners of a triangle, or those of a parallelogram but the fourth.
pub(super) fn corners(mesh: &Mesh, first: u32, second: Option<u32>) -> [Vec3; 3] {
    second
        .and_then(|second| parallelogram(mesh, first as usize, second as usize))
        .map_or_else(|| mesh.corners(first as usize), |(corners, _)| corners)
}

/// By how much of its shorter edge a parallelogram's fourth corner may be off, where rounding to
/// six decimals would allow more.
const SAME_SHAPE: f64 = 1.0 / 4096.0;

/// A triangle that is none of two.
const ALONE: u32 = u32::MAX;
/// A triangle that is the second of two.
const TAKEN: u32 = u32::MAX - 1;

/// For each triangle the one that completes it to a parallelogram, of the same part.
fn pairs(mesh: &Mesh) -> Vec<u32> {
    let mut uses = vec![0_u8; mesh.vertices.len()];
    for &corner in mesh.triangles.iter().flatten() {
        uses[corner as usize] = uses[corner as usize].saturating_add(1);
    }
    let part = |triangle: u32| mesh.parts.partition_point(|part| part.triangles.end <= triangle);
    let fit = |first: u32, second: u32| {
        part(first) == part(second)
            && parallelogram(mesh, first as usize, second as usize).is_some_and(|(_, fourth)| {
                // If it is not the fourth corner exactly, a ray could pass between this
                // parallelogram and a neighbour that uses the true corner.
                fourth.exact || uses[fourth.vertex as usize] == 1
            })
    };
    let mut seconds = vec![ALONE; mesh.triangles.len()];
    let join = |seconds: &mut Vec<u32>, first: u32, second: u32| {
        let free = |triangle: u32| seconds[triangle as usize] == ALONE;
        if free(first) && free(second) && fit(first, second) {
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

/// Triangles, alone so far, that share an edge: the lower first, in order.
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
    let mut found: Vec<_> = edges
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0)
        .map(|pair| (pair[0].1, pair[1].1))
        .collect();
    drop(edges);
    found.par_sort_unstable();
    found
}

struct Fourth {
    vertex: u32,
    /// Whether it is `b + c - a` without rounding.
    exact: bool,
}

/// The corners of the parallelogram that two triangles form within rounding: the first one's apex,
/// then the diagonal in the first one's own sense, then the fourth corner.
fn parallelogram(mesh: &Mesh, first: usize, second: usize) -> Option<([Vec3; 3], Fourth)> {
    let (own, next) = (mesh.triangles[first], mesh.triangles[second]);
    let (turn, vertex) = (0..3).find_map(|i| {
        let (b, c) = (own[(i + 1) % 3], own[(i + 2) % 3]);
        (0..3).find(|&k| next[k] == c && next[(k + 1) % 3] == b).map(|k| (i, next[(k + 2) % 3]))
    })?;
    let corners = [0, 1, 2].map(|k| mesh.vertices[own[(turn + k) % 3] as usize]);
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let fourth = mesh.vertices[vertex as usize].as_dvec3();
    let ideal = b + c - a;
    // Corners are rounded to f32, and before that, in a text file, to six decimals as a rule.
    let rounding = f64::from(f32::EPSILON) * (a.abs() + b.abs() + c.abs()) + 4.0 * 0.5e-6;
    let shortest = (b - a).length().min((c - a).length());
    let off = (ideal - fourth).abs();
    let close = off.cmple(rounding).all() && off.max_element() <= SAME_SHAPE * shortest;
    let exact = ideal == fourth;
    (has_area(corners) && close).then_some((corners, Fourth { vertex, exact }))
}

fn has_area(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).length_squared() > 0.0
}
