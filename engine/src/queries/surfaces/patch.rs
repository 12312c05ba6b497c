//! Flat pieces of surface in the world, cut by planes.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use super::disc_area::disc_area;

/// A triangle or an ellipse in the world: points `origin + s u + t v`.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct FlatPatch {
    /// First corner of the triangle, or centre of the ellipse, m.
    pub(in crate::queries) origin: DVec3,
    /// Edges of the triangle, or conjugate radii of the ellipse, m.
    pub(in crate::queries) u: DVec3,
    pub(in crate::queries) v: DVec3,
    /// True if `(s, t)` lies in the unit disc, false if it lies in the triangle `s, t, 1 - s - t >= 0`.
    pub(in crate::queries) is_ellipse: bool,
}

/// Convex part of a patch in its coordinates `(s, t)`, as a polygon; of an ellipse, what it shares with the disc.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct PatchPiece {
    corners: [DVec2; MOST_CORNERS],
    count: usize,
    is_ellipse: bool,
}

/// A square that is cut by both planes of each axis has ten corners.
const MOST_CORNERS: usize = 12;

/// Doubled area of a polygon below which its corners are too near each other to tell what lies in it; discs are as
/// large as π.
const SLIVER: f64 = 1e-12;

/// One of the world's coordinates as a function of a patch's: `at + slope · (s, t)`, m.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct Coordinate {
    at: f64,
    slope: DVec2,
}

impl FlatPatch {
    /// All of it.
    pub(in crate::queries) fn whole(&self) -> PatchPiece {
        let mut corners = [DVec2::ZERO; MOST_CORNERS];
        let all: &[[f64; 2]] = if self.is_ellipse {
            &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        } else {
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
        };
        for (corner, &place) in corners.iter_mut().zip(all) {
            *corner = place.into();
        }
        PatchPiece { corners, count: all.len(), is_ellipse: self.is_ellipse }
    }

    /// Box around it, m: its lowest and its highest corner.
    pub(in crate::queries) fn bounds(&self) -> (DVec3, DVec3) {
        let Self { origin, u, v, is_ellipse } = *self;
        if is_ellipse {
            let reach = (u * u + v * v).map(f64::sqrt);
            return (origin - reach, origin + reach);
        }
        let (low, high) = (u.min(v).min(DVec3::ZERO), u.max(v).max(DVec3::ZERO));
        (origin + low, origin + high)
    }

    /// Middle of its area, m.
    pub(in crate::queries) fn middle(&self) -> DVec3 {
        if self.is_ellipse { self.origin } else { self.origin + (self.u + self.v) / 3.0 }
    }

    /// Coordinate along an axis.
    pub(in crate::queries) fn coordinate(&self, axis: usize) -> Coordinate {
        Coordinate { at: self.origin[axis], slope: DVec2::new(self.u[axis], self.v[axis]) }
    }

    /// Parts of a piece between planes across an axis, with the number of each.
    ///
    /// - `side`: coordinate of the lower side of the part with a number, m
    pub(in crate::queries) fn slices(
        &self,
        piece: PatchPiece,
        axis: usize,
        numbers: RangeInclusive<i64>,
        side: impl Fn(i64) -> f64,
    ) -> impl Iterator<Item = (i64, PatchPiece)> {
        let coordinate = self.coordinate(axis);
        let (mut rest, last) = (piece, *numbers.end());
        let parts = numbers.map(move |number| {
            if number == last {
                return (number, rest);
            }
            let [below, above] = rest.split(coordinate, side(number + 1));
            rest = above;
            (number, below)
        });
        parts.filter(|(_, part)| !part.is_empty())
    }

    /// Point of a piece with the largest third coordinate, m; the piece must not be empty.
    pub(in crate::queries) fn highest(&self, piece: &PatchPiece) -> Option<DVec3> {
        let place = piece.farthest(DVec2::new(self.u.z, self.v.z))?;
        Some(self.origin + self.u * place.x + self.v * place.y)
    }
}

impl PatchPiece {
    /// The parts below and above the plane on which a coordinate has a value.
    pub(in crate::queries) fn split(&self, coordinate: Coordinate, plane: f64) -> [Self; 2] {
        let nothing = Self { count: 0, ..*self };
        let [mut below, mut above] = [nothing; 2];
        let side = |corner: DVec2| coordinate.at - plane + coordinate.slope.dot(corner);
        let corners = &self.corners[..self.count];
        let Some(&(mut from)) = corners.last() else { return [below, above] };
        let mut from_side = side(from);
        for &to in corners {
            let to_side = side(to);
            if (from_side < 0.0) != (to_side < 0.0) {
                let crossing = from + (to - from) * (from_side / (from_side - to_side));
                below.push(crossing);
                above.push(crossing);
            }
            if to_side < 0.0 {
                below.push(to);
            } else {
                above.push(to);
            }
            (from, from_side) = (to, to_side);
        }
        [below, above]
    }

