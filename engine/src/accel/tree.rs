//! Eight-wide trees: built by obvhs as binary trees, collapsed here by cost.

use glam::Vec3;
use obvhs::{
    Boundable,
    aabb::Aabb,
    bvh2::{Bvh2, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};

use super::simd::{Lanes, Words};

/// An `f32` box; boxes handed to the builder must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Box3 {
    pub min: Vec3,
    pub max: Vec3,
}

impl Box3 {
    pub(super) const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    pub(super) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub(super) fn padded(self, by: f32) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Largest absolute coordinate.
    pub(super) fn reach(self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }
}

impl Boundable for Box3 {
    fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }
}

/// Where a child is: an inner node's index, or a leaf's with one of the two tags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ref(pub u32);

impl Ref {
    /// A leaf: planar block or instance.
    pub(super) const LEAF: u32 = 1 << 31;
    /// A leaf of the second kind: disc block.
    pub(super) const OTHER: u32 = 1 << 30;
    /// No child.
    pub(super) const NONE: Self = Self(u32::MAX);

    #[inline(always)]
    pub(super) fn is_inner(self) -> bool {
        self.0 & Self::LEAF == 0
    }

    #[inline(always)]
    pub(super) fn is_other(self) -> bool {
        self.0 & Self::OTHER != 0
    }

    #[inline(always)]
    pub(super) fn index(self) -> usize {
        (self.0 & (Self::OTHER - 1)) as usize
    }
}

/// Boxes of eight children, lower and upper bound of each axis apart, and where they are.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(super) struct Node {
    pub bounds: [[Lanes; 2]; 3],
    pub child: Words,
    /// For rays of each octant, bit `i` of which is set where they run down axis `i`: the children
    /// from the farthest to the nearest, three bits each.
    pub order: Words,
}

impl Node {
    fn new() -> Self {
        Self {
            bounds: [[Lanes([f32::INFINITY; 8]), Lanes([f32::NEG_INFINITY; 8])]; 3],
            child: Words([Ref::NONE.0; 8]),
            order: Words([0; 8]),
        }
    }

    /// Fixes the order of the children, once all are set.
    fn arrange(&mut self) {
        for octant in 0..8 {
            let distance = |slot: usize| -> f32 {
                let along = |axis: usize| {
                    let [low, high] = self.bounds[axis].map(|bounds| bounds.0[slot]);
                    if octant >> axis & 1 == 0 { low + high } else { -low - high }
                };
                along(0) + along(1) + along(2)
            };
            let mut slots = [0, 1, 2, 3, 4, 5, 6, 7];
            slots.sort_by(|&a, &b| distance(b).total_cmp(&distance(a)));
            self.order.0[octant] =
                slots.iter().rev().fold(0, |packed, &slot| packed << 3 | slot as u32);
        }
    }

    fn set(&mut self, slot: usize, bounds: Box3, child: Ref) {
        for axis in 0..3 {
            self.bounds[axis][0].0[slot] = bounds.min[axis];
            self.bounds[axis][1].0[slot] = bounds.max[axis];
        }
        self.child.0[slot] = child.0;
    }
}

/// What the builder is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Primitives that one leaf holds at most.
    pub leaf: u32,
    /// Cost of testing a leaf over that of testing a node's boxes.
    pub leaf_cost: f32,
    /// By how much boxes grow, to cover the rounding of the traversal.
    pub pad: f32,
    /// Share of nodes that reinsertion tries to move.
    pub reinsertion: f32,
}

/// An eight-wide tree without its leaves, which the caller makes.
#[derive(Debug)]
pub(super) struct Tree {
    pub root: Ref,
    pub nodes: Vec<Node>,
}

/// Levels of wide nodes that follow the binary tree; below them a subtree is cut evenly, so that no
/// input, however odd, makes a tree deeper than this plus the logarithm of its primitives.
const DEEPEST: u32 = 24;

