use std::ops::Range;

use rayon::prelude::*;

use super::{Sums, zeroed};

/// Number of values that all randomisations are added to before the next ones: few enough to stay in the cache.
const TILE: usize = 1 << 12;

/// Mean and standard error over independent randomisations of the same values.
///
/// Source: Welford (1962), "Note on a method for calculating corrected sums of squares and
/// products".
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    count: u32,
    mean: Vec<f64>,
    squares: Vec<f64>,
}

impl Spread {
    /// Spread of no randomisation yet, for this number of values.
    #[must_use]
    pub fn new(values: usize) -> Self {
        Self { count: 0, mean: zeroed(values), squares: zeroed(values) }
    }

    /// Spread of these randomisations, each of `values` values.
    ///
    /// # Panics
    /// If the rows differ in length.
    #[must_use]
    pub fn from_rows<'a>(values: usize, rows: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let mut spread = Self::new(values);
        for row in rows {
            spread.push(row);
        }
        spread
    }

    /// Adds one randomisation.
    ///
    /// # Panics
    /// If its number of values differs.
    pub fn push(&mut self, randomisation: &[f64]) {
        assert_eq!(randomisation.len(), self.mean.len(), "one value each");
        self.count += 1;
        add(&mut self.mean, &mut self.squares, self.count, randomisation.iter().copied());
    }

    /// Adds the means of randomisations per sample: their sums over the number of samples.
    ///
    /// # Panics
    /// If the number of values of one differs.
    pub fn push_sums(&mut self, randomisations: &[&Sums], samples: u64) {
        let Some(first) = randomisations.first() else { return };
        let (cells, bands) = (first.cells(), first.bands());
        let values = |sums: &&Sums| sums.cells() * sums.bands();
        assert!(
            randomisations.iter().all(|sums| values(sums) == self.mean.len()),
            "one value each"
        );
        let rows: Vec<_> = randomisations.par_iter().map(|sums| sums.ordered()).collect();
        let tile = (TILE / bands.max(1)).max(1);
        let (before, samples) = (self.count, samples as f64);
        let means = self.mean.par_chunks_mut((tile * bands).max(1));
        let tiles = means.zip(self.squares.par_chunks_mut((tile * bands).max(1))).enumerate();
        tiles.for_each_init(Vec::new, |buffer, (index, (mean, squares))| {
            let range = index * tile..((index + 1) * tile).min(cells);
            for (count, row) in (before + 1..).zip(&rows) {
                let values = row.values(range.clone(), buffer).iter();
                add(mean, squares, count, values.map(|sum| sum / samples));
            }
        });
        self.count += rows.len() as u32;
    }

    /// Spread of the values at these indices, each multiplied by a factor.
    ///
    /// # Panics
    /// If an index is out of range.
    #[must_use]
    pub fn select(&self, indices: impl IntoIterator<Item = (usize, f64)>) -> Self {
        let scaled = |(index, scale): (usize, f64)| {
            (self.mean[index] * scale, self.squares[index] * scale * scale)
        };
        let (mean, squares) = indices.into_iter().map(scaled).unzip();
        Self { count: self.count, mean, squares }
    }

    /// Mean of each value.
    #[must_use]
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Standard error of each mean, `√(Σ (x - mean)² / (n (n - 1)))`; NaN of fewer than two
    /// randomisations.
    #[must_use]
    pub fn standard_error(&self) -> Vec<f64> {
        self.standard_error_of(0..self.mean.len())
    }

    /// Standard error of a range of means.
    ///
    /// # Panics
    /// If the range is longer.
    #[must_use]
    pub fn standard_error_of(&self, range: Range<usize>) -> Vec<f64> {
        if self.count < 2 {
            return vec![f64::NAN; range.len()];
        }
        let count = f64::from(self.count);
        self.squares[range].iter().map(|s| (s / (count * (count - 1.0))).sqrt()).collect()
    }

    /// Median over all values with a mean other than 0 of `standard error / |mean|`; infinite where
    /// there is none.
    #[must_use]
    pub fn median_relative_error(&self) -> f64 {
        let errors = self.standard_error();
        let mut relative: Vec<f64> = errors
            .iter()
            .zip(&self.mean)
            .filter(|&(_, &mean)| mean != 0.0)
            .map(|(error, mean)| error / mean.abs())
            .collect();
        if relative.is_empty() {
            // All values are exactly 0.
            return if self.count < 2 { f64::INFINITY } else { 0.0 };
        }
        let middle = relative.len() / 2;
        *relative.select_nth_unstable_by(middle, f64::total_cmp).1
    }
}

/// Adds the values of the randomisation of this number to the means and squares of those before it.
fn add(mean: &mut [f64], squares: &mut [f64], count: u32, values: impl Iterator<Item = f64>) {
    let count = f64::from(count);
    for ((mean, squares), x) in mean.iter_mut().zip(squares).zip(values) {
        let before = x - *mean;
        *mean += before / count;
        *squares += before * (x - *mean);
    }
}

#[cfg(test)]
mod tests {
    use super::{Spread, TILE};
    use crate::statistics::Sums;

    #[test]
    fn sums_are_added_as_their_means_whether_they_are_sparse_or_not() {
        let cells = 20 * TILE;
        let rows: Vec<Sums> = (0..5)
            .map(|row| {
                let mut sums = Sums::new_sparse(cells, 3);
                for step in 0..500 {
                    let cell = (step * step * 31 + row * 7) % cells;
                    sums.add_at(cell, step % 3, 1.0 / (step + row + 1) as f64);
                }
                sums
            })
            .collect();
        let mut expected = Spread::new(3 * cells);
        for row in &rows {
            let ordered = row.ordered();
            let mut buffer = Vec::new();
            let sums = ordered.values(0..cells, &mut buffer);
            expected.push(&sums.iter().map(|sum| sum / 7.0).collect::<Vec<_>>());
        }
        let mut spread = Spread::new(3 * cells);
        let rows: Vec<&Sums> = rows.iter().collect();
        spread.push_sums(&rows[..2], 7);
        spread.push_sums(&rows[2..], 7);
        assert_eq!(spread, expected);
        assert!(spread.mean().iter().any(|mean| *mean > 0.0));
    }

    #[test]
    fn mean_and_standard_error_are_those_of_the_textbook() {
        let mut spread = Spread::new(2);
        for row in [[1.0, 5.0], [2.0, 5.0], [3.0, 5.0], [6.0, 5.0]] {
            spread.push(&row);
        }
        assert_eq!(spread.mean(), [3.0, 5.0]);
        // Sum of squares 4 + 1 + 0 + 9 = 14, over 4 · 3.
        assert!((spread.standard_error()[0] - (14.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        assert_eq!(spread.standard_error()[1].to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn one_randomisation_has_no_standard_error() {
        assert!(Spread::from_rows(1, [[2.0].as_slice()]).standard_error()[0].is_nan());
    }
}
