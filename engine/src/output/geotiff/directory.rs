//! Directories of a TIFF file: tags and their values.
//!
//! Source: TIFF 6.0 (Adobe, 1992); `BigTIFF` as in libtiff 4.

use std::collections::BTreeMap;
use std::io;

/// Numbers of tags.
pub(super) mod tag {
    pub(in super::super) const NEW_SUBFILE_TYPE: u16 = 254;
    pub(in super::super) const IMAGE_WIDTH: u16 = 256;
    pub(in super::super) const IMAGE_LENGTH: u16 = 257;
    pub(in super::super) const BITS_PER_SAMPLE: u16 = 258;
    pub(in super::super) const COMPRESSION: u16 = 259;
    pub(in super::super) const PHOTOMETRIC: u16 = 262;
    pub(in super::super) const IMAGE_DESCRIPTION: u16 = 270;
    pub(in super::super) const SAMPLES_PER_PIXEL: u16 = 277;
    pub(in super::super) const PLANAR_CONFIGURATION: u16 = 284;
    pub(in super::super) const SOFTWARE: u16 = 305;
    pub(in super::super) const PREDICTOR: u16 = 317;
    pub(in super::super) const COLOR_MAP: u16 = 320;
    pub(in super::super) const TILE_WIDTH: u16 = 322;
    pub(in super::super) const TILE_LENGTH: u16 = 323;
    pub(in super::super) const TILE_OFFSETS: u16 = 324;
    pub(in super::super) const TILE_BYTE_COUNTS: u16 = 325;
    pub(in super::super) const EXTRA_SAMPLES: u16 = 338;
    pub(in super::super) const SAMPLE_FORMAT: u16 = 339;
    pub(in super::super) const MODEL_PIXEL_SCALE: u16 = 33550;
    pub(in super::super) const MODEL_TIEPOINT: u16 = 33922;
    pub(in super::super) const GEO_KEY_DIRECTORY: u16 = 34735;
    pub(in super::super) const GEO_ASCII_PARAMS: u16 = 34737;
    pub(in super::super) const GDAL_METADATA: u16 = 42112;
    pub(in super::super) const GDAL_NODATA: u16 = 42113;
}

/// Width of offsets in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OffsetWidth {
    /// Offsets of 32 bits.
    Classic,
    /// `BigTIFF`: offsets of 64 bits.
    Big,
}

impl OffsetWidth {
    /// Size of an offset, bytes.
    const fn offset(self) -> usize {
        match self {
            Self::Classic => 4,
            Self::Big => 8,
        }
    }

    /// Size of a tag in a directory, bytes.
    const fn entry(self) -> usize {
        4 + 2 * self.offset()
    }

    /// Size of the number of tags, bytes.
    const fn count(self) -> usize {
        match self {
            Self::Classic => 2,
            Self::Big => 8,
        }
    }

    fn push(self, offset: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
        match self {
            Self::Classic => {
                let too_far = |_| io::Error::other("an offset takes more than 32 bits");
                bytes.extend(u32::try_from(offset).map_err(too_far)?.to_le_bytes());
            }
            Self::Big => bytes.extend(offset.to_le_bytes()),
        }
        Ok(())
    }
}

/// Value of a tag.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum TagValue {
    Ascii(String),
    Shorts(Vec<u16>),
    Longs(Vec<u32>),
    Doubles(Vec<f64>),
    /// Offsets, or lengths of data.
    Places(Vec<u64>),
}

impl TagValue {
    /// Number of the type, number of values, and the values.
    fn encode(&self, kind: OffsetWidth) -> io::Result<(u16, usize, Vec<u8>)> {
        Ok(match self {
            Self::Ascii(text) => {
                let mut bytes = text.replace('\0', " ").into_bytes();
                bytes.push(0);
                (2, bytes.len(), bytes)
            }
            Self::Shorts(values) => {
                (3, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            Self::Longs(values) => {
                (4, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            Self::Doubles(values) => {
                (12, values.len(), values.iter().flat_map(|v| v.to_le_bytes()).collect())
            }
            Self::Places(values) => {
                let mut bytes = Vec::with_capacity(values.len() * kind.offset());
                values.iter().try_for_each(|&value| kind.push(value, &mut bytes))?;
                (if kind == OffsetWidth::Big { 16 } else { 4 }, values.len(), bytes)
            }
        })
    }
}

/// Tags of an image, by number.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TagDirectory(BTreeMap<u16, TagValue>);

impl TagDirectory {
    pub(super) fn insert(&mut self, tag: u16, field: TagValue) {
        self.0.insert(tag, field);
    }

    /// Directory that starts at an offset, and behind it the values that are no part of it.
    fn encode(&self, start: usize, is_last: bool, kind: OffsetWidth) -> io::Result<Vec<u8>> {
        let length = kind.count() + self.0.len() * kind.entry() + kind.offset();
        let (mut entries, mut values) = (Vec::with_capacity(length), Vec::new());
        let count = self.0.len() as u64;
        entries.extend(&count.to_le_bytes()[..kind.count()]);
        for (tag, field) in &self.0 {
            let (type_number, count, mut bytes) = field.encode(kind)?;
            entries.extend(tag.to_le_bytes());
            entries.extend(type_number.to_le_bytes());
            kind.push(count as u64, &mut entries)?;
            if bytes.len() <= kind.offset() {
                bytes.resize(kind.offset(), 0);
                entries.extend(bytes);
            } else {
                kind.push((start + length + values.len()) as u64, &mut entries)?;
                values.extend(bytes);
                pad(&mut values);
            }
        }
        let next = if is_last { 0 } else { start + length + values.len() };
        kind.push(next as u64, &mut entries)?;
        entries.extend(values);
        Ok(entries)
    }
}

/// Values start at multiples of 8.
fn pad(bytes: &mut Vec<u8>) {
    bytes.resize(bytes.len().next_multiple_of(8), 0);
}

/// The start of a file: its header and all directories, the first of which follows the header. Its length depends on the
/// numbers of values alone.
pub(super) fn encode(directories: &[TagDirectory], kind: OffsetWidth) -> io::Result<Vec<u8>> {
    let mut head: Vec<u8> = match kind {
        OffsetWidth::Classic => vec![b'I', b'I', 42, 0, 8, 0, 0, 0],
        OffsetWidth::Big => vec![b'I', b'I', 43, 0, 8, 0, 0, 0, 16, 0, 0, 0, 0, 0, 0, 0],
    };
    for (number, directory) in directories.iter().enumerate() {
        let is_last = number + 1 == directories.len();
        let bytes = directory.encode(head.len(), is_last, kind)?;
        head.extend(bytes);
    }
    Ok(head)
}
