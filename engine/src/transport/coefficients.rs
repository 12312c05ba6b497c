//! Sums whose spectra are evaluated later: what a cell has received is a polynomial in the spectra of the scene.

use std::io::{self, Read, Write};
use std::ops::Range;

use super::band_blocks::{BLOCK, blocks};
use super::spectrum_products::{ProductId, SpectrumProducts};
use super::state::{restore_u64, save_u64};
use super::term_runs::{PlacedTerm, TermRuns};
use crate::scattering::{LANES, SurfaceModels, with_simd};
use crate::statistics::Sums;

/// Coefficients of products of spectra in the cells of sums: each cell holds `Σ c P` in every band.
///
/// Thousands of packets share some hundred products, so that terms are far fewer than contributions, and their number does
/// not grow with that of the bands.
#[derive(Clone, Debug)]
pub(in crate::transport) struct Coefficients {
    products: SpectrumProducts,
    terms: Vec<Term>,
    /// True if they are evaluated only where memory ends.
    are_kept: bool,
}

/// Number of terms, and of products, beyond which coefficients are evaluated although they are kept.
const MOST_KEPT: usize = 1 << 22;

/// Coefficient of a product in a cell of some of the sums.
#[derive(Clone, Copy, Debug)]
struct Term {
    product: ProductId,
    sums: u32,
    cell: usize,
    coefficient: f64,
}

impl Term {
    const fn place(&self) -> (ProductId, u32, usize) {
        (self.product, self.sums, self.cell)
    }
}

impl Coefficients {
    /// No terms; with `reuse`, products of the same factors are one.
    pub(in crate::transport) fn new(reuse: bool) -> Self {
        Self { products: SpectrumProducts::new(reuse), terms: Vec::new(), are_kept: false }
    }

    /// No terms, which are evaluated only where memory ends.
    pub(in crate::transport) fn kept() -> Self {
        Self { are_kept: true, ..Self::new(true) }
    }

    /// No terms, which are kept if those of another are.
    pub(in crate::transport) fn like(other: &Self) -> Self {
        Self { are_kept: other.are_kept, ..Self::new(true) }
    }

    /// The products.
    pub(in crate::transport) const fn products(&mut self) -> &mut SpectrumProducts {
        &mut self.products
    }

    /// Returns whether there are more terms than `terms` or more products than `products`.
    pub(in crate::transport) const fn exceeds(&self, terms: usize, products: usize) -> bool {
        if self.are_kept {
            return self.terms.len() > MOST_KEPT || self.products.len() > MOST_KEPT;
        }
        self.terms.len() > terms || self.products.len() > products
    }

    /// Returns whether there is no term.
    pub(in crate::transport) const fn is_empty(&self) -> bool {
        self.terms.is_empty()
    }

    /// Adds a product times a coefficient to a cell.
    pub(in crate::transport) fn add(
        &mut self,
        sums: usize,
        cell: usize,
        product: ProductId,
        coefficient: f64,
    ) {
        self.terms.push(Term { product, sums: sums as u32, cell, coefficient });
    }

    /// Unites terms of the same product in the same cell, in the order in which they were added.
    pub(in crate::transport) fn unite(&mut self) {
        self.terms.sort_by_key(Term::place);
        self.terms.dedup_by(|next, last| {
            let is_same = next.place() == last.place();
            last.coefficient += if is_same { next.coefficient } else { 0.0 };
            is_same
        });
    }

    /// Adds all terms of another.
    pub(in crate::transport) fn absorb(&mut self, other: &Self) {
        self.extend(other, Some);
        self.unite();
    }

