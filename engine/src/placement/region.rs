//! Where stems may stand: a rectangle, only inside some polygons, outside others.

use glam::DVec2;

use super::PlacementError;
use super::crossings::{Edge, crossings, edges_of};
use crate::geometry::{Polygon, Rectangle};

/// Most edges of all slabs together: what an intricate region may cost in time and memory.
const MOST_PIECES: usize = 1 << 25;

/// A part of the plane, cut by horizontal lines through all corners and crossings into trapezoids.
///
/// Its area, whether a point lies in it, and uniform points in it follow from these exactly, but for
/// the rounding of numbers.
#[derive(Clone, Debug)]
pub struct Region {
    edges: Vec<Edge>,
    /// Heights between which the slabs lie, ascending, m.
    levels: Vec<f64>,
    /// First trapezoid of each slab, and the end of the last.
    starts: Vec<u32>,
    /// Left and right edge of each trapezoid, slab by slab, from left to right.
    sides: Vec<[u32; 2]>,
    /// Area up to and with each trapezoid, m².
    cumulative: Vec<f64>,
    /// The slab of each trapezoid.
    slabs: Vec<u32>,
}

impl Region {
    /// The points of a rectangle that lie in any polygon of `inside`, all of them if there is none,
    /// and in none of `outside`.
    ///
    /// # Errors
    /// A polygon that crosses itself (numbered through `inside`, then `outside`); nothing left;
    /// polygons too intricate.
    pub fn new(
        rectangle: Rectangle,
        inside: &[Polygon],
        outside: &[Polygon],
    ) -> Result<Self, PlacementError> {
        let polygons: Vec<Polygon> = inside.iter().chain(outside).cloned().collect();
        let mut edges = edges_of(&polygons)?;
        let frame = polygons.len() as u32;
        edges.extend(
            edges_of(&[rectangle.into()])?.into_iter().map(|e| Edge { polygon: frame, ..e }),
        );
        let crossings = crossings(&edges)?;
        let (bottom, top) = (rectangle.min.y, rectangle.max.y);
        edges.retain(|e| e.low.y < e.high.y && e.low.y < top && e.high.y > bottom);
        edges.sort_by(|a, b| a.low.y.total_cmp(&b.low.y));
        let ends = edges.iter().flat_map(|e| [e.low.y, e.high.y]);
        let mut levels: Vec<f64> = ends
            .chain(crossings.iter().map(|at| at.y))
            .filter(|y| (bottom..=top).contains(y))
            .collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let mut region = Self {
            edges,
            levels,
            starts: vec![0],
            sides: Vec::new(),
            cumulative: Vec::new(),
            slabs: Vec::new(),
        };
        region.cut(inside.len(), outside.len())?;
        if region.area() > 0.0 { Ok(region) } else { Err(PlacementError::NoGround) }
    }

    /// Fills in the trapezoids.
    fn cut(&mut self, inside: usize, outside: usize) -> Result<(), PlacementError> {
        let (mut active, mut waiting) = (Vec::<u32>::new(), 0);
        let mut is_in = vec![false; inside + outside + 1];
        let (mut area, mut pieces) = (0.0, 0);
        for slab in 0..self.levels.len().saturating_sub(1) {
            let (low, high) = (self.levels[slab], self.levels[slab + 1]);
            active.retain(|&edge| self.edges[edge as usize].high.y > low);
            while self.edges.get(waiting).is_some_and(|edge| edge.low.y <= low) {
                if self.edges[waiting].high.y > low {
                    active.push(waiting as u32);
                }
                waiting += 1;
            }
            pieces += active.len();
            if pieces > MOST_PIECES {
                return Err(PlacementError::TooIntricate);
            }
            let middle = low + 0.5 * (high - low);
            active.sort_by(|&a, &b| {
                let x = |edge: u32| self.edges[edge as usize].x_at(middle);
                x(a).total_cmp(&x(b))
            });
            let (mut within, mut without, mut left) = (0_usize, 0_usize, None);
            for &edge in &active {
                let polygon = self.edges[edge as usize].polygon as usize;
                is_in[polygon] = !is_in[polygon];
                if polygon < inside + outside {
                    let count = if polygon < inside { &mut within } else { &mut without };
                    if is_in[polygon] { *count += 1 } else { *count -= 1 }
                }
                let belongs =
                    is_in[inside + outside] && (inside == 0 || within > 0) && without == 0;
                match left {
                    None if belongs => left = Some(edge),
                    Some(start) if !belongs => {
                        left = None;
                        let size = self.trapezoid_area([start, edge], low, high);
                        if size > 0.0 {
                            area += size;
                            self.sides.push([start, edge]);
                            self.cumulative.push(area);
                            self.slabs.push(slab as u32);
                        }
                    }
                    _ => {}
                }
            }
            self.starts.push(self.sides.len() as u32);
        }
        Ok(())
    }

