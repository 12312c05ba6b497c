//! Products of spectra, each found once however many packets weigh as much in proportion.

use std::collections::HashMap;
use std::ops::Range;

use indexmap::IndexSet;

use crate::scattering::Spectrum;

/// What light of all bands is multiplied with: `P = Π f / max f`, whatever the order of the spectra `f`, and
/// the rest of it that one leaves, `P (1 - f)`.
///
/// A scene has few materials and most packets meet a few of them a few times, so that thousands of packets
/// have some hundred products. No factor is above 1, and each is 1 in some band: what underflows is nothing
/// beside another band.
#[derive(Clone, Debug)]
pub(super) struct Products<'a> {
    /// Each behind the one that it is made of.
    all: Vec<Product<'a>>,
    /// What makes one of many, if they are looked for: of few bands, that takes longer than to have several.
    index: Option<Index>,
}

/// A product before, and the spectrum that this one takes.
#[derive(Clone, Copy, Debug)]
enum Product<'a> {
    One,
    /// `P f / max f`.
    Times(usize, &'a Spectrum),
    /// `P (1 - f)`.
    Rest(usize, &'a Spectrum),
}

/// Products by what they are; spectra are told apart by where they are.
#[derive(Clone, Debug, Default)]
struct Index {
    /// What follows from a product by a spectrum, and whether it is the rest.
    next: HashMap<(usize, usize, bool), usize>,
    spectra: IndexSet<usize>,
    /// Products by the spectra that they have.
    known: HashMap<Powers, usize>,
    /// What each product has of them; of a rest nothing.
    powers: Vec<Powers>,
}

/// Places among the spectra, in order, and how often a product has each.
type Powers = Box<[(usize, u32)]>;

impl<'a> Products<'a> {
    /// The product of no spectrum.
    pub(super) const ONE: usize = 0;

    /// That of no spectrum alone, and of those to come each once if they are looked for.
    pub(super) fn new(looks: bool) -> Self {
        let mut products = Self { all: Vec::new(), index: looks.then(Index::default) };
        products.clear();
        products
    }

    /// Forgets all but that of no spectrum.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.all.push(Product::One);
        if let Some(Index { next, spectra, known, powers }) = &mut self.index {
            next.clear();
            spectra.clear();
            known.clear();
            powers.clear();
            powers.push(Box::default());
        }
    }

    /// How many there are.
    pub(super) const fn len(&self) -> usize {
        self.all.len()
    }

    /// The product `P f / max f`.
    pub(super) fn times(&mut self, product: usize, spectrum: &'a Spectrum) -> usize {
        let new = self.all.len();
        let index = self.index.as_mut();
        let found = index.map_or(new, |index| index.times(product, spectrum, new));
        if found == new {
            self.all.push(Product::Times(product, spectrum));
        }
        found
    }

    /// `P (1 - f)`, which is no product to go on from.
    pub(super) fn rest(&mut self, product: usize, spectrum: &'a Spectrum) -> usize {
        let new = self.all.len();
        let index = self.index.as_mut();
        let found = index.map_or(new, |index| index.rest(product, spectrum, new));
        if found == new {
            self.all.push(Product::Rest(product, spectrum));
        }
        found
    }

    /// Writes all of them in these bands, shape `[products, bands]`.
    #[inline(always)]
    pub(super) fn write(&self, bands: &Range<usize>, values: &mut Vec<f64>) {
        let width = bands.len();
        values.resize(self.all.len() * width, 0.0);
        for (place, product) in self.all.iter().enumerate() {
            let (before, rows) = values.split_at_mut(place * width);
            let row = &mut rows[..width];
            match *product {
                Product::One => row.fill(1.0),
                Product::Times(of, spectrum) => {
                    let before = &before[of * width..(of + 1) * width];
                    let largest = f64::from(spectrum.largest());
                    let c = if largest > 0.0 { 1.0 / largest } else { 0.0 };
                    for ((value, before), f) in
                        row.iter_mut().zip(before).zip(&spectrum[bands.clone()])
                    {
                        *value = before * (f64::from(*f) * c);
                    }
                }
                Product::Rest(of, spectrum) => {
                    let before = &before[of * width..(of + 1) * width];
                    for ((value, before), f) in
                        row.iter_mut().zip(before).zip(&spectrum[bands.clone()])
                    {
                        *value = before * (1.0 - f64::from(*f));
                    }
                }
            }
        }
    }
}

impl Index {
    /// Place of a product times a spectrum, or that of a new one.
    fn times(&mut self, product: usize, spectrum: &Spectrum, new: usize) -> usize {
        let address = std::ptr::from_ref(spectrum).addr();
        let Self { next, spectra, known, powers } = self;
        *next.entry((product, address, false)).or_insert_with(|| {
            let (place, _) = spectra.insert_full(address);
            let mut of_new = powers[product].to_vec();
            match of_new.binary_search_by_key(&place, |(spectrum, _)| *spectrum) {
                Ok(at) => of_new[at].1 += 1,
                Err(at) => of_new.insert(at, (place, 1)),
            }
            let of_new = of_new.into_boxed_slice();
            let found = *known.entry(of_new.clone()).or_insert(new);
            if found == new {
                powers.push(of_new);
            }
            found
        })
    }

    /// Place of the rest that a spectrum leaves of a product, or that of a new one.
    fn rest(&mut self, product: usize, spectrum: &Spectrum, new: usize) -> usize {
        let address = std::ptr::from_ref(spectrum).addr();
        *self.next.entry((product, address, true)).or_insert_with(|| {
            self.powers.push(Box::default());
            new
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::Spectrum;

    #[test]
    fn products_of_the_same_spectra_are_one_whatever_their_order() {
        let spectrum = |values: [f32; 3]| Spectrum::new(values);
        let (a, b) = (spectrum([0.5, 0.25, 0.0]), spectrum([0.125, 0.5, 0.75]));
        let black = spectrum([0.0; 3]);
        let mut products = Products::new(true);
        let one = Products::ONE;
        let [of_a, of_b] = [&a, &b].map(|spectrum| products.times(one, spectrum));
        let of_ab = products.times(of_a, &b);
        assert_eq!(products.times(of_b, &a), of_ab);
        let of_aab = products.times(of_ab, &a);
        let of_aa = products.times(of_a, &a);
        assert_eq!(products.times(of_aa, &b), of_aab);
        assert!(of_aa != of_ab);
        let rest = products.rest(of_a, &b);
        assert_eq!(products.rest(of_a, &b), rest);
        let nothing = products.times(of_a, &black);
        assert_eq!(products.len(), 8);
        let mut values = Vec::new();
        products.write(&(0..3), &mut values);
        for band in 0..3 {
            let [a, b] = [&a, &b].map(|spectrum| f64::from(spectrum[band]));
            let expected = [
                (of_a, a / 0.5),
                (of_ab, a * b / 0.5 / 0.75),
                (of_aab, a * a * b / 0.25 / 0.75),
                (rest, a / 0.5 * (1.0 - b)),
                (nothing, 0.0),
            ];
            for (product, expected) in expected {
                let found = values[3 * product + band];
                assert!((found - expected).abs() < 1e-15, "{product}: {found} for {expected}");
            }
        }
        products.clear();
        assert_eq!((products.len(), products.times(one, &b)), (1, 1));
        // Those that are not looked for are several.
        let mut products = Products::new(false);
        assert_ne!(products.times(one, &a), products.times(one, &a));
    }
}
