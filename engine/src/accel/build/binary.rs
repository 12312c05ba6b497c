//! Binary hierarchies: built by obvhs; subtrees of up to a thousand primitives are rebuilt for full leaves.

use glam::Vec3;
use obvhs::{
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};

use crate::accel::layout::Bounds32;

use super::{
    collapse::{ForestCost, cost_of},
    wide::BuildSettings,
};

/// Binary hierarchy, each subtree of which holds a range of `order`; children come after their parent.
pub(super) struct BinaryBvh {
    pub nodes: Vec<BinaryNode>,
    pub costs: Vec<ForestCost>,
    /// Primitives.
    pub order: Vec<u32>,
}

pub(super) struct BinaryNode {
    pub bounds: Bounds32,
    /// Indices of the two children; a leaf if the first is 0.
    pub children: [u32; 2],
    pub start: u32,
    pub count: u32,
}

impl BinaryBvh {
    pub(super) fn bounds(&self) -> Bounds32 {
        self.nodes[0].bounds
    }
}

/// Maximum number of primitives of a subtree that is rebuilt; more takes longer and gains nothing.
const MAX_REBUILT: u32 = 1024;

/// Builds the hierarchy over the boxes with the indices `members`.
pub(super) fn build(
    boxes: &[Bounds32],
    members: &[u32],
    settings: BuildSettings,
    is_second_kind: &impl Fn(u32) -> bool,
) -> BinaryBvh {
    let member_boxes: Vec<Bounds32> =
        members.iter().map(|&member| boxes[member as usize]).collect();
    let source = ploc(&member_boxes, settings.reinsertion);
    drop(member_boxes);
    let counts = counts(&source);
    let mut builder = BinaryBuilder {
        boxes,
        members,
        settings,
        is_second_kind,
        source: &source,
        counts,
        tree: BinaryBvh {
            nodes: Vec::with_capacity(source.nodes.len()),
            costs: Vec::with_capacity(source.nodes.len()),
            order: Vec::with_capacity(members.len()),
        },
    };
    builder.copy_all();
    builder.tree
}

fn ploc(boxes: &[Bounds32], reinsertion: f32) -> Bvh2 {
    let indices = (0..boxes.len() as u32).collect();
    let mut binary = PlocBuilder::with_capacity(boxes.len()).build(
        PlocSearchDistance::Medium,
        boxes,
        indices,
        SortPrecision::U64,
        1,
    );
    ReinsertionOptimizer::default().run(&mut binary, reinsertion, None);
    binary
}

/// Number of primitives below each node.
fn counts(source: &Bvh2) -> Vec<u32> {
    let mut order = Vec::with_capacity(source.nodes.len());
    let mut pending = vec![0_u32];
    while let Some(index) = pending.pop() {
        order.push(index);
        let node = &source.nodes[index as usize];
        if !node.is_leaf() {
            pending.extend([node.first_index, node.first_index + 1]);
        }
    }
    let mut counts = vec![1; source.nodes.len()];
    for &index in order.iter().rev() {
        let node = &source.nodes[index as usize];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            counts[index as usize] = counts[first] + counts[first + 1];
        }
    }
    counts
}

/// Node of obvhs that is still to be copied.
#[derive(Clone, Copy)]
struct PendingNode {
    source: u32,
    /// Parent in the copy, and which of its two children the node is.
    parent: Option<(u32, usize)>,
}

/// Copy of the hierarchy of obvhs in progress.
struct BinaryBuilder<'a, K> {
    boxes: &'a [Bounds32],
    members: &'a [u32],
    settings: BuildSettings,
    is_second_kind: &'a K,
    source: &'a Bvh2,
    counts: Vec<u32>,
    tree: BinaryBvh,
}

