//! Binary hierarchies over blocks: obvhs builds them over primitives and improves them over the blocks that small
//! subtrees are divided into.

use std::collections::VecDeque;

use obvhs::{
    bvh2::{Bvh2, DEFAULT_MAX_STACK_DEPTH, node::Bvh2Node, reinsertion::ReinsertionOptimizer},
    ploc::{PlocBuilder, PlocSearchDistance, SortPrecision},
};
use rayon::prelude::*;

use crate::accel::layout::Bounds32;

use super::{
    collapse::{ForestCost, cost_of},
    leaves::Leaves,
    subtree::{Subtree, SubtreeBuilder},
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

/// Maximum number of primitives of a subtree that is built top-down: fewer make more nodes, more make longer boxes.
const MAX_SUBTREE: u32 = 1024;

/// Number of nodes that reinsertion tries to move at first, per primitive: most nodes above blocks of a mesh, and an
/// eighth of those above instances. Four times as many save one visit in a hundred.
const REINSERTED_NODES: f32 = 0.25;

/// Builds the hierarchy over the boxes with the indices `members`; its leaves are blocks.
pub(super) fn build(
    boxes: &[Bounds32],
    members: &[u32],
    settings: BuildSettings,
    is_second_kind: &(impl Fn(u32) -> bool + Sync),
) -> BinaryBvh {
    let source = ploc(boxes, members);
    let counts = counts(&source);
    let (nodes, roots) = copy_top(&source, &counts);
    let build_subtree = |builder: &mut SubtreeBuilder, root: &SubtreeRoot| {
        let mut primitives = Vec::with_capacity(counts[root.source as usize] as usize);
        let mut pending = vec![root.source];
        while let Some(node) = pending.pop() {
            let node = &source.nodes[node as usize];
            if node.is_leaf() {
                let member = source.primitive_indices[node.first_index as usize];
                primitives.push(members[member as usize]);
            } else {
                pending.extend([node.first_index, node.first_index + 1]);
            }
        }
        builder.build(boxes, primitives, settings.leaf_size, is_second_kind)
    };
    let subtrees: Vec<Subtree> =
        roots.par_iter().map_init(SubtreeBuilder::default, build_subtree).collect();
    drop((source, counts));
    let mut blocks = BlockBvh::new(nodes, &roots, subtrees);
    let fraction = REINSERTED_NODES * members.len() as f32 / blocks.bvh.nodes.len() as f32;
    ReinsertionOptimizer::default().run(&mut blocks.bvh, fraction.min(1.0), None);
    let mut tree = blocks.into_depth_first_order();
    for index in (0..tree.nodes.len()).rev() {
        tree.costs[index] = cost_of(&tree, index, settings, is_second_kind);
    }
    tree
}

/// Builds the hierarchy of obvhs over primitives.
fn ploc(boxes: &[Bounds32], members: &[u32]) -> Bvh2 {
    let member_boxes: Vec<Bounds32> =
        members.iter().map(|&member| boxes[member as usize]).collect();
    PlocBuilder::with_capacity(members.len()).build(
        PlocSearchDistance::Medium,
        &member_boxes,
        (0..members.len() as u32).collect(),
        SortPrecision::U64,
        1,
    )
}

/// Number of primitives below each node of a hierarchy whose children come after their parents.
fn counts(source: &Bvh2) -> Vec<u32> {
    let mut counts = vec![1; source.nodes.len()];
    for (index, node) in source.nodes.iter().enumerate().rev() {
        if !node.is_leaf() {
            let first = node.first_index as usize;
            counts[index] = counts[first] + counts[first + 1];
        }
    }
    counts
}

/// Root of a small subtree.
struct SubtreeRoot {
    /// Node of the hierarchy over primitives.
    source: u32,
    /// Node of the hierarchy over blocks.
    node: u32,
    depth: usize,
}

/// Copies the nodes above small subtrees, level by level; the nodes of the subtrees' roots are empty.
fn copy_top(source: &Bvh2, counts: &[u32]) -> (Vec<Bvh2Node>, Vec<SubtreeRoot>) {
    let mut nodes = vec![Bvh2Node::default()];
    let mut roots = Vec::new();
    let mut queue = VecDeque::from([SubtreeRoot { source: 0, node: 0, depth: 0 }]);
    while let Some(root) = queue.pop_front() {
        if counts[root.source as usize] <= MAX_SUBTREE {
            roots.push(root);
            continue;
        }
        let node = &source.nodes[root.source as usize];
        let first = nodes.len() as u32;
        nodes[root.node as usize] = Bvh2Node::new(*node.aabb(), 0, first);
        nodes.extend([Bvh2Node::default(); 2]);
        queue.extend([0, 1].map(|side| SubtreeRoot {
            source: node.first_index + side,
            node: first + side,
            depth: root.depth + 1,
        }));
    }
    (nodes, roots)
}

/// Hierarchy of obvhs whose primitives are blocks.
struct BlockBvh {
    bvh: Bvh2,
    blocks: Leaves,
}

impl BlockBvh {
    /// Puts subtrees below the nodes above them.
    fn new(mut nodes: Vec<Bvh2Node>, roots: &[SubtreeRoot], subtrees: Vec<Subtree>) -> Self {
        let sum = |length: fn(&Subtree) -> usize| subtrees.iter().map(length).sum::<usize>();
        nodes.reserve_exact(sum(|subtree| subtree.nodes.len()));
        let mut blocks = Leaves::with_capacity(
            sum(|subtree| subtree.blocks.order.len()),
            sum(|subtree| subtree.blocks.ends.len()),
        );
        let mut max_depth = DEFAULT_MAX_STACK_DEPTH;
        for (root, subtree) in roots.iter().zip(subtrees) {
            max_depth = max_depth.max(root.depth + subtree.depth);
            // The root itself lies elsewhere.
            let first_node = nodes.len() as u32 - 1;
            let first_block = blocks.append(subtree.blocks);
            let mut moved = subtree.nodes.into_iter().map(|mut node| {
                node.first_index += if node.is_leaf() { first_block } else { first_node };
                node
            });
            if let Some(node) = moved.next() {
                nodes[root.node as usize] = node;
            }
            nodes.extend(moved);
        }
        let primitive_indices = (0..blocks.ends.len() as u32).collect();
        Self { bvh: Bvh2 { nodes, primitive_indices, max_depth, ..Bvh2::default() }, blocks }
    }

    /// Copies the hierarchy, so that each subtree holds a range of the primitives.
    fn into_depth_first_order(self) -> BinaryBvh {
        let count = self.bvh.nodes.len();
        let mut tree = BinaryBvh {
            nodes: Vec::with_capacity(count),
            costs: vec![ForestCost::UNKNOWN; count],
            order: Vec::with_capacity(self.blocks.order.len()),
        };
        // Each with its parent in the copy and which of the two children it is.
        let mut pending = vec![(0, None)];
        while let Some((source, parent)) = pending.pop() {
            let index = tree.nodes.len() as u32;
            if let Some((parent, side)) = parent {
                let parent: &mut BinaryNode = &mut tree.nodes[parent as usize];
                parent.children[side as usize] = index;
            }
            let node = &self.bvh.nodes[source as usize];
            let start = tree.order.len() as u32;
            if node.is_leaf() {
                tree.order.extend(self.blocks.get(node.first_index as usize));
            } else {
                pending.extend([1, 0].map(|side| (node.first_index + side, Some((index, side)))));
            }
            let bounds = Bounds32 { min: node.aabb().min.into(), max: node.aabb().max.into() };
            let count = tree.order.len() as u32 - start;
            tree.nodes.push(BinaryNode { bounds, children: [0; 2], start, count });
        }
        for index in (0..tree.nodes.len()).rev() {
            let [left, right] = tree.nodes[index].children;
            if left != 0 {
                let count = |child: u32| tree.nodes[child as usize].count;
                tree.nodes[index].count = count(left) + count(right);
            }
        }
        tree
    }
}
