//! Numbers in the saved states of films, little-endian.

use std::io::{self, Read, Write};

/// Size of a number, bytes.
const WORD: usize = 8;

/// Numbers that are written or read together.
const TOGETHER: usize = 512;

/// Writes numbers.
pub(in crate::transport) fn save_u64(out: &mut dyn Write, numbers: &[u64]) -> io::Result<()> {
    save(out, numbers, u64::to_le_bytes)
}

pub(in crate::transport) fn save_f64(out: &mut dyn Write, numbers: &[f64]) -> io::Result<()> {
    save(out, numbers, f64::to_le_bytes)
}

fn save<T: Copy>(
    out: &mut dyn Write,
    numbers: &[T],
    to_bytes: impl Fn(T) -> [u8; WORD],
) -> io::Result<()> {
    let mut bytes = [[0; WORD]; TOGETHER];
    for numbers in numbers.chunks(TOGETHER) {
        for (bytes, &number) in bytes.iter_mut().zip(numbers) {
            *bytes = to_bytes(number);
        }
        out.write_all(bytes[..numbers.len()].as_flattened())?;
    }
    Ok(())
}

/// Reads numbers over the given ones.
pub(in crate::transport) fn restore_u64(
    input: &mut dyn Read,
    numbers: &mut [u64],
) -> io::Result<()> {
    restore(input, numbers, u64::from_le_bytes)
}

pub(in crate::transport) fn restore_f64(
    input: &mut dyn Read,
    numbers: &mut [f64],
) -> io::Result<()> {
    restore(input, numbers, f64::from_le_bytes)
}

fn restore<T>(
    input: &mut dyn Read,
    numbers: &mut [T],
    from_bytes: impl Fn([u8; WORD]) -> T,
) -> io::Result<()> {
    let mut bytes = [[0; WORD]; TOGETHER];
    for numbers in numbers.chunks_mut(TOGETHER) {
        input.read_exact(bytes[..numbers.len()].as_flattened_mut())?;
        for (number, &bytes) in numbers.iter_mut().zip(&bytes) {
            *number = from_bytes(bytes);
        }
    }
    Ok(())
}
