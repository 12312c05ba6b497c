//! Triangles of the ground inside some polygons and outside others.

use std::collections::HashMap;

use glam::{DVec2, I64Vec2};
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation, mitigate_underflow};

use super::PlacementError;
use crate::geometry::{Polygon, Rectangle};

/// Most corners of all polygons of a region.
const MOST_CORNERS: usize = 300_000;

/// Farthest coordinate of a corner, m: beyond, crossings are not known to a millimetre.
const FARTHEST: f64 = 1e9;

/// Most crossings of different polygons.
const MOST_CROSSINGS: usize = 1 << 20;

/// Corners and crossings that are closer than this fraction of the largest coordinate are one vertex: some fifty times
/// the rounding of a crossing.
const CLOSE: f64 = 1e-14;

/// Most comparisons of an edge with a point, of which each takes about a nanosecond.
const MOST_COMPARISONS: usize = 1 << 33;

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Triangles of a region, and the line segments that bound it.
#[derive(Debug, Default)]
pub(super) struct Triangles {
    /// Corners of each triangle, counter-clockwise, m.
    pub(super) corners: Vec<[DVec2; 3]>,
    /// Sides of triangles on the region's outline, m.
    pub(super) outline: Vec<[DVec2; 2]>,
}

/// Triangulates the part of a rectangle that lies in any polygon of `inside`, or all of it if there is none,
/// and in no polygon of `outside`.
///
/// A constrained Delaunay triangulation has the edges of all polygons as edges of its triangles; edges that
/// cross are split. Triangles that no polygon separates form a face, which is inside or outside as a whole:
/// the middle of its largest triangle decides, by the even-odd rule for each polygon.
///
/// # Errors
/// A polygon that crosses itself (numbered through `inside`, then `outside`), or polygons too intricate.
pub(super) fn triangulate(
    rectangle: Rectangle,
    inside: &[Polygon],
    outside: &[Polygon],
) -> Result<Triangles, PlacementError> {
    let polygons = || inside.iter().chain(outside);
    let corners = polygons().flat_map(|polygon| &polygon.rings).map(Vec::len).sum();
    if corners > MOST_CORNERS {
        return Err(PlacementError::TooManyCorners { corners, most: MOST_CORNERS });
    }
    for (number, polygon) in (0..).zip(polygons()) {
        refuse_crossings(polygon, number)?;
    }
    let outlines = |polygons| -> Vec<_> { outlines_near(rectangle, polygons).collect() };
    let (is_bounded, inside, outside) = (!inside.is_empty(), outlines(inside), outlines(outside));
    RegionOutlines { rectangle, is_bounded, inside, outside }.triangulate()
}

/// Refuses a polygon with edges that cross; edges that only touch are allowed.
fn refuse_crossings(polygon: &Polygon, number: u32) -> Result<(), PlacementError> {
    let mut delaunay = Delaunay::new();
    for [start, end] in insert_rings(&mut delaunay, &[polygon])?.ends {
        if let Some(other) = delaunay.get_conflicting_edges_between_vertices(start, end).next() {
            let ends = [start, end].map(|vertex| position(&delaunay, vertex));
            let other = other.vertices().map(|vertex| position(&delaunay, vertex.fix()));
            return Err(PlacementError::CrossesItself {
                polygon: number,
                at: crossing(ends, other),
            });
        }
        delaunay.add_constraint(start, end);
    }
    Ok(())
}

/// Returns where two line segments that cross do so.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> DVec2 {
    let fraction = (c - a).perp_dot(d - c) / (b - a).perp_dot(d - c);
    // `max` takes 0 for NaN, of nearly parallel segments: an end.
    let fraction = fraction.max(0.0);
    a + (b - a) * fraction.min(1.0)
}

fn position(delaunay: &Delaunay, vertex: FixedVertexHandle) -> DVec2 {
    let point = delaunay.vertex(vertex).position();
    DVec2::new(point.x, point.y)
}

