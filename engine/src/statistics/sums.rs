use std::ops::Range;

use super::cell_index::{CellIndex, reserve};

/// Sums over the samples of one block or one randomisation, shape `[cells, bands]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    cells: usize,
    bands: usize,
    values: Vec<f64>,
    /// Cells that have values, in the order of `values`; `None` if all have.
    touched: Option<CellIndex>,
}

/// Number of values from which sums hold only the cells that are touched, 512 KiB.
const SPARSE_FROM: usize = 1 << 16;

impl Sums {
    /// Sums that are all zero.
    #[must_use]
    pub fn new(cells: usize, bands: usize) -> Self {
        Self { cells, bands, values: zeroed(cells * bands), touched: None }
    }

    /// Sums that are all zero. If there are many cells, only those that something is added to take memory; the sums are
    /// the same, bit for bit.
    #[must_use]
    pub fn new_sparse(cells: usize, bands: usize) -> Self {
        if cells.saturating_mul(bands) < SPARSE_FROM || cells > CellIndex::MOST {
            return Self::new(cells, bands);
        }
        Self { cells, bands, values: Vec::new(), touched: Some(CellIndex::default()) }
    }

    /// Memory of the sums that [`Self::new`] returns, bytes; `u64::MAX` if the number does not fit.
    #[must_use]
    pub fn bytes(cells: usize, bands: usize) -> u64 {
        let bytes = cells as u128 * bands as u128 * size_of::<f64>() as u128;
        bytes.try_into().unwrap_or(u64::MAX)
    }

    /// Maximum memory of the sums that [`Self::new_sparse`] returns once `touched` cells were added to, bytes.
    #[must_use]
    pub fn sparse_bytes(cells: usize, bands: usize, touched: u64) -> u64 {
        let all = Self::bytes(cells, bands);
        if all < Self::bytes(SPARSE_FROM, 1) {
            return all;
        }
        // Values are there twice while they grow; each cell has an index.
        let values = Self::bytes(2 * bands, 1).saturating_add(CellIndex::BYTES);
        let touched = touched.min(cells as u64);
        values.saturating_mul(touched)
    }

    /// Index of the first sum of a cell in [`Self::values_mut`]; it does not change.
    ///
    /// # Panics
    /// If the cell is out of range.
    pub fn start(&mut self, cell: usize) -> usize {
        assert!(cell < self.cells, "the cell is in range");
        let row = self.touched.as_mut().map_or(cell, |touched| {
            let row = touched.insert(cell);
            if touched.len() * self.bands > self.values.len() {
                reserve(&mut self.values, self.bands);
                self.values.resize(self.values.len() + self.bands, 0.0);
            }
            row
        });
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

    /// Returns whether some value is not zero.
    #[must_use]
    pub fn has_values(&self) -> bool {
        self.values.iter().any(|value| value.to_bits() > 0)
    }

    /// Adds other sums of the same shape, cell by cell.
    ///
    /// # Panics
    /// If the shapes differ.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!((self.cells, self.bands), (other.cells, other.bands), "one shape");
        let Some(touched) = &other.touched else {
            self.fill_in();
            for (sum, value) in self.values.iter_mut().zip(&other.values) {
                *sum += value;
            }
            return;
        };
        let own = self.touched.as_ref().map_or(0, CellIndex::len);
        let both = (own + touched.len()) as u64;
        if Self::sparse_bytes(self.cells, self.bands, both) > Self::bytes(self.cells, self.bands) {
            self.fill_in();
        }
        for (cell, values) in touched.cells().zip(other.values.chunks_exact(self.bands)) {
            for (sum, value) in self.cell_mut(cell).iter_mut().zip(values) {
                *sum += value;
            }
        }
    }

    /// Gives every cell its values.
    fn fill_in(&mut self) {
        if self.touched.is_some() {
            let mut all = Self::new(self.cells, self.bands);
            let ordered = self.ordered();
            all.values.copy_from_slice(ordered.values(0..self.cells, &mut Vec::new()));
            *self = all;
        }
    }

    /// Access to the sums in the order of their cells.
    #[must_use]
    pub fn ordered(&self) -> OrderedSums<'_> {
        let buckets = self.touched.as_ref().map(|touched| Buckets::new(touched, self.cells));
        OrderedSums { sums: self, buckets }
    }

    /// Sums, shape `[cells, bands]`, bands fastest.
    ///
    /// # Panics
    /// If they hold only the cells that were touched.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        assert!(self.touched.is_none(), "sparse sums are read by `ordered`");
        &self.values
    }

    /// Mutable sums, from the places that [`Self::start`] returned.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Number of cells.
    #[must_use]
    pub const fn cells(&self) -> usize {
        self.cells
    }

    /// Number of bands of a cell.
    #[must_use]
    pub const fn bands(&self) -> usize {
        self.bands
    }
}