/// Builds the tree over `boxes`. `kind` tells primitives apart that may not share a leaf;
/// `make_leaf` takes the primitives of one leaf, all of a kind, and says where it put them.
///
/// The order of leaves and nodes is that of a depth-first walk.
pub(super) fn build(
    boxes: &[Box3],
    plan: Plan,
    kind: impl Fn(u32) -> bool,
    make_leaf: &mut impl FnMut(&[u32]) -> Ref,
) -> Tree {
    let mut tree = Tree { root: Ref::NONE, nodes: Vec::new() };
    if boxes.is_empty() {
        return tree;
    }
    let binary = binary_tree(boxes, plan.reinsertion);
    let mut collapse = Collapse {
        costs: costs(&binary, plan, &kind),
        binary: &binary,
        boxes,
        plan,
        kind,
        make_leaf,
        nodes: Vec::new(),
    };
    tree.root = collapse.emit(0, 0);
    tree.nodes = collapse.nodes;
    tree
}

fn binary_tree(boxes: &[Box3], reinsertion: f32) -> Bvh2 {
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

/// Least cost of a subtree as a forest of at most 1 to 8 trees, and what it holds.
#[derive(Clone, Copy)]
struct Cost {
    /// `forest[i]`: of at most `i + 1` trees.
    forest: [f32; 8],
    /// As one leaf; infinite when it cannot be one.
    leaf: f32,
    count: u32,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    First,
    Second,
    Mixed,
}

/// The surface-area cost of every subtree, children first.
///
/// Source: Ylitie, Karras and Laine (2017), Efficient incoherent ray traversal on GPUs through
/// compressed wide BVHs, section 3.1.
fn costs(binary: &Bvh2, plan: Plan, kind: &impl Fn(u32) -> bool) -> Vec<Cost> {
    let empty = Cost { forest: [0.0; 8], leaf: 0.0, count: 0, kind: Kind::Mixed };
    let mut costs = vec![empty; binary.nodes.len()];
    let mut order = Vec::with_capacity(binary.nodes.len());
    let mut waiting = vec![0_u32];
    while let Some(at) = waiting.pop() {
        order.push(at);
        let node = &binary.nodes[at as usize];
        if !node.is_leaf() {
            waiting.extend([node.first_index, node.first_index + 1]);
        }
    }
    for &at in order.iter().rev() {
        let node = &binary.nodes[at as usize];
        let area = node.aabb().half_area();
        costs[at as usize] = if node.is_leaf() {
            let primitive = binary.primitive_indices[node.first_index as usize];
            let kind = if kind(primitive) { Kind::Second } else { Kind::First };
            let leaf = area * plan.leaf_cost;
            Cost { forest: [leaf; 8], leaf, count: 1, kind }
        } else {
            let left = costs[node.first_index as usize];
            let right = costs[node.first_index as usize + 1];
            let count = left.count + right.count;
            let kind = if left.kind == right.kind { left.kind } else { Kind::Mixed };
            let fits = count <= plan.leaf && kind != Kind::Mixed;
            let leaf = if fits { area * plan.leaf_cost } else { f32::INFINITY };
            let mut forest = [0.0; 8];
            for (trees, cost) in forest.iter_mut().enumerate().skip(1) {
                *cost = split(&left, &right, trees).1;
            }
            forest[0] = leaf.min(area + forest[7]);
            for trees in 1..8 {
                forest[trees] = forest[trees].min(forest[trees - 1]);
            }
            Cost { forest, leaf, count, kind }
        };
    }
    costs
}

/// The best way to share `trees + 1` trees between two subtrees: the left one's number less one,
/// and the cost.
fn split(left: &Cost, right: &Cost, trees: usize) -> (usize, f32) {
    (0..trees)
        .map(|own| (own, left.forest[own] + right.forest[trees - 1 - own]))
        .reduce(|best, next| if next.1 < best.1 { next } else { best })
        .unwrap_or((0, f32::INFINITY))
}

struct Collapse<'a, K, L> {
    binary: &'a Bvh2,
    costs: Vec<Cost>,
    boxes: &'a [Box3],
    plan: Plan,
    kind: K,
    make_leaf: &'a mut L,
    nodes: Vec<Node>,
}