impl<K: Fn(u32) -> bool> BinaryBuilder<'_, K> {
    /// Copies the hierarchy of obvhs, depth first; rebuilds small subtrees where that is cheaper.
    fn copy_all(&mut self) {
        let mut pending = vec![PendingNode { source: 0, parent: None }];
        while let Some(node) = pending.pop() {
            let count = self.counts[node.source as usize];
            if count <= MAX_REBUILT && count > self.settings.leaf_size {
                self.link(node);
                self.copy_or_rebuild(node.source);
            } else {
                self.copy_node(node, &mut pending);
            }
        }
        self.set_costs(0);
    }

    /// Makes the next node of the copy a child of its parent.
    fn link(&mut self, node: PendingNode) {
        let index = self.tree.nodes.len() as u32;
        if let Some((parent, side)) = node.parent {
            self.tree.nodes[parent as usize].children[side] = index;
        }
    }

    /// Copies one node and pushes its children, the first one last.
    fn copy_node(&mut self, pending_node: PendingNode, pending: &mut Vec<PendingNode>) {
        self.link(pending_node);
        let index = self.tree.nodes.len() as u32;
        let node = &self.source.nodes[pending_node.source as usize];
        let bounds = Bounds32 { min: node.aabb().min.into(), max: node.aabb().max.into() };
        let start = self.tree.order.len() as u32;
        let count = self.counts[pending_node.source as usize];
        self.tree.nodes.push(BinaryNode { bounds, children: [0; 2], start, count });
        self.tree.costs.push(ForestCost::UNKNOWN);
        if node.is_leaf() {
            let member = self.source.primitive_indices[node.first_index as usize];
            self.tree.order.push(self.members[member as usize]);
        } else {
            for side in [1, 0] {
                let source = node.first_index + side;
                pending.push(PendingNode { source, parent: Some((index, side as usize)) });
            }
        }
    }

    /// Copies a subtree as it is, or rebuilds it if that is cheaper.
    fn copy_or_rebuild(&mut self, source: u32) {
        let (first, start) = (self.tree.nodes.len(), self.tree.order.len());
        let mut pending = vec![PendingNode { source, parent: None }];
        while let Some(node) = pending.pop() {
            self.copy_node(node, &mut pending);
        }
        self.set_costs(first);
        let copied = (self.tree.nodes.split_off(first), self.tree.costs.split_off(first));
        let copied_order = self.tree.order[start..].to_vec();
        let mut order = copied_order.clone();
        self.rebuild(&mut order, start as u32);
        self.tree.order.truncate(start);
        self.tree.order.extend(order);
        self.set_costs(first);
        if copied.1[0].as_one_tree() <= self.tree.costs[first].as_one_tree() {
            self.tree.nodes.truncate(first);
            self.tree.costs.truncate(first);
            self.tree.order.truncate(start);
            self.tree.nodes.extend(copied.0);
            self.tree.costs.extend(copied.1);
            self.tree.order.extend(copied_order);
        }
    }

    /// Builds top-down, with the lowest sum of area times blocks at each cut; returns the index of the root.
    fn rebuild(&mut self, order: &mut [u32], start: u32) -> u32 {
        let index = self.tree.nodes.len();
        let bounds = self.union(order);
        let count = order.len() as u32;
        self.tree.nodes.push(BinaryNode { bounds, children: [0; 2], start, count });
        self.tree.costs.push(ForestCost::UNKNOWN);
        let is_second = |&primitive: &u32| (self.is_second_kind)(primitive);
        let seconds = order.iter().filter(|p| is_second(p)).count();
        let is_mixed = seconds > 0 && seconds < order.len();
        if count <= self.settings.leaf_size && !is_mixed {
            return index as u32;
        }
        let cut = if is_mixed {
            order.sort_by_key(|p| is_second(p));
            order.len() - seconds
        } else {
            self.sort_and_cut(order)
        };
        let (low, high) = order.split_at_mut(cut);
        let children = [self.rebuild(low, start), self.rebuild(high, start + cut as u32)];
        self.tree.nodes[index].children = children;
        index as u32
    }

    fn union(&self, order: &[u32]) -> Bounds32 {
        order.iter().map(|&p| self.boxes[p as usize]).fold(Bounds32::EMPTY, Bounds32::union)
    }

    /// Sorts along the best axis and returns the number of primitives before the cut.
    fn sort_and_cut(&self, order: &mut [u32]) -> usize {
        let blocks = |count: usize| count.div_ceil(self.settings.leaf_size as usize) as f32;
        let sort = |order: &mut [u32], axis: usize| {
            let center = |p: u32| -> Vec3 { self.boxes[p as usize].double_center() };
            order.sort_unstable_by(|&a, &b| {
                center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b))
            });
        };
        let mut best = (f32::INFINITY, 0, 1);
        let mut above = vec![0.0; order.len()];
        for axis in 0..3 {
            sort(order, axis);
            let mut bounds = Bounds32::EMPTY;
            for (index, &p) in order.iter().enumerate().rev() {
                bounds = bounds.union(self.boxes[p as usize]);
                above[index] = bounds.half_area() * blocks(order.len() - index);
            }
            bounds = Bounds32::EMPTY;
            for cut in 1..order.len() {
                bounds = bounds.union(self.boxes[order[cut - 1] as usize]);
                let cost = bounds.half_area() * blocks(cut) + above[cut];
                if cost < best.0 {
                    best = (cost, axis, cut);
                }
            }
        }
        sort(order, best.1);
        best.2
    }

    /// Computes the costs of all nodes from `first` on that are not known yet.
    fn set_costs(&mut self, first: usize) {
        for index in (first..self.tree.nodes.len()).rev() {
            if !self.tree.costs[index].is_known() {
                self.tree.costs[index] =
                    cost_of(&self.tree, index, self.settings, self.is_second_kind);
            }
        }
    }
}
