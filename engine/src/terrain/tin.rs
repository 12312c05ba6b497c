use std::collections::BinaryHeap;

use glam::{DVec2, DVec3};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::cover::{CoverGrid, HOLE};
use super::grid::HeightGrid;

/// A corner of triangles, m.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: Point2<f64>,
    height: f64,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

type Delaunay = ConstrainedDelaunayTriangulation<Corner>;

/// Triangles over the whole grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tin {
    /// Corners, m from the grid's corner.
    pub(super) corners: Vec<DVec3>,
    /// Corner indices, counter-clockwise seen from above, with their part; holes are left out.
    pub(super) triangles: Vec<([u32; 3], u16)>,
}

/// The point of the grid with the largest error in a face; the largest error comes first, then the
/// first point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    /// Bits of the error: those of numbers above 0 are in the order of the numbers.
    error: u64,
    node: std::cmp::Reverse<usize>,
    face: usize,
    /// Number of changes of the face before this point was found.
    age: u32,
    /// A corner of the face: where to start looking for it.
    hint: usize,
}

/// Triangles whose distance from every point of the grid that has a height is at most `tolerance`,
/// measured vertically, and whose edges run along the borders of a cover.
///
/// Greedy insertion: the point with the largest error becomes a corner, until none is beyond the
/// tolerance. A part of a border that is not within the tolerance of the bilinear surface is split.
///
/// Source: Garland and Heckbert (1995), Fast polygonal approximation of terrains and height fields,
/// CMU-CS-95-181, algorithm III, over a constrained Delaunay triangulation.
pub(super) fn triangulate(grid: &HeightGrid, cover: &CoverGrid, tolerance: f64) -> Tin {
    let mut tin = Insertion::new(grid, tolerance);
    tin.add_sides();
    for border in cover.borders() {
        tin.add_border(border);
    }
    tin.refine();
    tin.finish(cover)
}

struct Insertion<'a> {
    grid: &'a HeightGrid,
    tolerance: f64,
    delaunay: Delaunay,
    is_corner: Vec<bool>,
    /// Number of changes of each face.
    ages: Vec<u32>,
    queue: BinaryHeap<Candidate>,
}

impl<'a> Insertion<'a> {
    fn new(grid: &'a HeightGrid, tolerance: f64) -> Self {
        Self {
            grid,
            tolerance,
            delaunay: Delaunay::new(),
            is_corner: vec![false; grid.heights.len()],
            ages: Vec::new(),
            queue: BinaryHeap::new(),
        }
    }

    /// A corner of the bilinear surface, or at a height of its own.
    fn insert(&mut self, at: DVec2, height: Option<f64>) -> FixedVertexHandle {
        let height = height.or_else(|| self.grid.height(at)).unwrap_or(0.0);
        let corner = Corner { at: Point2::new(at.x, at.y), height };
        self.delaunay.insert(corner).expect("points of a raster are finite and not huge")
    }

    /// The corners of the rectangle; there may be no height, but then there is a hole.
    fn add_sides(&mut self) {
        let (columns, rows) = (self.grid.xs.len(), self.grid.ys.len());
        for node in [0, columns - 1, columns * (rows - 1), columns * rows - 1] {
            self.insert(self.grid.point(node), None);
            self.is_corner[node] = true;
        }
    }

    /// A border as edges that stay within the tolerance of the bilinear surface.
    fn add_border(&mut self, [from, to]: [DVec2; 2]) {
        let axis = usize::from(to.y > from.y);
        let points = if axis == 0 { &self.grid.xs } else { &self.grid.ys };
        let first = points.partition_point(|&p| p <= from[axis]);
        let end = points.partition_point(|&p| p < to[axis]);
        let inner = points[first..end.max(first)].iter().map(|&p| {
            let mut at = from;
            at[axis] = p;
            at
        });
        let profile: Vec<(DVec2, f64)> = std::iter::once(from)
            .chain(inner)
            .chain(std::iter::once(to))
            .map(|at| (at, self.grid.height(at).unwrap_or(f64::NAN)))
            .collect();
        let mut kept = vec![0, profile.len() - 1];
        let mut spans = vec![(0, profile.len() - 1)];
        while let Some((a, b)) = spans.pop() {
            let (start, end) = (profile[a], profile[b]);
            let error = |i: usize| {
                let share = (profile[i].0[axis] - start.0[axis]) / (end.0[axis] - start.0[axis]);
                (start.1 + share * (end.1 - start.1) - profile[i].1).abs()
            };
            let worst = (a + 1..b).max_by(|&i, &j| error(i).total_cmp(&error(j)));
            if let Some(worst) = worst.filter(|&i| error(i) > self.tolerance) {
                kept.push(worst);
                spans.extend([(a, worst), (worst, b)]);
            }
        }
        kept.sort_unstable();
        let corners: Vec<_> = kept
            .iter()
            .map(|&i| self.insert(profile[i].0, Some(profile[i].1).filter(|z| !z.is_nan())))
            .collect();
        for pair in corners.windows(2) {
            self.delaunay.add_constraint(pair[0], pair[1]);
        }
    }

