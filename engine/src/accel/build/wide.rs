//! Eight-wide hierarchies over boxes: built by obvhs as binary ones, collapsed here by cost.

use obvhs::{Boundable, aabb::Aabb};
use rayon::prelude::*;

use crate::accel::{
    layout::{Bounds32, ChildRef, WideBvh, WideNode},
    simd::{Words, with_huge_pages},
};

use super::{
    binary,
    collapse::{self, CollapsedBvh},
    leaves::Leaves,
};

impl Boundable for Bounds32 {
    fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }
}

/// Parameters of a build.
#[derive(Clone, Copy, Debug)]
pub(super) struct BuildSettings {
    /// Maximum number of primitives of a leaf.
    pub leaf_size: u32,
    /// Cost of testing a leaf, relative to that of testing a node's boxes.
    pub leaf_cost: f32,
    /// Padding of boxes, which covers the rounding of the traversal.
    pub padding: f32,
}

/// Maximum number of primitives that one binary hierarchy is built over: it bounds the memory of a build, and
/// subsets are built in parallel.
const MAX_SUBSET: usize = 1 << 18;

/// Builds the hierarchy over `boxes`, whose leaves are numbered; [`link_leaves`] completes it.
///
/// `is_second_kind` is the kind of a primitive: primitives of both kinds may not share a leaf. Leaves and nodes are in
/// depth-first order.
pub(super) fn build(
    boxes: Vec<Bounds32>,
    settings: BuildSettings,
    is_second_kind: impl Fn(u32) -> bool + Sync,
) -> CollapsedBvh {
    if boxes.is_empty() {
        let tree = WideBvh { root: ChildRef::NONE, nodes: Vec::new() };
        return CollapsedBvh { tree, leaves: Leaves::default() };
    }
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut subsets = Vec::new();
    let splits = split_at_medians(&boxes, &mut order, &mut subsets);
    let subsets: Vec<(Bounds32, CollapsedBvh)> = subsets
        .into_par_iter()
        .map(|members| {
            let tree = binary::build(&boxes, members, settings, &is_second_kind);
            (tree.bounds(), collapse::collapse(&boxes, tree, settings, &is_second_kind))
        })
        .collect();
    drop(boxes);
    drop(order);
    let mut merge = Merge::new(subsets, settings.padding);
    let root = merge.append_split(&splits).1;
    CollapsedBvh { tree: WideBvh { root, nodes: merge.nodes }, leaves: merge.leaves }
}

/// Replaces the numbers of leaves by references to them, and sets the order of the children of all nodes.
pub(super) fn link_leaves(tree: &mut WideBvh, leaf: impl Fn(usize) -> ChildRef + Sync) {
    let link = |child: u32| match ChildRef(child) {
        ChildRef::NONE => child,
        inner if inner.is_inner() => child,
        number => leaf(number.index()).0,
    };
    tree.nodes.par_iter_mut().for_each(|node| {
        node.child.0 = node.child.0.map(link);
        node.sort_children();
    });
    tree.root.0 = link(tree.root.0);
}

/// Division of the primitives at medians: the index of a subset, or two halves.
enum MedianSplit {
    Subset(usize),
    Halves(Box<[Self; 2]>),
}

/// Splits at the median of the longest axis of the centres until subsets are small enough.
fn split_at_medians<'a>(
    boxes: &[Bounds32],
    order: &'a mut [u32],
    subsets: &mut Vec<&'a mut [u32]>,
) -> MedianSplit {
    if order.len() <= MAX_SUBSET {
        subsets.push(order);
        return MedianSplit::Subset(subsets.len() - 1);
    }
    let center = |index: u32| boxes[index as usize].double_center();
    let centers = order.iter().fold(Bounds32::EMPTY, |centers, &index| {
        let center = center(index);
        centers.union(Bounds32 { min: center, max: center })
    });
    let axis = (centers.max - centers.min).max_position();
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |&a, &b| {
        center(a)[axis].total_cmp(&center(b)[axis]).then(a.cmp(&b))
    });
    let (low, high) = order.split_at_mut(half);
    MedianSplit::Halves(Box::new([
        split_at_medians(boxes, low, subsets),
        split_at_medians(boxes, high, subsets),
    ]))
}

/// Merges the hierarchies of all subsets into one.
struct Merge {
    nodes: Vec<WideNode>,
    leaves: Leaves,
    padding: f32,
    subsets: Vec<Option<(Bounds32, CollapsedBvh)>>,
}

impl Merge {
    /// Reserves memory for the hierarchies of all subsets.
    fn new(subsets: Vec<(Bounds32, CollapsedBvh)>, padding: f32) -> Self {
        let sum = |length: fn(&CollapsedBvh) -> usize| {
            subsets.iter().map(|(_, subset)| length(subset)).sum::<usize>()
        };
        let inner = sum(|subset| subset.tree.nodes.len()) + subsets.len();
        let leaves = Leaves::with_capacity(
            sum(|subset| subset.leaves.order.len()),
            sum(|subset| subset.leaves.ends.len()),
        );
        let nodes = with_huge_pages(inner);
        Self { nodes, leaves, padding, subsets: subsets.into_iter().map(Some).collect() }
    }

    /// Appends the hierarchy of a split; returns its box and the reference to it.
    fn append_split(&mut self, split: &MedianSplit) -> (Bounds32, ChildRef) {
        let mut children = vec![split];
        if let MedianSplit::Subset(subset) = *split {
            let Some((bounds, subset)) = self.subsets[subset].take() else {
                return (Bounds32::EMPTY, ChildRef::NONE);
            };
            return (bounds, self.append_subset(subset));
        }
        // Halves have equal sizes, and stay alike when the first split is always the next to be replaced.
        while let Some(at) =
            children.iter().position(|split| matches!(split, MedianSplit::Halves(_)))
        {
            if children.len() == 8 {
                break;
            }
            if let MedianSplit::Halves(halves) = children.remove(at) {
                children.extend(halves.iter());
            }
        }
        let index = self.nodes.len();
        self.nodes.push(WideNode::new());
        let mut union = Bounds32::EMPTY;
        for (slot, split) in children.into_iter().enumerate() {
            let (bounds, child) = self.append_split(split);
            union = union.union(bounds);
            self.nodes[index].set(slot, bounds.padded(self.padding), child);
        }
        (union, ChildRef(index as u32))
    }

    /// Appends the hierarchy of a subset; returns the reference to its root.
    fn append_subset(&mut self, CollapsedBvh { tree, leaves }: CollapsedBvh) -> ChildRef {
        let first_node = self.nodes.len() as u32;
        let first_leaf = self.leaves.append(leaves);
        let moved = |child: u32| match ChildRef(child) {
            ChildRef::NONE => child,
            inner if inner.is_inner() => child + first_node,
            _ => child + first_leaf,
        };
        self.nodes.extend(tree.nodes.into_iter().map(|mut node| {
            node.child = Words(node.child.0.map(moved));
            node
        }));
        ChildRef(moved(tree.root.0))
    }
}