fn insert(delaunay: &mut Delaunay, at: DVec2) -> FixedVertexHandle {
    let point = mitigate_underflow(Point2::new(at.x, at.y));
    delaunay.insert(point).expect("corners are finite and near, and crossings lie between them")
}

/// Edges between vertices of a triangulation.
struct Edges {
    /// Start and end of each edge.
    ends: Vec<[FixedVertexHandle; 2]>,
    /// Distance at which two points are one vertex, m.
    close: f64,
}

/// Inserts the corners of polygons and returns their edges.
fn insert_rings(delaunay: &mut Delaunay, polygons: &[&Polygon]) -> Result<Edges, PlacementError> {
    let corners = || polygons.iter().flat_map(|polygon| &polygon.rings).flatten();
    let is_far = |corner: &&DVec2| !corner.abs().cmple(DVec2::splat(FARTHEST)).all();
    if let Some(&at) = corners().find(is_far) {
        return Err(PlacementError::FarCorner { at, most: FARTHEST });
    }
    let largest = corners().map(|corner| corner.abs().max_element()).fold(1e-9, f64::max);
    let close = CLOSE * largest;
    let mut vertices = HashMap::new();
    let mut vertex = |corner: DVec2| {
        let cell = (corner / close).round().as_i64vec2();
        let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| cell + I64Vec2::new(x, y)));
        let mut known = around.filter_map(|cell| vertices.get(&cell).copied());
        let known = known.find(|&known| position(delaunay, known).distance(corner) <= close);
        known.unwrap_or_else(|| {
            let vertex = insert(delaunay, corner);
            vertices.insert(cell, vertex);
            vertex
        })
    };
    let mut ends = Vec::new();
    for ring in polygons.iter().flat_map(|polygon| &polygon.rings) {
        let ring: Vec<FixedVertexHandle> = ring.iter().map(|&corner| vertex(corner)).collect();
        let next = ring.iter().cycle().skip(1);
        ends.extend(ring.iter().zip(next).filter(|(a, b)| a != b).map(|(&a, &b)| [a, b]));
    }
    Ok(Edges { ends, close })
}

/// Makes constraints of edges; those that cross are split where they do.
///
/// The point of a crossing is rounded and then an ordinary vertex, so that parts which cross others for that are
/// split again. `add_constraint_and_split` of `spade` panics for borders that differ by rounding alone.
fn add_constraints(delaunay: &mut Delaunay, edges: Edges) -> Result<(), PlacementError> {
    let Edges { ends: mut edges, close } = edges;
    let mut crossings = 0;
    while let Some([start, end]) = edges.pop() {
        if start == end {
            continue;
        }
        let other = delaunay.get_conflicting_edges_between_vertices(start, end).next();
        let Some(other) = other.map(|edge| edge.fix()) else {
            delaunay.add_constraint(start, end);
            continue;
        };
        if crossings == MOST_CROSSINGS {
            return Err(PlacementError::TooManyCrossings { most: MOST_CROSSINGS });
        }
        crossings += 1;
        let [from, to] = delaunay.directed_edge(other).vertices().map(|vertex| vertex.fix());
        // The edge may be flipped once it is no constraint.
        delaunay.remove_constraint_edge(other.as_undirected());
        let ends = [start, end, from, to];
        let [a, b, c, d] = ends.map(|vertex| position(delaunay, vertex));
        let at = crossing([a, b], [c, d]);
        let distance = |vertex: &FixedVertexHandle| position(delaunay, *vertex).distance(at);
        let nearest = ends.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let middle = match nearest.filter(|vertex| distance(vertex) <= close) {
            Some(vertex) => vertex,
            None => insert(delaunay, at),
        };
        edges.extend([[from, middle], [middle, to], [start, middle], [middle, end]]);
    }
    Ok(())
}

/// Polygon with the smallest rectangle around it.
struct Outline<'a> {
    polygon: &'a Polygon,
    bounds: Rectangle,
}

