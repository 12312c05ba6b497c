/// Rows of the cells that something was added to, in the order in which they came: a hash table with linear probing,
/// a third of the memory of a general one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CellIndex {
    /// Cell of each row.
    cells: Vec<usize>,
    /// One more than the row of a cell, or 0: a power of two of slots, of which at most half are taken.
    slots: Vec<u32>,
}

/// 2⁶⁴ over the golden ratio: the upper bits of its multiples are spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl CellIndex {
    /// Maximum memory for each cell, bytes: a number in a list that grows by doubling, four slots at most, and half of
    /// them again while they grow.
    pub(super) const BYTES: u64 = 2 * size_of::<usize>() as u64 + 6 * size_of::<u32>() as u64;

    /// Cell of each row.
    pub(super) fn cells(&self) -> &[usize] {
        &self.cells
    }

    /// Row of a cell: a new one if it had none.
    pub(super) fn insert(&mut self, cell: usize) -> usize {
        if 2 * (self.cells.len() + 1) > self.slots.len() {
            self.grow();
        }
        let slot = self.slot(cell);
        let row = self.slots[slot];
        if row > 0 {
            return row as usize - 1;
        }
        self.cells.push(cell);
        self.slots[slot] = u32::try_from(self.cells.len()).expect("memory holds fewer cells");
        self.cells.len() - 1
    }

    /// Slot that holds a cell, or the free one in which it belongs.
    fn slot(&self, cell: usize) -> usize {
        let mask = self.slots.len() - 1;
        let hash = (cell as u64).wrapping_mul(GOLDEN) >> self.slots.len().leading_zeros();
        let mut slot = hash as usize & mask;
        while self.slots[slot] > 0 && self.cells[self.slots[slot] as usize - 1] != cell {
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        self.slots = vec![0; (2 * self.slots.len()).max(64)];
        for row in 0..self.cells.len() {
            let slot = self.slot(self.cells[row]);
            self.slots[slot] = row as u32 + 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::CellIndex;

    #[test]
    fn each_cell_has_one_row_in_the_order_in_which_they_came() {
        let mut index = CellIndex::default();
        let cells: Vec<usize> = (0..5000).map(|i| (i * i) % 9973 + (i % 3) * (1 << 40)).collect();
        let mut expected: Vec<usize> = Vec::new();
        for &cell in &cells {
            let row = expected.iter().position(|known| *known == cell).unwrap_or_else(|| {
                expected.push(cell);
                expected.len() - 1
            });
            assert_eq!(index.insert(cell), row);
        }
        assert_eq!(index.cells(), expected);
    }
}
