//! Edges of polygons, and where they cross.

use glam::DVec2;
use robust::{Coord, orient2d};

use super::PlacementError;
use crate::geometry::Polygon;

/// Most corners of all polygons of a region.
const MOST_CORNERS: usize = 300_000;

/// Most crossings of different polygons.
const MOST_CROSSINGS: usize = 1 << 20;

/// An edge of a polygon, upwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    pub(super) polygon: u32,
}

impl Edge {
    /// Where it passes a height between its ends.
    pub(super) fn x_at(&self, y: f64) -> f64 {
        let Self { low, high, .. } = self;
        if y >= high.y {
            return high.x;
        }
        low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y))
    }

    fn is_proper_crossing(&self, other: &Self) -> bool {
        let side = |a: DVec2, b: DVec2, c: DVec2| {
            let coord = |p: DVec2| Coord { x: p.x, y: p.y };
            orient2d(coord(a), coord(b), coord(c))
        };
        let apart = |one: &Self, two: &Self| {
            let (a, b) = (side(one.low, one.high, two.low), side(one.low, one.high, two.high));
            (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0)
        };
        apart(self, other) && apart(other, self)
    }

    /// Where two edges that cross do so.
    fn crossing(&self, other: &Self) -> DVec2 {
        let (a, b) = (self.high - self.low, other.high - other.low);
        let t = (other.low - self.low).perp_dot(b) / a.perp_dot(b);
        self.low + a * t.clamp(0.0, 1.0)
    }
}

/// All edges of polygons, numbered in their order.
pub(super) fn edges_of(polygons: &[Polygon]) -> Result<Vec<Edge>, PlacementError> {
    let corners: usize = polygons.iter().flat_map(|p| &p.rings).map(Vec::len).sum();
    if corners > MOST_CORNERS {
        return Err(PlacementError::TooManyCorners { corners, most: MOST_CORNERS });
    }
    let mut edges = Vec::with_capacity(corners);
    for (polygon, Polygon { rings }) in (0..).zip(polygons) {
        for ring in rings {
            let next = ring.iter().cycle().skip(1);
            edges.extend(ring.iter().zip(next).filter(|(a, b)| a != b).map(|(&a, &b)| {
                let (low, high) = if (a.y, a.x) < (b.y, b.x) { (a, b) } else { (b, a) };
                Edge { low, high, polygon }
            }));
        }
    }
    Ok(edges)
}

/// Where edges of different polygons cross; an error where those of one do.
///
/// Edges that only touch do not cross: their corners are heights of the region anyway.
pub(super) fn crossings(edges: &[Edge]) -> Result<Vec<DVec2>, PlacementError> {
    let west = |e: &Edge| e.low.x.min(e.high.x);
    let east = |e: &Edge| e.low.x.max(e.high.x);
    let mut order: Vec<&Edge> = edges.iter().collect();
    order.sort_by(|a, b| west(a).total_cmp(&west(b)));
    let mut found = Vec::new();
    for (index, one) in order.iter().enumerate() {
        let reach = east(one);
        for other in order[index + 1..].iter().take_while(|other| west(other) <= reach) {
            let is_apart = other.low.y > one.high.y || other.high.y < one.low.y;
            if is_apart || !one.is_proper_crossing(other) {
                continue;
            }
            let at = one.crossing(other);
            if one.polygon == other.polygon {
                return Err(PlacementError::CrossesItself { polygon: one.polygon, at });
            }
            if found.len() == MOST_CROSSINGS {
                return Err(PlacementError::TooManyCrossings { most: MOST_CROSSINGS });
            }
            found.push(at);
        }
    }
    Ok(found)
}
