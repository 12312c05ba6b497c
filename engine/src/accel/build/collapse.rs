//! Collapse of binary hierarchies to eight-wide ones with the lowest cost.

use std::ops::Range;

use crate::accel::layout::{Bounds32, ChildRef, WideBvh, WideNode};

use super::{binary::BinaryBvh, leaves::Leaves, wide::BuildSettings};

/// Lowest cost of a subtree as a forest of at most 1 to 8 trees.
#[derive(Clone, Copy)]
pub(super) struct ForestCost {
    /// `forest[i]`: cost as at most `i + 1` trees.
    forest: [f32; 8],
    /// Cost as one leaf; infinite if the subtree cannot be one.
    leaf: f32,
    kind: LeafKind,
}

/// Kind of the primitives of a subtree; those of both kinds may not share a leaf.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LeafKind {
    First,
    Second,
    Mixed,
    Unknown,
}

impl ForestCost {
    pub(super) const UNKNOWN: Self = Self { forest: [0.0; 8], leaf: 0.0, kind: LeafKind::Unknown };
}

/// Cost of a node by the surface-area heuristic; the costs of its children must be known.
///
/// Source: Ylitie, Karras and Laine (2017), Efficient incoherent ray traversal on GPUs through
/// compressed wide BVHs, section 3.1.
pub(super) fn cost_of(
    tree: &BinaryBvh,
    index: usize,
    settings: BuildSettings,
    is_second_kind: &impl Fn(u32) -> bool,
) -> ForestCost {
    let node = &tree.nodes[index];
    let area = node.bounds.half_area();
    if node.children[0] == 0 {
        let is_second = is_second_kind(tree.order[node.start as usize]);
        let kind = if is_second { LeafKind::Second } else { LeafKind::First };
        let leaf = area * settings.leaf_cost;
        return ForestCost { forest: [leaf; 8], leaf, kind };
    }
    let [left, right] = node.children.map(|child| tree.costs[child as usize]);
    let kind = if left.kind == right.kind { left.kind } else { LeafKind::Mixed };
    let fits = node.count <= settings.leaf_size && kind != LeafKind::Mixed;
    let leaf = if fits { area * settings.leaf_cost } else { f32::INFINITY };
    let mut forest = [0.0; 8];
    for (trees, cost) in forest.iter_mut().enumerate().skip(1) {
        *cost = split(&left, &right, trees).1;
    }
    forest[0] = leaf.min(area + forest[7]);
    for trees in 1..8 {
        forest[trees] = forest[trees].min(forest[trees - 1]);
    }
    ForestCost { forest, leaf, kind }
}

/// Best division of `trees + 1` trees between two subtrees: the number of trees of the left one minus one,
/// and the cost.
fn split(left: &ForestCost, right: &ForestCost, trees: usize) -> (usize, f32) {
    (0..trees)
        .map(|in_left| (in_left, left.forest[in_left] + right.forest[trees - 1 - in_left]))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })
        .unwrap_or((0, f32::INFINITY))
}

/// Eight-wide hierarchy whose leaves are numbered in depth-first order; the order of the children of its nodes is
/// not set.
pub(super) struct CollapsedBvh {
    pub tree: WideBvh,
    pub leaves: Leaves,
}

/// Number of levels that follow the binary hierarchy; below them a subtree is divided evenly. Thus for any input
/// the depth is at most this plus the logarithm of the number of primitives.
const MAX_LEVELS: u32 = 24;

/// Returns the eight-wide hierarchy with the lowest cost.
pub(super) fn collapse(
    boxes: &[Bounds32],
    mut tree: BinaryBvh,
    settings: BuildSettings,
    is_second_kind: &impl Fn(u32) -> bool,
) -> CollapsedBvh {
    let leaves = Leaves { order: std::mem::take(&mut tree.order), ends: Vec::new() };
    let mut collapse =
        Collapse { boxes, tree: &tree, settings, is_second_kind, nodes: Vec::new(), leaves };
    let root = collapse.subtree(0, 0);
    let Collapse { nodes, leaves, .. } = collapse;
    CollapsedBvh { tree: WideBvh { root, nodes }, leaves }
}

