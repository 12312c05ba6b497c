use super::zeroed;

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
        let count = f64::from(self.count);
        for ((mean, squares), &x) in self.mean.iter_mut().zip(&mut self.squares).zip(randomisation)
        {
            let before = x - *mean;
            *mean += before / count;
            *squares += before * (x - *mean);
        }
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
        if self.count < 2 {
            return vec![f64::NAN; self.mean.len()];
        }
        let count = f64::from(self.count);
        self.squares.iter().map(|s| (s / (count * (count - 1.0))).sqrt()).collect()
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

#[cfg(test)]
mod tests {
    use super::Spread;

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
