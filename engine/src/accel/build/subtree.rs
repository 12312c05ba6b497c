//! Top-down construction of small subtrees for full leaves: exact sweeps along three axes that are sorted once.

use std::ops::Range;

use glam::Vec3A;
use obvhs::{aabb::Aabb, bvh2::node::Bvh2Node};

use crate::accel::layout::Bounds32;

use super::leaves::Leaves;

/// Binary hierarchy over blocks of primitives.
pub(super) struct Subtree {
    /// Root, then pairs of siblings; a leaf holds the number of its block.
    pub nodes: Vec<Bvh2Node>,
    pub blocks: Leaves,
    /// Maximum number of nodes from the root down to a leaf.
    pub depth: usize,
}

/// Builder of subtrees; the next one uses its memory again. Primitives are numbered in ascending order of their indices.
#[derive(Default)]
pub(super) struct SubtreeBuilder {
    boxes: Vec<LocalBox>,
    is_second: Vec<bool>,
    /// Primitives along each axis by centre; equal centres by index.
    sorted: [Vec<u16>; 3],
    /// Keys while an axis is sorted.
    keys: Vec<u64>,
    /// Cost of the primitives from each one on, while cuts are compared.
    above: Vec<f32>,
    /// Side of the cut of each primitive.
    is_high: Vec<bool>,
    /// Primitives of the high side, while the others are moved together.
    high: Vec<u16>,
}

/// Node that is still to be built.
struct PendingNode {
    index: usize,
    /// Its range of the sorted primitives.
    range: Range<usize>,
    /// Axis along which its block lists them, if it is a leaf.
    axis: usize,
    depth: usize,
}

/// Cut of a range of the sorted primitives.
struct Cut {
    axis: usize,
    /// Number of primitives of the low side.
    low: usize,
}

impl SubtreeBuilder {
    /// Divides the boxes with the indices `primitives` into blocks, with the lowest sum of area times blocks at each
    /// cut.
    pub(super) fn build(
        &mut self,
        boxes: &[Bounds32],
        mut primitives: Vec<u32>,
        leaf_size: u32,
        is_second_kind: &impl Fn(u32) -> bool,
    ) -> Subtree {
        primitives.sort_unstable();
        self.boxes.clear();
        self.boxes.extend(primitives.iter().map(|&p| LocalBox::from(boxes[p as usize])));
        self.is_second.clear();
        self.is_second.extend(primitives.iter().map(|&p| is_second_kind(p)));
        self.above.resize(primitives.len(), 0.0);
        self.is_high.resize(primitives.len(), false);
        for axis in 0..3 {
            self.sort(axis);
        }
        let blocks = Leaves::with_capacity(primitives.len(), primitives.len() / leaf_size as usize);
        let mut tree = Subtree { nodes: vec![Bvh2Node::default()], blocks, depth: 0 };
        let root = PendingNode { index: 0, range: 0..primitives.len(), axis: 0, depth: 1 };
        self.divide(&mut tree, root, leaf_size as usize);
        for local in &mut tree.blocks.order {
            *local = primitives[*local as usize];
        }
        tree
    }

    fn sort(&mut self, axis: usize) {
        self.keys.clear();
        let keys = self.boxes.iter().zip(0_u64..).map(|(bounds, local)| {
            let center = (bounds.min + bounds.max)[axis].to_bits();
            // In the order of `f32::total_cmp`.
            let key = if center >> 31 == 0 { center | 1 << 31 } else { !center };
            u64::from(key) << 32 | local
        });
        self.keys.extend(keys);
        self.keys.sort_unstable();
        self.sorted[axis].clear();
        self.sorted[axis].extend(self.keys.iter().map(|&key| key as u16));
    }

