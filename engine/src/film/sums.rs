use indexmap::IndexSet;

/// Sums over the samples of one block or one randomisation, shape `[cells, bands]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    bands: usize,
    values: Vec<f64>,
    /// Cells that have values, in the order of these; `None` if all have.
    touched: Option<IndexSet<usize>>,
}

/// Values from which a block's sums hold only the cells that it touches, 512 KiB.
const MANY: usize = 1 << 16;

/// Memory of the index of a cell, bytes: a number and its hash in a list that grows by doubling, and a
/// place in a hash table that is a quarter full at least.
const INDEX: u64 = 72;

impl Sums {
    /// All zero.
    #[must_use]
    pub fn new(cells: usize, bands: usize) -> Self {
        Self { bands, values: zeroed(cells * bands), touched: None }
    }

    /// All zero, to be merged into others: of many cells, it takes the memory of those alone that
    /// something is added to. Sums come out the same, bit for bit.
    #[must_use]
    pub fn of_block(cells: usize, bands: usize) -> Self {
        if cells.saturating_mul(bands) < MANY {
            return Self::new(cells, bands);
        }
        Self { bands, values: Vec::new(), touched: Some(IndexSet::new()) }
    }

    /// Memory of what [`Self::new`] makes, bytes; `u64::MAX` of more than can be counted.
    #[must_use]
    pub fn bytes(cells: usize, bands: usize) -> u64 {
        let bytes = cells as u128 * bands as u128 * size_of::<f64>() as u128;
        bytes.try_into().unwrap_or(u64::MAX)
    }

    /// The most memory of what [`Self::of_block`] makes once so many cells were added to, bytes.
    #[must_use]
    pub fn block_bytes(cells: usize, bands: usize, touched: u64) -> u64 {
        let all = Self::bytes(cells, bands);
        if all < Self::bytes(MANY, 1) {
            return all;
        }
        // Values grow by doubling; of each cell there is an index.
        let values = Self::bytes(2 * bands, 1).saturating_add(INDEX);
        let touched = touched.min(cells as u64);
        values.saturating_mul(touched)
    }

    /// Where the sums of a cell start among [`Self::values_mut`]; they stay there.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn start(&mut self, cell: usize) -> usize {
        let row = self.touched.as_mut().map_or(cell, |touched| {
            let (row, is_new) = touched.insert_full(cell);
            if is_new {
                self.values.resize(self.values.len() + self.bands, 0.0);
            }
            row
        });
        assert!((row + 1) * self.bands <= self.values.len(), "there is such a cell");
        row * self.bands
    }

    /// The sums of a cell, shape `[bands]`, to be added to.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn cell_mut(&mut self, cell: usize) -> &mut [f64] {
        let start = self.start(cell);
        &mut self.values[start..start + self.bands]
    }

    /// Adds a value to one band of a cell.
    ///
    /// # Panics
    /// If there is no such cell or band.
    pub fn add_at(&mut self, cell: usize, band: usize, value: f64) {
        self.cell_mut(cell)[band] += value;
    }

    /// Adds other sums of the same shape, cell by cell.
    ///
    /// # Panics
    /// If the shapes differ.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!(self.bands, other.bands, "one shape");
        if let Some(touched) = &other.touched {
            for (&cell, values) in touched.iter().zip(other.values.chunks_exact(self.bands)) {
                for (sum, value) in self.cell_mut(cell).iter_mut().zip(values) {
                    *sum += value;
                }
            }
            return;
        }
        assert_eq!(self.values.len(), other.values.len(), "one shape");
        for (sum, value) in self.values.iter_mut().zip(&other.values) {
            *sum += value;
        }
    }

    /// The sums, shape `[cells, bands]`, bands fastest.
    ///
    /// # Panics
    /// If they are of a block.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        assert!(self.touched.is_none(), "a block's sums are there to be merged");
        &self.values
    }

    /// The same, mutable.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Bands of a cell.
    #[must_use]
    pub const fn bands(&self) -> usize {
        self.bands
    }
}

/// Zeroed memory, touched now: reading a lazy zero page before it is written faults twice, and the second fault
/// stalls all threads.
pub(crate) fn zeroed(len: usize) -> Vec<f64> {
    let mut zeros = Vec::with_capacity(len);
    zeros.resize(len, 0.0);
    zeros
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_that_holds_only_what_it_touches_merges_to_the_same_bits() {
        let cells = MANY / 2;
        let fill = |sums: &mut Sums, seed: usize| {
            for step in 0..1000 {
                let cell = (step * step * 7919 + seed) % 97 * (cells / 97);
                for (band, sum) in sums.cell_mut(cell).iter_mut().enumerate() {
                    *sum += 1.0 / (1 + step + band) as f64;
                    *sum += [0.1, 0.7][band] * 1e-3 * seed as f64;
                }
            }
        };
        let (mut sparse, mut dense) = (Sums::new(cells, 2), Sums::new(cells, 2));
        for seed in 1..5 {
            let (mut block, mut all) = (Sums::of_block(cells, 2), Sums::new(cells, 2));
            fill(&mut block, seed);
            fill(&mut all, seed);
            assert!(block.values.len() <= 2 * 97 && all.values.len() == 2 * cells);
            sparse.merge(&block);
            dense.merge(&all);
        }
        assert!(dense.values().iter().any(|sum| *sum > 1.0));
        let bits = |sums: &Sums| sums.values().iter().map(|sum| sum.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&sparse), bits(&dense));
    }
}
