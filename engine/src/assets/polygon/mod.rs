//! Polygons, concave ones too, cut into triangles.

mod contact;
mod plane;
mod slabs;

#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

use self::contact::{covers_once, without_spikes};
use self::plane::project;

/// Triangles that cover a polygon.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Pieces {
    /// Corners of each triangle, which runs around like the polygon: places among the polygon's
    /// corners followed by `crossings`.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Points on the outline between its corners.
    pub(super) crossings: Vec<DVec3>,
    /// True if the outline crosses itself or runs around twice, so that the area which it encloses is
    /// not that of the shoelace formula.
    pub(super) is_crossed: bool,
}

/// An outline that crosses itself too often to be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tangled;

/// Cuts a polygon into triangles that cover what its outline encloses, once.
///
/// Their total area is that of the shoelace formula, whatever excursions of zero width the outline
/// makes: a slit to a hole, or a spike out and back. Corners need not lie in one plane: what counts
/// is their projection along the polygon's mean normal. Where an outline crosses itself, everything
/// with a winding number other than 0 is inside.
///
/// The triangles are a fan where that covers the polygon, else ears, else those of horizontal slabs.
///
/// # Errors
/// An outline that crosses itself too often.
pub(super) fn triangulate(corners: &[DVec3], out: &mut Pieces) -> Result<(), Tangled> {
    out.triangles.clear();
    out.crossings.clear();
    out.is_crossed = false;
    let count = corners.len();
    let fan = (1..count.saturating_sub(1)).map(|i| [0, i, i + 1]);
    if count <= 3 {
        out.triangles.extend(fan);
        return Ok(());
    }
    let flat = project(corners);
    // The signed areas of the triangles always add up to that of the polygon. If none is negative,
    // they cover each point as often as the outline runs around it.
    let is_positive = |triangles: &[[usize; 3]], least: f64| {
        triangles.iter().all(|t| turn(t.map(|i| flat[i])) >= least)
    };
    out.triangles.extend(fan);
    let mut is_cover = is_positive(&out.triangles, 0.0);
    if !is_cover {
        out.triangles.clear();
        clip_ears(&flat, &mut out.triangles);
        is_cover = is_positive(&out.triangles, -rounding(&flat));
    }
    if is_cover && covers_once(&flat) {
        return Ok(());
    }
    let ring = without_spikes(&flat);
    let mut pieces = Pieces::default();
    if !is_cover && ring.len() >= 3 {
        let flat: Vec<DVec2> = ring.iter().map(|&corner| flat[corner]).collect();
        clip_ears(&flat, &mut pieces.triangles);
        let least = -rounding(&flat);
        let is_positive = pieces.triangles.iter().all(|t| turn(t.map(|i| flat[i])) >= least);
        if is_positive && covers_once(&flat) {
            out.triangles.clear();
            out.triangles.extend(pieces.triangles.iter().map(|t| t.map(|i| ring[i])));
            return Ok(());
        }
        pieces.triangles.clear();
    }
    slabs::cover(corners, &flat, &ring, &mut pieces)?;
    // Touching itself does no harm.
    if !is_cover || pieces.is_crossed {
        *out = pieces;
    }
    Ok(())
}

/// Bound of the rounding error of [`turn`] for corners of a polygon.
fn rounding(flat: &[DVec2]) -> f64 {
    let far = flat.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    16.0 * f64::EPSILON * far * far
}

fn clip_ears(flat: &[DVec2], out: &mut Vec<[usize; 3]>) {
    let mut ring = OutlineRing::new(flat);
    for _ in 3..flat.len() {
        let [before, ear, after] = ring.neighbours(ring.ear());
        out.push([before, ear, after]);
        ring.remove(ear);
    }
    out.push(ring.neighbours(ring.first));
}

/// Twice the signed area; above 0 if counter-clockwise.
fn turn([a, b, c]: [DVec2; 3]) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Corners that are not yet cut off.
///
/// Cutting an ear changes only whether its two neighbours are ears (`O'Rourke` 1998, Computational
/// Geometry in C, 1.6.5), so that all cuts together take the square of the number of corners.
struct OutlineRing<'a> {
    flat: &'a [DVec2],
    before: Vec<usize>,
    after: Vec<usize>,
    is_ear: Vec<bool>,
    first: usize,
}

impl<'a> OutlineRing<'a> {
    fn new(flat: &'a [DVec2]) -> Self {
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

    /// Returns whether the triangle at this corner lies in the polygon and holds no other corner of it.
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