struct Collapse<'a, K> {
    boxes: &'a [Bounds32],
    tree: &'a BinaryBvh,
    settings: BuildSettings,
    is_second_kind: &'a K,
    nodes: Vec<WideNode>,
    leaves: Leaves,
}

impl<K: Fn(u32) -> bool> Collapse<'_, K> {
    /// Writes the subtree of a binary node as one tree.
    fn subtree(&mut self, at: u32, depth: u32) -> ChildRef {
        let cost = &self.tree.costs[at as usize];
        let node = &self.tree.nodes[at as usize];
        let range = node.start as usize..(node.start + node.count) as usize;
        if cost.leaf <= cost.forest[0] {
            return self.leaf(range);
        }
        if depth >= MAX_LEVELS {
            let is_second_kind = self.is_second_kind;
            self.leaves.order[range.clone()].sort_by_key(|&primitive| is_second_kind(primitive));
            return self.divide_evenly(range);
        }
        let mut children = Vec::with_capacity(8);
        self.forest_roots(at, 7, true, &mut children);
        let index = self.nodes.len();
        self.nodes.push(WideNode::new());
        for (slot, &child) in children.iter().enumerate() {
            let bounds = self.tree.nodes[child as usize].bounds.padded(self.settings.padding);
            let reference = self.subtree(child, depth + 1);
            self.nodes[index].set(slot, bounds, reference);
        }
        ChildRef(index as u32)
    }

    /// Adds a leaf, which starts where the one before ends.
    fn leaf(&mut self, range: Range<usize>) -> ChildRef {
        self.leaves.ends.push(range.end as u32);
        ChildRef(ChildRef::LEAF | (self.leaves.ends.len() as u32 - 1))
    }

    /// Appends the roots of the cheapest forest of at most `trees + 1` trees; if `must_split`, the node itself
    /// may not be one of them.
    fn forest_roots(&self, at: u32, mut trees: usize, must_split: bool, roots: &mut Vec<u32>) {
        let cost = &self.tree.costs[at as usize];
        if !must_split {
            while trees > 0 && cost.forest[trees - 1] <= cost.forest[trees] {
                trees -= 1;
            }
            if trees == 0 {
                roots.push(at);
                return;
            }
        }
        let [left, right] = self.tree.nodes[at as usize].children;
        let costs = &self.tree.costs;
        let in_left = split(&costs[left as usize], &costs[right as usize], trees).0;
        self.forest_roots(left, in_left, false, roots);
        self.forest_roots(right, trees - 1 - in_left, false, roots);
    }

    /// Writes a tree of minimum depth, whatever its cost; the primitives are sorted by kind.
    fn divide_evenly(&mut self, range: Range<usize>) -> ChildRef {
        let primitives = &self.leaves.order[range.clone()];
        let kind = |index: usize| (self.is_second_kind)(primitives[index]);
        let is_one_kind = kind(0) == kind(primitives.len() - 1);
        if primitives.len() <= self.settings.leaf_size as usize && is_one_kind {
            return self.leaf(range);
        }
        let index = self.nodes.len();
        self.nodes.push(WideNode::new());
        let step = range.len().div_ceil(8);
        for (slot, start) in range.clone().step_by(step).enumerate() {
            let part = start..(start + step).min(range.end);
            let members = self.leaves.order[part.clone()].iter();
            let bounds =
                members.map(|&p| self.boxes[p as usize]).fold(Bounds32::EMPTY, Bounds32::union);
            let reference = self.divide_evenly(part);
            self.nodes[index].set(slot, bounds.padded(self.settings.padding), reference);
        }
        ChildRef(index as u32)
    }
}