    /// Builds the subtree below a node.
    fn divide(&mut self, tree: &mut Subtree, node: PendingNode, leaf_size: usize) {
        let PendingNode { index, range, axis, depth } = node;
        tree.depth = tree.depth.max(depth);
        let members = &self.sorted[axis][range.clone()];
        let bounds = members
            .iter()
            .fold(LocalBox::EMPTY, |bounds, &local| bounds.union(self.boxes[usize::from(local)]));
        let bounds = Aabb { min: bounds.min, max: bounds.max };
        let seconds = members.iter().filter(|&&local| self.is_second[usize::from(local)]).count();
        let is_mixed = seconds > 0 && seconds < range.len();
        if range.len() <= leaf_size && !is_mixed {
            tree.nodes[index] = Bvh2Node::new(bounds, 1, tree.blocks.ends.len() as u32);
            tree.blocks.order.extend(members.iter().map(|&local| u32::from(local)));
            tree.blocks.ends.push(tree.blocks.order.len() as u32);
            return;
        }
        let cut = if is_mixed {
            Cut { axis, low: self.mark_kinds(&range, axis) }
        } else {
            let cut = self.best_cut(&range, leaf_size);
            self.mark_sides(&range, &cut);
            cut
        };
        for sorted in 0..3 {
            if is_mixed || sorted != cut.axis {
                self.partition(&range, sorted);
            }
        }
        let first = tree.nodes.len();
        tree.nodes[index] = Bvh2Node::new(bounds, 0, first as u32);
        tree.nodes.extend([Bvh2Node::default(); 2]);
        let middle = range.start + cut.low;
        for (index, range) in [(first, range.start..middle), (first + 1, middle..range.end)] {
            let child = PendingNode { index, range, axis: cut.axis, depth: depth + 1 };
            self.divide(tree, child, leaf_size);
        }
    }

    /// Cut with the lowest sum of area times blocks over all axes.
    fn best_cut(&mut self, range: &Range<usize>, leaf_size: usize) -> Cut {
        let blocks = |count: usize| count.div_ceil(leaf_size) as f32;
        let mut lowest = f32::INFINITY;
        let mut best = Cut { axis: 0, low: 1 };
        for axis in 0..3 {
            let members = &self.sorted[axis][range.clone()];
            let above = &mut self.above[..members.len()];
            let mut bounds = LocalBox::EMPTY;
            for (index, (&local, above)) in members.iter().zip(&mut *above).enumerate().rev() {
                bounds = bounds.union(self.boxes[usize::from(local)]);
                *above = bounds.half_area() * blocks(members.len() - index);
            }
            bounds = LocalBox::EMPTY;
            for (low, (&local, above)) in (1..).zip(members.iter().zip(&above[1..])) {
                bounds = bounds.union(self.boxes[usize::from(local)]);
                let cost = bounds.half_area() * blocks(low) + above;
                if cost < lowest {
                    lowest = cost;
                    best = Cut { axis, low };
                }
            }
        }
        best
    }

    /// Marks the primitives of the second kind as the high side; returns the number of the others.
    fn mark_kinds(&mut self, range: &Range<usize>, axis: usize) -> usize {
        let mut low = 0;
        for &local in &self.sorted[axis][range.clone()] {
            let is_high = self.is_second[usize::from(local)];
            self.is_high[usize::from(local)] = is_high;
            low += usize::from(!is_high);
        }
        low
    }

    fn mark_sides(&mut self, range: &Range<usize>, cut: &Cut) {
        for (position, &local) in self.sorted[cut.axis][range.clone()].iter().enumerate() {
            self.is_high[usize::from(local)] = position >= cut.low;
        }
    }

    /// Moves the low side of the cut before the high one; both keep their order.
    fn partition(&mut self, range: &Range<usize>, axis: usize) {
        let members = &mut self.sorted[axis][range.clone()];
        self.high.clear();
        let mut low = 0;
        for index in 0..members.len() {
            let local = members[index];
            if self.is_high[usize::from(local)] {
                self.high.push(local);
            } else {
                members[low] = local;
                low += 1;
            }
        }
        members[low..].copy_from_slice(&self.high);
    }
}

/// Box in registers of four lanes.
#[derive(Clone, Copy)]
struct LocalBox {
    min: Vec3A,
    max: Vec3A,
}

impl LocalBox {
    const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    fn half_area(self) -> f32 {
        let size = (self.max - self.min).max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

impl From<Bounds32> for LocalBox {
    fn from(bounds: Bounds32) -> Self {
        Self { min: bounds.min.into(), max: bounds.max.into() }
    }
}
