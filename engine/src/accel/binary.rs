//! Binary trees: built by obvhs, and below a thousand primitives built again for full leaves.

use glam::Vec3;
use obvhs::{
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};

use super::{
    collapse::{Cost, cost_of},
    tree::{Box3, Plan},
};

/// A binary tree whose subtrees each hold a range of `order`; children come after their parent.
pub(super) struct Binary {
    pub nodes: Vec<BinaryNode>,
    pub costs: Vec<Cost>,
    /// Primitives.
    pub order: Vec<u32>,
}

pub(super) struct BinaryNode {
    pub bounds: Box3,
    /// The two children; no children at all if the first is 0.
    pub children: [u32; 2],
    pub start: u32,
    pub count: u32,
}

impl Binary {
    pub(super) fn bounds(&self) -> Box3 {
        self.nodes[0].bounds
    }
}

/// Subtrees of at most this many primitives are built again; more takes longer and gains nothing.
const AGAIN: u32 = 1024;

/// Builds the tree over some of the boxes.
pub(super) fn build(
    boxes: &[Box3],
    members: &[u32],
    plan: Plan,
    kind: &impl Fn(u32) -> bool,
) -> Binary {
    let own: Vec<Box3> = members.iter().map(|&member| boxes[member as usize]).collect();
    let source = ploc(&own, plan.reinsertion);
    drop(own);
    let counts = counts(&source);
    let mut copy = Copy {
        boxes,
        members,
        plan,
        kind,
        source: &source,
        counts,
        tree: Binary {
            nodes: Vec::with_capacity(source.nodes.len()),
            costs: Vec::with_capacity(source.nodes.len()),
            order: Vec::with_capacity(members.len()),
        },
    };
    copy.all();
    copy.tree
}

fn ploc(boxes: &[Box3], reinsertion: f32) -> Bvh2 {
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
    let mut waiting = vec![0_u32];
    while let Some(at) = waiting.pop() {
        order.push(at);
        let node = &source.nodes[at as usize];
        if !node.is_leaf() {
            waiting.extend([node.first_index, node.first_index + 1]);
        }
    }
    let mut counts = vec![1; source.nodes.len()];
    for &at in order.iter().rev() {
        let node = &source.nodes[at as usize];
        if !node.is_leaf() {
            let first = node.first_index as usize;
            counts[at as usize] = counts[first] + counts[first + 1];
        }
    }
    counts
}

struct Copy<'a, K> {
    boxes: &'a [Box3],
    members: &'a [u32],
    plan: Plan,
    kind: &'a K,
    source: &'a Bvh2,
    counts: Vec<u32>,
    tree: Binary,
}