/// Returns the polygons that may share an area with a rectangle.
fn outlines_near(rectangle: Rectangle, polygons: &[Polygon]) -> impl Iterator<Item = Outline<'_>> {
    let outlines = polygons.iter().filter_map(|polygon| {
        let bounds = polygon.bounds()?;
        Some(Outline { polygon, bounds })
    });
    outlines.filter(move |outline| outline.bounds.overlaps(rectangle))
}

/// Rectangle with the polygons that say which of its points belong to a region.
struct RegionOutlines<'a> {
    rectangle: Rectangle,
    /// True if points have to lie in a polygon of `inside`.
    is_bounded: bool,
    inside: Vec<Outline<'a>>,
    outside: Vec<Outline<'a>>,
}

impl RegionOutlines<'_> {
    fn triangulate(&self) -> Result<Triangles, PlacementError> {
        let mut delaunay = Delaunay::new();
        let frame = Polygon::from(self.rectangle);
        let polygons = self.inside.iter().chain(&self.outside).map(|outline| outline.polygon);
        let polygons: Vec<&Polygon> = std::iter::once(&frame).chain(polygons).collect();
        let edges = insert_rings(&mut delaunay, &polygons)?;
        add_constraints(&mut delaunay, edges)?;
        let is_inside = self.find_inside(&delaunay)?;
        let mut triangles = Triangles::default();
        for face in delaunay.inner_faces().filter(|face| is_inside[face.fix().index()]) {
            triangles.corners.push(face.positions().map(|point| DVec2::new(point.x, point.y)));
            for edge in face.adjacent_edges() {
                if !is_inside[edge.rev().face().fix().index()] {
                    let ends = edge.positions().map(|point| DVec2::new(point.x, point.y));
                    triangles.outline.push(ends);
                }
            }
        }
        Ok(triangles)
    }

    /// Returns for each triangle, by its index, whether it belongs to the region.
    fn find_inside(&self, delaunay: &Delaunay) -> Result<Vec<bool>, PlacementError> {
        let mut is_inside = vec![false; delaunay.num_all_faces()];
        let mut is_visited = is_inside.clone();
        let (mut face, mut comparisons) = (Vec::new(), 0);
        for first in delaunay.inner_faces() {
            if std::mem::replace(&mut is_visited[first.fix().index()], true) {
                continue;
            }
            face.clear();
            face.push(first);
            let mut next = 0;
            while let Some(triangle) = face.get(next).copied() {
                next += 1;
                let open = triangle.adjacent_edges().into_iter();
                for edge in open.filter(|edge| !edge.is_constraint_edge()) {
                    if let Some(neighbor) = edge.rev().face().as_inner()
                        && !std::mem::replace(&mut is_visited[neighbor.fix().index()], true)
                    {
                        face.push(neighbor);
                    }
                }
            }
            let largest = face.iter().max_by(|a, b| a.area().total_cmp(&b.area()));
            let center = largest.expect("a face has a triangle").center();
            if self.contains(DVec2::new(center.x, center.y), &mut comparisons) {
                for triangle in &face {
                    is_inside[triangle.fix().index()] = true;
                }
            }
            if comparisons > MOST_COMPARISONS {
                return Err(PlacementError::TooIntricate);
            }
        }
        Ok(is_inside)
    }

    /// Returns whether a point belongs to the region, and adds the number of edges it was compared with.
    fn contains(&self, point: DVec2, comparisons: &mut usize) -> bool {
        let mut is_in = |outline: &Outline<'_>| {
            let Outline { polygon, bounds } = outline;
            bounds.contains(point) && {
                *comparisons += polygon.rings.iter().map(Vec::len).sum::<usize>();
                polygon.contains(point)
            }
        };
        self.rectangle.contains(point)
            && (!self.is_bounded || self.inside.iter().any(&mut is_in))
            && !self.outside.iter().any(&mut is_in)
    }
}
