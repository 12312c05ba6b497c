//! Contributions of packets to the cells of counters, recorded before any spectrum is evaluated.

use std::ops::Range;

use crate::scattering::{LANES, Lobe, SurfaceModels};
use crate::statistics::Sums;
use crate::transport::coefficients::Coefficients;
use crate::transport::films::ReplicateRow;
use crate::transport::spectrum_products::{ProductId, SpectrumProducts};

/// Contributions of packets to cells. A packet weighs one of `SpectrumProducts` times a number; contributions
/// of several packets to a cell by the same product are added before any band is evaluated.
#[derive(Clone, Debug)]
pub(super) struct Tally<'m> {
    models: &'m SurfaceModels,
    coefficients: Coefficients,
    /// True if coefficients are kept for the whole randomisation.
    keeps_coefficients: bool,
    /// The packet's weight: this product times this scale.
    weight: Weight,
    /// The factor that was evaluated last: several cells in a row may get the same.
    last: Option<(WeightFactor, Weight)>,
    sums: Vec<Sums>,
}

/// A product of spectra times a number.
#[derive(Clone, Copy, Debug)]
struct Weight {
    product: ProductId,
    scale: f64,
}

impl Weight {
    const ONE: Self = Self { product: SpectrumProducts::ONE, scale: 1.0 };
}

/// Fraction of a packet's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum WeightFactor {
    /// All of it.
    One,
    /// The weight times a lobe.
    Lobe(Lobe),
    /// The weight times 1 minus a lobe.
    Complement(Lobe),
}

/// Flush beyond this many terms: enough that many share their cells.
const MOST_TERMS: usize = 1 << 15;

/// Flush beyond this many products: few enough that a block of them fits the cache.
const MOST_PRODUCTS: usize = 1 << 10;

/// Number of bands from which coefficients are kept for the whole randomisation: evaluating that many takes longer than
/// uniting coefficients.
const MANY_BANDS: usize = 512;

impl<'m> Tally<'m> {
    /// A tally of these sums, without contributions. With `keeps_all`, no coefficient is evaluated as long as there is
    /// room.
    pub(super) fn new(models: &'m SurfaceModels, sums: Vec<Sums>, keeps_all: bool) -> Self {
        let bands = bands(&sums);
        let keeps_all = keeps_all && models.are_diffuse();
        let coefficients =
            if keeps_all { Coefficients::kept() } else { Coefficients::new(bands > LANES) };
        Self {
            models,
            coefficients,
            keeps_coefficients: keeps_all || bands >= MANY_BANDS && models.are_diffuse(),
            weight: Weight::ONE,
            last: None,
            sums,
        }
    }

    /// Starts a packet with a weight of 1 in every band.
    pub(super) const fn start(&mut self) {
        (self.weight, self.last) = (Weight::ONE, None);
    }

    /// Multiplies the packet's weight by a lobe.
    pub(super) fn scatter(&mut self, lobe: Lobe) {
        self.weight = self.times(lobe);
        self.last = None;
    }

    /// Adds a fraction of the packet's weight, times a scale, to a cell of some of the sums.
    ///
    /// # Panics
    /// If there is no such cell.
    pub(super) fn add(&mut self, sums: usize, cell: usize, factor: WeightFactor, scale: f64) {
        assert!(cell < self.sums[sums].cells(), "the cell is in range");
        if let (true, WeightFactor::Complement(lobe)) = (self.keeps_coefficients, factor) {
            // `P (1 - f)` as two terms, which other packets share.
            self.add(sums, cell, WeightFactor::One, scale);
            return self.add(sums, cell, WeightFactor::Lobe(lobe), -scale);
        }
        let weight = match self.last {
            Some((last, weight)) if last == factor => weight,
            _ => self.evaluate(factor),
        };
        self.coefficients.add(sums, cell, weight.product, weight.scale * scale);
    }

    fn evaluate(&mut self, factor: WeightFactor) -> Weight {
        let weight = match factor {
            WeightFactor::One => self.weight,
            WeightFactor::Lobe(lobe) => self.times(lobe),
            WeightFactor::Complement(Lobe { spectrum, scale }) => {
                let products = self.coefficients.products();
                let product = products.complement(self.weight.product, spectrum, scale);
                Weight { product, ..self.weight }
            }
        };
        self.last = Some((factor, weight));
        weight
    }

