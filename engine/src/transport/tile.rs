//! A square of pixels of an image.

use glam::UVec2;

use super::RANDOMISATIONS;
use super::walk::{Walk, show_each};
use crate::film::{Sums, written};

/// A square of pixels, row by row.
pub(super) struct Tile {
    pub(super) low: UVec2,
    pub(super) high: UVec2,
    /// Samples of each pixel that met the scene.
    pub(super) hits: Vec<u64>,
    /// Their mean, shape `[pixels, columns]`.
    pub(super) mean: Vec<f64>,
    /// The sum of their squared deviations from it.
    pub(super) squares: Vec<f64>,
    /// Sums over all pixels, shape `[randomisations, columns]`.
    pub(super) sums: Sums,
    /// Samples that they are made of.
    pub(super) counts: Vec<u64>,
}

impl Tile {
    /// One that holds nothing yet.
    pub(super) fn new(low: UVec2, high: UVec2) -> Self {
        let sums = Sums::new(0, 0);
        let (hits, mean, squares, counts) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { low, high, hits, mean, squares, sums, counts }
    }

    /// Takes the memory that it needs to be traced.
    pub(super) fn set_up(&mut self, columns: usize) {
        if self.hits.is_empty() {
            let pixels = self.pixels().count();
            let zeros = || written(pixels * columns);
            (self.mean, self.squares) = (zeros(), zeros());
            self.hits = vec![0; pixels];
            self.sums = Sums::new(RANDOMISATIONS as usize, columns);
            self.counts = vec![0; RANDOMISATIONS as usize];
        }
    }

    pub(super) fn pixels(&self) -> impl Iterator<Item = UVec2> + use<> {
        let (low, high) = (self.low, self.high);
        (low.y..high.y).flat_map(move |y| (low.x..high.x).map(move |x| UVec2::new(x, y)))
    }

    /// Mean variance of one sample in its pixels, shape `[columns]`, of `n` samples of each; NaN where no
    /// pixel has two.
    pub(super) fn variance(&self, n: f64) -> Vec<f64> {
        let columns = self.sums.bands();
        let (mut sums, mut weight) = (vec![0.0; columns], 0.0);
        for (&hits, squares) in self.hits.iter().zip(self.squares.chunks(columns)) {
            if hits > 1 {
                let hits = hits as f64;
                weight += hits - 1.0;
                for (sum, squares) in sums.iter_mut().zip(squares) {
                    *sum += (hits - 1.0) * of_ratio(*squares, hits, n);
                }
            }
        }
        sums.iter().map(|sum| sum / weight).collect()
    }

    /// Takes in what walks found, a sample of a pixel and of a row of sums each.
    ///
    /// Source: Welford (1962), "Note on a method for calculating corrected sums of squares and
    /// products".
    pub(super) fn push<'w, 'a: 'w, W: Walk<'a> + 'w>(
        &mut self,
        walks: &(impl Iterator<Item = &'w W> + Clone),
        samples: &[(usize, usize)],
    ) {
        let Self { hits, mean, squares, sums, counts, .. } = self;
        let shares: Vec<f64> = samples
            .iter()
            .map(|&(pixel, row)| {
                hits[pixel] += 1;
                counts[row] += 1;
                1.0 / hits[pixel] as f64
            })
            .collect();
        let all = sums.bands();
        show_each(
            walks,
            all,
            #[inline(always)]
            |sample, columns, found| {
                let ((pixel, row), share) = (samples[sample], shares[sample]);
                let range = pixel * all + columns.start..pixel * all + columns.end;
                let moments = mean[range.clone()].iter_mut().zip(&mut squares[range]);
                let sums = &mut sums.cell_mut(row)[columns];
                for (((mean, squares), sum), value) in moments.zip(sums).zip(found) {
                    let before = value - *mean;
                    *mean += before * share;
                    *squares += before * (value - *mean);
                    *sum += value;
                }
            },
        );
    }
}

/// Variance of one of the samples that met the scene, from the sum of squared deviations of `hits` of
/// `n`: of a ratio whose counts are 0 or 1 (see `film::ratio`).
pub(super) fn of_ratio(squares: f64, hits: f64, n: f64) -> f64 {
    if n > 1.0 { squares * n / ((n - 1.0) * hits) } else { f64::NAN }
}
