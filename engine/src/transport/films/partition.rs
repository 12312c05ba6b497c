//! Partition of a measurement among several runs, and the format of its state.

use std::io::{self, Read, Write};

/// One of several disjoint parts of a measurement: those of its units (randomisations, or tiles of an image)
/// whose number modulo `count` is `index`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// Its number, from 0.
    pub index: u32,
    /// Number of partitions.
    pub count: u32,
}

impl Partition {
    /// The whole measurement.
    pub const ALL: Self = Self { index: 0, count: 1 };

    /// Returns whether a unit belongs to it.
    #[must_use]
    pub const fn owns(self, unit: usize) -> bool {
        unit % self.count as usize == self.index as usize
    }
}

/// Writes numbers, little-endian.
pub(in crate::transport) fn save_u64(out: &mut dyn Write, numbers: &[u64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

pub(super) fn save_f64(out: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

/// Reads numbers over the given ones.
pub(in crate::transport) fn restore_u64(
    input: &mut dyn Read,
    numbers: &mut [u64],
) -> io::Result<()> {
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
