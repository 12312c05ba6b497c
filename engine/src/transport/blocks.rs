use rayon::prelude::*;

/// Does blocks `0..count` in parallel and hands their results over in block order, a batch at a time
/// so that few wait in memory. What comes out cannot depend on the number of threads.
pub(super) fn in_order<T: Send>(
    count: usize,
    batch: usize,
    work: impl Fn(usize) -> T + Sync,
    mut fold: impl FnMut(usize, T),
) {
    for start in (0..count).step_by(batch) {
        let end = (start + batch).min(count);
        let results: Vec<T> = (start..end).into_par_iter().map(&work).collect();
        for (block, result) in (start..end).zip(results) {
            fold(block, result);
        }
    }
}
