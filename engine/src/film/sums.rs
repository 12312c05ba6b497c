/// Sums over the samples of one block or one randomisation, shape `[cells, bands]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    bands: usize,
    values: Vec<f64>,
}

impl Sums {
    /// All zero.
    #[must_use]
    pub fn new(cells: usize, bands: usize) -> Self {
        Self { bands, values: vec![0.0; cells * bands] }
    }

    /// Adds `spectrum · scale` to a cell; of `spectrum`, padded or not, the bands count.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn add(&mut self, cell: usize, spectrum: &[f32], scale: f64) {
        let start = cell * self.bands;
        let cell = &mut self.values[start..start + self.bands];
        for (sum, &value) in cell.iter_mut().zip(spectrum) {
            *sum += f64::from(value) * scale;
        }
    }

    /// Adds `f(lane)` to each band of a cell.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn add_with(&mut self, cell: usize, f: impl Fn(usize) -> f64) {
        let start = cell * self.bands;
        for (lane, sum) in self.values[start..start + self.bands].iter_mut().enumerate() {
            *sum += f(lane);
        }
    }

    /// Adds a value to one band of a cell.
    ///
    /// # Panics
    /// If there is no such cell or band.
    pub fn add_at(&mut self, cell: usize, band: usize, value: f64) {
        self.values[cell * self.bands + band] += value;
    }

    /// Adds sums of one cell, shape `[bands]`.
    ///
    /// # Panics
    /// If there is no such cell.
    pub fn add_cell(&mut self, cell: usize, values: &[f64]) {
        self.add_with(cell, |band| values[band]);
    }

    /// Adds other sums of the same shape, cell by cell.
    ///
    /// # Panics
    /// If the shapes differ.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!((self.bands, self.values.len()), (other.bands, other.values.len()), "one shape");
        for (sum, value) in self.values.iter_mut().zip(&other.values) {
            *sum += value;
        }
    }

    /// The sums, shape `[cells, bands]`, bands fastest.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Bands of a cell.
    #[must_use]
    pub const fn bands(&self) -> usize {
        self.bands
    }
}