impl<K: Fn(u32) -> bool> Copy<'_, K> {
    /// Copies the tree of obvhs, depth first, small subtrees in the cheaper of two forms.
    fn all(&mut self) {
        // Where to copy from, and whose which child it is.
        let mut waiting = vec![(0_u32, None)];
        while let Some((from, parent)) = waiting.pop() {
            let index = self.tree.nodes.len() as u32;
            if let Some((parent, side)) = parent {
                let parent: &mut BinaryNode = &mut self.tree.nodes[parent as usize];
                parent.children[side] = index;
            }
            let count = self.counts[from as usize];
            let small = count <= AGAIN && count > self.plan.leaf;
            if small {
                self.cheaper(from);
            } else {
                self.one(from, index, &mut waiting);
            }
        }
        self.finish(0);
    }

    /// Copies one node and asks for its children, the first one next.
    fn one(&mut self, from: u32, index: u32, waiting: &mut Vec<(u32, Option<(u32, usize)>)>) {
        let node = &self.source.nodes[from as usize];
        let bounds = Box3 { min: node.aabb().min.into(), max: node.aabb().max.into() };
        let (start, count) = (self.tree.order.len() as u32, self.counts[from as usize]);
        self.tree.nodes.push(BinaryNode { bounds, children: [0; 2], start, count });
        self.tree.costs.push(Cost::UNKNOWN);
        if node.is_leaf() {
            let own = self.source.primitive_indices[node.first_index as usize];
            self.tree.order.push(self.members[own as usize]);
        } else {
            waiting.push((node.first_index + 1, Some((index, 1))));
            waiting.push((node.first_index, Some((index, 0))));
        }
    }

    /// Copies a subtree as it is, or builds it again if that is cheaper.
    fn cheaper(&mut self, from: u32) {
        let (first, start) = (self.tree.nodes.len(), self.tree.order.len());
        let mut waiting = vec![(from, None)];
        while let Some((from, parent)) = waiting.pop() {
            let index = self.tree.nodes.len() as u32;
            if let Some((parent, side)) = parent {
                let parent: &mut BinaryNode = &mut self.tree.nodes[parent as usize];
                parent.children[side] = index;
            }
            self.one(from, index, &mut waiting);
        }
        self.finish(first);
        let kept = (self.tree.nodes.split_off(first), self.tree.costs.split_off(first));
        let kept_order = self.tree.order[start..].to_vec();
        let mut order = kept_order.clone();
        self.again(&mut order, start as u32);
        self.tree.order.truncate(start);
        self.tree.order.extend(order);
        self.finish(first);
        if kept.1[0].as_one() <= self.tree.costs[first].as_one() {
            self.tree.nodes.truncate(first);
            self.tree.costs.truncate(first);
            self.tree.order.truncate(start);
            self.tree.nodes.extend(kept.0);
            self.tree.costs.extend(kept.1);
            self.tree.order.extend(kept_order);
        }
    }

    /// Builds top-down, at each cut with the least sum of area times blocks; says where.
    fn again(&mut self, order: &mut [u32], start: u32) -> u32 {
        let index = self.tree.nodes.len();
        let bounds = self.around(order);
        let count = order.len() as u32;
        self.tree.nodes.push(BinaryNode { bounds, children: [0; 2], start, count });
        self.tree.costs.push(Cost::UNKNOWN);
        let is_second = |&primitive: &u32| (self.kind)(primitive);
        let seconds = order.iter().filter(|p| is_second(p)).count();
        let mixed = seconds > 0 && seconds < order.len();
        if count <= self.plan.leaf && !mixed {
            return index as u32;
        }
        let cut = if mixed {
            order.sort_by_key(|p| is_second(p));
            order.len() - seconds
        } else {
            self.cut(order)
        };
        let (low, high) = order.split_at_mut(cut);
        let children = [self.again(low, start), self.again(high, start + cut as u32)];
        self.tree.nodes[index].children = children;
        index as u32
    }

    fn around(&self, order: &[u32]) -> Box3 {
        order.iter().map(|&p| self.boxes[p as usize]).fold(Box3::EMPTY, Box3::union)
    }

    /// Sorts along the best axis and says how many come before the cut.
    fn cut(&self, order: &mut [u32]) -> usize {
        let blocks = |count: usize| count.div_ceil(self.plan.leaf as usize) as f32;
        let sort = |order: &mut [u32], axis: usize| {
            let middle = |p: u32| -> Vec3 { self.boxes[p as usize].middle() };
            order.sort_unstable_by(|&a, &b| {
                middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(&b))
            });
        };
        let mut best = (f32::INFINITY, 0, 1);
        let mut above = vec![0.0; order.len()];
        for axis in 0..3 {
            sort(order, axis);
            let mut bounds = Box3::EMPTY;
            for (index, &p) in order.iter().enumerate().rev() {
                bounds = bounds.union(self.boxes[p as usize]);
                above[index] = bounds.half_area() * blocks(order.len() - index);
            }
            bounds = Box3::EMPTY;
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

    /// Costs of all nodes from `first` on that are not known yet.
    fn finish(&mut self, first: usize) {
        for index in (first..self.tree.nodes.len()).rev() {
            if !self.tree.costs[index].is_known() {
                self.tree.costs[index] = cost_of(&self.tree, index, self.plan, self.kind);
            }
        }
    }
}
