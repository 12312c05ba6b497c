//! What packets bring to the cells of counters, written down before any spectrum is looked at.

use std::ops::Range;

use super::history::blocks;
use super::products::Products;
use crate::film::Sums;
use crate::scattering::{LANES, Spectrum, widely};

/// Shares of packets that count in cells. A packet's weight is a product of spectra times a number; what
/// several packets bring to a cell by the same product is added up before any band is looked at, and the
/// bands then block by block, so that a block of the products stays in the cache.
#[derive(Clone, Debug)]
pub struct Tally<'a> {
    products: Products<'a>,
    /// The packet's weight: this product,
    product: usize,
    /// times this.
    scale: f64,
    entries: Vec<Entry>,
    /// The share that was found last: several cells in a row may get the same.
    known: Option<(Share<'a>, Place)>,
    sums: Vec<Sums>,
    /// The sums that are added to.
    current: usize,
}

/// A share of the packet's weight: a product, and what it is to be multiplied with.
type Place = (usize, f64);

/// So much of a product for a cell, by where it starts in some sums.
#[derive(Clone, Copy, Debug)]
struct Entry {
    product: usize,
    sums: usize,
    start: usize,
    scale: f64,
}

/// Share of a packet's weight.
#[derive(Clone, Copy, Debug)]
pub(super) enum Share<'a> {
    /// All of it.
    Whole,
    /// What a surface scatters of it.
    Of(&'a Spectrum),
    /// What it does not scatter.
    ButFor(&'a Spectrum),
}

impl Share<'_> {
    /// Whether both are the same share, by what it is and not by its values.
    #[inline(always)]
    pub(super) fn is(self, other: Self) -> bool {
        match (self, other) {
            (Self::Whole, Self::Whole) => true,
            (Self::Of(a), Self::Of(b)) | (Self::ButFor(a), Self::ButFor(b)) => std::ptr::eq(a, b),
            _ => false,
        }
    }
}

/// Entries, and products, from which on a tally is settled: so many share their cells, and a block of the
/// products finds room in the cache.
const MOST: (usize, usize) = (1 << 15, 1 << 10);

impl<'a> Tally<'a> {
    /// Of these sums, nothing yet.
    pub(super) fn new(sums: Vec<Sums>) -> Self {
        let products = Products::new(sums.iter().any(|sums| sums.bands() > LANES));
        let (product, scale, entries, known) = (Products::ONE, 1.0, Vec::new(), None);
        Self { products, product, scale, entries, known, sums, current: 0 }
    }

    /// What follows is of a packet that weighs 1 in every band.
    pub(super) const fn start(&mut self) {
        (self.product, self.scale, self.known) = (Products::ONE, 1.0, None);
    }

    /// From now on its weight is `w f c`.
    pub(super) fn scatter(&mut self, spectrum: &'a Spectrum, scale: f32) {
        self.product = self.products.times(self.product, spectrum);
        self.scale *= f64::from(spectrum.largest()) * f64::from(scale);
        self.known = None;
    }

    /// From now on these sums are added to.
    pub(super) const fn turn_to(&mut self, sums: usize) {
        self.current = sums;
    }

    /// Adds a share of the packet's weight, times a factor, to a cell.
    ///
    /// # Panics
    /// If there is no such cell.
    pub(super) fn add(&mut self, cell: usize, share: Share<'a>, scale: f64) {
        let (product, weight) = match self.known {
            Some((known, place)) if share.is(known) => place,
            _ => self.find(share),
        };
        let (sums, start) = (self.current, self.sums[self.current].start(cell));
        self.entries.push(Entry { product, sums, start, scale: weight * scale });
    }

    fn find(&mut self, share: Share<'a>) -> Place {
        let place = match share {
            Share::Whole => (self.product, self.scale),
            Share::Of(f) => {
                (self.products.times(self.product, f), self.scale * f64::from(f.largest()))
            }
            Share::ButFor(f) => (self.products.rest(self.product, f), self.scale),
        };
        self.known = Some((share, place));
        place
    }

