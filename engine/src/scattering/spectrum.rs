//! Spectra of a scene, by id.

use super::representatives::RepresentativeBands;
use super::{LANES, padded};

/// Identifies a spectrum of a [`SceneSpectra`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpectrumId(u32);

impl SpectrumId {
    /// Zero in every band; in every table.
    pub const ZERO: Self = Self(0);
    /// One in every band; in every table.
    pub const ONE: Self = Self(1);

    /// Its number in the table, for files.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0
    }

    /// The spectrum of a number that [`Self::number`] gave.
    #[must_use]
    pub const fn from_number(number: u32) -> Self {
        Self(number)
    }

    const fn index(self) -> usize {
        self.0 as usize
    }
}

/// All spectra of a scene, each with its values in the representative bands.
///
/// Decisions for all bands at once, such as the choice of a lobe or the end of a path, look at
/// [`RepresentativeBands`] alone. A representative's value is at least a 16th of the largest among the bands that
/// it represents: it is zero only if all of them are, so that no decision rules a band out. With few bands all of
/// them are representative.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpectra {
    bands: usize,
    /// Length of a row of `values`.
    lanes: usize,
    /// Shape `[spectra, lanes]`.
    values: Vec<f32>,
    /// Shape `[spectra, representative lanes]`.
    representatives: Vec<f32>,
    chosen: RepresentativeBands,
    /// Shape `[spectra]`.
    largest: Vec<f32>,
    /// True for spectra that multiply the throughput of paths, shape `[spectra]`.
    is_factor: Vec<bool>,
}

impl SceneSpectra {
    /// A table for this number of bands that holds [`SpectrumId::ZERO`] and [`SpectrumId::ONE`].
    #[must_use]
    pub fn new(bands: usize) -> Self {
        let mut table = Self {
            bands,
            lanes: bands.next_multiple_of(LANES),
            values: Vec::new(),
            representatives: Vec::new(),
            chosen: RepresentativeBands::all(bands),
            largest: Vec::new(),
            is_factor: Vec::new(),
        };
        for constant in [0.0, 1.0] {
            table.add_counted(std::iter::repeat_n(constant, bands));
        }
        table
    }

    /// Adds a spectrum of nonnegative values that multiplies the throughput of paths, shape `[bands]`.
    ///
    /// # Panics
    /// If it does not have one value per band.
    pub fn add(&mut self, values: impl IntoIterator<Item = f32>) -> SpectrumId {
        self.add_row(values.into_iter().collect(), true)
    }

    /// Adds a spectrum of nonnegative values by which light is counted and no path goes on, shape `[bands]`.
    /// Representative bands are chosen without it.
    ///
    /// # Panics
    /// If it does not have one value per band.
    pub fn add_counted(&mut self, values: impl IntoIterator<Item = f32>) -> SpectrumId {
        self.add_row(values.into_iter().collect(), false)
    }

    fn add_row(&mut self, values: Vec<f32>, is_factor: bool) -> SpectrumId {
        assert_eq!(values.len(), self.bands, "a spectrum has one value per band");
        self.largest.push(values.iter().copied().fold(0.0, f32::max));
        self.is_factor.push(is_factor);
        self.representatives.extend(self.chosen.values_of(&values));
        self.values.extend(padded(values));
        SpectrumId(self.largest.len() as u32 - 1)
    }

    /// Chooses the representative bands for the spectra so far and for values of models that depend on directions, each of
    /// shape `[bands]`; with few bands there is nothing to choose.
    pub fn choose_representatives(&mut self, shapes: &[Vec<f32>]) {
        if self.bands <= RepresentativeBands::MOST {
            return;
        }
        let rows = self.values.chunks(self.lanes).map(|row| &row[..self.bands]);
        let factors = rows.clone().zip(&self.is_factor).filter(|(_, is_factor)| **is_factor);
        let factors = factors.map(|(row, _)| row);
        let factors: Vec<&[f32]> = factors.chain(shapes.iter().map(Vec::as_slice)).collect();
        self.chosen = RepresentativeBands::choose(self.bands, &factors);
        self.representatives = rows.flat_map(|row| self.chosen.values_of(row)).collect();
    }

    /// Returns whether a spectrum multiplies the throughput of paths.
    pub(super) fn is_factor(&self, id: SpectrumId) -> bool {
        self.is_factor[id.index()]
    }

    /// Number of spectra.
    #[must_use]
    pub fn count(&self) -> usize {
        self.largest.len()
    }

    /// Number of bands.
    #[must_use]
    pub const fn bands(&self) -> usize {
        self.bands
    }

    /// The spectrum, padded with zeros to whole groups of [`LANES`]; shape `[lanes]`.
    #[inline]
    #[must_use]
    pub fn lanes(&self, id: SpectrumId) -> &[f32] {
        &self.values[id.index() * self.lanes..][..self.lanes]
    }

    /// Its values in the representative bands, padded with zeros to whole groups of [`LANES`].
    #[inline]
    #[must_use]
    pub fn representatives(&self, id: SpectrumId) -> &[f32] {
        let lanes = self.chosen.lanes();
        &self.representatives[id.index() * lanes..][..lanes]
    }

    /// The representative bands.
    #[must_use]
    pub const fn representative_bands(&self) -> &RepresentativeBands {
        &self.chosen
    }

    /// Its largest value.
    #[inline]
    #[must_use]
    pub fn largest(&self, id: SpectrumId) -> f32 {
        self.largest[id.index()]
    }

    /// Returns whether it is 0 in every band.
    #[inline]
    #[must_use]
    pub fn is_zero(&self, id: SpectrumId) -> bool {
        self.largest(id) == 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_holds_zero_and_one() {
        for bands in [0, 1, 9, 300] {
            let table = SceneSpectra::new(bands);
            assert!(table.is_zero(SpectrumId::ZERO));
            let (ones, padding) = table.lanes(SpectrumId::ONE).split_at(bands);
            assert_eq!(ones, vec![1.0; bands]);
            assert_eq!(padding, vec![0.0; padding.len()]);
        }
    }
}
