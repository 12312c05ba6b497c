//! Products of spectra: the spectral part of packet weights, computed once for all packets that share it.

use std::collections::HashMap;
use std::io::{self, Read, Write};
use std::ops::Range;

use indexmap::IndexSet;

use crate::scattering::{LobeSpectrum, SpectrumId, SurfaceModels};
use crate::transport::band_blocks::BLOCK;
use crate::transport::state::{restore_u64, save_u64};

/// Products `P = Π f / max f` of spectra `f` in any order, and `P (1 - f)`.
///
/// A scene has few materials, and most packets meet a few of them a few times: thousands of packets share some
/// hundred products. No factor is above 1 and each is 1 in some band, so that a value that underflows is
/// negligible beside another band. Lobes of models that depend on directions are factors as they are; each
/// makes a product of its own.
#[derive(Clone, Debug)]
pub(in crate::transport) struct SpectrumProducts {
    /// Each after the product that it is made of.
    all: Vec<Product>,
    /// Lookup for reuse; absent where bands are few and a duplicate is cheaper than a lookup.
    index: Option<ProductIndex>,
}

/// Index of a product.
pub(in crate::transport) type ProductId = usize;

#[derive(Clone, Copy, Debug)]
enum Product {
    One,
    /// `P f / max f`.
    Times(ProductId, LobeSpectrum),
    /// `P (1 - c f)`.
    Complement(ProductId, LobeSpectrum, f32),
}

/// Products by their factors.
#[derive(Clone, Debug, Default)]
struct ProductIndex {
    /// Product that follows from another by a factor or its complement.
    next: HashMap<(ProductId, Factor), ProductId>,
    spectra: IndexSet<SpectrumId>,
    /// Products by their spectra.
    known: HashMap<Powers, ProductId>,
    /// Powers of each product; those of a product that depends on directions start anew.
    powers: Vec<Powers>,
}

/// A factor that products can share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Factor {
    Spectrum(SpectrumId),
    Complement(SpectrumId),
}

/// A product that depends on directions, or [`SpectrumProducts::ONE`], times powers of spectra: pairs of an index
/// of the spectrum, in order, and an exponent.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
struct Powers {
    base: ProductId,
    exponents: Box<[(usize, u32)]>,
}

impl SpectrumProducts {
    /// The empty product.
    pub(in crate::transport) const ONE: ProductId = 0;

    /// The empty product alone; with `reuse`, products of the same factors are one.
    pub(in crate::transport) fn new(reuse: bool) -> Self {
        let mut products = Self { all: Vec::new(), index: reuse.then(ProductIndex::default) };
        products.clear();
        products
    }

    /// Adds those products of another that are needed; returns the index of each here.
    pub(in crate::transport) fn absorb(&mut self, other: &Self, needed: &[bool]) -> Vec<ProductId> {
        let mut ids: Vec<ProductId> = Vec::with_capacity(other.all.len());
        for (product, is_needed) in other.all.iter().zip(needed) {
            ids.push(match *product {
                Product::Times(of, spectrum) if *is_needed => self.times(ids[of], spectrum),
                Product::Complement(of, spectrum, c) if *is_needed => {
                    self.complement(ids[of], spectrum, c)
                }
                Product::One | Product::Times(..) | Product::Complement(..) => Self::ONE,
            });
        }
        ids
    }

    /// Writes all products, each as the product and the spectrum that it is made of, with the largest value of the
    /// spectrum.
    ///
    /// # Errors
    /// Errors of the writer.
    ///
    /// # Panics
    /// If a product is not one of spectra of the table alone.
    pub(in crate::transport) fn save(
        &self,
        models: &SurfaceModels,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        save_u64(out, &[self.all.len() as u64 - 1])?;
        self.all[1..].iter().try_for_each(|product| {
            let Product::Times(of, factor @ LobeSpectrum::Table(spectrum)) = *product else {
                panic!("coefficients are kept of products of spectra alone")
            };
            let largest = f64::from(models.normalisation(&factor));
            save_u64(out, &[of as u64, spectrum.number().into(), largest.to_bits()])
        })
    }

