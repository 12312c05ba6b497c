use super::{Failure, Options};

/// Largest number of threads that a run may be given.
fn most_threads() -> usize {
    const MOST: usize = 1024;
    std::thread::available_parallelism().map_or(MOST, |here| here.get().max(MOST))
}

/// Runs in a pool of as many threads as asked for; no result depends on their number.
pub(super) fn in_pool<T: Send>(
    options: &Options,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    match options.threads {
        None => work(),
        Some(threads) if threads == 0 || threads > most_threads() => {
            let reason = format!(
                "give 1 to {}; results do not depend on it, and more than the machine has gain nothing",
                most_threads()
            );
            Err(Failure::Threads { threads, reason })
        }
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| Failure::Threads { threads, reason: error.to_string() })?
            .install(work),
    }
}
