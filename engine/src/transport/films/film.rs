//! Measurements that samples are added to.

use std::io::{self, Read, Write};

use glam::UVec2;

use super::{Partition, blocks};
use crate::transport::ProgressFn;

/// A measurement that samples can be added to. However they are cut into rounds, the sums are the same, bit for
/// bit, if every round but the last ends where its [`Schedule`] says.
pub trait Film {
    /// Adds the samples of each randomisation up to `to` (in an image, of each pixel); `progress` receives the part of them that is done.
    ///
    /// # Errors
    /// If sums are kept in a temporary file that cannot be made, read or written.
    fn trace(&mut self, to: u64, progress: ProgressFn<'_>) -> io::Result<()>;

    /// Restricts it to a partition of the samples.
    fn restrict(&mut self, partition: Partition);

    /// Columns and rows of the units that partitions share out: tiles of an image, or one column of randomisations.
    fn units(&self) -> UVec2;

    /// Writes the state of its partition; only where a round may end (see [`Schedule`]).
    ///
    /// # Errors
    /// Errors of the writer.
    fn save(&self, out: &mut dyn Write) -> io::Result<()>;

    /// Replaces the state of a partition by one that a film of the same measurement wrote, after `done` samples of
    /// each randomisation.
    ///
    /// # Errors
    /// Errors of the reader, which must not end early.
    fn restore(&mut self, partition: Partition, done: u64, input: &mut dyn Read) -> io::Result<()>;

    /// Checks that samples can be added later.
    ///
    /// # Errors
    /// The memory in bytes that this would take, if it is too much.
    fn can_grow(&self) -> Result<(), u64>;

    /// Memory that it holds once it is traced, bytes: none before. `u64::MAX` if it is more.
    fn bytes(&self) -> u64;

    /// Maximum memory that it takes beside that, bytes: of blocks that wait while it is traced, or of outcomes when
    /// products are computed.
    fn bytes_beside(&self) -> u64;

    /// Size of the temporary file that it has once it is traced, bytes.
    fn bytes_on_disk(&self) -> u64 {
        0
    }

    /// Size of the state of its partition, bytes.
    fn bytes_of_state(&self) -> u64 {
        self.bytes()
    }

    /// Paths or photon packets traced.
    fn samples(&self) -> u64;

    /// Rays traced.
    fn rays(&self) -> u64;

    /// Returns whether all of its sums are coefficients of products of spectra, so that its state can be restored with
    /// other spectra.
    fn has_coefficients_alone(&self) -> bool {
        false
    }

    /// Largest fraction of the incident energy of photon packets that is not accounted for.
    fn imbalance(&self) -> Option<f64> {
        None
    }
}

/// Numbers of samples at which rounds may end, and at which errors are evaluated. They are the same in every run,
/// so that a resumed run ends where one long run would have ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Schedule {
    /// Ends of blocks.
    Blocks,
    /// After any sample; errors are evaluated from this number on.
    Samples(u64),
}

impl Schedule {
    /// Smallest number above `n` at which a round may end.
    #[must_use]
    pub const fn next(self, n: u64) -> u64 {
        match self {
            Self::Blocks => blocks::next_end(n),
            Self::Samples(_) => n + 1,
        }
    }

    /// Largest number up to `n` at which a round may end.
    #[must_use]
    pub const fn last(self, n: u64) -> u64 {
        match self {
            Self::Blocks => blocks::last_end(n),
            Self::Samples(_) => n,
        }
    }

    /// Numbers of samples at which errors are evaluated, each about an eighth above the one before.
    pub fn evaluations(self) -> impl Iterator<Item = u64> {
        let first = match self {
            Self::Blocks => self.next(0),
            Self::Samples(first) => first,
        };
        std::iter::successors(Some(first), move |&n| Some(self.next(n + n / 9)))
    }
}