    /// Area as a fraction of the whole patch.
    pub(in crate::queries) fn fraction(&self) -> f64 {
        let corners = &self.corners[..self.count];
        if self.is_ellipse {
            return disc_area(corners) / PI;
        }
        let next = corners.iter().cycle().skip(1);
        // Half of the sum of the products is the area, and half the square of the edge that of the whole.
        corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum()
    }

    /// Returns whether no point is left; a piece without an area may have some.
    pub(in crate::queries) const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Point that lies farthest in a direction; `None` if there is no point.
    fn farthest(&self, direction: DVec2) -> Option<DVec2> {
        let corners = &self.corners[..self.count];
        let best = |a: DVec2, b: DVec2| if direction.dot(b) > direction.dot(a) { b } else { a };
        if !self.is_ellipse {
            return corners.iter().copied().reduce(best);
        }
        // The end of the disc if it lies in the polygon; else corners in the disc, and places where edges cross it.
        let end = direction.normalize_or_zero();
        let edges = || corners.iter().copied().zip(corners.iter().copied().cycle().skip(1));
        let is_sliver = || edges().map(|(a, b)| a.perp_dot(b)).sum::<f64>() < SLIVER;
        if edges().all(|(a, b)| (b - a).perp_dot(end - a) >= 0.0) && !is_sliver() {
            return Some(end);
        }
        let inside = corners.iter().copied().filter(|corner| corner.length_squared() <= 1.0);
        inside.chain(edges().flat_map(|(a, b)| crossings(a, b))).reduce(best)
    }

    fn push(&mut self, corner: DVec2) {
        // Rounding may make a corner too many, which is where one is already.
        if let Some(place) = self.corners.get_mut(self.count) {
            *place = corner;
            self.count += 1;
        }
    }
}

/// Points of an edge that lie on the unit circle.
fn crossings(a: DVec2, b: DVec2) -> impl Iterator<Item = DVec2> {
    let along = b - a;
    let length = along.length_squared();
    let middle = -a.dot(along) / length;
    let half = (1.0 / length - (a.perp_dot(along) / length).powi(2)).sqrt();
    let places = [middle - half, middle + half].into_iter();
    // A NaN, of an edge that misses the circle, lies in no range.
    places.filter(|place| (0.0..=1.0).contains(place)).map(move |place| a + along * place)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ellipse() -> FlatPatch {
        let (u, v) = (DVec3::new(2.0, 0.5, 0.3), DVec3::new(-0.4, 1.0, 0.8));
        FlatPatch { origin: DVec3::new(10.0, -3.0, 5.0), u, v, is_ellipse: true }
    }

    #[test]
    fn pieces_add_up_to_the_whole() {
        for patch in [ellipse(), FlatPatch { is_ellipse: false, ..ellipse() }] {
            let (low, high) = patch.bounds();
            let mut pieces = vec![patch.whole()];
            for axis in 0..3 {
                for step in 1..7 {
                    let plane = low[axis] + (high[axis] - low[axis]) * f64::from(step) / 7.3;
                    let cut = |piece: &PatchPiece| piece.split(patch.coordinate(axis), plane);
                    pieces =
                        pieces.iter().flat_map(cut).filter(|piece| !piece.is_empty()).collect();
                }
            }
            let fractions: Vec<f64> = pieces.iter().map(PatchPiece::fraction).collect();
            assert!(fractions.iter().all(|&part| (-1e-15..0.5).contains(&part)));
            assert!(pieces.len() > 40);
            assert!((fractions.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        }
    }

    /// The whole ellipse reaches as high as its box; a part of it as high as the highest of many of its points.
    #[test]
    fn the_highest_point_of_a_part_is_above_all_others_of_it() {
        for patch in [ellipse(), FlatPatch { is_ellipse: false, ..ellipse() }] {
            let top = patch.highest(&patch.whole()).expect("it has points");
            assert!((top.z - patch.bounds().1.z).abs() < 1e-14);
            let [west, _] = patch.whole().split(patch.coordinate(0), 9.5);
            let [_, part] = west.split(patch.coordinate(1), -3.2);
            let top = patch.highest(&part).map_or(f64::NEG_INFINITY, |top| top.z);
            let mut best = f64::NEG_INFINITY;
            let steps = 2000;
            for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
                let at = |step: i32| 2.0 * f64::from(step) / f64::from(steps) - 1.0;
                let (s, t) = (at(i), at(j));
                let is_in = if patch.is_ellipse {
                    s * s + t * t <= 1.0
                } else {
                    s.min(t).min(1.0 - s - t) >= 0.0
                };
                let point = patch.origin + patch.u * s + patch.v * t;
                if is_in && point.x < 9.5 && point.y >= -3.2 {
                    best = best.max(point.z);
                }
            }
            assert!(best.is_finite() == top.is_finite());
            assert!(best <= top + 1e-12 && (top - best < 2e-3 || !top.is_finite()), "{best} {top}");
        }
    }
}
