//! Extent of a mesh along any direction, from which the boxes around its instances follow.

use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::accel::layout::{Bounds32, ChildRef, MeshBvh};

/// Maximum number of topmost parts of a mesh from which the boxes of instances follow, eight smaller ones in each:
/// with the boxes of the topmost alone, a ray enters a tenth more instances.
const MAX_TOPMOST_PARTS: usize = 64;

/// Instances of a mesh from which on a table of its extents takes less time than their parts do.
const TABULATED_FROM: usize = 2048;

/// Intervals along each side of a face of a table. A box around a sphere is then wider by a thousandth.
const INTERVALS: usize = 32;

/// Lowest and highest scalar product of any direction with the points of a mesh.
#[derive(Debug)]
pub(super) enum MeshExtent {
    /// By a walk over parts of the mesh.
    Parts(MeshParts),
    /// By a table over directions.
    Table(SupportTable),
}

impl MeshExtent {
    /// Extent of a mesh of which there are about this number of instances.
    pub(super) fn new(mesh: &MeshBvh, instances: usize) -> Self {
        let parts = MeshParts::new(mesh);
        if instances < TABULATED_FROM || parts.topmost.is_empty() {
            Self::Parts(parts)
        } else {
            Self::Table(SupportTable::new(&parts))
        }
    }

    /// True if the mesh has no primitives.
    pub(super) const fn is_empty(&self) -> bool {
        matches!(self, Self::Parts(parts) if parts.topmost.is_empty())
    }

    /// Bounds of the scalar product of a `direction`, of any length, with all points of the mesh.
    pub(super) fn along(&self, direction: DVec3) -> (f64, f64) {
        match self {
            Self::Parts(parts) => parts.extent(direction),
            Self::Table(table) => (-table.support(-direction), table.support(direction)),
        }
    }
}

/// Upper bounds of the support function `h(d) = max d · p` of a mesh, over the points `p` of its parts.
///
/// `h` is convex and grows with the length of `d`. On the plane of each face of a cube around the origin it is
/// therefore nowhere above the linear interpolation between the corners of the triangles of a grid.
#[derive(Debug)]
pub(super) struct SupportTable {
    /// `h` at the points of the grids of six faces: +x, -x, +y, -y, +z, -z.
    values: Box<[f64]>,
}

impl SupportTable {
    const POINTS: usize = INTERVALS + 1;

    fn new(parts: &MeshParts) -> Self {
        let coordinate = |index: usize| 2.0 * index as f64 / INTERVALS as f64 - 1.0;
        let value = |index: usize| {
            let (face, at) =
                (index / (Self::POINTS * Self::POINTS), index % (Self::POINTS * Self::POINTS));
            let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
            let mut direction = DVec3::ZERO;
            direction[axis] = sign;
            direction[(axis + 1) % 3] = coordinate(at % Self::POINTS);
            direction[(axis + 2) % 3] = coordinate(at / Self::POINTS);
            parts.extent(direction).1
        };
        Self { values: (0..6 * Self::POINTS * Self::POINTS).map(value).collect() }
    }

    fn support(&self, direction: DVec3) -> f64 {
        let axis = direction.abs().max_position();
        let length = direction[axis].abs();
        let face = 2 * axis + usize::from(direction[axis] < 0.0);
        let grid = |side: f64| 0.5 * INTERVALS as f64 * (side / length + 1.0);
        let (u, v) = (grid(direction[(axis + 1) % 3]), grid(direction[(axis + 2) % 3]));
        let (column, row) = ((u as usize).min(INTERVALS - 1), (v as usize).min(INTERVALS - 1));
        let (u, v) = (u - column as f64, v - row as f64);
        let corner = (face * Self::POINTS + row) * Self::POINTS + column;
        let value = |column: usize, row: usize| self.values[corner + row * Self::POINTS + column];
        let (near, far) = (value(0, 0), value(1, 1));
        let of_unit = if u > v {
            (1.0 - u) * near + (u - v) * value(1, 0) + v * far
        } else {
            (1.0 - v) * near + (v - u) * value(0, 1) + u * far
        };
        length * of_unit
    }
}

/// Boxes around parts of a mesh, from its topmost nodes: their union, when rotated, is tighter than the rotated box
/// around the whole mesh.
#[derive(Debug)]
pub(super) struct MeshParts {
    /// Boxes of the topmost parts and the ranges of their own parts, those that are farthest from the middle first.
    topmost: Vec<(PartBox, Range<usize>)>,
    parts: Vec<PartBox>,
}