/// Sums in the order of their cells.
#[derive(Debug)]
pub struct OrderedSums<'a> {
    sums: &'a Sums,
    /// Rows of the cells that were touched; `None` if all have values.
    buckets: Option<Buckets>,
}

/// Rows by ranges of their cells.
#[derive(Debug)]
struct Buckets {
    /// First of the rows of each bucket, and the end of the last.
    starts: Vec<usize>,
    rows: Vec<u32>,
}

/// Number of cells of a bucket.
const BUCKET: usize = 1 << 10;

impl Buckets {
    /// Rows of the touched cells, all below `end`.
    fn new(touched: &CellIndex, end: usize) -> Self {
        let mut starts = vec![0; end.div_ceil(BUCKET) + 1];
        for cell in touched.cells() {
            starts[cell / BUCKET + 1] += 1;
        }
        for bucket in 1..starts.len() {
            starts[bucket] += starts[bucket - 1];
        }
        let (mut next, mut rows) = (starts.clone(), vec![0; touched.len()]);
        for (row, cell) in touched.cells().enumerate() {
            let place = &mut next[cell / BUCKET];
            rows[*place] = row as u32;
            *place += 1;
        }
        Self { starts, rows }
    }

    /// Rows whose cells may lie in a range.
    fn rows(&self, cells: &Range<usize>) -> &[u32] {
        let last = self.starts[cells.end.div_ceil(BUCKET)];
        &self.rows[self.starts[cells.start / BUCKET].min(last)..last]
    }
}

impl OrderedSums<'_> {
    /// Sums of a range of cells, shape `[cells, bands]`; `buffer` holds them if some were not touched.
    ///
    /// # Panics
    /// If a cell is out of range.
    pub fn values<'b>(&'b self, cells: Range<usize>, buffer: &'b mut Vec<f64>) -> &'b [f64] {
        let Sums { bands, values, touched, .. } = self.sums;
        let (Some(buckets), Some(touched)) = (&self.buckets, touched) else {
            return &values[cells.start * bands..cells.end * bands];
        };
        buffer.clear();
        buffer.resize(cells.len() * bands, 0.0);
        for &row in buckets.rows(&cells) {
            let row = row as usize;
            let cell = touched.cell(row);
            if cells.contains(&cell) {
                let start = (cell - cells.start) * bands;
                let row = &values[row * bands..(row + 1) * bands];
                buffer[start..start + bands].copy_from_slice(row);
            }
        }
        buffer
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

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|sum| sum.to_bits()).collect()
    }

    #[test]
    fn sums_that_hold_only_what_is_touched_merge_to_the_same_bits() {
        let cells = SPARSE_FROM / 2;
        let fill = |sums: &mut Sums, seed: usize, places: usize| {
            for step in 0..1000 {
                let cell = (step * step * 7919 + seed) % places * (cells / places);
                for (band, sum) in sums.cell_mut(cell).iter_mut().enumerate() {
                    *sum += 1.0 / (1 + step + band) as f64;
                    *sum += [0.1, 0.7][band] * 1e-3 * seed as f64;
                }
            }
        };
        // Few cells stay sparse; of many all have values at last.
        for (places, blocks) in [(97, 5), (cells, 40)] {
            let (mut sparse, mut dense) = (Sums::new_sparse(cells, 2), Sums::new(cells, 2));
            for seed in 1..blocks {
                let (mut block, mut all) = (Sums::new_sparse(cells, 2), Sums::new(cells, 2));
                fill(&mut block, seed, places);
                fill(&mut all, seed, places);
                assert!(block.values.len() <= 2 * 1000 && all.values.len() == 2 * cells);
                sparse.merge(&block);
                dense.merge(&all);
            }
            assert_eq!(sparse.touched.is_some(), places == 97);
            assert!(dense.values().iter().any(|sum| *sum > 1.0));
            let ordered = sparse.ordered();
            for range in [0..cells, 11..9001] {
                let expected = &dense.values()[2 * range.start..2 * range.end];
                assert_eq!(bits(ordered.values(range, &mut Vec::new())), bits(expected));
            }
        }
    }
}
