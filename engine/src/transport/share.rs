//! What of a measurement one of several runs traces, and how its state is written down.

use std::io::{self, Read, Write};

/// One of several disjoint shares of a measurement: of the units that it is made of (randomisations,
/// or tiles of an image) those whose number leaves `index` when divided by `of`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Share {
    /// Its number, from 0.
    pub index: u32,
    /// How many there are.
    pub of: u32,
}

impl Share {
    /// All of it.
    pub const ALL: Self = Self { index: 0, of: 1 };

    /// Whether a unit belongs to it.
    #[must_use]
    pub const fn owns(self, unit: usize) -> bool {
        unit % self.of as usize == self.index as usize
    }
}

/// Writes numbers, little-endian.
pub(super) fn save_u64(out: &mut dyn Write, numbers: &[u64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

pub(super) fn save_f64(out: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

/// Reads numbers in place of those that are there.
pub(super) fn restore_u64(input: &mut dyn Read, numbers: &mut [u64]) -> io::Result<()> {
    for number in numbers {
        *number = u64::from_le_bytes(word(input)?);
    }
    Ok(())
}

pub(super) fn restore_f64(input: &mut dyn Read, numbers: &mut [f64]) -> io::Result<()> {
    for number in numbers {
        *number = f64::from_le_bytes(word(input)?);
    }
    Ok(())
}

fn word(input: &mut dyn Read) -> io::Result<[u8; 8]> {
    let mut bytes = [0; 8];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}
