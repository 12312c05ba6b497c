use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use rayon::ScopeFifo;

/// Runs jobs in parallel and folds their results in the order of the jobs, so that the outcome does not
/// depend on the number of threads. Few results are held back for an earlier one, and no thread idles
/// while there are jobs.
pub(super) fn in_order<J: Send, T: Send>(
    jobs: impl IntoIterator<Item = J, IntoIter: Send>,
    work: impl Fn(J) -> T + Sync,
    fold: impl FnMut(T) + Send,
) {
    let line = Line { jobs: jobs.into_iter(), fold, folded: 0, waiting: VecDeque::new() };
    let line = Mutex::new(line);
    rayon::scope_fifo(|scope| (0..ahead()).for_each(|_| start_next(scope, &line, &work)));
}

/// Maximum number of jobs that run or whose results are held back.
pub(super) fn ahead() -> usize {
    2 * rayon::current_num_threads()
}

/// Jobs in order, of which the first are folded.
struct Line<I, F, T> {
    jobs: I,
    fold: F,
    folded: usize,
    /// Results of the next jobs, as far as they are done.
    waiting: VecDeque<Option<T>>,
}

impl<I, F: FnMut(T), T> Line<I, F, T> {
    /// Takes a result, and folds those that follow the last fold; returns their number.
    fn take(&mut self, number: usize, result: T) -> usize {
        self.waiting[number - self.folded] = Some(result);
        let before = self.folded;
        while let Some(Some(_)) = self.waiting.front() {
            self.waiting.pop_front().flatten().into_iter().for_each(&mut self.fold);
            self.folded += 1;
        }
        self.folded - before
    }
}

/// Starts the next job in the line, if there is one; when that makes room, those after it.
fn start_next<'s, J: Send + 's, T: Send + 's>(
    scope: &ScopeFifo<'s>,
    line: &'s Mutex<Line<impl Iterator<Item = J> + Send, impl FnMut(T) + Send, T>>,
    work: &'s (impl Fn(J) -> T + Sync),
) {
    let lock = || line.lock().unwrap_or_else(PoisonError::into_inner);
    let mut first = lock();
    let Some(job) = first.jobs.next() else { return };
    let number = first.folded + first.waiting.len();
    first.waiting.push_back(None);
    drop(first);
    scope.spawn_fifo(move |scope| {
        let result = work(job);
        let folded = lock().take(number, result);
        (0..folded).for_each(|_| start_next(scope, line, work));
    });
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
    use std::hint::black_box;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    /// Jobs of very different length, more than may wait, on more threads than there are processors.
    #[test]
    fn results_come_in_the_order_of_their_jobs_and_few_wait() {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(5).build().expect("threads");
        let (started, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let mut found = Vec::new();
        pool.install(|| {
            in_order(
                0..1000_usize,
                |job| {
                    let under_way =
                        started.fetch_add(1, Ordering::SeqCst) + 1 - done.load(Ordering::SeqCst);
                    let turns = if job % 97 == 0 { 200_000 } else { job % 7 };
                    (job, under_way, (0..turns).fold(job, |a, b| black_box(a ^ b)))
                },
                |(job, under_way, _)| {
                    done.fetch_add(1, Ordering::SeqCst);
                    found.push((job, under_way));
                },
            );
        });
        assert!(found.iter().map(|&(job, _)| job).eq(0..1000));
        let most = found.iter().map(|&(_, under_way)| under_way).max();
        assert!(most <= Some(pool.install(ahead)), "{most:?}");
    }

    #[test]
    fn a_job_that_fails_ends_all_of_them() {
        let fails = || in_order(0..100, |job| assert_ne!(job, 41, "as it should"), |()| {});
        assert!(std::panic::catch_unwind(fails).is_err());
    }

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
