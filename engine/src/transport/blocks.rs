use std::ops::Range;

use rayon::prelude::*;

/// Does jobs in parallel and hands their results over in the order of the jobs, a batch at a time so
/// that few wait in memory; `watch` hears when all of a batch are handed over. What comes out cannot
/// depend on the number of threads.
pub(super) fn in_order<J: Send, T: Send>(
    jobs: impl IntoIterator<Item = J>,
    batch: usize,
    work: impl Fn(J) -> T + Sync,
    mut fold: impl FnMut(T),
    watch: impl Fn(usize),
) {
    let (mut jobs, mut done) = (jobs.into_iter(), 0);
    loop {
        let batch: Vec<J> = jobs.by_ref().take(batch).collect();
        if batch.is_empty() {
            return;
        }
        let results: Vec<T> = batch.into_par_iter().map(&work).collect();
        done += results.len();
        results.into_iter().for_each(&mut fold);
        watch(done);
    }
}

/// Samples of the largest block. Small enough to share the work out evenly, large enough that folding
/// the blocks' sums costs nothing beside tracing them.
pub(super) const LARGEST: u64 = 2048;

/// Samples of the first block.
const FIRST: u64 = 16;

/// Samples from which on a block is an eighth of the power of two before it.
const EIGHTHS: u64 = 8 * FIRST;

/// The first place behind `n` samples of a randomisation where a block ends. Blocks end at these
/// places in every run, so that sums are folded alike however a run is cut: at 16, 32, 64 and 128,
/// then every eighth of the power of two that was reached, at least every 2048.
pub(super) const fn next_end(n: u64) -> u64 {
    if n < FIRST {
        FIRST
    } else if n < EIGHTHS {
        2 * (1 << n.ilog2())
    } else {
        let step = step(n);
        (n / step + 1).saturating_mul(step)
    }
}

/// The last place at or before `n` samples where a block ends.
pub(super) const fn last_end(n: u64) -> u64 {
    if n < FIRST {
        0
    } else if n < EIGHTHS {
        1 << n.ilog2()
    } else {
        n - n % step(n)
    }
}

const fn step(n: u64) -> u64 {
    let step = (1 << n.ilog2()) / 8;
    if step < LARGEST { step } else { LARGEST }
}

/// Blocks of these samples; the last one may end too early.
pub(super) fn of(samples: Range<u64>) -> impl Iterator<Item = Range<u64>> {
    let end = samples.end;
    std::iter::successors(Some(samples.start..samples.start), move |last| {
        Some(last.end..next_end(last.end).min(end))
    })
    .skip(1)
    .take_while(|block| !block.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_end_at_the_same_places_however_a_run_is_cut() {
        let ends: Vec<u64> = of(0..131_072).map(|block| block.end).collect();
        assert_eq!(ends[..8], [16, 32, 64, 128, 144, 160, 176, 192]);
        assert!(ends.windows(2).all(|pair| pair[1] - pair[0] <= LARGEST));
        for &cut in &ends {
            assert_eq!((last_end(cut), last_end(cut + 1)), (cut, cut));
            assert!(
                of(cut..131_072)
                    .map(|block| block.end)
                    .eq(ends.iter().copied().filter(|&end| end > cut))
            );
        }
        assert!(of(7..7).next().is_none());
    }
}
