//! Polygons, concave ones too, cut into triangles.

use glam::{DVec2, DVec3};

/// Triangles that cover a polygon, as places in `corners`; each runs around it like the polygon.
///
/// A fan where that covers it, else ears are clipped. Corners need not lie in one plane: what counts
/// is their projection along the polygon's mean normal. Of a polygon that crosses itself, the
/// corners decide something; there are always `corners.len() - 2` triangles.
pub(super) fn triangulate(corners: &[DVec3], out: &mut Vec<[usize; 3]>) {
    out.clear();
    let count = corners.len();
    let fan = (1..count.saturating_sub(1)).map(|i| [0, i, i + 1]);
    if count <= 3 {
        out.extend(fan);
        return;
    }
    let flat = project(corners);
    if fan.clone().all(|t| turn(t.map(|i| flat[i])) >= 0.0) {
        out.extend(fan);
        return;
    }
    let mut ring = Ring::new(flat);
    for _ in 3..count {
        let [before, ear, after] = ring.neighbours(ring.ear());
        out.push([before, ear, after]);
        ring.remove(ear);
    }
    out.push(ring.neighbours(ring.first));
}

/// The polygon in the plane across its mean normal (Newell), counter-clockwise.
fn project(corners: &[DVec3]) -> Vec<DVec2> {
    // Relative to the first corner: far from the origin, products of coordinates lose all digits.
    let from_first = |index: usize| corners[index % corners.len()] - corners[0];
    let double_area: DVec3 =
        (0..corners.len()).map(|i| from_first(i).cross(from_first(i + 1))).sum();
    let normal = double_area.try_normalize().unwrap_or(DVec3::Z);
    let (right, up) = normal.any_orthonormal_pair();
    let flat = |i| DVec2::new(right.dot(from_first(i)), up.dot(from_first(i)));
    // The pair may be left-handed with the normal or not: that is asked, not assumed.
    let handed = right.cross(up).dot(normal).signum();
    (0..corners.len()).map(|i| flat(i) * DVec2::new(handed, 1.0)).collect()
}

/// Twice the signed area; above 0 if counter-clockwise.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Corners that are not yet cut off.
///
/// Cutting an ear changes only whether its two neighbours are ears (`O'Rourke` 1998, Computational
/// Geometry in C, 1.6.5), so that all cuts together take the square of the number of corners.
struct Ring {
    flat: Vec<DVec2>,
    before: Vec<usize>,
    after: Vec<usize>,
    is_ear: Vec<bool>,
    first: usize,
}

impl Ring {
    fn new(flat: Vec<DVec2>) -> Self {
        let count = flat.len();
        let before = (0..count).map(|at| (at + count - 1) % count).collect();
        let after = (0..count).map(|at| (at + 1) % count).collect();
        let mut ring = Self { flat, before, after, is_ear: vec![false; count], first: 0 };
        for at in 0..count {
            ring.is_ear[at] = ring.cuts_nothing(at);
        }
        ring
    }

    fn neighbours(&self, at: usize) -> [usize; 3] {
        [self.before[at], at, self.after[at]]
    }

    /// The first ear; of a polygon that crosses itself and has none, the second corner.
    fn ear(&self) -> usize {
        let mut at = self.first;
        loop {
            if self.is_ear[at] {
                return at;
            }
            at = self.after[at];
            if at == self.first {
                return self.after[at];
            }
        }
    }

    fn remove(&mut self, at: usize) {
        let [before, _, after] = self.neighbours(at);
        self.after[before] = after;
        self.before[after] = before;
        if self.first == at {
            self.first = after;
        }
        for at in [before, after] {
            self.is_ear[at] = self.cuts_nothing(at);
        }
    }

    /// Whether the triangle at this corner lies in the polygon and holds no other corner of it.
    fn cuts_nothing(&self, at: usize) -> bool {
        let [before, _, end] = self.neighbours(at);
        let [a, b, c] = [before, at, end].map(|corner| self.flat[corner]);
        if turn([a, b, c]) <= 0.0 {
            return false;
        }
        let inside =
            |p: DVec2| turn([a, b, p]) >= 0.0 && turn([b, c, p]) >= 0.0 && turn([c, a, p]) >= 0.0;
        let mut other = self.after[end];
        while other != before {
            let p = self.flat[other];
            // A corner at the same place as one of the ear's own touches it without cutting it.
            if p != a && p != b && p != c && inside(p) {
                return false;
            }
            other = self.after[other];
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec3]) -> f64 {
        let mut triangles = Vec::new();
        triangulate(corners, &mut triangles);
        assert_eq!(triangles.len(), corners.len() - 2);
        let of = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i]);
            (b - a).cross(c - a).length() / 2.0
        };
        triangles.iter().map(of).sum()
    }

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
        // In a slanted plane whose map to (x, y) keeps areas up to the factor sqrt(1 + 1 + 4).
        points.iter().map(|&(x, y)| DVec3::new(x, y, x - 2.0 * y + 7.0)).collect()
    }

    #[test]
    fn triangles_of_concave_polygons_cover_them_once() {
        let slant = 6_f64.sqrt();
        let arrow = [(0.0, 0.0), (2.0, -1.0), (0.0, 2.0), (-2.0, -1.0)];
        let l = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
        let comb = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        for (points, expected) in [(&arrow[..], 4.0), (&l, 5.0), (&comb, 11.0)] {
            for start in 0..points.len() {
                let mut turned = points.to_vec();
                turned.rotate_left(start);
                let corners = polygon(&turned);
                assert!((area(&corners) - expected * slant).abs() < 1e-12, "{turned:?}");
                let backwards: Vec<_> = corners.into_iter().rev().collect();
                assert!((area(&backwards) - expected * slant).abs() < 1e-12, "{turned:?}");
            }
        }
    }

    #[test]
    fn triangles_run_around_like_their_polygon() {
        let corners = polygon(&[(0.0, 0.0), (2.0, -1.0), (0.0, 2.0), (-2.0, -1.0)]);
        let mut triangles = Vec::new();
        triangulate(&corners, &mut triangles);
        for t in triangles {
            let [a, b, c] = t.map(|i| corners[i]);
            assert!((b - a).cross(c - a).z > 0.0, "{t:?}");
        }
    }
}