    /// Reads what [`Self::save`] wrote into an empty table. Returns the index of each product that was written, and the
    /// ratio of what it is relative to: that of the models' spectra over that of the spectra that it was written with.
    ///
    /// # Errors
    /// Errors of the reader, and products of later ones or of spectra that the models do not have.
    pub(in crate::transport) fn restore(
        &mut self,
        models: &SurfaceModels,
        input: &mut dyn Read,
    ) -> io::Result<Vec<(ProductId, f64)>> {
        self.clear();
        let mut scales = vec![(Self::ONE, 1.0)];
        let mut count = [0];
        restore_u64(input, &mut count)?;
        for _ in 0..count[0] {
            let mut numbers = [0; 3];
            restore_u64(input, &mut numbers)?;
            let [of, spectrum, largest] = numbers;
            let before = scales.get(of as usize).copied();
            let (Some((of, scale)), true) = (before, spectrum < models.spectra.count() as u64)
            else {
                return Err(io::ErrorKind::InvalidData.into());
            };
            let factor = LobeSpectrum::Table(SpectrumId::from_number(spectrum as u32));
            let (before, now) = (f64::from_bits(largest), models.normalisation(&factor));
            let ratio = if before > 0.0 { f64::from(now) / before } else { 0.0 };
            scales.push((self.times(of, factor), scale * ratio));
        }
        Ok(scales)
    }

    /// Removes all but the empty product.
    pub(in crate::transport) fn clear(&mut self) {
        self.all.clear();
        self.all.push(Product::One);
        if let Some(ProductIndex { next, spectra, known, powers }) = &mut self.index {
            next.clear();
            spectra.clear();
            known.clear();
            powers.clear();
            powers.push(Powers::default());
        }
    }

    /// Number of products.
    pub(in crate::transport) const fn len(&self) -> usize {
        self.all.len()
    }

    /// `P f / max f`; of models that depend on directions, `P f`.
    pub(in crate::transport) fn times(
        &mut self,
        product: ProductId,
        spectrum: LobeSpectrum,
    ) -> ProductId {
        let new = self.all.len();
        let id = self.index.as_mut().map_or(new, |index| index.times(product, spectrum, new));
        if id == new {
            self.all.push(Product::Times(product, spectrum));
        }
        id
    }

    /// `P (1 - c f)`, which no further product is made of.
    pub(in crate::transport) fn complement(
        &mut self,
        product: ProductId,
        spectrum: LobeSpectrum,
        c: f32,
    ) -> ProductId {
        let new = self.all.len();
        let id = self.index.as_mut().map_or(new, |index| index.complement(product, spectrum, new));
        if id == new {
            self.all.push(Product::Complement(product, spectrum, c));
        }
        id
    }

    /// Returns whether each product is one of these, or one of these is made of it.
    pub(in crate::transport) fn needed(&self, ids: impl Iterator<Item = ProductId>) -> Vec<bool> {
        let mut needed = vec![false; self.all.len()];
        ids.for_each(|id| needed[id] = true);
        for (id, product) in self.all.iter().enumerate().rev() {
            if let Product::Times(of, _) | Product::Complement(of, ..) = *product {
                needed[of] |= needed[id];
            }
        }
        needed
    }

    /// Writes those products that are needed in a range of bands, shape `[products, bands]`.
    #[inline(always)]
    pub(in crate::transport) fn write(
        &self,
        models: &SurfaceModels,
        needed: &[bool],
        bands: &Range<usize>,
        values: &mut Vec<f64>,
    ) {
        let width = bands.len();
        values.resize(self.all.len() * width, 0.0);
        let mut buffer = [0.0; BLOCK];
        let products = self.all.iter().enumerate().zip(needed);
        for ((id, product), _) in products.filter(|(_, is_needed)| **is_needed) {
            let (before, rows) = values.split_at_mut(id * width);
            let row = &mut rows[..width];
            match *product {
                Product::One => row.fill(1.0),
                Product::Times(of, spectrum) => {
                    let largest = f64::from(models.normalisation(&spectrum));
                    let c = if largest > 0.0 { 1.0 / largest } else { 0.0 };
                    let before = &before[of * width..(of + 1) * width];
                    let spectrum = models.values(&spectrum, bands.clone(), &mut buffer);
                    multiply_row(row, before, spectrum, |f| f * c);
                }
                Product::Complement(of, spectrum, c) => {
                    let before = &before[of * width..(of + 1) * width];
                    let spectrum = models.values(&spectrum, bands.clone(), &mut buffer);
                    multiply_row(row, before, spectrum, |f| 1.0 - f * f64::from(c));
                }
            }
        }
    }
}

/// Multiplies a row by a function of a spectrum, band by band.
#[inline(always)]
fn multiply_row(row: &mut [f64], before: &[f64], spectrum: &[f32], factor: impl Fn(f64) -> f64) {
    for ((value, before), f) in row.iter_mut().zip(before).zip(spectrum) {
        *value = before * factor(f64::from(*f));
    }
}

