//! Tiles: cut from rows, prepared for compression, compressed side by side.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use super::pyramid::Level;

/// Width and height of a tile, pixels.
pub(in crate::output) const TILE: usize = 256;

/// Noise hardly compresses: higher levels take longer for files of the same size.
const COMPRESSION: u32 = 1;

/// Places of tiles: band by band, from the north-west, row by row.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct TileIndex {
    pub(super) offsets: Vec<u64>,
    /// Sizes, bytes.
    pub(super) lengths: Vec<u64>,
}

impl TileIndex {
    /// Index of tiles before they are written.
    pub(super) fn unknown(level: &Level, bands: usize) -> Self {
        let [across, down] = level.tiles();
        let none = vec![0; across * down * bands];
        Self { offsets: none.clone(), lengths: none }
    }
}

/// Writes all tiles of a level from `place` on, where the file is written next, and moves `place` behind them.
pub(super) fn write_tiles(
    level: &Level,
    bands: usize,
    place: &mut u64,
    file: &mut impl Write,
) -> io::Result<TileIndex> {
    let mut index = TileIndex::default();
    let [across, down] = level.tiles();
    for band in 0..bands {
        for row in 0..down {
            let rows = row * TILE..((row + 1) * TILE).min(level.height);
            let values = level.rows(band, rows)?;
            let columns = (0..across).into_par_iter();
            let tiles = columns.map(|column| compressed(level, &values, column));
            for tile in tiles.collect::<io::Result<Vec<_>>>()? {
                file.write_all(&tile)?;
                index.offsets.push(*place);
                index.lengths.push(tile.len() as u64);
                *place += tile.len() as u64;
            }
        }
    }
    Ok(index)
}

/// A tile of a row of tiles.
fn compressed(level: &Level, rows: &[f32], column: usize) -> io::Result<Vec<u8>> {
    let columns = column * TILE..((column + 1) * TILE).min(level.width);
    let mut bytes = Vec::with_capacity(TILE * TILE * level.bytes_of_value());
    let mut row = [f32::NAN; TILE];
    for values in rows.chunks(level.width) {
        row[..columns.len()].copy_from_slice(&values[columns.clone()]);
        push_row(&row, level.is_of_classes, &mut bytes);
    }
    // Tiles at the edges are filled up.
    let rest = TILE - rows.len() / level.width;
    for _ in 0..rest {
        push_row(&[f32::NAN; TILE], level.is_of_classes, &mut bytes);
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(COMPRESSION));
    encoder.write_all(&bytes)?;
    encoder.finish()
}

/// Appends a row of a tile: of classes as bytes, of other values by the floating-point predictor, which puts the highest
/// bytes of all values before the next ones and stores differences. Source: Adobe Photoshop TIFF Technical Note 3 (2005).
fn push_row(row: &[f32; TILE], is_of_classes: bool, bytes: &mut Vec<u8>) {
    if is_of_classes {
        let number = |value: &f32| if value.is_finite() { *value as u8 } else { 0 };
        return bytes.extend(row.iter().map(number));
    }
    let mut previous = 0_u8;
    for place in 0..size_of::<f32>() {
        bytes.extend(row.iter().map(|value| {
            let byte = value.to_be_bytes()[place];
            let difference = byte.wrapping_sub(previous);
            previous = byte;
            difference
        }));
    }
}
