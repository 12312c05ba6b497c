//! From binary trees to eight-wide ones, at the least cost.

use std::ops::Range;

use super::{
    binary::Binary,
    tree::{Box3, Node, Plan, Ref},
};

/// Least cost of a subtree as a forest of at most 1 to 8 trees.
#[derive(Clone, Copy)]
pub(super) struct Cost {
    /// `forest[i]`: of at most `i + 1` trees.
    forest: [f32; 8],
    /// As one leaf; infinite when it cannot be one.
    leaf: f32,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    First,
    Second,
    Mixed,
    Unknown,
}

impl Cost {
    pub(super) const UNKNOWN: Self = Self { forest: [0.0; 8], leaf: 0.0, kind: Kind::Unknown };

    pub(super) fn is_known(&self) -> bool {
        self.kind != Kind::Unknown
    }

    /// As one tree.
    pub(super) fn as_one(&self) -> f32 {
        self.forest[0]
    }
}

/// Cost of a node by the surface-area heuristic; those of its children must be known.
///
/// Source: Ylitie, Karras and Laine (2017), Efficient incoherent ray traversal on GPUs through
/// compressed wide BVHs, section 3.1.
pub(super) fn cost_of(
    tree: &Binary,
    index: usize,
    plan: Plan,
    kind: &impl Fn(u32) -> bool,
) -> Cost {
    let node = &tree.nodes[index];
    let area = node.bounds.half_area();
    if node.children[0] == 0 {
        let is_second = kind(tree.order[node.start as usize]);
        let kind = if is_second { Kind::Second } else { Kind::First };
        let leaf = area * plan.leaf_cost;
        return Cost { forest: [leaf; 8], leaf, kind };
    }
    let [left, right] = node.children.map(|child| tree.costs[child as usize]);
    let kind = if left.kind == right.kind { left.kind } else { Kind::Mixed };
    let fits = node.count <= plan.leaf && kind != Kind::Mixed;
    let leaf = if fits { area * plan.leaf_cost } else { f32::INFINITY };
    let mut forest = [0.0; 8];
    for (trees, cost) in forest.iter_mut().enumerate().skip(1) {
        *cost = split(&left, &right, trees).1;
    }
    forest[0] = leaf.min(area + forest[7]);
    for trees in 1..8 {
        forest[trees] = forest[trees].min(forest[trees - 1]);
    }
    Cost { forest, leaf, kind }
}

/// The best way to share `trees + 1` trees between two subtrees: the left one's number less one,
/// and the cost.
fn split(left: &Cost, right: &Cost, trees: usize) -> (usize, f32) {
    (0..trees)
        .map(|own| (own, left.forest[own] + right.forest[trees - 1 - own]))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })
        .unwrap_or((0, f32::INFINITY))
}

/// A wide tree whose leaves are numbered.
pub(super) struct Part {
    pub root: Ref,
    pub nodes: Vec<Node>,
    /// Each leaf's range of `order`.
    pub leaves: Vec<Range<usize>>,
    pub order: Vec<u32>,
}

/// Levels of wide nodes that follow the binary tree; below them a subtree is cut evenly, so that no
/// input, however odd, makes a tree deeper than this plus the logarithm of its primitives.
const DEEPEST: u32 = 24;

/// Makes the wide tree of least cost.
pub(super) fn collapse(
    boxes: &[Box3],
    mut tree: Binary,
    plan: Plan,
    kind: &impl Fn(u32) -> bool,
) -> Part {
    let order = std::mem::take(&mut tree.order);
    let mut emit = Emit { boxes, tree: &tree, order, plan, kind, nodes: vec![], leaves: vec![] };
    let root = emit.one(0, 0);
    Part { root, nodes: emit.nodes, leaves: emit.leaves, order: emit.order }
}

struct Emit<'a, K> {
    boxes: &'a [Box3],
    tree: &'a Binary,
    order: Vec<u32>,
    plan: Plan,
    kind: &'a K,
    nodes: Vec<Node>,
    leaves: Vec<Range<usize>>,
}

impl<K: Fn(u32) -> bool> Emit<'_, K> {
    /// Writes the subtree of a binary node as one wide tree.
    fn one(&mut self, at: u32, depth: u32) -> Ref {
        let cost = &self.tree.costs[at as usize];
        let node = &self.tree.nodes[at as usize];
        let range = node.start as usize..(node.start + node.count) as usize;
        if cost.leaf <= cost.forest[0] {
            return self.leaf(range);
        }
        if depth >= DEEPEST {
            let kind = self.kind;
            self.order[range.clone()].sort_by_key(|&primitive| kind(primitive));
            return self.evenly(range);
        }
        let mut children = Vec::with_capacity(8);
        self.roots(at, 7, true, &mut children);
        let index = self.nodes.len();
        self.nodes.push(Node::new());
        for (slot, &child) in children.iter().enumerate() {
            let bounds = self.tree.nodes[child as usize].bounds.padded(self.plan.pad);
            let reference = self.one(child, depth + 1);
            self.nodes[index].set(slot, bounds, reference);
        }
        self.nodes[index].arrange();
        Ref(index as u32)
    }

    fn leaf(&mut self, range: Range<usize>) -> Ref {
        self.leaves.push(range);
        Ref(Ref::LEAF | (self.leaves.len() as u32 - 1))
    }

    /// The roots of the cheapest forest of at most `trees + 1` trees; `open` when the node itself
    /// may not be one of them.
    fn roots(&self, at: u32, mut trees: usize, open: bool, roots: &mut Vec<u32>) {
        let cost = &self.tree.costs[at as usize];
        if !open {
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
        let own = split(&costs[left as usize], &costs[right as usize], trees).0;
        self.roots(left, own, false, roots);
        self.roots(right, trees - 1 - own, false, roots);
    }

    /// A tree of the least depth, whatever its cost; the primitives are sorted by kind.
    fn evenly(&mut self, range: Range<usize>) -> Ref {
        let primitives = &self.order[range.clone()];
        let one_kind = (self.kind)(primitives[0]) == (self.kind)(primitives[primitives.len() - 1]);
        if primitives.len() <= self.plan.leaf as usize && one_kind {
            return self.leaf(range);
        }
        let index = self.nodes.len();
        self.nodes.push(Node::new());
        let step = range.len().div_ceil(8);
        for (slot, start) in range.clone().step_by(step).enumerate() {
            let part = start..(start + step).min(range.end);
            let members = self.order[part.clone()].iter();
            let bounds = members.map(|&p| self.boxes[p as usize]).fold(Box3::EMPTY, Box3::union);
            let reference = self.evenly(part);
            self.nodes[index].set(slot, bounds.padded(self.plan.pad), reference);
        }
        self.nodes[index].arrange();
        Ref(index as u32)
    }
}
