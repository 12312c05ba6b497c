//! What packets weigh, band by band: found once for all of them that weigh the same but for a factor.

use std::collections::HashMap;
use std::ops::Range;

use indexmap::IndexSet;

use crate::scattering::Spectrum;

/// Weights `P = Π f / max f`, whatever the order of the spectra `f`, and what one leaves of them, `P (1 - f)`.
///
/// A scene has few materials and most packets meet a few of them a few times, so that thousands of packets
/// have some hundred weights. No factor is above 1, and each is 1 in some band: what underflows is nothing
/// beside another band.
#[derive(Clone, Debug)]
pub(super) struct Weights<'a> {
    /// Each behind the one that it is made of.
    all: Vec<Weight<'a>>,
    /// To find one again; of few bands, that takes longer than to have it twice.
    index: Option<Index>,
}

/// An earlier weight, and the spectrum that this one takes.
#[derive(Clone, Copy, Debug)]
enum Weight<'a> {
    One,
    /// `P f / max f`.
    Times(usize, &'a Spectrum),
    /// `P (1 - f)`.
    Rest(usize, &'a Spectrum),
}

/// Weights by what they are made of; spectra are told apart by where they are.
#[derive(Clone, Debug, Default)]
struct Index {
    /// What follows from a weight by a spectrum; `true` for what that leaves.
    next: HashMap<(usize, usize, bool), usize>,
    spectra: IndexSet<usize>,
    /// Weights by the spectra that they have.
    known: HashMap<Powers, usize>,
    /// Those of each weight; of what a spectrum leaves, none.
    powers: Vec<Powers>,
}

/// Places among the spectra, in order, and how often a weight has each.
type Powers = Box<[(usize, u32)]>;

impl<'a> Weights<'a> {
    /// That of all packets before they meet anything.
    pub(super) const ONE: usize = 0;

    /// That alone, and those to come each once if they are `sought`.
    pub(super) fn new(sought: bool) -> Self {
        let mut weights = Self { all: Vec::new(), index: sought.then(Index::default) };
        weights.clear();
        weights
    }

    /// Forgets all others.
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.all.push(Weight::One);
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

    /// `P f / max f`.
    pub(super) fn times(&mut self, weight: usize, spectrum: &'a Spectrum) -> usize {
        self.place(Weight::Times(weight, spectrum))
    }

    /// `P (1 - f)`, which nothing can be made of.
    pub(super) fn rest(&mut self, weight: usize, spectrum: &'a Spectrum) -> usize {
        self.place(Weight::Rest(weight, spectrum))
    }

    /// Where a weight is, at the end if it is not known.
    fn place(&mut self, weight: Weight<'a>) -> usize {
        let new = self.all.len();
        let found = self.index.as_mut().map_or(new, |index| index.place(weight, new));
        if found == new {
            self.all.push(weight);
        }
        found
    }

    /// Writes all of them in these bands, shape `[weights, bands]`.
    #[inline(always)]
    pub(super) fn write(&self, bands: &Range<usize>, values: &mut Vec<f64>) {
        let width = bands.len();
        values.resize(self.all.len() * width, 0.0);
        for (place, weight) in self.all.iter().enumerate() {
            let (before, rows) = values.split_at_mut(place * width);
            let row = &mut rows[..width];
            match *weight {
                Weight::One => row.fill(1.0),
                Weight::Times(of, spectrum) => {
                    let largest = f64::from(spectrum.largest());
                    let c = if largest > 0.0 { 1.0 / largest } else { 0.0 };
                    let before = &before[of * width..(of + 1) * width];
                    make(row, before, &spectrum[bands.clone()], |f| f * c);
                }
                Weight::Rest(of, spectrum) => {
                    let before = &before[of * width..(of + 1) * width];
                    make(row, before, &spectrum[bands.clone()], |f| 1.0 - f);
                }
            }
        }
    }
}

/// The weight before times what is made of a spectrum, band by band.
#[inline(always)]
fn make(row: &mut [f64], before: &[f64], spectrum: &[f32], factor: impl Fn(f64) -> f64) {
    for ((value, before), f) in row.iter_mut().zip(before).zip(spectrum) {
        *value = before * factor(f64::from(*f));
    }
}

impl Index {
    /// Where a weight is: at the new place unless it is known.
    fn place(&mut self, weight: Weight<'_>, new: usize) -> usize {
        let (of, spectrum, is_rest) = match weight {
            Weight::One => return Weights::ONE,
            Weight::Times(of, spectrum) => (of, spectrum, false),
            Weight::Rest(of, spectrum) => (of, spectrum, true),
        };
        let address = std::ptr::from_ref(spectrum).addr();
        let Self { next, spectra, known, powers } = self;
        *next.entry((of, address, is_rest)).or_insert_with(|| {
            if is_rest {
                powers.push(Box::default());
                return new;
            }
            let (place, _) = spectra.insert_full(address);
            let mut of_new = powers[of].to_vec();
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::Spectrum;

    #[test]
    fn weights_of_the_same_spectra_are_one_whatever_their_order() {
        let spectrum = |values: [f32; 3]| Spectrum::new(values);
        let (a, b) = (spectrum([0.5, 0.25, 0.0]), spectrum([0.125, 0.5, 0.75]));
        let black = spectrum([0.0; 3]);
        let mut weights = Weights::new(true);
        let one = Weights::ONE;
        let [of_a, of_b] = [&a, &b].map(|spectrum| weights.times(one, spectrum));
        let of_ab = weights.times(of_a, &b);
        assert_eq!(weights.times(of_b, &a), of_ab);
        let of_aab = weights.times(of_ab, &a);
        let of_aa = weights.times(of_a, &a);
        assert_eq!(weights.times(of_aa, &b), of_aab);
        assert!(of_aa != of_ab);
        let rest = weights.rest(of_a, &b);
        assert_eq!(weights.rest(of_a, &b), rest);
        let nothing = weights.times(of_a, &black);
        assert_eq!(weights.len(), 8);
        let mut values = Vec::new();
        weights.write(&(0..3), &mut values);
        for band in 0..3 {
            let [a, b] = [&a, &b].map(|spectrum| f64::from(spectrum[band]));
            let expected = [
                (of_a, a / 0.5),
                (of_ab, a * b / 0.5 / 0.75),
                (of_aab, a * a * b / 0.25 / 0.75),
                (rest, a / 0.5 * (1.0 - b)),
                (nothing, 0.0),
            ];
            for (weight, expected) in expected {
                let found = values[3 * weight + band];
                assert!((found - expected).abs() < 1e-15, "{weight}: {found} for {expected}");
            }
        }
        weights.clear();
        assert_eq!((weights.len(), weights.times(one, &b)), (1, 1));
        // Those that are not sought are several.
        let mut weights = Weights::new(false);
        assert_ne!(weights.times(one, &a), weights.times(one, &a));
    }
}
