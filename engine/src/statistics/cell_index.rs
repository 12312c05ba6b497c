/// Rows of the cells that something was added to, in the order in which they came: a hash table with linear probing,
/// a fifth of the memory of a general one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CellIndex {
    /// Cell of each row.
    cells: Vec<u32>,
    /// One more than the row of a cell, or 0: a power of two of slots, of which at most three quarters are taken.
    slots: Vec<u32>,
}

/// 2⁶⁴ over the golden ratio: the upper bits of its multiples are spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl CellIndex {
    /// Number of cells that it can tell apart.
    pub(super) const MOST: usize = u32::MAX as usize;

    /// Maximum memory for each cell, bytes: a number, again while their list grows, three slots at most, and half of
    /// them again while they grow.
    pub(super) const BYTES: u64 = 7 * size_of::<u32>() as u64;

    /// Number of cells.
    pub(super) const fn len(&self) -> usize {
        self.cells.len()
    }

    /// Cell of each row.
    pub(super) fn cells(&self) -> impl ExactSizeIterator<Item = usize> {
        self.cells.iter().map(|&cell| cell as usize)
    }

    /// Cell of a row.
    pub(super) fn cell(&self, row: usize) -> usize {
        self.cells[row] as usize
    }

    /// Row of a cell below [`Self::MOST`]: a new one if it had none.
    pub(super) fn insert(&mut self, cell: usize) -> usize {
        if 4 * (self.cells.len() + 1) > 3 * self.slots.len() {
            self.grow();
        }
        let cell = cell as u32;
        let slot = self.slot(cell);
        let row = self.slots[slot];
        if row > 0 {
            return row as usize - 1;
        }
        reserve(&mut self.cells, 1);
        self.cells.push(cell);
        self.slots[slot] = self.cells.len() as u32;
        self.cells.len() - 1
    }

    /// Slot that holds a cell, or the free one in which it belongs.
    fn slot(&self, cell: u32) -> usize {
        let mask = self.slots.len() - 1;
        let hash = u64::from(cell).wrapping_mul(GOLDEN) >> self.slots.len().leading_zeros();
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

/// Makes room for more values. A list grows by a quarter: many of them are kept.
pub(super) fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more.max(list.len() / 4));
    }
}

#[cfg(test)]
mod tests {
    use super::CellIndex;

    #[test]
    fn each_cell_has_one_row_in_the_order_in_which_they_came() {
        let mut index = CellIndex::default();
        let cells: Vec<usize> = (0..5000).map(|i| (i * i) % 9973 + (i % 3) * (1 << 30)).collect();
        let mut expected: Vec<usize> = Vec::new();
        for &cell in &cells {
            let row = expected.iter().position(|known| *known == cell).unwrap_or_else(|| {
                expected.push(cell);
                expected.len() - 1
            });
            assert_eq!(index.insert(cell), row);
        }
        assert!(index.cells().eq(expected));
    }
}
