//! What packets bring to the cells of counters, written down before any spectrum is looked at.

use std::ops::Range;

use super::history::{BLOCK, blocks};
use crate::film::Sums;
use crate::scattering::{Spectrum, widely};

/// Shares of packets that count in cells. A packet's weight is the product of all that it was multiplied with;
/// weights and sums of all bands are found after several packets, block by block of bands, so that a block of
/// the cells stays in the cache. Sums are made in the order of the events, whenever that is.
#[derive(Clone, Debug)]
pub struct Tally<'a> {
    entries: Vec<Entry<'a>>,
    sums: Vec<Sums>,
    /// The sums that are added to.
    current: usize,
}

#[derive(Clone, Copy, Debug)]
enum Entry<'a> {
    /// A packet starts with the weight 1.
    Start,
    /// `w ← w f c`.
    Scattering(&'a [f32], f32),
    /// A cell of some sums, by where it starts, gets a share of the weight times a factor.
    Sum { sums: usize, start: usize, share: Share<'a>, scale: f64 },
}

/// Share of a packet's weight.
#[derive(Clone, Copy, Debug)]
pub(super) enum Share<'a> {
    /// All of it.
    Whole,
    /// What a surface scatters of it.
    Of(&'a Spectrum),
    /// What it does not scatter: the difference of the very numbers that come and go on.
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

    /// The share of a weight in a block of bands.
    #[inline(always)]
    fn of(self, weight: &[f32], block: &Range<usize>, power: &mut [f64]) {
        let all = power.iter_mut().zip(weight);
        match self {
            Self::Whole => {
                for (power, weight) in all {
                    *power = f64::from(*weight);
                }
            }
            Self::Of(f) => {
                for ((power, weight), f) in all.zip(&f[block.clone()]) {
                    *power = f64::from(weight * f);
                }
            }
            Self::ButFor(f) => {
                for ((power, weight), f) in all.zip(&f[block.clone()]) {
                    *power = f64::from(*weight) - f64::from(weight * f);
                }
            }
        }
    }
}

impl<'a> Tally<'a> {
    /// Of these sums, nothing yet.
    pub(super) const fn new(sums: Vec<Sums>) -> Self {
        Self { entries: Vec::new(), sums, current: 0 }
    }

    /// What follows is of a packet that weighs 1 in every band.
    pub(super) fn start(&mut self) {
        self.entries.push(Entry::Start);
    }

    /// From now on its weight is `w f c`.
    pub(super) fn scatter(&mut self, spectrum: &'a [f32], scale: f32) {
        self.entries.push(Entry::Scattering(spectrum, scale));
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
        let start = self.sums[self.current].start(cell);
        self.entries.push(Entry::Sum { sums: self.current, start, share, scale });
    }

    /// Number of entries that no sum holds yet.
    pub(super) const fn waiting(&self) -> usize {
        self.entries.len()
    }

    /// Adds all that was written down of packets with power in these bands alone.
    pub(super) fn settle(&mut self, bands: Range<usize>) {
        let Self { entries, sums, .. } = self;
        widely(
            #[inline(always)]
            || {
                for block in blocks(bands) {
                    settle_block(entries, sums, &block);
                }
            },
        );
        entries.clear();
    }

    /// The sums.
    pub(super) fn into_sums(self) -> Vec<Sums> {
        self.sums
    }
}

#[inline(always)]
fn settle_block(entries: &[Entry<'_>], sums: &mut [Sums], block: &Range<usize>) {
    let (mut weight, mut power) = ([1.0_f32; BLOCK], [0.0_f64; BLOCK]);
    let (weight, power) = (&mut weight[..block.len()], &mut power[..block.len()]);
    // The share that `power` is: several cells in a row may get the same.
    let mut known = None;
    for entry in entries {
        match *entry {
            Entry::Start => {
                weight.fill(1.0);
                known = None;
            }
            Entry::Scattering(f, c) => {
                for (weight, f) in weight.iter_mut().zip(&f[block.clone()]) {
                    *weight *= f * c;
                }
                known = None;
            }
            Entry::Sum { sums: of, start, share, scale } => {
                if !known.is_some_and(|known| share.is(known)) {
                    share.of(weight, block, power);
                    known = Some(share);
                }
                let cell = &mut sums[of].values_mut()[start + block.start..start + block.end];
                for (sum, power) in cell.iter_mut().zip(&*power) {
                    *sum += power * scale;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
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
        assert!(tally.waiting() == 0);
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
