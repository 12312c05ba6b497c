use std::ops::Deref;

use super::padded;

/// A spectrum over lanes and its outline.
///
/// What is decided for all bands at once, such as the choice of a lobe or the end of a path, looks at the
/// outline alone: the largest value of each of at most [`Self::OUTLINE`] groups of neighbouring bands.
/// Products of outlines bound the outline of the product, and of no more bands than that they are it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    lanes: Box<[f32]>,
    outline: Box<[f32]>,
    is_black: bool,
}

impl Spectrum {
    /// The most values of an outline.
    pub const OUTLINE: usize = 32;

    /// Of a value in each band, none of them negative.
    #[must_use]
    pub fn new(bands: impl IntoIterator<Item = f32>) -> Self {
        let bands: Vec<f32> = bands.into_iter().collect();
        let is_black = bands.iter().all(|&value| value == 0.0);
        let largest = |group: &[f32]| group.iter().copied().fold(0.0, f32::max);
        let outline = padded(bands.chunks(Self::group(bands.len())).map(largest));
        Self { lanes: padded(bands), outline, is_black }
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

    /// The largest value of each group of bands, padded with zeros to whole groups of lanes.
    #[must_use]
    pub fn outline(&self) -> &[f32] {
        &self.outline
    }

    /// Whether it is 0 in every band.
    #[must_use]
    pub const fn is_black(&self) -> bool {
        self.is_black
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
    #[expect(clippy::float_cmp, reason = "values are copied")]
    fn an_outline_bounds_its_bands_and_is_them_if_they_are_few() {
        for bands in [0, 1, 7, 31, 32, 33, 64, 65, 2100] {
            let value = |band: usize| (band * 7919 % 101) as f32;
            let spectrum = Spectrum::new((0..bands).map(value));
            let outline = spectrum.outline();
            assert_eq!(outline.len(), Spectrum::outline_of(bands));
            assert!(outline.len() <= Spectrum::OUTLINE && spectrum.len() >= bands);
            for band in 0..bands {
                let bound = outline[band / bands.div_ceil(Spectrum::OUTLINE)];
                assert!(bound >= value(band), "{bands}: {band}");
                assert!(bands > Spectrum::OUTLINE || bound == value(band), "{bands}: {band}");
            }
            let largest = spectrum.iter().copied().fold(0.0, f32::max);
            assert_eq!(outline.iter().copied().fold(0.0, f32::max), largest);
        }
    }
}
