//! Mean over an image and its standard error, from the differences between the replicates of its pixels.

use super::tile::{PRIOR, REPLICATES_PER_PIXEL, Tile};

/// Squared deviations of the samples of an image from the mean of one column over all that met the scene, summed over
/// the pixels.
///
/// The mean is a ratio, the sum of the values over their number. Its variance is that of the sum of the residuals
/// `value - mean`, where samples that missed the scene have a residual of 0. The pixels are independent strata, so the
/// variances of their sums add up: what pixels differ by is no error.
///
/// Source: Cochran (1977), "Sampling techniques", eq. 2.40 (linearised error of a ratio) and section 5.9 (strata).
#[derive(Clone, Copy, Default)]
pub(super) struct MeanDeviations {
    /// Number of pixels that met the scene.
    pixels: f64,
    /// Deviations of a sample from the mean of its replicate.
    within: RatioResiduals,
    /// Deviations of the means of replicates from that of the pixel, times their samples.
    between: RatioResiduals,
}

impl MeanDeviations {
    /// Deviations of the columns of a tile whose pixels have `n` samples each.
    pub(super) fn from_tile(tile: &Tile, n: u64) -> Vec<Self> {
        let columns = tile.sums.bands();
        let mut all = vec![Self::default(); columns];
        // The samples of a pixel alternate between its replicates.
        let samples = [n.div_ceil(2) as f64, (n / 2) as f64];
        let scale = (samples[0] * samples[1] / n as f64).sqrt();
        for pixel in (0..tile.pixels().count()).filter(|&pixel| tile.valid_samples(pixel) > 0) {
            let valid = tile.valid.each_ref().map(|valid| valid[pixel] as f64);
            let hit: [f64; REPLICATES_PER_PIXEL] =
                std::array::from_fn(|replicate| valid[replicate] / samples[replicate]);
            let of_pixel = pixel * columns..(pixel + 1) * columns;
            let means = tile.means.each_ref().map(|means| &means[of_pixel.clone()]);
            let means = means[0].iter().zip(means[1]).zip(&tile.squares[of_pixel]);
            for (deviations, ((&a, &b), &squares)) in all.iter_mut().zip(means) {
                deviations.pixels += 1.0;
                let apart = hit[0] * a - hit[1] * b;
                deviations.between.add(scale * apart, scale * (hit[0] - hit[1]));
                deviations.within.xx += squares;
                for (replicate, mean) in [a, b].into_iter().enumerate() {
                    let weight = (valid[replicate] * (1.0 - hit[replicate])).sqrt();
                    deviations.within.add(weight * mean, weight);
                }
            }
        }
        all
    }

    /// Adds the deviations of another tile.
    pub(super) fn merge(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.within.merge(&other.within);
        self.between.merge(&other.between);
    }

    /// Standard error of the `mean` of `count` samples that met the scene, from pixels with `n` samples each; NaN with
    /// one sample per pixel.
    ///
    /// The differences between replicates have one degree of freedom per pixel. If pixels are few, the variance is drawn
    /// towards that of independent samples, as the design effect of a tile is.
    pub(super) fn standard_error(&self, mean: f64, count: f64, n: u64) -> f64 {
        if n < REPLICATES_PER_PIXEL as u64 {
            return f64::NAN;
        }
        let (between, within) = (self.between.sum(mean), self.within.sum(mean));
        let of_replicates = n as f64 * between;
        let of_samples = within + REPLICATES_PER_PIXEL as f64 * between;
        let variance = (self.pixels * of_replicates + PRIOR * of_samples) / (self.pixels + PRIOR);
        variance.sqrt() / count
    }
}

/// Sum of squared residuals `(x - r y)²` for any ratio `r`.
#[derive(Clone, Copy, Default)]
struct RatioResiduals {
    xx: f64,
    xy: f64,
    yy: f64,
}

impl RatioResiduals {
    fn add(&mut self, x: f64, y: f64) {
        self.xx += x * x;
        self.xy += x * y;
        self.yy += y * y;
    }

    fn merge(&mut self, other: &Self) {
        self.xx += other.xx;
        self.xy += other.xy;
        self.yy += other.yy;
    }

    /// The sum for a ratio, without what rounding leaves below 0.
    fn sum(&self, ratio: f64) -> f64 {
        (self.xx - ratio * (2.0 * self.xy - ratio * self.yy)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    /// Standard error of the mean of one column of two pixels, from samples that met the scene and their means by
    /// replicate and pixel.
    fn mean_and_error(n: u64, valid: [[u64; 2]; 2], means: [[f64; 2]; 2]) -> (f64, f64) {
        let mut tile = Tile::new(UVec2::ZERO, UVec2::new(2, 1));
        tile.set_up(1);
        tile.valid = valid.map(Vec::from);
        tile.means = means.map(Vec::from);
        let count = tile.valid.iter().flatten().sum::<u64>() as f64;
        let values = tile.valid.iter().flatten().zip(tile.means.iter().flatten());
        let mean = values.map(|(&valid, mean)| valid as f64 * mean).sum::<f64>() / count;
        (mean, MeanDeviations::from_tile(&tile, n)[0].standard_error(mean, count, n))
    }

    fn assert_close(found: (f64, f64), expected: (f64, f64)) {
        let is_close = |found: f64, expected: f64| (found - expected).abs() < 1e-12;
        assert!(is_close(found.0, expected.0) && is_close(found.1, expected.1), "{found:?}");
    }

    /// Two pixels whose samples differ by 3 and by 4: the variance of their sum is 3² + 4², whatever the pixels
    /// differ by.
    #[test]
    fn differences_within_pixels_are_the_error() {
        let found = mean_and_error(2, [[1, 1], [1, 1]], [[10.0, 104.0], [13.0, 100.0]]);
        assert_close(found, (56.75, 5.0 / 4.0));
    }

    #[test]
    fn the_number_of_samples_that_meet_the_scene_is_no_error_of_one_value() {
        let (mean, error) = mean_and_error(4, [[2, 1], [1, 2]], [[3.0; 2]; 2]);
        assert!((mean - 3.0).abs() < 1e-12 && error < 1e-7, "{mean} ± {error}");
        // Pixels of 0 and 1 that are hit by one sample of two, in one replicate each.
        let (mean, error) = mean_and_error(2, [[1, 0], [0, 1]], [[0.0, 0.0], [0.0, 1.0]]);
        assert_close((mean, error), (0.5, 0.5_f64.sqrt() / 2.0));
    }

    #[test]
    fn one_sample_per_pixel_has_no_error() {
        let (_, error) = mean_and_error(1, [[1, 1], [0, 0]], [[1.0, 2.0], [0.0, 0.0]]);
        assert!(error.is_nan());
    }
}
