//! Bounding volume hierarchy over the surfaces of one material in one mesh.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::FlatPatch;
use crate::components::{Disc, Mesh, MeshPart};
use crate::geometry::{basis, round_down, round_up};

/// Axes that surfaces are divided along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum TreeAxes {
    /// All three: nodes are compact.
    All,
    /// Those of the ground: nodes are columns, as high as the mesh.
    Horizontal,
}

/// Surfaces of a mesh that share a material, in an order in which each node of a binary tree holds a range.
#[derive(Debug)]
pub(in crate::queries) struct SurfaceTree<'a> {
    mesh: &'a Mesh,
    axes: TreeAxes,
    /// Numbers of triangles, and behind them those of discs.
    order: Vec<u32>,
    /// Copies of the surfaces in this order: those of a node lie side by side in memory, which is what visits of nodes
    /// take most of their time for.
    surfaces: Vec<TreeSurface>,
    /// Nodes in depth-first order; the left child of a node follows it.
    nodes: Vec<TreeNode>,
}

/// A surface in object space, m.
#[derive(Clone, Copy, Debug)]
enum TreeSurface {
    Triangle([Vec3; 3]),
    Disc(Disc),
}

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct TreeNode {
    /// Box around its surfaces, m, object space.
    low: Vec3,
    high: Vec3,
    /// Its surfaces, as a range of the order.
    start: u32,
    end: u32,
    /// Right child; 0 if it has no children.
    right: u32,
}

/// Surfaces of a node without children.
const LEAF: usize = 4;

/// Middle of a surface and its number.
type Middle = (Vec3, u32);

impl<'a> SurfaceTree<'a> {
    /// Tree over parts of a mesh; `None` if they hold no surface.
    pub(in crate::queries) fn new<'p>(
        mesh: &'a Mesh,
        parts: impl Iterator<Item = &'p MeshPart>,
    ) -> Option<Self> {
        let triangles = mesh.triangles.len() as u32;
        let numbers = parts.flat_map(|part| {
            part.triangles.clone().chain(part.discs.start + triangles..part.discs.end + triangles)
        });
        let tree = Self::divided(mesh, TreeAxes::All, numbers.collect());
        (!tree.order.is_empty()).then_some(tree)
    }

    /// Tree over the same surfaces whose nodes are columns.
    pub(in crate::queries) fn in_columns(&self) -> Self {
        Self::divided(self.mesh, TreeAxes::Horizontal, self.order.clone())
    }

    /// Tree over surfaces with these numbers.
    fn divided(mesh: &'a Mesh, axes: TreeAxes, order: Vec<u32>) -> Self {
        let mut tree = Self { mesh, axes, order, surfaces: Vec::new(), nodes: Vec::new() };
        let middle = |&number: &u32| (tree.middle(number), number);
        let mut middles: Vec<Middle> = tree.order.iter().map(middle).collect();
        if !middles.is_empty() {
            tree.add_node(&mut middles, 0);
        }
        tree.order = middles.into_iter().map(|(_, number)| number).collect();
        tree.surfaces = tree.order.iter().map(|&number| tree.surface(number)).collect();
        tree
    }

    fn surface(&self, number: u32) -> TreeSurface {
        self.disc(number).map_or_else(
            || TreeSurface::Triangle(self.mesh.corners(number as usize)),
            |&disc| TreeSurface::Disc(disc),
        )
    }

    fn middle(&self, number: u32) -> Vec3 {
        match self.disc(number) {
            Some(disc) => disc.center,
            None => self.mesh.corners(number as usize).into_iter().sum::<Vec3>() / 3.0,
        }
    }

    fn disc(&self, number: u32) -> Option<&Disc> {
        let disc = (number as usize).checked_sub(self.mesh.triangles.len())?;
        self.mesh.discs.get(disc)
    }

    /// Adds the node of some surfaces, whose order begins at `start`, and all nodes below it.
    fn add_node(&mut self, middles: &mut [Middle], start: u32) {
        let at = self.nodes.len();
        let boxes = middles.iter().map(|&(_, number)| self.object_bounds(number));
        let (low, high) =
            boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((Vec3::ZERO, Vec3::ZERO));
        let end = start + middles.len() as u32;
        self.nodes.push(TreeNode { low, high, start, end, right: 0 });
        if middles.len() <= LEAF {
            return;
        }
        let (least, most) = middles
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), (middle, _)| {
                (low.min(*middle), high.max(*middle))
            });
        let axis = match self.axes {
            TreeAxes::All => (most - least).max_position(),
            TreeAxes::Horizontal => (most - least).truncate().max_position(),
        };
        let half = middles.len() / 2;
        middles.select_nth_unstable_by(half, |a, b| {
            a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
        });
        let (left, right) = middles.split_at_mut(half);
        self.add_node(left, start);
        self.nodes[at].right = self.nodes.len() as u32;
        self.add_node(right, start + half as u32);
    }

    /// Box around a surface, m, object space.
    fn object_bounds(&self, number: u32) -> (Vec3, Vec3) {
        let (low, high) = self.surface(number).patch().bounds();
        (Vec3::from(low.to_array().map(round_down)), Vec3::from(high.to_array().map(round_up)))
    }

    /// Nodes; the first is the root.
    pub(in crate::queries) fn nodes(&self) -> &[TreeNode] {
        &self.nodes
    }

    /// Number of surfaces.
    pub(in crate::queries) fn len(&self) -> usize {
        self.order.len()
    }

    /// A surface in object space, m, by its place in the order.
    pub(in crate::queries) fn patch(&self, place: usize) -> FlatPatch {
        self.surfaces[place].patch()
    }

    /// Vector of a surface's area, m², object space; it is perpendicular to it and as long as it is large.
    pub(in crate::queries) fn area_vector(&self, place: usize) -> DVec3 {
        match &self.surfaces[place] {
            TreeSurface::Triangle(corners) => {
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                0.5 * (b - a).cross(c - a)
            }
            TreeSurface::Disc(disc) => {
                let normal = disc.normal.as_dvec3().normalize_or_zero();
                normal * (PI * f64::from(disc.radius).powi(2))
            }
        }
    }
}