    /// The terms of one of the sums in several of these, as far as they are there; their sums are numbered by the place
    /// among these, and each cell is added to others with the weights that a function returns for it.
    pub(in crate::transport) fn combined<'a, W: IntoIterator<Item = (usize, f64)>>(
        all: impl IntoIterator<Item = Option<&'a Self>>,
        sums: usize,
        weights: impl Fn(usize) -> W,
    ) -> Self {
        let mut joined = Self::new(true);
        for (number, one) in (0..).zip(all) {
            let Some(one) = one else { continue };
            joined.extend(one, |term| {
                let is_asked = term.sums as usize == sums;
                let weights = is_asked.then(|| weights(term.cell)).into_iter().flatten();
                weights.map(move |(cell, weight)| Term {
                    sums: number,
                    cell,
                    coefficient: term.coefficient * weight,
                    ..term
                })
            });
        }
        joined.unite();
        joined
    }

    /// Removes the terms of cells that hold at most a fraction `negligible` of what the largest cell of the same sums may
    /// hold, whatever the spectra; returns bounds of what was removed, shape `[sums, cells]`. The products are those of
    /// surfaces that scatter alike in all directions: they are at most 1.
    pub(in crate::transport) fn without_negligible(
        &mut self,
        sums: usize,
        cells: usize,
        negligible: f64,
    ) -> Vec<f64> {
        let place = |term: &Term| term.sums as usize * cells + term.cell;
        let mut bounds = vec![0.0; sums * cells];
        self.terms.iter().for_each(|term| bounds[place(term)] += term.coefficient.abs());
        for bounds in bounds.chunks_mut(cells) {
            let most = negligible * bounds.iter().copied().fold(0.0, f64::max);
            bounds.iter_mut().filter(|bound| **bound > most).for_each(|bound| *bound = 0.0);
        }
        self.terms.retain(|term| bounds[place(term)] <= 0.0);
        bounds
    }

    /// Adds the terms that a function makes of those of another.
    fn extend<T: IntoIterator<Item = Term>>(&mut self, other: &Self, terms: impl Fn(Term) -> T) {
        let made: Vec<Term> = other.terms.iter().copied().flat_map(terms).collect();
        let needed = other.products.needed(made.iter().map(|term| term.product));
        let ids = self.products.absorb(&other.products, &needed);
        self.terms.extend(made.iter().map(|term| Term { product: ids[term.product], ..*term }));
    }

    /// Adds the values of all terms in these bands to the sums that they are of, and removes them.
    pub(in crate::transport) fn flush(
        &mut self,
        models: &SurfaceModels,
        bands: Range<usize>,
        sums: &mut [Sums],
    ) {
        if bands.len() > LANES {
            self.unite();
        }
        self.add_to(models, bands, &mut sums.iter_mut().map(Some).collect::<Vec<_>>());
        self.terms.clear();
        self.products.clear();
    }

    /// Adds the values of terms to those of the sums that are there.
    pub(in crate::transport) fn add_to(
        &self,
        models: &SurfaceModels,
        bands: Range<usize>,
        sums: &mut [Option<&mut Sums>],
    ) {
        let mut placed = Vec::with_capacity(self.terms.len());
        for &Term { product, sums: index, cell, coefficient } in &self.terms {
            let index = index as usize;
            if let Some(sums) = sums[index].as_mut() {
                let start = sums.start(cell);
                placed.push(PlacedTerm { product, coefficient, sums: index, start });
            }
        }
        let needed = self.products.needed(placed.iter().map(|term| term.product));
        // One block takes less time than sorting.
        let runs = (bands.len() > BLOCK).then(|| TermRuns::new(std::mem::take(&mut placed)));
        let mut values = Vec::new();
        with_simd(
            #[inline(always)]
            || {
                for block in blocks(bands) {
                    self.products.write(models, &needed, &block, &mut values);
                    if let Some(runs) = &runs {
                        runs.add_to(&block, &values, sums);
                    }
                    for term in &placed {
                        let Some(sums) = &mut sums[term.sums] else { continue };
                        let cell = term.start + block.start..term.start + block.end;
                        let product = term.product * block.len();
                        let values = &values[product..product + block.len()];
                        for (sum, value) in sums.values_mut()[cell].iter_mut().zip(values) {
                            *sum += value * term.coefficient;
                        }
                    }
                }
            },
        );
    }

    /// Writes all products and terms, and the largest value of each spectrum: products are relative to it.
    ///
    /// # Errors
    /// Errors of the writer.
    pub(in crate::transport) fn save(
        &self,
        models: &SurfaceModels,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        self.products.save(models, out)?;
        save_u64(out, &[self.terms.len() as u64])?;
        self.terms.iter().try_for_each(|term| {
            let Term { product, sums, cell, coefficient } = *term;
            save_u64(out, &[product as u64, sums.into(), cell as u64, coefficient.to_bits()])
        })
    }

    /// Reads what [`Self::save`] wrote. The models may hold other spectra than those that it was written with, by the same
    /// ids.
    ///
    /// # Errors
    /// Errors of the reader, and numbers that cannot be.
    pub(in crate::transport) fn restore(
        models: &SurfaceModels,
        input: &mut dyn Read,
    ) -> io::Result<Self> {
        let mut restored = Self::new(true);
        let scales = restored.products.restore(models, input)?;
        let mut count = [0];
        restore_u64(input, &mut count)?;
        for _ in 0..count[0] {
            let mut numbers = [0; 4];
            restore_u64(input, &mut numbers)?;
            let [product, sums, cell, bits] = numbers;
            let product = product as usize;
            let Some((id, scale)) = scales.get(product).copied() else {
                return Err(io::ErrorKind::InvalidData.into());
            };
            let coefficient = f64::from_bits(bits) * scale;
            let (sums, cell) = (sums as u32, cell as usize);
            restored.terms.push(Term { product: id, sums, cell, coefficient });
        }
        Ok(restored)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::LobeSpectrum;

    /// Two sums of three cells: whole numbers, rounding, and nothing. *Expected*: the terms of rounding are gone and bounded
    /// beside the large cell of their own sums alone; whatever the spectra, the bound is not exceeded.
    #[test]
    fn terms_of_rounding_are_bounded_and_removed() {
        let mut models = SurfaceModels::new(3);
        let spectrum = models.spectra.add([0.9, 0.1, 0.5]);
        let mut terms = Coefficients::kept();
        let product = terms.products().times(SpectrumProducts::ONE, LobeSpectrum::Table(spectrum));
        terms.add(0, 0, SpectrumProducts::ONE, 2048.0);
        terms.add(0, 1, SpectrumProducts::ONE, 3e-13);
        terms.add(0, 1, product, -2e-13);
        terms.add(1, 1, product, 3e-13);
        let all = terms.clone();
        let bounds = terms.without_negligible(2, 3, 1e-12);
        assert_eq!(bounds, [0.0, 3e-13 + 2e-13, 0.0, 0.0, 0.0, 0.0]);
        let value = |terms: &Coefficients| {
            let mut sums = [Sums::new(3, 3), Sums::new(3, 3)];
            terms.add_to(&models, 0..3, &mut sums.iter_mut().map(Some).collect::<Vec<_>>());
            sums
        };
        let (kept, exact) = (value(&terms), value(&all));
        assert_eq!(kept[1], exact[1]);
        let removed = exact[0].values().iter().zip(kept[0].values()).map(|(a, b)| (a - b).abs());
        let removed: Vec<f64> = removed.collect();
        assert!(removed[..3].iter().chain(&removed[6..]).all(|removed| *removed <= 0.0));
        assert!(removed[3..6].iter().all(|removed| *removed > 0.0 && *removed <= bounds[1]));
    }
}
