//! Eight-wide trees: built by obvhs as binary trees, collapsed here by cost.

use glam::Vec3;
use obvhs::{Boundable, aabb::Aabb};
use rayon::prelude::*;

use super::{
    binary,
    collapse::{self, Part},
    simd::{Lanes, Words},
};

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

    pub(super) fn half_area(self) -> f32 {
        let size = (self.max - self.min).max(Vec3::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    /// Twice the centre.
    pub(super) fn middle(self) -> Vec3 {
        self.min + self.max
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
    pub(super) fn new() -> Self {
        Self {
            bounds: [[Lanes([f32::INFINITY; 8]), Lanes([f32::NEG_INFINITY; 8])]; 3],
            child: Words([Ref::NONE.0; 8]),
            order: Words([0; 8]),
        }
    }

    /// Fixes the order of the children, once all are set.
    pub(super) fn arrange(&mut self) {
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

    pub(super) fn set(&mut self, slot: usize, bounds: Box3, child: Ref) {
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

/// Primitives that one binary tree is built over: it bounds the memory that building takes, and
/// lets parts be built at once.
const PART: usize = 1 << 18;

/// Builds the tree over `boxes`. `kind` tells primitives apart that may not share a leaf.
/// `make_leaves` is told how many leaves there will be and gives what takes the primitives of one
/// leaf, all of a kind, and says where it put them.
///
/// The order of leaves and nodes is that of a depth-first walk.
pub(super) fn build<L: FnMut(&[u32]) -> Ref>(
    boxes: Vec<Box3>,
    plan: Plan,
    kind: impl Fn(u32) -> bool + Sync,
    make_leaves: impl FnOnce(usize) -> L,
) -> Tree {
    if boxes.is_empty() {
        return Tree { root: Ref::NONE, nodes: Vec::new() };
    }
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut parts = Vec::new();
    let top = halve(&boxes, &mut order, &mut parts);
    let parts: Vec<(Box3, Part)> = parts
        .into_par_iter()
        .map(|members| {
            let tree = binary::build(&boxes, members, plan, &kind);
            (tree.bounds(), collapse::collapse(&boxes, tree, plan, &kind))
        })
        .collect();
    drop(boxes);
    drop(order);
    let leaves = parts.iter().map(|(_, part)| part.leaves.len()).sum();
    let inner: usize = parts.iter().map(|(_, part)| part.nodes.len()).sum();
    let mut join = Join {
        make_leaf: make_leaves(leaves),
        nodes: Vec::with_capacity(inner + parts.len()),
        pad: plan.pad,
        parts: parts.into_iter().map(Some).collect(),
    };
    let root = join.emit(&top).1;
    Tree { root, nodes: join.nodes }
}

/// How the primitives were shared out: a part, or two halves.
enum Half {
    Part(usize),
    Two(Box<[Self; 2]>),
}

/// Cuts at the median of the longest axis of the centres until parts are small enough.
fn halve<'a>(boxes: &[Box3], order: &'a mut [u32], parts: &mut Vec<&'a mut [u32]>) -> Half {
    if order.len() <= PART {
        parts.push(order);
        return Half::Part(parts.len() - 1);
    }
    let middle = |index: u32| boxes[index as usize].middle();
    let around = order.iter().fold(Box3::EMPTY, |around, &index| {
        let at = middle(index);
        around.union(Box3 { min: at, max: at })
    });
    let axis = (around.max - around.min).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(&b))
    });
    let (low, high) = order.split_at_mut(half);
    Half::Two(Box::new([halve(boxes, low, parts), halve(boxes, high, parts)]))
}

/// Puts the trees of all parts into one.
struct Join<L> {
    make_leaf: L,
    nodes: Vec<Node>,
    pad: f32,
    parts: Vec<Option<(Box3, Part)>>,
}

impl<L: FnMut(&[u32]) -> Ref> Join<L> {
    fn emit(&mut self, half: &Half) -> (Box3, Ref) {
        let mut open = vec![half];
        if let Half::Part(part) = *half {
            let Some((bounds, part)) = self.parts[part].take() else {
                return (Box3::EMPTY, Ref::NONE);
            };
            return (bounds, self.append(part));
        }
        // Halves are of equal size, so that opening the first of all keeps them so.
        while let Some(at) = open.iter().position(|half| matches!(half, Half::Two(_))) {
            if open.len() == 8 {
                break;
            }
            if let Half::Two(halves) = open.remove(at) {
                open.extend(halves.iter());
            }
        }
        let index = self.nodes.len();
        self.nodes.push(Node::new());
        let mut around = Box3::EMPTY;
        for (slot, half) in open.into_iter().enumerate() {
            let (bounds, child) = self.emit(half);
            around = around.union(bounds);
            self.nodes[index].set(slot, bounds.padded(self.pad), child);
        }
        self.nodes[index].arrange();
        (around, Ref(index as u32))
    }

    fn append(&mut self, part: Part) -> Ref {
        let first = self.nodes.len() as u32;
        let made: Vec<Ref> =
            part.leaves.iter().map(|leaf| (self.make_leaf)(&part.order[leaf.clone()])).collect();
        let moved = |child: Ref| match child {
            Ref::NONE => Ref::NONE,
            child if child.is_inner() => Ref(child.0 + first),
            child => made[child.index()],
        };
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.child = Words(node.child.0.map(|child| moved(Ref(child)).0));
            node
        }));
        moved(part.root)
    }
}