impl TreeSurface {
    fn patch(&self) -> FlatPatch {
        match self {
            Self::Triangle(corners) => {
                let [a, b, c] = corners.map(Vec3::as_dvec3);
                FlatPatch { origin: a, u: b - a, v: c - a, is_ellipse: false }
            }
            Self::Disc(disc) => {
                let (u, v) = basis(disc.normal.as_dvec3().normalize_or_zero());
                let (u, v) = (u * f64::from(disc.radius), v * f64::from(disc.radius));
                FlatPatch { origin: disc.center.as_dvec3(), u, v, is_ellipse: true }
            }
        }
    }
}

impl TreeNode {
    /// Box around its surfaces, m, object space: its middle and half its extent.
    pub(in crate::queries) fn middle_and_half(&self) -> (DVec3, DVec3) {
        let (low, high) = (self.low.as_dvec3(), self.high.as_dvec3());
        (0.5 * (low + high), 0.5 * (high - low))
    }

    /// Its children, or none.
    pub(in crate::queries) fn children(&self, node: u32) -> Option<[u32; 2]> {
        (self.right > 0).then_some([node + 1, self.right])
    }

    /// Places of its surfaces in the order.
    pub(in crate::queries) const fn places(&self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_hold_their_surfaces_and_cover_all_of_them() {
        let corner = |index: u32| {
            let at = |factor: u32| (index * factor % 97) as f32;
            Vec3::new(at(31), at(57), at(71))
        };
        let vertices: Vec<Vec3> = (0..300).map(corner).collect();
        let triangles: Vec<[u32; 3]> = (0..100).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let discs = (0..50).map(|i| Disc { center: corner(7 * i), normal: Vec3::Y, radius: 2.0 });
        let part = MeshPart { name: "a".to_owned(), triangles: 0..100, discs: 10..50 };
        let mesh = Mesh { vertices, triangles, discs: discs.collect(), parts: vec![part] };
        let tree = SurfaceTree::new(&mesh, mesh.parts.iter()).expect("it has surfaces");
        let mut order = tree.order.clone();
        order.sort_unstable();
        assert_eq!(order, (0..100).chain(110..150).collect::<Vec<u32>>());
        let mut covered = vec![0; tree.len()];
        for (index, node) in tree.nodes().iter().enumerate() {
            let (middle, half) = node.middle_and_half();
            for place in node.places() {
                let (low, high) = tree.patch(place).bounds();
                let reach = (high - middle).abs().max((low - middle).abs());
                assert!((half - reach).min_element() > -1e-5, "{half} {reach}");
                covered[place] += usize::from(node.children(index as u32).is_none());
            }
            if let Some([left, right]) = node.children(index as u32) {
                let [left, right] =
                    [left, right].map(|child| tree.nodes()[child as usize].places());
                assert_eq!(
                    (left.start, left.end, right.end),
                    (node.places().start, right.start, node.places().end)
                );
            }
        }
        assert_eq!(covered, vec![1; tree.len()]);
    }
}
