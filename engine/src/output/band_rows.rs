//! Blocks of rows of an image, band by band.

use std::ops::Range;

use rayon::prelude::*;

use super::{OutputError, Source};
use crate::products::{Image, PixelRows};

/// Rows of an image, with each band's values side by side.
#[derive(Debug)]
pub(super) struct BandRows {
    pub(super) rows: Range<usize>,
    /// Pixels in a row.
    pub(super) width: usize,
    /// Shape `[bands, rows, width]`.
    values: Vec<f32>,
    standard_error: Vec<f32>,
    /// Shape `[rows, width]`.
    pub(super) coverage: Vec<f32>,
}

/// Bands that are sorted out together: the values of a pixel in them are a line of the cache.
const TOGETHER: usize = 16;

impl BandRows {
    /// Reads rows of an image.
    pub(super) fn read(
        source: &Source<'_>,
        image: &Image,
        rows: Range<usize>,
    ) -> Result<Self, OutputError> {
        let pixels = image.pixels.rows(rows.clone()).map_err(OutputError::pixels(source))?;
        let (bands, count) = (image.bands.len(), rows.len() * image.width);
        source.equal("image values", count * bands, pixels.values.len())?;
        source.equal("image standard errors", count * bands, pixels.standard_error.len())?;
        source.equal("image coverages", count, pixels.coverage.len())?;
        Ok(Self::new(image, rows, pixels))
    }

    /// Rows of an image that hold these pixels.
    pub(super) fn new(image: &Image, rows: Range<usize>, pixels: PixelRows) -> Self {
        let (bands, width) = (image.bands.len(), image.width);
        let PixelRows { values, standard_error, coverage, .. } = pixels;
        let [values, standard_error] =
            [values, standard_error].map(|values| by_band(values, bands, coverage.len()));
        Self { rows, width, values, standard_error, coverage }
    }

    /// Values of a band, shape `[rows, width]`.
    pub(super) fn values(&self, band: usize) -> &[f32] {
        &self.values[band * self.coverage.len()..][..self.coverage.len()]
    }

    /// Standard errors of a band, shape `[rows, width]`.
    pub(super) fn standard_error(&self, band: usize) -> &[f32] {
        &self.standard_error[band * self.coverage.len()..][..self.coverage.len()]
    }

    /// Number of bands.
    pub(super) fn bands(&self) -> usize {
        self.values.len() / self.coverage.len().max(1)
    }
}

/// Values of shape `[pixels, bands]` as `[bands, pixels]`.
fn by_band(values: Vec<f32>, bands: usize, pixels: usize) -> Vec<f32> {
    if bands == 1 || pixels == 0 {
        return values;
    }
    let mut sorted = vec![0.0; values.len()];
    sorted.par_chunks_mut(TOGETHER * pixels).enumerate().for_each(|(group, sorted)| {
        let first = group * TOGETHER;
        let count = sorted.len() / pixels;
        for (pixel, all) in values.chunks_exact(bands).enumerate() {
            for (band, &value) in all[first..first + count].iter().enumerate() {
                sorted[band * pixels + pixel] = value;
            }
        }
    });
    sorted
}

#[cfg(test)]
mod tests {
    use super::by_band;

    #[test]
    fn values_of_a_band_come_side_by_side() {
        for (bands, pixels) in [(1, 5), (2, 3), (37, 11), (16, 1), (5, 0)] {
            let values: Vec<f32> = (0..bands * pixels).map(|index| index as f32).collect();
            let sorted = by_band(values.clone(), bands, pixels);
            assert_eq!(sorted.len(), values.len());
            for (index, value) in sorted.iter().enumerate() {
                let (band, pixel) = (index / pixels, index % pixels);
                assert_eq!(value.to_bits(), values[pixel * bands + band].to_bits());
            }
        }
    }
}
