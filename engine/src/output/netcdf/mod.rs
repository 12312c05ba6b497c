//! `NetCDF` files in the classic format, with places of 64 bits.
//!
//! The crate `netcdf3` takes all values of a variable at once, which an image of gigabytes is too large for, and does not
//! write the format with sizes of 64 bits. Without an unlimited dimension a file is a header, which is written here, and the
//! values of one variable behind those of the other.
//!
//! Source: "`NetCDF` Classic Format Specification" (Unidata) and "CDF-5" (`PnetCDF`).

mod header;
mod read;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;

use std::io::{self, Write};

use self::header::{Header, Width};
pub(super) use self::read::text_attribute;
use super::dataset::{ByteOrder, Dataset};

/// Number of values that are read and written at a time.
const BLOCK: usize = 1 << 18;

/// Size of a variable up to which the format with places of 64 bits and sizes of 32 bits, which more programs read, has
/// room for it, bytes.
const LARGEST: u64 = (1 << 32) - 4;

/// Writes a data set.
pub(super) fn write(dataset: &Dataset<'_>, file: &mut impl Write) -> io::Result<()> {
    write_up_to(LARGEST, dataset, file)
}

/// Writes a data set with sizes of 64 bits if a variable is larger than this, bytes.
fn write_up_to(largest: u64, dataset: &Dataset<'_>, file: &mut impl Write) -> io::Result<()> {
    let header = Header::new(dataset);
    let is_large = header.variables.iter().any(|variable| variable.bytes > largest);
    let bytes = header.encode(if is_large { Width::Sizes } else { Width::Places })?;
    file.write_all(&bytes)?;
    for (variable, layout) in dataset.variables.iter().zip(&header.variables) {
        let mut start = 0;
        while start < layout.values {
            let end = (start + BLOCK).min(layout.values);
            file.write_all(&variable.values.bytes(start..end, ByteOrder::Big)?)?;
            start = end;
        }
        file.write_all(&[0; 3][..(layout.padded() - layout.bytes) as usize])?;
    }
    Ok(())
}
