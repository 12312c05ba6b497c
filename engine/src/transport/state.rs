//! Numbers in the saved states of films, little-endian.

use std::io::{self, Read, Write};

/// Writes numbers.
pub(in crate::transport) fn save_u64(out: &mut dyn Write, numbers: &[u64]) -> io::Result<()> {
    numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
}

pub(in crate::transport) fn save_f64(out: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
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

pub(in crate::transport) fn restore_f64(
    input: &mut dyn Read,
    numbers: &mut [f64],
) -> io::Result<()> {
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