    /// Inserts points until all errors are within the tolerance.
    fn refine(&mut self) {
        let faces: Vec<_> = self.delaunay.inner_faces().map(|face| face.fix()).collect();
        for face in faces {
            self.scan(face);
        }
        let mut changed = Vec::new();
        while let Some(worst) = self.queue.pop() {
            let Candidate { node: std::cmp::Reverse(node), face, age, hint, .. } = worst;
            if self.ages[face] != age || self.is_corner[node] {
                continue;
            }
            self.is_corner[node] = true;
            let at = self.grid.point(node);
            let height = self.grid.heights[node];
            let hint = FixedVertexHandle::from_index(hint);
            let corner = Corner { at: Point2::new(at.x, at.y), height };
            let inserted = self.delaunay.insert_with_hint(corner, hint);
            let inserted = inserted.expect("points of a raster are finite and not huge");
            // Whatever insertion changes, it makes a neighbour of the new corner.
            changed.clear();
            let around = self.delaunay.vertex(inserted).out_edges();
            changed.extend(around.filter_map(|edge| edge.face().as_inner()).map(|f| f.fix()));
            for &face in &changed {
                self.scan(face);
            }
        }
    }

    /// Looks for the largest error of a face beyond the tolerance.
    fn scan(&mut self, face: FixedFaceHandle<InnerTag>) {
        let corners = self.delaunay.face(face).vertices().map(|vertex| {
            let Corner { at, height } = *vertex.data();
            DVec3::new(at.x, at.y, height)
        });
        let index = face.index();
        if self.ages.len() <= index {
            self.ages.resize(index + 1, 0);
        }
        self.ages[index] += 1;
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        if normal.z <= 0.0 {
            return;
        }
        let slope = -normal.truncate() / normal.z;
        let (xs, ys) = (&self.grid.xs, &self.grid.ys);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let first = ys.partition_point(|&y| y < low.y);
        let mut worst: Option<(f64, usize)> = None;
        for (row, &y) in ys.iter().enumerate().skip(first) {
            if y > high.y {
                break;
            }
            let Some((west, east)) = span(&corners, y) else { continue };
            let start = xs.partition_point(|&x| x < west);
            for (column, &x) in xs.iter().enumerate().skip(start) {
                if x > east {
                    break;
                }
                let node = row * xs.len() + column;
                let plane = a.z + slope.dot(DVec2::new(x, y) - a.truncate());
                let error = (plane - self.grid.heights[node]).abs();
                if error > worst.map_or(self.tolerance, |(worst, _)| worst) && !self.is_corner[node]
                {
                    worst = Some((error, node));
                }
            }
        }
        if let Some((error, node)) = worst {
            let (error, node) = (error.to_bits(), std::cmp::Reverse(node));
            let hint = self.delaunay.face(face).vertices()[0].fix().index();
            self.queue.push(Candidate { error, node, face: index, age: self.ages[index], hint });
        }
    }

    fn finish(self, cover: &CoverGrid) -> Tin {
        let corners: Vec<DVec3> = self
            .delaunay
            .vertices()
            .map(|vertex| DVec3::new(vertex.data().at.x, vertex.data().at.y, vertex.data().height))
            .collect();
        let triangles = self.delaunay.inner_faces().map(|face| {
            let ids = face.vertices().map(|vertex| vertex.fix().index() as u32);
            let [a, b, c] = ids.map(|id| corners[id as usize].truncate());
            (ids, cover.part((a + b + c) / 3.0))
        });
        let triangles = triangles.filter(|&(_, part)| part != HOLE).collect();
        Tin { corners, triangles }
    }
}

/// Returns the range of x of a triangle at a height y.
fn span(corners: &[DVec3; 3], y: f64) -> Option<(f64, f64)> {
    let mut range: Option<(f64, f64)> = None;
    let mut add = |x: f64| {
        range = Some(range.map_or((x, x), |(low, high)| (low.min(x), high.max(x))));
    };
    for i in 0..3 {
        let (p, q) = (corners[i], corners[(i + 1) % 3]);
        if (p.y - y).abs() <= 0.0 {
            add(p.x);
        }
        if (p.y < y) != (q.y < y) {
            // Clamped, so that rounding does not reach beyond the triangle.
            let x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
            add(x.clamp(p.x.min(q.x), p.x.max(q.x)));
        }
    }
    // A point on an edge must not slip between two faces by rounding.
    let room = 1e-12 * (corners[0].x.abs() + corners[1].x.abs() + corners[2].x.abs());
    range.map(|(low, high)| (low - room, high + room))
}
