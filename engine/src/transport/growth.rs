//! Measurements that grow.

use std::io::{self, Read, Write};

use super::{Share, Watch, blocks};

/// A measurement that samples can be added to: however they are cut into rounds, the sums come out
/// the same, bit for bit, as long as every round but the last ends where its [`Schedule`] says.
pub trait Film {
    /// Adds the samples of each randomisation up to this one. Receives the part of them that is done.
    fn trace(&mut self, to: u64, watch: Watch<'_>);

    /// From now on, traces this share of each sample alone.
    fn restrict(&mut self, share: Share);

    /// Writes down what is there of its share; only where a round may end (see [`Schedule`]).
    ///
    /// # Errors
    /// Of the writer.
    fn save(&self, out: &mut dyn Write) -> io::Result<()>;

    /// Takes a share in that was written down by a film of the same measurement, in place of what is
    /// there of it. Afterwards so many samples of each randomisation are done.
    ///
    /// # Errors
    /// Of the reader, which must not end early.
    fn restore(&mut self, share: Share, done: u64, input: &mut dyn Read) -> io::Result<()>;

    /// Whether more can be added later; if not, the memory in bytes that this would take.
    ///
    /// # Errors
    /// That memory.
    fn can_grow(&self) -> Result<(), u64>;

    /// Memory of what it holds once it is traced, bytes: nothing before. `u64::MAX` of more than can
    /// be counted.
    fn bytes(&self) -> u64;

    /// The most memory that it takes beside that, bytes: of blocks that wait while it is traced, or
    /// of what is found when products are made of it.
    fn bytes_beside(&self) -> u64;

    /// Paths or photon packets traced.
    fn samples(&self) -> u64;

    /// Rays traced.
    fn rays(&self) -> u64;

    /// Of photon packets, the largest share of the incident energy that is not accounted for.
    fn imbalance(&self) -> Option<f64> {
        None
    }
}

/// Where rounds may end, and where errors are looked at: the same places in every run, whatever it
/// is asked for, so that a run that is gone on with ends where one long run would have ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Schedule {
    /// At the ends of blocks.
    Blocks,
    /// After any sample; errors are looked at from so many on.
    Samples(u64),
}

impl Schedule {
    /// The first place behind `n` where a round may end.
    #[must_use]
    pub const fn next(self, n: u64) -> u64 {
        match self {
            Self::Blocks => blocks::next_end(n),
            Self::Samples(_) => n + 1,
        }
    }

    /// The last place at or before `n` where a round may end.
    #[must_use]
    pub const fn last(self, n: u64) -> u64 {
        match self {
            Self::Blocks => blocks::last_end(n),
            Self::Samples(_) => n,
        }
    }

    /// Places where errors are looked at, each about an eighth beyond the one before it.
    pub fn looks(self) -> impl Iterator<Item = u64> {
        let first = match self {
            Self::Blocks => self.next(0),
            Self::Samples(first) => first,
        };
        std::iter::successors(Some(first), move |&n| Some(self.next(n + n / 9)))
    }
}
