//! Global attributes out of the header of a file.

use std::io::{self, Read};

/// Longest name or value that is read, bytes.
const LONGEST: u64 = 4 << 20;

/// Text of a global attribute; `None` if there is none of this name.
///
/// # Errors
/// If the file cannot be read, or its header is damaged.
pub(in crate::output) fn text_attribute(file: impl Read, name: &str) -> io::Result<Option<String>> {
    let mut header = HeaderReader { file, has_wide_sizes: false };
    let [_, _, _, version] = header.bytes()?;
    header.has_wide_sizes = version == 5;
    header.size()?;
    for _ in 0..header.list()? {
        header.padded(1)?;
        header.size()?;
    }
    for _ in 0..header.list()? {
        let found = header.padded(1)?;
        let size = match u32::from_be_bytes(header.bytes()?) {
            1 | 2 | 7 => 1,
            3 | 8 => 2,
            4 | 5 | 9 => 4,
            6 | 10 | 11 => 8,
            _ => return Err(damaged()),
        };
        let value = header.padded(size)?;
        if found == name.as_bytes() {
            return Ok(Some(String::from_utf8(value).map_err(|_not_text| damaged())?));
        }
    }
    Ok(None)
}

fn damaged() -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, "its header has no sense")
}

struct HeaderReader<R> {
    file: R,
    has_wide_sizes: bool,
}

impl<R: Read> HeaderReader<R> {
    fn bytes<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes)?;
        Ok(bytes)
    }

    fn size(&mut self) -> io::Result<u64> {
        Ok(if self.has_wide_sizes {
            u64::from_be_bytes(self.bytes()?)
        } else {
            u32::from_be_bytes(self.bytes()?).into()
        })
    }

    /// Number of the elements of a list.
    fn list(&mut self) -> io::Result<u64> {
        self.bytes::<4>()?;
        self.size()
    }

    /// Values with their number before them, filled up to a multiple of 4 bytes.
    fn padded(&mut self, size: u64) -> io::Result<Vec<u8>> {
        let length = self.size()?.checked_mul(size).filter(|length| *length <= LONGEST);
        let length = length.ok_or_else(damaged)?;
        let mut bytes = Vec::new();
        (&mut self.file).take(length.next_multiple_of(4)).read_to_end(&mut bytes)?;
        if (bytes.len() as u64) < length.next_multiple_of(4) {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        bytes.truncate(length as usize);
        Ok(bytes)
    }
}
