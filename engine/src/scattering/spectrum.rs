use std::ops::Deref;

use super::padded;

/// A spectrum over lanes and its outline.
///
/// What is decided for all bands at once, such as the choice of a lobe or the end of a path, looks at the
/// outline alone: at the middle band of each of at most [`Self::OUTLINE`] groups of neighbours. So decisions
/// are those of real bands, whatever order those come in. Where another band of the group is far brighter, a
/// part of that stands for it: no band that has power is ever ruled out. Of no more bands than groups, the
/// outline is the spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    lanes: Box<[f32]>,
    outline: Box<[f32]>,
    largest: f32,
}

impl Spectrum {
    /// The most values of an outline.
    pub const OUTLINE: usize = 128;

    /// The least that stands for a group, over its largest value.
    const LEAST: f32 = 1.0 / 16.0;

    /// Of a value in each band, none of them negative.
    #[must_use]
    pub fn new(bands: impl IntoIterator<Item = f32>) -> Self {
        let bands: Vec<f32> = bands.into_iter().collect();
        let largest = bands.iter().copied().fold(0.0, f32::max);
        let outline = padded(bands.chunks(Self::group(bands.len())).map(|group| {
            let largest = group.iter().copied().fold(0.0, f32::max);
            group[group.len() / 2].max(Self::LEAST * largest)
        }));
        Self { lanes: padded(bands), outline, largest }
    }

    /// Bands that one value of an outline stands for.
    const fn group(bands: usize) -> usize {
        let group = bands.div_ceil(Self::OUTLINE);
        if group == 0 { 1 } else { group }
    }

    /// Length of the outlines of so many bands.
    #[must_use]
    pub const fn outline_of(bands: usize) -> usize {
        bands.div_ceil(Self::group(bands)).next_multiple_of(super::LANES)
    }

    /// The value of an outline that stands for a band of so many.
    #[must_use]
    pub const fn place(band: usize, bands: usize) -> usize {
        band / Self::group(bands)
    }

    /// What stands for each group of bands, padded with zeros to whole groups of lanes.
    #[must_use]
    pub fn outline(&self) -> &[f32] {
        &self.outline
    }

    /// Its largest value.
    #[must_use]
    pub const fn largest(&self) -> f32 {
        self.largest
    }

    /// Whether it is 0 in every band.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.largest == 0.0
    }
}

/// Shape `[lanes]`.
impl Deref for Spectrum {
    type Target = [f32];

    fn deref(&self) -> &[f32] {
        &self.lanes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_rules_no_band_out_and_is_the_spectrum_if_bands_are_few() {
        for bands in [0, 1, 7, 64, 127, 128, 129, 256, 257, 2100] {
            for only in 0..bands.min(70) {
                let value = |band: usize| if band == only { 0.7 } else { 0.0 };
                let spectrum = Spectrum::new((0..bands).map(value));
                let outline = spectrum.outline();
                assert_eq!(outline.len(), Spectrum::outline_of(bands));
                assert!(outline.len() <= Spectrum::OUTLINE && spectrum.len() >= bands);
                assert!(outline[Spectrum::place(only, bands)] >= 0.7 / 16.0, "{bands}: {only}");
                assert!(bands > Spectrum::OUTLINE || outline == &*spectrum, "{bands}: {only}");
            }
        }
    }
}