impl ProductIndex {
    /// Index of a product: `new` unless it is known.
    fn times(&mut self, product: ProductId, spectrum: LobeSpectrum, new: ProductId) -> ProductId {
        let Self { next, spectra, known, powers } = self;
        let LobeSpectrum::Table(spectrum) = spectrum else {
            powers.push(Powers { base: new, exponents: Box::default() });
            return new;
        };
        *next.entry((product, Factor::Spectrum(spectrum))).or_insert_with(|| {
            let (place, _) = spectra.insert_full(spectrum);
            let mut exponents = powers[product].exponents.to_vec();
            match exponents.binary_search_by_key(&place, |(spectrum, _)| *spectrum) {
                Ok(at) => exponents[at].1 += 1,
                Err(at) => exponents.insert(at, (place, 1)),
            }
            let key = Powers { base: powers[product].base, exponents: exponents.into() };
            let id = *known.entry(key.clone()).or_insert(new);
            if id == new {
                powers.push(key);
            }
            id
        })
    }

    /// Index of a complement: `new` unless it is known.
    fn complement(
        &mut self,
        product: ProductId,
        spectrum: LobeSpectrum,
        new: ProductId,
    ) -> ProductId {
        let Self { next, powers, .. } = self;
        let id = match spectrum {
            LobeSpectrum::Table(spectrum) => {
                *next.entry((product, Factor::Complement(spectrum))).or_insert(new)
            }
            LobeSpectrum::Sum(_) | LobeSpectrum::Model(..) | LobeSpectrum::Cell(..) => new,
        };
        if id == new {
            powers.push(Powers::default());
        }
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_the_same_spectra_are_one_whatever_their_order() {
        let mut models = SurfaceModels::new(3);
        let mut spectrum = |values: [f32; 3]| LobeSpectrum::Table(models.spectra.add(values));
        let (a, b) = (spectrum([0.5, 0.25, 0.0]), spectrum([0.125, 0.5, 0.75]));
        let black = spectrum([0.0; 3]);
        let mut products = SpectrumProducts::new(true);
        let one = SpectrumProducts::ONE;
        let [of_a, of_b] = [a, b].map(|spectrum| products.times(one, spectrum));
        let of_ab = products.times(of_a, b);
        assert_eq!(products.times(of_b, a), of_ab);
        let of_aab = products.times(of_ab, a);
        let of_aa = products.times(of_a, a);
        assert_eq!(products.times(of_aa, b), of_aab);
        assert!(of_aa != of_ab);
        let rest = products.complement(of_a, b, 1.0);
        assert_eq!(products.complement(of_a, b, 1.0), rest);
        let nothing = products.times(of_a, black);
        assert_eq!(products.len(), 8);
        let mut values = Vec::new();
        products.write(&models, &vec![true; products.len()], &(0..3), &mut values);
        for band in 0..3 {
            let value =
                |spectrum| f64::from(models.values(&spectrum, band..band + 1, &mut [0.0])[0]);
            let [a, b] = [a, b].map(value);
            let expected = [
                (of_a, a / 0.5),
                (of_ab, a * b / 0.5 / 0.75),
                (of_aab, a * a * b / 0.25 / 0.75),
                (rest, a / 0.5 * (1.0 - b)),
                (nothing, 0.0),
            ];
            for (product, expected) in expected {
                let value = values[3 * product + band];
                assert!((value - expected).abs() < 1e-15, "{product}: {value} for {expected}");
            }
        }
        products.clear();
        assert_eq!((products.len(), products.times(one, b)), (1, 1));
        // Without reuse each is new.
        let mut products = SpectrumProducts::new(false);
        assert_ne!(products.times(one, a), products.times(one, a));
    }

    /// A factor that depends on directions is never shared; what follows from it by spectra is.
    #[test]
    fn products_of_directions_are_their_own() {
        let mut models = SurfaceModels::new(2);
        let [a, b] = [[0.5, 1.0], [0.25, 0.5]].map(|values| models.spectra.add(values));
        let sum = LobeSpectrum::Sum([(a, 0.5), (b, 2.0)]);
        let [of_a, of_b] = [a, b].map(LobeSpectrum::Table);
        let mut products = SpectrumProducts::new(true);
        let first = products.times(SpectrumProducts::ONE, sum);
        let second = products.times(SpectrumProducts::ONE, sum);
        assert_ne!(first, second);
        let [ab, ba] = [[of_a, of_b], [of_b, of_a]]
            .map(|factors| factors.into_iter().fold(first, |id, f| products.times(id, f)));
        assert_eq!(ab, ba);
        assert_ne!(ab, products.times(second, of_a));
        let mut values = Vec::new();
        products.write(&models, &vec![true; products.len()], &(0..2), &mut values);
        // (0.5 a + 2 b) a / max a · b / max b
        let expected = [(0.25 + 0.5) * 0.5 * 0.5, 1.5];
        assert!((values[2 * ab] - expected[0]).abs() < 1e-7, "{values:?}");
        assert!((values[2 * ab + 1] - expected[1]).abs() < 1e-7, "{values:?}");
    }
}
