//! The inside of an outline that crosses itself, slab by slab.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::{Pieces, Tangled};

/// Share of the square of the extent below which a triangle is left out: it is none in f32.
const SMALLEST: f64 = 1e-11;

/// Difference between the enclosed area and that of the shoelace formula, as a share, from which on the
/// outline crosses itself.
const CROSSED: f64 = 1e-6;

/// Most heights of corners and crossings, per corner, and a few more.
const MOST_LEVELS: (usize, usize) = (4, 64);

/// An edge of the outline that is not level, by its lower and upper end.
struct Edge {
    low: DVec2,
    high: DVec2,
    /// Places of the ends in the polygon.
    ends: [usize; 2],
    /// Change of the winding number across it, from left to right.
    step: i32,
}

impl Edge {
    /// The share of its height at which it reaches a level.
    fn share(&self, y: f64) -> f64 {
        ((y - self.low.y) / (self.high.y - self.low.y)).clamp(0.0, 1.0)
    }

    fn x(&self, y: f64) -> f64 {
        self.low.x + (self.high.x - self.low.x) * self.share(y)
    }
}

/// Adds the triangles of the trapezoids between the levels of all corners and crossings that the
/// outline runs around. `ring` has the places of its corners.
pub(super) fn cover(
    corners: &[DVec3],
    flat: &[DVec2],
    ring: &[usize],
    out: &mut Pieces,
) -> Result<(), Tangled> {
    let edges = edges(flat, ring);
    let levels = levels(&edges, ring.len())?;
    let far = edges.iter().map(|edge| edge.low.abs().max(edge.high.abs()).max_element());
    let far = far.fold(0.0, f64::max);
    let smallest = SMALLEST * far * far;
    let mut slabs = Slabs { corners, levels: &levels, smallest, known: HashMap::new(), out };
    let mut enclosed = 0.0;
    for level in 1..levels.len() {
        let [bottom, top] = [levels[level - 1], levels[level]];
        let middle = 0.5 * (bottom + top);
        let crossing = edges.iter().enumerate();
        let crossing = crossing.filter(|(_, edge)| edge.low.y <= bottom && top <= edge.high.y);
        let mut crossing: Vec<Side<'_>> = crossing.collect();
        crossing.sort_by(|a, b| a.1.x(middle).total_cmp(&b.1.x(middle)));
        let mut winding = 0_i32;
        let mut left = None;
        for side in crossing {
            let before = winding.signum();
            winding += side.1.step;
            if before == winding.signum() {
                continue;
            }
            if let Some(left) = left.filter(|_| before != 0) {
                enclosed += slabs.trapezoid(left, side, level, before > 0);
            }
            left = Some(side);
        }
    }
    let following = ring.iter().cycle().skip(1);
    let double: f64 = ring.iter().zip(following).map(|(&a, &b)| flat[a].perp_dot(flat[b])).sum();
    out.is_crossed = (enclosed - 0.5 * double.abs()).abs() > CROSSED * enclosed;
    Ok(())
}

/// An edge and its number.
type Side<'a> = (usize, &'a Edge);

fn edges(flat: &[DVec2], ring: &[usize]) -> Vec<Edge> {
    let following = ring.iter().cycle().skip(1);
    let is_level = |a: usize, b: usize| flat[a].y - flat[b].y == 0.0;
    let pairs = ring.iter().zip(following).filter(|(start, end)| !is_level(**start, **end));
    pairs
        .map(|(&start, &end)| {
            let ends = [start, end];
            // Inside is to the left of an edge that runs up.
            let (ends, step) =
                if flat[start].y < flat[end].y { (ends, -1) } else { ([end, start], 1) };
            Edge { low: flat[ends[0]], high: flat[ends[1]], ends, step }
        })
        .collect()
}

/// Heights of all corners and crossings, from the lowest up.
fn levels(edges: &[Edge], corners: usize) -> Result<Vec<f64>, Tangled> {
    let (per_corner, more) = MOST_LEVELS;
    let most = per_corner * corners + more;
    let mut levels: Vec<f64> = edges.iter().flat_map(|edge| [edge.low.y, edge.high.y]).collect();
    for (index, edge) in edges.iter().enumerate() {
        for other in &edges[..index] {
            let (low, high) = (edge.low.y.max(other.low.y), edge.high.y.min(other.high.y));
            if low >= high {
                continue;
            }
            // Where the difference of the two lines changes its sign.
            let [below, above] = [low, high].map(|y| edge.x(y) - other.x(y));
            if below * above < 0.0 {
                levels.push(low + (high - low) * (below / (below - above)));
            }
        }
        if levels.len() > 2 * edges.len() + most {
            return Err(Tangled);
        }
    }
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    Ok(levels)
}

/// Makes the trapezoids of slabs.
struct Slabs<'a> {
    corners: &'a [DVec3],
    levels: &'a [f64],
    /// Area below which a triangle is left out.
    smallest: f64,
    /// New points by the numbers of their edge and level.
    known: HashMap<(usize, usize), usize>,
    out: &'a mut Pieces,
}

impl Slabs<'_> {
    /// Adds the trapezoid between two edges below a level, and returns its area.
    fn trapezoid(&mut self, left: Side<'_>, right: Side<'_>, level: usize, is_ccw: bool) -> f64 {
        let heights = [self.levels[level - 1], self.levels[level]];
        let widths = heights.map(|y| (right.1.x(y) - left.1.x(y)).max(0.0));
        let [a, b] = [left, right].map(|side| self.point(side, level - 1));
        let [d, c] = [left, right].map(|side| self.point(side, level));
        // The triangles below and above the diagonal.
        let areas = widths.map(|width| 0.5 * width * (heights[1] - heights[0]));
        for (area, [a, b, c]) in areas.into_iter().zip([[a, b, c], [a, c, d]]) {
            if area > self.smallest {
                // The outline runs the other way around what it encloses clockwise.
                self.out.triangles.push(if is_ccw { [a, b, c] } else { [a, c, b] });
            }
        }
        areas[0] + areas[1]
    }

    /// Place of the point of an edge at a level.
    fn point(&mut self, (index, edge): Side<'_>, level: usize) -> usize {
        let ([low, high], y) = (edge.ends, self.levels[level]);
        if y <= edge.low.y {
            return low;
        }
        if y >= edge.high.y {
            return high;
        }
        let (corners, crossings) = (self.corners, &mut self.out.crossings);
        *self.known.entry((index, level)).or_insert_with(|| {
            crossings.push(corners[low].lerp(corners[high], edge.share(y)));
            corners.len() + crossings.len() - 1
        })
    }
}
