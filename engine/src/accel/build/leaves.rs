/// Primitives of a hierarchy, leaf by leaf.
#[derive(Default)]
pub(super) struct Leaves {
    pub order: Vec<u32>,
    /// End of each leaf in `order`, where the next one starts.
    pub ends: Vec<u32>,
}

impl Leaves {
    /// Primitives of a leaf.
    pub(super) fn get(&self, leaf: usize) -> &[u32] {
        let start = if leaf == 0 { 0 } else { self.ends[leaf - 1] };
        &self.order[start as usize..self.ends[leaf] as usize]
    }

    /// Empty list with memory for this number of primitives and of leaves.
    pub(super) fn with_capacity(primitives: usize, leaves: usize) -> Self {
        Self { order: Vec::with_capacity(primitives), ends: Vec::with_capacity(leaves) }
    }

    /// Appends leaves; returns the number of the first of them.
    pub(super) fn append(&mut self, leaves: Self) -> u32 {
        let (first, start) = (self.ends.len() as u32, self.order.len() as u32);
        self.order.extend(leaves.order);
        self.ends.extend(leaves.ends.into_iter().map(|end| end + start));
        first
    }
}
