//! The directories of a TIFF: their sizes, held against the length of the file before any reader asks
//! for memory, and how their values are shown. Source: TIFF 6.0, section 2; `BigTIFF` has wider fields and is otherwise alike.

use std::io::{self, Read, Seek, SeekFrom};

use super::RasterError;

/// Most tags of a directory: classic TIFF counts them in 16 bits.
const MOST_TAGS: u64 = u16::MAX as u64;

/// Most directories that are looked at: overviews and masks of one picture are a few dozen.
const MOST_DIRECTORIES: usize = 64;

/// Tags by their numbers.
const SUBFILE: u16 = 254;
const PHOTOMETRIC: u16 = 262;
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

/// Tags of a directory that are needed before it is decoded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Directory {
    pub(super) width: u64,
    pub(super) height: u64,
    bits: u64,
    compression: u64,
    tile_width: u64,
    tile_height: u64,
    /// Flags of the picture's relation to others in the file.
    subfile: u64,
    /// Photometric interpretation, and the byte of the file where it is written.
    pub(super) photometric: Option<TagNumber>,
    next: u64,
}

/// A number of 16 bits in a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct TagNumber {
    pub(super) value: u64,
    pub(super) at: u64,
}

impl Directory {
    /// Returns whether it is the mask of a picture of the full size.
    pub(super) fn is_mask_of(&self, other: &Self) -> bool {
        const MASK: u64 = 4;
        const REDUCED: u64 = 1;
        self.subfile & (MASK | REDUCED) == MASK
            && (self.width, self.height) == (other.width, other.height)
    }
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

/// Directories of a file, of which the first is one of a picture that the file is long enough for.
pub(super) fn read(reader: impl Read + Seek, length: u64) -> Result<Vec<Directory>, RasterError> {
    let cut = |_cut| RasterError::Tiff("its list of tags is cut off".to_owned());
    let mut numbers = Numbers { reader, is_big: false };
    let (wide, mut start) = head(&mut numbers).map_err(cut)?;
    let mut directories = Vec::new();
    while start != 0 && directories.len() < MOST_DIRECTORIES {
        let directory = match directory(&mut numbers, start, wide, length) {
            Ok(directory) => directory?,
            // What lies behind the first picture is not needed to read it.
            Err(_cut) if !directories.is_empty() => break,
            Err(error) => return Err(cut(error)),
        };
        check(&directory, length)?;
        start = directory.next;
        directories.push(directory);
    }
    if directories.is_empty() {
        return Err(RasterError::Tiff("it holds no picture".to_owned()));
    }
    Ok(directories)
}

/// Refuses a file that is too short for what a directory says.
fn check(directory: &Directory, length: u64) -> Result<(), RasterError> {
    let &Directory { width, height, bits, compression, tile_width, tile_height, .. } = directory;
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

/// Bytes of an offset, and where the first directory starts.
fn head(numbers: &mut Numbers<impl Read + Seek>) -> io::Result<(usize, u64)> {
    numbers.is_big = numbers.next(2)? == u64::from(u16::from_le_bytes(*b"MM"));
    let wide = match numbers.next(2)? {
        43 => {
            numbers.next(4)?;
            8
        }
        _ => 4,
    };
    Ok((wide, numbers.next(wide)?))
}

fn directory(
    numbers: &mut Numbers<impl Read + Seek>,
    start: u64,
    wide: usize,
    length: u64,
) -> io::Result<Result<Directory, RasterError>> {
    numbers.reader.seek(SeekFrom::Start(start))?;
    let tags = numbers.next(if wide == 8 { 8 } else { 2 })?;
    let mut found = Directory { bits: 1, compression: 1, ..Directory::default() };
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
        let at = numbers.reader.stream_position()?;
        let value = numbers.next(if is_here { size as usize } else { wide })?;
        let rest = if is_here { wide - size as usize } else { 0 };
        numbers.next(rest)?;
        let place = match tag {
            SUBFILE => &mut found.subfile,
            WIDTH => &mut found.width,
            HEIGHT => &mut found.height,
            BITS => &mut found.bits,
            COMPRESSION => &mut found.compression,
            TILE_WIDTH => &mut found.tile_width,
            TILE_HEIGHT => &mut found.tile_height,
            PHOTOMETRIC if is_here && size == 2 => {
                found.photometric = Some(TagNumber { value, at });
                continue;
            }
            _ => continue,
        };
        if is_here {
            *place = value;
        }
    }
    found.next = numbers.next(wide)?;
    Ok(Ok(found))
}

/// A file that reads as another one where some numbers of 16 bits are concerned.
///
/// The library inverts values whose photometric interpretation is "white is zero", and decodes no
/// palettes and masks; what is stored are numbers all the same, so all are read as "black is zero".
pub(super) struct PhotometricPatch<R> {
    inner: R,
    /// Bytes that are read as others.
    bytes: Vec<(u64, u8)>,
}

impl<R: Read + Seek> PhotometricPatch<R> {
    /// Reads the photometric interpretation of numbers, palettes and masks as "black is zero".
    pub(super) fn new(mut inner: R, directories: &[Directory]) -> io::Result<Self> {
        const WHITE_IS_ZERO: u64 = 0;
        const BLACK_IS_ZERO: u8 = 1;
        const PALETTE: u64 = 3;
        const MASK: u64 = 4;
        inner.rewind()?;
        let mut order = [0; 2];
        inner.read_exact(&mut order)?;
        let is_big = order == *b"MM";
        inner.rewind()?;
        let bytes = directories
            .iter()
            .filter_map(|directory| directory.photometric)
            .filter(|written| matches!(written.value, WHITE_IS_ZERO | PALETTE | MASK))
            .flat_map(|TagNumber { at, .. }| {
                let low = u64::from(is_big);
                [(at + low, BLACK_IS_ZERO), (at + 1 - low, 0)]
            })
            .collect();
        Ok(Self { inner, bytes })
    }
}

impl<R: Read + Seek> Read for PhotometricPatch<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let start = self.inner.stream_position()?;
        let count = self.inner.read(buffer)?;
        for &(at, byte) in &self.bytes {
            if let Some(offset) = at.checked_sub(start).filter(|offset| *offset < count as u64) {
                buffer[offset as usize] = byte;
            }
        }
        Ok(count)
    }
}

impl<R: Seek> Seek for PhotometricPatch<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}
