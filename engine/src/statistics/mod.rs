//! Mergeable accumulators in f64, and the standard errors of their sums.
//!
//! Work is cut into fixed blocks; each fills its own [`Sums`], and they are folded in block order,
//! so a result does not depend on the number of threads. A measurement is repeated as independent
//! randomisations, and [`Spread`] over these gives the standard error, whatever correlations the
//! points within one of them have.

mod cell_index;
mod ranks;
mod ratio;
mod replicates;
mod spread;
mod sums;

pub use ranks::values_at_ranks;
pub use ratio::ratio;
pub use replicates::Replicates;
pub use spread::Spread;
pub(crate) use sums::zeroed;
pub use sums::{OrderedSums, Sums};
