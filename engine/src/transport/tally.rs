//! What packets bring to the cells of counters, written down before any spectrum is looked at.

use std::ops::Range;

use super::history::blocks;
use super::weights::Weights;
use crate::film::Sums;
use crate::scattering::{LANES, Spectrum, widely};

/// Shares of packets that count in cells. A packet weighs one of `Weights` times a number; what several
/// packets bring to a cell by the same one is added up before any band is looked at, and the bands then block
/// by block, so that a block of the weights stays in the cache.
#[derive(Clone, Debug)]
pub struct Tally<'a> {
    weights: Weights<'a>,
    /// What the packet weighs: this one,
    weight: usize,
    /// times this.
    scale: f64,
    entries: Vec<Entry>,
    /// The share that was found last: several cells in a row may get the same.
    known: Option<(Share<'a>, Found)>,
    sums: Vec<Sums>,
    /// The sums that are added to.
    current: usize,
}

/// A share of what the packet weighs: one of the weights, and what that is to be multiplied with.
type Found = (usize, f64);

/// So much of a weight for a cell, by where it starts in some sums.
#[derive(Clone, Copy, Debug)]
struct Entry {
    weight: usize,
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

/// Entries, and weights, from which on a tally is settled: so many share their cells, and a block of the
/// weights finds room in the cache.
const MOST: (usize, usize) = (1 << 15, 1 << 10);

impl<'a> Tally<'a> {
    /// Of these sums, nothing yet.
    pub(super) fn new(sums: Vec<Sums>) -> Self {
        let weights = Weights::new(sums.iter().any(|sums| sums.bands() > LANES));
        let (weight, scale, entries, known) = (Weights::ONE, 1.0, Vec::new(), None);
        Self { weights, weight, scale, entries, known, sums, current: 0 }
    }

    /// What follows is of a packet that weighs 1 in every band.
    pub(super) const fn start(&mut self) {
        (self.weight, self.scale, self.known) = (Weights::ONE, 1.0, None);
    }

    /// From now on its weight is `w f c`.
    pub(super) fn scatter(&mut self, spectrum: &'a Spectrum, scale: f32) {
        self.weight = self.weights.times(self.weight, spectrum);
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
        let (weight, of_share) = match self.known {
            Some((known, found)) if share.is(known) => found,
            _ => self.find(share),
        };
        let (sums, start) = (self.current, self.sums[self.current].start(cell));
        self.entries.push(Entry { weight, sums, start, scale: of_share * scale });
    }

    fn find(&mut self, share: Share<'a>) -> Found {
        let found = match share {
            Share::Whole => (self.weight, self.scale),
            Share::Of(f) => {
                (self.weights.times(self.weight, f), self.scale * f64::from(f.largest()))
            }
            Share::ButFor(f) => (self.weights.rest(self.weight, f), self.scale),
        };
        self.known = Some((share, found));
        found
    }

    /// Whether it is time to settle, once a packet has come to its end.
    pub(super) const fn is_full(&self) -> bool {
        self.entries.len() > MOST.0 || self.weights.len() > MOST.1
    }

    /// Adds all that was written down of packets with power in these bands alone. The next packet starts anew.
    pub(super) fn settle(&mut self, bands: Range<usize>) {
        let Self { weights, entries, sums, .. } = self;
        if bands.len() > LANES {
            let place = |entry: &Entry| (entry.weight, entry.sums, entry.start);
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
                    weights.write(&block, &mut values);
                    for &Entry { weight, sums: of, start, scale } in &*entries {
                        let cell = start + block.start..start + block.end;
                        let cell = sums[of].values_mut()[cell].iter_mut();
                        let values = &values[weight * block.len()..(weight + 1) * block.len()];
                        for (sum, value) in cell.zip(values) {
                            *sum += value * scale;
                        }
                    }
                }
            },
        );
        entries.clear();
        weights.clear();
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

    /// Whatever is settled when, each band of each cell holds the sum of its shares of the weights.
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
                // Eighths and their weights are exact.
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