impl MeshParts {
    fn new(mesh: &MeshBvh) -> Self {
        let mut topmost = Vec::new();
        if mesh.tree.root != ChildRef::NONE {
            topmost.push((mesh.bounds, mesh.tree.root));
        }
        let mut next = 0;
        while next < topmost.len() && topmost.len() + 7 <= MAX_TOPMOST_PARTS {
            let (_, node) = topmost[next];
            if node.is_inner() {
                topmost.remove(next);
                topmost.extend(children(mesh, node));
            } else {
                next += 1;
            }
        }
        let mut parts = Vec::new();
        let mut topmost: Vec<_> = topmost
            .into_iter()
            .map(|(bounds, node)| {
                let start = parts.len();
                if node.is_inner() {
                    parts.extend(children(mesh, node).map(|(part, _)| PartBox::from(part)));
                } else {
                    parts.push(PartBox::from(bounds));
                }
                (PartBox::from(bounds), start..parts.len())
            })
            .collect();
        let middle = PartBox::from(mesh.bounds).center;
        let distance = |part: &PartBox| part.center.distance_squared(middle);
        topmost.sort_by(|(a, _), (b, _)| distance(b).total_cmp(&distance(a)));
        Self { topmost, parts }
    }

    /// Lowest and highest scalar product of `direction` and a point of the parts.
    fn extent(&self, direction: DVec3) -> (f64, f64) {
        let absolute = direction.abs();
        let project = |part: &PartBox| {
            let (center, half) = (direction.dot(part.center), absolute.dot(part.half));
            (center - half, center + half)
        };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (part, parts) in &self.topmost {
            let (part_low, part_high) = project(part);
            if part_low < low || part_high > high {
                for (part_low, part_high) in self.parts[parts.clone()].iter().map(project) {
                    low = low.min(part_low);
                    high = high.max(part_high);
                }
            }
        }
        (low, high)
    }
}

#[derive(Debug)]
struct PartBox {
    center: DVec3,
    half: DVec3,
}

impl From<Bounds32> for PartBox {
    fn from(bounds: Bounds32) -> Self {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        Self { center: 0.5 * (min + max), half: 0.5 * (max - min) }
    }
}

/// Children of a node, with boxes that are not padded beyond the mesh's own.
fn children(mesh: &MeshBvh, node: ChildRef) -> impl Iterator<Item = (Bounds32, ChildRef)> {
    let node = &mesh.tree.nodes[node.index()];
    let present = (0..8).filter(|&slot| node.child.0[slot] != ChildRef::NONE.0);
    present.map(|slot| {
        let side =
            |side: usize| Vec3::from_array([0, 1, 2].map(|axis| node.bounds[axis][side].0[slot]));
        let (min, max) = (side(0).max(mesh.bounds.min), side(1).min(mesh.bounds.max));
        (Bounds32 { min, max }, ChildRef(node.child.0[slot]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parts in a ring of eight, away from the origin.
    fn parts() -> MeshParts {
        let part = |index: usize| {
            let turn = index as f64 * std::f64::consts::FRAC_PI_4;
            let center = DVec3::new(3.0 + 2.0 * turn.cos(), 2.0 * turn.sin() - 1.0, 0.5 * turn);
            PartBox { center, half: DVec3::new(0.3, 0.2, 0.1 + 0.05 * turn) }
        };
        let topmost = (0..8).map(|index| (part(index), index..index + 1)).collect();
        MeshParts { topmost, parts: (0..8).map(part).collect() }
    }

    /// *Expected*: no direction has a larger extent than the table says. Between points at a distance `s = 1/16`, a
    /// line is at most `s/4` times the change of slope above a convex function, which for a body of width `w` is at most
    /// `w`: along two sides no more than `s w / 2`.
    #[test]
    fn a_table_is_never_below_the_extent_and_hardly_above_it() {
        let (parts, mut widest) = (parts(), 0.0_f64);
        let table = MeshExtent::Table(SupportTable::new(&parts));
        for index in 0..20_000_u32 {
            let z = 2.0 * (f64::from(index) + 0.5) / 20_000.0 - 1.0;
            let (sin, cos) = (f64::from(index) * 2.399_963_229_728_653).sin_cos();
            let across = (1.0 - z * z).sqrt();
            let length = 0.1 + f64::from(index % 7);
            let direction = length * DVec3::new(across * cos, across * sin, z);
            let ((low, high), (least, most)) = (parts.extent(direction), table.along(direction));
            let rounding = 1e-12 * length;
            assert!(least <= low + rounding && most >= high - rounding, "{direction}");
            widest = widest.max((most - high).max(low - least) / length);
        }
        let width = (0..3).map(|axis| {
            let (low, high) = parts.extent(DVec3::AXES[axis]);
            high - low
        });
        let most = width.fold(0.0, f64::hypot) / 32.0;
        assert!(widest < most && widest > 0.0, "{widest} {most}");
    }

    #[test]
    fn directions_along_axes_and_edges_of_the_cube_are_exact() {
        let parts = parts();
        let table = MeshExtent::Table(SupportTable::new(&parts));
        for direction in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::ONE, DVec3::new(1.0, -1.0, 1.0)]
        {
            assert_eq!(table.along(direction), parts.extent(direction), "{direction}");
        }
    }
}
