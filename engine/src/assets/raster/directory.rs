//! What a TIFF says about its sizes, held against the length of the file before any reader asks for
//! memory. Source: TIFF 6.0, section 2; `BigTIFF` has wider fields and is otherwise alike.

use std::io::{self, Read, Seek, SeekFrom};

use super::RasterError;

/// Most tags of a directory: classic TIFF counts them in 16 bits.
const MOST_TAGS: u64 = u16::MAX as u64;

/// Tags by their numbers.
const WIDTH: u16 = 256;
const HEIGHT: u16 = 257;
const BITS: u16 = 258;
const COMPRESSION: u16 = 259;
const TILE_WIDTH: u16 = 322;
const TILE_HEIGHT: u16 = 323;

/// Bytes that one byte of a file can become.
fn expansion(compression: u64) -> u64 {
    match compression {
        1 => 1,
        // Runs of 128 bytes in two.
        32773 => 64,
        // Codes of 12 bits for up to 4096 bytes.
        5 => 2731,
        // RFC 1951: at best two bits for 258 bytes.
        8 | 32946 => 1032,
        // RFC 8878, the most that any other does: a block of 128 KiB in four bytes.
        _ => 1 << 15,
    }
}

/// Bytes of a value of each type, from type 1.
const SIZES: [u64; 18] = [1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8];

/// The tags that say how large something is.
struct Sizes {
    width: u64,
    height: u64,
    bits: u64,
    compression: u64,
    tile_width: u64,
    tile_height: u64,
}

/// Whole numbers in the file's order of bytes.
struct Numbers<R> {
    reader: R,
    is_big: bool,
}

impl<R: Read + Seek> Numbers<R> {
    fn next(&mut self, bytes: usize) -> io::Result<u64> {
        let mut number = [0; 8];
        self.reader.read_exact(&mut number[..bytes])?;
        if self.is_big {
            number[..bytes].reverse();
        }
        Ok(u64::from_le_bytes(number))
    }
}

/// Refuses a file that is too short for what its first directory says.
pub(super) fn check(reader: impl Read + Seek, length: u64) -> Result<(), RasterError> {
    let cut = |_cut| RasterError::Tiff("its list of tags is cut off".to_owned());
    let sizes = sizes(reader, length).map_err(cut)??;
    let Sizes { width, height, bits, compression, tile_width, tile_height } = sizes;
    for (columns, rows) in [(width, height), (tile_width, tile_height)] {
        let cells = u128::from(columns) * u128::from(rows);
        let needed = (cells * u128::from(bits)).div_ceil(u128::from(8 * expansion(compression)));
        if needed > u128::from(length) {
            let needed = needed.min(u64::MAX.into()) as u64;
            return Err(RasterError::TooShort { columns, rows, needed, found: length });
        }
    }
    Ok(())
}

fn sizes(reader: impl Read + Seek, length: u64) -> io::Result<Result<Sizes, RasterError>> {
    let mut numbers = Numbers { reader, is_big: false };
    numbers.is_big = numbers.next(2)? == u64::from(u16::from_le_bytes(*b"MM"));
    let (wide, count) = match numbers.next(2)? {
        43 => {
            numbers.next(4)?;
            (8, 8)
        }
        _ => (4, 2),
    };
    let start = numbers.next(wide)?;
    numbers.reader.seek(SeekFrom::Start(start))?;
    let tags = numbers.next(count)?;
    let mut sizes =
        Sizes { width: 0, height: 0, bits: 1, compression: 1, tile_width: 0, tile_height: 0 };
    for _ in 0..tags.min(MOST_TAGS) {
        let tag = numbers.next(2)? as u16;
        let kind = numbers.next(2)? as usize;
        let count = numbers.next(wide)?;
        let size = kind.checked_sub(1).and_then(|index| SIZES.get(index)).copied().unwrap_or(0);
        if size == 0 && wide == 8 {
            // Readers disagree about how long such an entry is.
            return Ok(Err(RasterError::Tiff(format!("tag {tag} is of an unknown type, {kind}"))));
        }
        let claimed = count.saturating_mul(size);
        if claimed > length {
            let problem =
                format!("tag {tag} says {claimed} bytes, but the file has {length}; it is cut off");
            return Ok(Err(RasterError::Tiff(problem)));
        }
        // A value that fits stands right there, from the first byte on.
        let is_here = count == 1 && (1..=wide as u64).contains(&size);
        let value = numbers.next(if is_here { size as usize } else { wide })?;
        let rest = if is_here { wide - size as usize } else { 0 };
        numbers.next(rest)?;
        let place = match tag {
            WIDTH => &mut sizes.width,
            HEIGHT => &mut sizes.height,
            BITS => &mut sizes.bits,
            COMPRESSION => &mut sizes.compression,
            TILE_WIDTH => &mut sizes.tile_width,
            TILE_HEIGHT => &mut sizes.tile_height,
            _ => continue,
        };
        if is_here {
            *place = value;
        }
    }
    Ok(Ok(sizes))
}