impl<K: Fn(u32) -> bool, L: FnMut(&[u32]) -> Ref> Collapse<'_, K, L> {
    /// Writes the subtree of a binary node as one wide tree.
    fn emit(&mut self, at: u32, depth: u32) -> Ref {
        let cost = &self.costs[at as usize];
        if cost.leaf <= cost.forest[0] {
            let primitives = self.primitives(at);
            return (self.make_leaf)(&primitives);
        }
        if depth >= DEEPEST {
            let mut primitives = self.primitives(at);
            primitives.sort_by_key(|&primitive| (self.kind)(primitive));
            return self.emit_evenly(&primitives);
        }
        let mut children = Vec::with_capacity(8);
        self.roots(at, 7, true, &mut children);
        // The largest first: a search for any hit visits children in this order.
        let area = |child: &u32| self.binary.nodes[*child as usize].aabb().half_area();
        children.sort_by(|a, b| area(b).total_cmp(&area(a)));
        let index = self.nodes.len();
        self.nodes.push(Node::new());
        for (slot, &child) in children.iter().enumerate() {
            let aabb = self.binary.nodes[child as usize].aabb();
            let bounds = Box3 { min: aabb.min.into(), max: aabb.max.into() };
            let reference = self.emit(child, depth + 1);
            self.nodes[index].set(slot, bounds.padded(self.plan.pad), reference);
        }
        self.nodes[index].arrange();
        Ref(index as u32)
    }

    /// The roots of the cheapest forest of at most `trees + 1` trees; `open` when the node itself
    /// may not be one of them.
    fn roots(&self, at: u32, mut trees: usize, open: bool, roots: &mut Vec<u32>) {
        let cost = &self.costs[at as usize];
        let node = &self.binary.nodes[at as usize];
        if !open {
            while trees > 0 && cost.forest[trees - 1] <= cost.forest[trees] {
                trees -= 1;
            }
            if trees == 0 {
                roots.push(at);
                return;
            }
        }
        let (left, right) = (node.first_index, node.first_index + 1);
        let own = split(&self.costs[left as usize], &self.costs[right as usize], trees).0;
        self.roots(left, own, false, roots);
        self.roots(right, trees - 1 - own, false, roots);
    }

    fn primitives(&self, at: u32) -> Vec<u32> {
        let mut found = Vec::with_capacity(self.costs[at as usize].count as usize);
        let mut waiting = vec![at];
        while let Some(at) = waiting.pop() {
            let node = &self.binary.nodes[at as usize];
            if node.is_leaf() {
                found.push(self.binary.primitive_indices[node.first_index as usize]);
            } else {
                waiting.extend([node.first_index + 1, node.first_index]);
            }
        }
        found
    }

    /// A tree of the least depth, whatever its cost; the primitives are sorted by kind.
    fn emit_evenly(&mut self, primitives: &[u32]) -> Ref {
        let one_kind = (self.kind)(primitives[0]) == (self.kind)(primitives[primitives.len() - 1]);
        if primitives.len() <= self.plan.leaf as usize && one_kind {
            return (self.make_leaf)(primitives);
        }
        let index = self.nodes.len();
        self.nodes.push(Node::new());
        for (slot, part) in primitives.chunks(primitives.len().div_ceil(8)).enumerate() {
            let bounds =
                part.iter().map(|&p| self.boxes[p as usize]).fold(Box3::EMPTY, Box3::union);
            let reference = self.emit_evenly(part);
            self.nodes[index].set(slot, bounds.padded(self.plan.pad), reference);
        }
        self.nodes[index].arrange();
        Ref(index as u32)
    }
}
