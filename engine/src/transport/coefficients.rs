//! Sums whose spectra are evaluated later: what a cell has received is a polynomial in the spectra of the scene.

use std::io::{self, Read, Write};
use std::ops::Range;

use super::band_blocks::blocks;
use super::spectrum_products::{ProductId, SpectrumProducts};
use super::state::{restore_u64, save_u64};
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
}

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
        Self { products: SpectrumProducts::new(reuse), terms: Vec::new() }
    }

    /// The products.
    pub(in crate::transport) const fn products(&mut self) -> &mut SpectrumProducts {
        &mut self.products
    }

    /// Returns whether there are more terms than `terms` or more products than `products`.
    pub(in crate::transport) const fn exceeds(&self, terms: usize, products: usize) -> bool {
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
        self.extend(other, |term| Some(term.sums));
        self.unite();
    }

    /// The terms of one of the sums in several of these, as far as they are there; their sums are numbered by the place
    /// among these.
    pub(in crate::transport) fn of_sums<'a>(
        all: impl IntoIterator<Item = Option<&'a Self>>,
        sums: usize,
    ) -> Self {
        let mut joined = Self::new(true);
        for (number, one) in (0..).zip(all) {
            let Some(one) = one else { continue };
            joined.extend(one, |term| (term.sums as usize == sums).then_some(number));
        }
        joined.unite();
        joined
    }

    /// Adds the terms of another for which a function returns new sums.
    fn extend(&mut self, other: &Self, sums: impl Fn(&Term) -> Option<u32>) {
        let chosen = || other.terms.iter().filter_map(|term| Some((term, sums(term)?)));
        let needed = other.products.needed(chosen().map(|(term, _)| term.product));
        let ids = self.products.absorb(&other.products, &needed);
        let moved = |(term, sums): (&Term, u32)| Term { product: ids[term.product], sums, ..*term };
        self.terms.extend(chosen().map(moved));
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
        let mut starts = Vec::with_capacity(self.terms.len());
        for term in &self.terms {
            let sums = sums[term.sums as usize].as_mut();
            starts.push(sums.map(|sums| sums.start(term.cell)));
        }
        let placed =
            || self.terms.iter().zip(&starts).filter_map(|(term, start)| Some((term, (*start)?)));
        let needed = self.products.needed(placed().map(|(term, _)| term.product));
        let mut values = Vec::new();
        with_simd(
            #[inline(always)]
            || {
                for block in blocks(bands) {
                    self.products.write(models, &needed, &block, &mut values);
                    for (term, start) in placed() {
                        let Some(sums) = &mut sums[term.sums as usize] else { continue };
                        let cell = start + block.start..start + block.end;
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

    /// Writes all products and terms.
    ///
    /// # Errors
    /// Errors of the writer.
    pub(in crate::transport) fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        self.products.save(out)?;
        save_u64(out, &[self.terms.len() as u64])?;
        self.terms.iter().try_for_each(|term| {
            let Term { product, sums, cell, coefficient } = *term;
            save_u64(out, &[product as u64, sums.into(), cell as u64, coefficient.to_bits()])
        })
    }

    /// Reads what [`Self::save`] wrote.
    ///
    /// # Errors
    /// Errors of the reader, and numbers that cannot be.
    pub(in crate::transport) fn restore(&mut self, input: &mut dyn Read) -> io::Result<()> {
        self.products.restore(input)?;
        let mut count = [0];
        restore_u64(input, &mut count)?;
        self.terms.clear();
        for _ in 0..count[0] {
            let mut numbers = [0; 4];
            restore_u64(input, &mut numbers)?;
            let [product, sums, cell, bits] = numbers;
            let product = product as usize;
            if product >= self.products.len() {
                return Err(io::ErrorKind::InvalidData.into());
            }
            let coefficient = f64::from_bits(bits);
            self.terms.push(Term { product, sums: sums as u32, cell: cell as usize, coefficient });
        }
        Ok(())
    }
}