    /// Left and right end of a trapezoid at a height of its slab.
    fn ends(&self, sides: [u32; 2], y: f64) -> (f64, f64) {
        let [left, right] = sides.map(|edge| self.edges[edge as usize].x_at(y));
        (left, right.max(left))
    }

    fn trapezoid_area(&self, sides: [u32; 2], low: f64, high: f64) -> f64 {
        let width = |y| {
            let (left, right) = self.ends(sides, y);
            right - left
        };
        0.5 * (width(low) + width(high)) * (high - low)
    }

    /// Area, m².
    #[must_use]
    pub fn area(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    /// The smallest rectangle around it.
    #[must_use]
    pub fn bounds(&self) -> Rectangle {
        let (mut min, mut max) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (&slab, &sides) in self.slabs.iter().zip(&self.sides) {
            for y in [self.levels[slab as usize], self.levels[slab as usize + 1]] {
                let (left, right) = self.ends(sides, y);
                min = min.min(DVec2::new(left, y));
                max = max.max(DVec2::new(right, y));
            }
        }
        Rectangle { min, max }
    }

    /// Trapezoids of a slab, from left to right.
    fn slab(&self, slab: usize) -> &[[u32; 2]] {
        &self.sides[self.starts[slab] as usize..self.starts[slab + 1] as usize]
    }

    /// Whether a point lies in it.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        let slab = self.levels.partition_point(|&level| level <= point.y);
        if slab == 0 || slab == self.levels.len() {
            return false;
        }
        let sides = self.slab(slab - 1);
        let first = sides.partition_point(|&sides| self.ends(sides, point.y).1 < point.x);
        sides.get(first).is_some_and(|&sides| self.ends(sides, point.y).0 <= point.x)
    }

    /// Whether it may share points with a rectangle: surely not, if this says no.
    #[must_use]
    pub fn may_overlap(&self, rectangle: Rectangle) -> bool {
        let Rectangle { min, max } = rectangle;
        let first = self.levels.partition_point(|&level| level <= min.y).saturating_sub(1);
        let slabs = first..self.levels.len().saturating_sub(1);
        slabs.take_while(|&slab| self.levels[slab] < max.y).any(|slab| {
            let (low, high) = (self.levels[slab].max(min.y), self.levels[slab + 1].min(max.y));
            low < high
                && self.slab(slab).iter().any(|&sides| {
                    let ((a, b), (c, d)) = (self.ends(sides, low), self.ends(sides, high));
                    a.min(c) < max.x && b.max(d) > min.x
                })
        })
    }

    /// The uniform point of two uniform numbers in (0, 1): equal areas get equal chances.
    #[must_use]
    pub fn sample(&self, u: f64, v: f64) -> DVec2 {
        let target = u * self.area();
        let last = self.cumulative.len() - 1;
        let piece = self.cumulative.partition_point(|&area| area <= target).min(last);
        let below = if piece == 0 { 0.0 } else { self.cumulative[piece - 1] };
        let share = ((target - below) / (self.cumulative[piece] - below)).clamp(0.0, 1.0);
        let (sides, slab) = (self.sides[piece], self.slabs[piece] as usize);
        let (low, high) = (self.levels[slab], self.levels[slab + 1]);
        let width = |y| {
            let (left, right) = self.ends(sides, y);
            right - left
        };
        // Solves (a t + (b - a) t²/2) = share (a + b)/2 for the height t in a slab of widths a, b.
        let (a, b) = (width(low), width(high));
        let root = (a * a + share * (b * b - a * a)).max(0.0).sqrt();
        let t = if a + root > 0.0 { share * (a + b) / (a + root) } else { 0.0 };
        let y = low + t.min(1.0) * (high - low);
        let (left, right) = self.ends(sides, y);
        DVec2::new(left + v * (right - left), y)
    }
}
