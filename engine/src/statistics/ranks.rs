//! Order statistics of sequences that are too long to be kept.

/// Values that are sorted in memory at most.
const FEW: u64 = 1 << 20;

/// Bits by which a pass narrows the range of a rank.
const BITS: u32 = 16;

/// Values of some ranks of a sequence in the order of `f64::total_cmp`. Each pass over the sequence narrows the range
/// that holds a rank, until few values are left in it.
///
/// - `ranks`: function from the number of values to ranks from 0, which is called for at least one value
/// - `visit`: one pass over the sequence, the same at each call
///
/// # Errors
/// The first error of a pass.
pub fn values_at_ranks<const N: usize, E>(
    ranks: impl FnOnce(u64) -> [u64; N],
    mut visit: impl FnMut(&mut dyn FnMut(f64)) -> Result<(), E>,
) -> Result<Option<[f64; N]>, E> {
    let mut bins = vec![0_u64; 1 << BITS];
    let (mut count, mut few) = (0_u64, Vec::new());
    visit(&mut |value| {
        if count < FEW {
            few.push(value);
        }
        bins[(key(value) >> (u64::BITS - BITS)) as usize] += 1;
        count += 1;
    })?;
    if count == 0 {
        return Ok(None);
    }
    if count <= FEW {
        let at = |rank| *few.select_nth_unstable_by(rank as usize, f64::total_cmp).1;
        return Ok(Some(ranks(count).map(at)));
    }
    drop(few);
    let mut ranges = ranks(count).map(|rank| Narrowed { prefix: 0, bits: 0, rank, count });
    for range in &mut ranges {
        range.narrow(&bins);
    }
    while let Some(widest) = ranges.iter().find(|range| !range.is_few()).copied() {
        bins.fill(0);
        visit(&mut |value| {
            if widest.holds(key(value)) {
                let bin = key(value) >> (u64::BITS - widest.bits - BITS) & ((1 << BITS) - 1);
                bins[bin as usize] += 1;
            }
        })?;
        for range in ranges.iter_mut().filter(|range| range.is_same(&widest)) {
            range.narrow(&bins);
        }
    }
    let mut found: [Vec<f64>; N] = ranges.map(|range| Vec::with_capacity(range.room()));
    if ranges.iter().any(|range| range.bits < u64::BITS) {
        visit(&mut |value| {
            for (range, found) in ranges.iter().zip(&mut found) {
                if range.bits < u64::BITS && range.holds(key(value)) {
                    found.push(value);
                }
            }
        })?;
    }
    Ok(Some(std::array::from_fn(|at| match ranges[at] {
        Narrowed { bits: u64::BITS, prefix, .. } => value_of(prefix),
        Narrowed { rank, .. } => *found[at].select_nth_unstable_by(rank as usize, f64::total_cmp).1,
    })))
}

/// Range of values with the same first bits of their keys, which holds a rank.
#[derive(Clone, Copy)]
struct Narrowed {
    prefix: u64,
    bits: u32,
    /// Rank among the values of the range.
    rank: u64,
    /// Number of values in it.
    count: u64,
}

impl Narrowed {
    fn narrow(&mut self, bins: &[u64]) {
        for (bin, &count) in (0..).zip(bins) {
            if self.rank < count {
                let shift = u64::BITS - self.bits - BITS;
                self.prefix |= bin << shift;
                self.bits += BITS;
                self.count = count;
                return;
            }
            self.rank -= count;
        }
    }

    const fn holds(&self, key: u64) -> bool {
        (key ^ self.prefix).leading_zeros() >= self.bits
    }

    const fn is_few(&self) -> bool {
        self.count <= FEW || self.bits == u64::BITS
    }

    const fn is_same(&self, other: &Self) -> bool {
        self.prefix == other.prefix && self.bits == other.bits
    }

    /// Values that it will collect.
    const fn room(&self) -> usize {
        if self.bits < u64::BITS { self.count as usize } else { 0 }
    }
}

/// Whole number in the order of `f64::total_cmp`.
const fn key(value: f64) -> u64 {
    let bits = value.to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// Inverse of [`key`].
const fn value_of(key: u64) -> f64 {
    f64::from_bits(if key >> 63 == 1 { key & !(1 << 63) } else { !key })
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    fn at_ranks<const N: usize>(all: &[f64], ranks: [u64; N]) -> (Option<[f64; N]>, u32) {
        let mut passes = 0;
        let found: Result<_, Infallible> = values_at_ranks(
            |_| ranks,
            |each| {
                passes += 1;
                for &value in all {
                    each(value);
                }
                Ok(())
            },
        );
        (found.unwrap_or_else(|never| match never {}), passes)
    }

    #[test]
    fn ranks_are_those_of_the_sorted_sequence() {
        for (count, most) in [(5000, 1), (FEW as i32 + 7, 3)] {
            let all: Vec<f64> = (0..count)
                .map(|i| f64::from(i.wrapping_mul(1_103_515_245) % 100_003 - 50_000) * 0.37)
                .collect();
            let mut sorted = all.clone();
            sorted.sort_by(f64::total_cmp);
            let last = all.len() as u64 - 1;
            for rank in [0, 1, 49, last / 2, last - 50, last] {
                let (found, passes) = at_ranks(&all, [rank, last - rank]);
                let expected = [rank, last - rank].map(|rank| sorted[rank as usize]);
                assert_eq!(found, Some(expected));
                assert!(passes <= most, "{passes} passes");
            }
        }
        assert_eq!(at_ranks(&[], [0]).0, None);
    }

    /// More equal values than are collected, and two neighbours that differ in their last bit.
    #[test]
    fn many_equal_values_are_counted_and_not_collected() {
        let next = f64::from_bits(0.3_f64.to_bits() + 1);
        let mut all = vec![0.3; (FEW + 10) as usize];
        all.extend([next, f64::INFINITY, -1.0]);
        let last = FEW + 10;
        let (found, passes) = at_ranks(&all, [0, 1, last, last + 1, last + 2]);
        assert_eq!(found, Some([-1.0, 0.3, 0.3, next, f64::INFINITY]));
        assert_eq!(passes, 5, "four of 16 bits each, one for values that are few");
    }
}
