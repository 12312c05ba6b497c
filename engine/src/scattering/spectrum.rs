//! Spectra of a scene, by id.

use super::{LANES, padded};

/// Identifies a spectrum of a [`SceneSpectra`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpectrumId(u32);

impl SpectrumId {
    /// Zero in every band; in every table.
    pub const ZERO: Self = Self(0);
    /// One in every band; in every table.
    pub const ONE: Self = Self(1);

    const fn index(self) -> usize {
        self.0 as usize
    }
}

/// All spectra of a scene, each with its representative bands.
///
/// Decisions for all bands at once, such as the choice of a lobe or the end of a path, look at representative
/// bands alone: the middle band of each of at most [`Self::REPRESENTATIVES`] groups of neighbouring bands. So
/// decisions are those of real bands, in whatever order bands come. A group's value is at least a 16th of its
/// largest band: it is zero only if all its bands are. With no more bands than groups, the representative
/// bands are the spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpectra {
    bands: usize,
    /// Length of a row of `values`.
    lanes: usize,
    /// Length of a row of `representatives`.
    representative_lanes: usize,
    /// Shape `[spectra, lanes]`.
    values: Vec<f32>,
    /// Shape `[spectra, representative lanes]`.
    representatives: Vec<f32>,
    /// Shape `[spectra]`.
    largest: Vec<f32>,
}

impl SceneSpectra {
    /// Maximum number of representative bands.
    pub const REPRESENTATIVES: usize = 128;

    /// Minimum value of a group of bands over the largest of its bands.
    pub(super) const LEAST: f32 = 1.0 / 16.0;

    /// A table for this number of bands that holds [`SpectrumId::ZERO`] and [`SpectrumId::ONE`].
    #[must_use]
    pub fn new(bands: usize) -> Self {
        let (values, representatives, largest) = (Vec::new(), Vec::new(), Vec::new());
        let mut table = Self {
            bands,
            lanes: bands.next_multiple_of(LANES),
            representative_lanes: Self::representatives_len(bands),
            values,
            representatives,
            largest,
        };
        for constant in [0.0, 1.0] {
            table.add(std::iter::repeat_n(constant, bands));
        }
        table
    }

    /// Adds a spectrum of nonnegative values, shape `[bands]`.
    ///
    /// # Panics
    /// If it does not have one value per band.
    pub fn add(&mut self, values: impl IntoIterator<Item = f32>) -> SpectrumId {
        let values: Vec<f32> = values.into_iter().collect();
        assert_eq!(values.len(), self.bands, "a spectrum has one value per band");
        self.largest.push(values.iter().copied().fold(0.0, f32::max));
        self.representatives.extend(representatives_of(&values));
        self.values.extend(padded(values));
        SpectrumId(self.largest.len() as u32 - 1)
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

    /// Its representative bands, padded with zeros to whole groups of [`LANES`].
    #[inline]
    #[must_use]
    pub fn representatives(&self, id: SpectrumId) -> &[f32] {
        let lanes = self.representative_lanes;
        &self.representatives[id.index() * lanes..][..lanes]
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

    /// Length of the representative bands of a spectrum with this number of bands, padding included.
    #[must_use]
    pub const fn representatives_len(bands: usize) -> usize {
        bands.div_ceil(group_size(bands)).next_multiple_of(LANES)
    }

    /// Index of the representative band that stands for a band.
    #[must_use]
    pub const fn representative_of(band: usize, bands: usize) -> usize {
        band / group_size(bands)
    }
}

/// Number of bands that one representative band stands for.
pub(super) const fn group_size(bands: usize) -> usize {
    let size = bands.div_ceil(SceneSpectra::REPRESENTATIVES);
    if size == 0 { 1 } else { size }
}

/// Representative bands of a spectrum, padded with zeros to whole groups of lanes.
pub(crate) fn representatives_of(values: &[f32]) -> Box<[f32]> {
    padded(values.chunks(group_size(values.len())).map(|group| {
        let largest = group.iter().copied().fold(0.0, f32::max);
        group[group.len() / 2].max(SceneSpectra::LEAST * largest)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn representative_bands_rule_no_band_out_and_are_the_spectrum_if_bands_are_few() {
        for bands in [0, 1, 7, 64, 127, 128, 129, 256, 257, 2100] {
            let mut table = SceneSpectra::new(bands);
            for only in 0..bands.min(70) {
                let value = |band: usize| if band == only { 0.7 } else { 0.0 };
                let id = table.add((0..bands).map(value));
                let representatives = table.representatives(id);
                assert_eq!(representatives.len(), SceneSpectra::representatives_len(bands));
                assert!(representatives.len() <= SceneSpectra::REPRESENTATIVES);
                let group = SceneSpectra::representative_of(only, bands);
                assert!(representatives[group] >= 0.7 / 16.0, "{bands}: {only}");
                let is_whole = representatives == table.lanes(id);
                assert!(bands > SceneSpectra::REPRESENTATIVES || is_whole, "{bands}: {only}");
            }
        }
    }

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
