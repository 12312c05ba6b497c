use indexmap::IndexSet;

/// Sums over the samples of one block or one randomisation, shape `[cells, bands]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    bands: usize,
    values: Vec<f64>,
    /// Cells that have values, in the order of `values`; `None` if all have.
    touched: Option<IndexSet<usize>>,
}

/// Number of values from which a block's sums hold only the cells that it touches, 512 KiB.
const SPARSE_FROM: usize = 1 << 16;

/// Memory of the index of a cell, bytes: a number and its hash in a list that grows by doubling, and an
/// entry of a hash table that is at least a quarter full.
const INDEX_BYTES: u64 = 72;

impl Sums {
    /// Sums that are all zero.
    #[must_use]
    pub fn new(cells: usize, bands: usize) -> Self {
        Self { bands, values: zeroed(cells * bands), touched: None }
    }

    /// Sums of a block, all zero, which will be merged into others: if there are many cells, only those that
    /// something is added to take memory. The merged sums are the same, bit for bit.
    #[must_use]
    pub fn new_for_block(cells: usize, bands: usize) -> Self {
        if cells.saturating_mul(bands) < SPARSE_FROM {
            return Self::new(cells, bands);
        }
        Self { bands, values: Vec::new(), touched: Some(IndexSet::new()) }
    }

    /// Memory of the sums that [`Self::new`] returns, bytes; `u64::MAX` if the number does not fit.
    #[must_use]
    pub fn bytes(cells: usize, bands: usize) -> u64 {
        let bytes = cells as u128 * bands as u128 * size_of::<f64>() as u128;
        bytes.try_into().unwrap_or(u64::MAX)
    }

    /// Maximum memory of the sums that [`Self::new_for_block`] returns once `touched` cells were added to, bytes.
    #[must_use]
    pub fn block_bytes(cells: usize, bands: usize, touched: u64) -> u64 {
        let all = Self::bytes(cells, bands);
        if all < Self::bytes(SPARSE_FROM, 1) {
            return all;
        }
        // Values grow by doubling; each cell has an index.
        let values = Self::bytes(2 * bands, 1).saturating_add(INDEX_BYTES);
        let touched = touched.min(cells as u64);
        values.saturating_mul(touched)
    }

    /// Index of the first sum of a cell in [`Self::values_mut`]; it does not change.
    ///
    /// # Panics
    /// If the cell is out of range.
    pub fn start(&mut self, cell: usize) -> usize {
        let row = self.touched.as_mut().map_or(cell, |touched| {
            let (row, is_new) = touched.insert_full(cell);
            if is_new {
                self.values.resize(self.values.len() + self.bands, 0.0);
            }
            row
        });
        assert!((row + 1) * self.bands <= self.values.len(), "the cell is in range");
        row * self.bands
    }

    /// Sums of a cell, shape `[bands]`.
    ///
    /// # Panics
    /// If the cell is out of range.
    pub fn cell_mut(&mut self, cell: usize) -> &mut [f64] {
        let start = self.start(cell);
        &mut self.values[start..start + self.bands]
    }

    /// Adds a value to one band of a cell.
    ///
    /// # Panics
    /// If the cell or the band is out of range.
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

    /// Sums, shape `[cells, bands]`, bands fastest.
    ///
    /// # Panics
    /// If these are sums of a block.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        assert!(self.touched.is_none(), "sums of a block are only merged");
        &self.values
    }

    /// Mutable sums; those of a block hold only the cells that it touches.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Number of bands of a cell.
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
        let cells = SPARSE_FROM / 2;
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
            let (mut block, mut all) = (Sums::new_for_block(cells, 2), Sums::new(cells, 2));
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