    fn times(&mut self, lobe: Lobe) -> Weight {
        let largest = self.models.normalisation(&lobe.spectrum);
        Weight {
            product: self.coefficients.products().times(self.weight.product, lobe.spectrum),
            scale: self.weight.scale * (f64::from(largest) * f64::from(lobe.scale)),
        }
    }

    /// Makes room at the end of a packet with power in these bands, if there is little left.
    pub(super) fn make_room(&mut self, bands: Range<usize>) {
        if !self.coefficients.exceeds(MOST_TERMS, MOST_PRODUCTS) {
            return;
        }
        if self.keeps_coefficients {
            self.coefficients.unite();
            if !self.coefficients.exceeds(MOST_TERMS / 2, ReplicateRow::MOST_PRODUCTS) {
                return;
            }
        }
        self.flush(bands);
    }

    /// Adds all contributions to the sums, of packets with power in these bands alone. The next packet starts anew.
    pub(super) fn flush(&mut self, bands: Range<usize>) {
        self.coefficients.flush(self.models, bands, &mut self.sums);
        self.start();
    }

    /// Sums, and coefficients that are still to be evaluated, if they are kept.
    pub(super) fn into_row(mut self) -> ReplicateRow {
        if self.keeps_coefficients {
            self.coefficients.unite();
        } else {
            self.flush(0..bands(&self.sums));
        }
        ReplicateRow { sums: self.sums, coefficients: Some(self.coefficients) }
    }
}

fn bands(sums: &[Sums]) -> usize {
    sums.iter().map(Sums::bands).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::SpectrumId;
    use crate::transport::band_blocks::BLOCK;

    /// Whatever is flushed when, each band of each cell holds the sum of its fractions of the weights.
    #[test]
    fn cells_hold_their_fractions_of_packet_weights() {
        let bands = 2 * BLOCK + 7;
        let mut models = SurfaceModels::new(bands);
        let [a, b, c] = [1, 2, 3].map(|seed: usize| {
            let value = move |band: usize| ((band * 31 + seed * 17) % 7) as f32 / 8.0;
            models.spectra.add((0..bands).map(value))
        });
        let mut tally = Tally::new(&models, vec![Sums::new(2, bands), Sums::new(1, bands)], false);
        let rounds = 5;
        for round in 0..rounds {
            tally.start();
            tally.scatter(Lobe::from(a).scaled(2.0));
            tally.add(0, 0, WeightFactor::One, 1.0);
            tally.add(0, 1, WeightFactor::Lobe(b.into()), 0.5);
            tally.add(1, 0, WeightFactor::Lobe(b.into()), 3.0);
            tally.scatter(Lobe::from(b).scaled(0.5));
            tally.add(1, 0, WeightFactor::Complement(c.into()), 1.0);
            if round % 2 == 0 {
                tally.flush(0..bands);
            }
        }
        let sums = tally.into_row().sums;
        for band in 0..bands {
            let [a, b, c] = [a, b, c].map(|id| f64::from(models.spectra.lanes(id)[band]));
            let n = f64::from(rounds);
            let expected = [2.0 * a, a * b, 6.0 * a * b + a * b * (1.0 - c)].map(|sum| n * sum);
            let sums =
                [sums[0].values()[band], sums[0].values()[bands + band], sums[1].values()[band]];
            for (sum, expected) in sums.into_iter().zip(expected) {
                // Eighths and their products are exact.
                assert!((sum - expected).abs() < 1e-12, "{band}: {sum} for {expected}");
            }
        }
    }

    #[test]
    fn a_flush_of_one_band_leaves_the_others() {
        let models = SurfaceModels::new(20);
        let mut tally = Tally::new(&models, vec![Sums::new(1, 20)], false);
        tally.start();
        tally.scatter(Lobe::from(SpectrumId::ONE).scaled(3.0));
        tally.add(0, 0, WeightFactor::One, 1.0);
        tally.flush(17..18);
        let expected: Vec<f64> = (0..20).map(|band| if band == 17 { 3.0 } else { 0.0 }).collect();
        assert_eq!(tally.into_row().sums[0].values(), expected);
    }
}
