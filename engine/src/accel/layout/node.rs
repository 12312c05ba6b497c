use crate::accel::simd::{Lanes, Words};

use super::Bounds32;

/// Reference to a child of a node: the index of an inner node, or that of a leaf with one of two tags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::accel) struct ChildRef(pub u32);

impl ChildRef {
    /// Tag of a leaf: a planar block, or an instance.
    pub(in crate::accel) const LEAF: u32 = 1 << 31;
    /// Additional tag of a leaf that is a disc block.
    pub(in crate::accel) const DISCS: u32 = 1 << 30;
    /// No child.
    pub(in crate::accel) const NONE: Self = Self(u32::MAX);

    #[inline(always)]
    pub(in crate::accel) fn is_inner(self) -> bool {
        self.0 & Self::LEAF == 0
    }

    #[inline(always)]
    pub(in crate::accel) fn is_discs(self) -> bool {
        self.0 & Self::DISCS != 0
    }

    #[inline(always)]
    pub(in crate::accel) fn index(self) -> usize {
        (self.0 & (Self::DISCS - 1)) as usize
    }
}

/// Eight children: their boxes, lower and upper bounds of each axis apart, and references to them.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub(in crate::accel) struct WideNode {
    /// Shape `[axes][lower, upper]`.
    pub bounds: [[Lanes; 2]; 3],
    pub child: Words,
    /// Children from the farthest to the nearest, three bits each, for rays of each octant; bit `i` of an octant
    /// is set where rays run down axis `i`.
    pub order: Words,
}

impl WideNode {
    /// Node without children.
    pub(in crate::accel) fn new() -> Self {
        Self {
            bounds: [[Lanes([f32::INFINITY; 8]), Lanes([f32::NEG_INFINITY; 8])]; 3],
            child: Words([ChildRef::NONE.0; 8]),
            order: Words([0; 8]),
        }
    }

    /// Sets the order of the children, once all of them are set.
    pub(in crate::accel) fn sort_children(&mut self) {
        // Twice the centres; 0 for a slot without a child.
        let centers = self.bounds.each_ref().map(|[low, high]| {
            let center = |slot: usize| {
                if low.0[slot] <= high.0[slot] { low.0[slot] + high.0[slot] } else { 0.0 }
            };
            std::array::from_fn::<f32, 8, _>(center)
        });
        for octant in 0..8 {
            let sign = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1.0 } else { -1.0 });
            let distance: [f32; 8] = std::array::from_fn(|slot| {
                sign[0] * centers[0][slot] + sign[1] * centers[1][slot] + sign[2] * centers[2][slot]
            });
            // Number of children that are farther; of equal ones, the first counts as farther.
            let mut order = 0;
            for slot in 0..8 {
                let is_farther = |other: usize| {
                    if other < slot {
                        distance[other] >= distance[slot]
                    } else {
                        distance[other] > distance[slot]
                    }
                };
                let rank: u32 = (0..8).map(|other| u32::from(is_farther(other))).sum();
                order |= (slot as u32) << (3 * rank);
            }
            self.order.0[octant] = order;
        }
    }

    pub(in crate::accel) fn set(&mut self, slot: usize, bounds: Bounds32, child: ChildRef) {
        for axis in 0..3 {
            self.bounds[axis][0].0[slot] = bounds.min[axis];
            self.bounds[axis][1].0[slot] = bounds.max[axis];
        }
        self.child.0[slot] = child.0;
    }
}

/// Eight-wide bounding volume hierarchy; its owner holds the leaves.
#[derive(Debug)]
pub(in crate::accel) struct WideBvh {
    pub root: ChildRef,
    pub nodes: Vec<WideNode>,
}

impl WideBvh {
    /// Memory of the nodes, bytes.
    pub(in crate::accel) fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }
}