    /// Whether it is time to settle, once a packet has come to its end.
    pub(super) const fn is_full(&self) -> bool {
        self.entries.len() > MOST.0 || self.products.len() > MOST.1
    }

    /// Adds all that was written down of packets with power in these bands alone. The next packet starts anew.
    pub(super) fn settle(&mut self, bands: Range<usize>) {
        let Self { products, entries, sums, .. } = self;
        if bands.len() > LANES {
            let place = |entry: &Entry| (entry.product, entry.sums, entry.start);
            entries.sort_by_key(place);
            entries.dedup_by(|next, last| {
                let is_same = place(next) == place(last);
                last.scale += if is_same { next.scale } else { 0.0 };
                is_same
            });
        }
        let mut values = Vec::new();
        widely(
            #[inline(always)]
            || {
                for block in blocks(bands) {
                    products.write(&block, &mut values);
                    for &Entry { product, sums: of, start, scale } in &*entries {
                        let cell = start + block.start..start + block.end;
                        let cell = sums[of].values_mut()[cell].iter_mut();
                        let values = &values[product * block.len()..(product + 1) * block.len()];
                        for (sum, value) in cell.zip(values) {
                            *sum += value * scale;
                        }
                    }
                }
            },
        );
        entries.clear();
        products.clear();
        self.start();
    }

    /// The sums.
    pub(super) fn into_sums(self) -> Vec<Sums> {
        self.sums
    }
}

#[cfg(test)]
mod tests {
    use super::super::history::BLOCK;
    use super::*;

    /// Whatever is settled when, each band of each cell holds the sum of its shares of the products.
    #[test]
    fn cells_hold_their_shares_of_what_packets_weigh() {
        let bands = 2 * BLOCK + 7;
        let spectrum = |seed: usize| {
            Spectrum::new((0..bands).map(move |band| ((band * 31 + seed * 17) % 7) as f32 / 8.0))
        };
        let [a, b, c] = [1, 2, 3].map(spectrum);
        let mut tally = Tally::new(vec![Sums::new(2, bands), Sums::new(1, bands)]);
        let rounds = 5;
        for round in 0..rounds {
            tally.start();
            tally.scatter(&a, 2.0);
            tally.add(0, Share::Whole, 1.0);
            tally.add(1, Share::Of(&b), 0.5);
            tally.turn_to(1);
            tally.add(0, Share::Of(&b), 3.0);
            tally.scatter(&b, 0.5);
            tally.add(0, Share::ButFor(&c), 1.0);
            tally.turn_to(0);
            if round % 2 == 0 {
                tally.settle(0..bands);
            }
        }
        assert!(tally.entries.is_empty());
        let sums = tally.into_sums();
        for band in 0..bands {
            let [a, b, c] = [&a, &b, &c].map(|spectrum| f64::from(spectrum[band]));
            let n = f64::from(rounds);
            let expected = [2.0 * a, a * b, 6.0 * a * b + a * b * (1.0 - c)].map(|sum| n * sum);
            let found =
                [sums[0].values()[band], sums[0].values()[bands + band], sums[1].values()[band]];
            for (found, expected) in found.into_iter().zip(expected) {
                // Eighths and their products are exact.
                assert!((found - expected).abs() < 1e-12, "{band}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn what_is_settled_in_one_band_leaves_the_others() {
        let all = Spectrum::new([1.0; 20]);
        let mut tally = Tally::new(vec![Sums::new(1, 20)]);
        tally.start();
        tally.scatter(&all, 3.0);
        tally.add(0, Share::Whole, 1.0);
        tally.settle(17..18);
        let expected: Vec<f64> = (0..20).map(|band| if band == 17 { 3.0 } else { 0.0 }).collect();
        assert_eq!(tally.into_sums()[0].values(), expected);
    }
}
