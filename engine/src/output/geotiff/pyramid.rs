//! Overviews of a raster: each has half the width and height of the one below.

use std::fs::File;
use std::io::{self, Write as _};
use std::ops::Range;

use rayon::prelude::*;

use super::super::classification;
use super::super::envi::{self, RasterSize};
use super::tiles::TILE;

/// Rows of an overview that are made at a time.
const ROWS: usize = 64;

/// Pixels of a raster or of one of its overviews in a file, band after band.
#[derive(Debug)]
pub(super) struct Level {
    pub(super) file: File,
    pub(super) width: usize,
    pub(super) height: usize,
    /// True if values are numbers of classes.
    pub(super) is_of_classes: bool,
    /// True if the file holds bytes, which are 0 where there are no data.
    pub(super) is_of_bytes: bool,
}

impl Level {
    /// Values of rows of a band; NaN where there are no data.
    pub(super) fn rows(&self, band: usize, rows: Range<usize>) -> io::Result<Vec<f32>> {
        let size = RasterSize { width: self.width, height: self.height };
        if !self.is_of_bytes {
            return envi::read_rows(size, band, rows, &self.file);
        }
        classification::read_rows(size, rows, &self.file)
    }

    /// Size of a value in tiles, bytes.
    pub(super) const fn bytes_of_value(&self) -> usize {
        if self.is_of_classes { 1 } else { 4 }
    }

    /// Tiles side by side, and one below the other.
    pub(super) const fn tiles(&self) -> [usize; 2] {
        [self.width.div_ceil(TILE), self.height.div_ceil(TILE)]
    }

    /// Size of all tiles without compression, bytes.
    pub(super) fn bytes_of_tiles(&self, bands: usize) -> u64 {
        let [across, down] = self.tiles();
        (across * down * bands * TILE * TILE * self.bytes_of_value()) as u64
    }

    /// Returns an overview of half the width and height.
    fn halved(&self, bands: usize, mut file: File) -> io::Result<Self> {
        let [width, height] = [self.width, self.height].map(|length| length.div_ceil(2));
        for band in 0..bands {
            for start in (0..height).step_by(ROWS) {
                let rows = 2 * start..(2 * (start + ROWS)).min(self.height);
                let values = self.rows(band, rows)?;
                let rows: Vec<&[f32]> = values.chunks(2 * self.width).collect();
                let halve = |rows: &&[f32]| halve(rows, self.width, self.is_of_classes);
                for row in rows.par_iter().map(halve).collect::<Vec<_>>() {
                    let bytes: Vec<u8> = row.into_iter().flat_map(f32::to_le_bytes).collect();
                    file.write_all(&bytes)?;
                }
            }
        }
        Ok(Self { file, width, height, is_of_classes: self.is_of_classes, is_of_bytes: false })
    }
}

/// A row of an overview from two rows, or from the last one alone.
fn halve(rows: &[f32], width: usize, is_of_classes: bool) -> Vec<f32> {
    let pixel = |column: usize| {
        let columns = 2 * column..(2 * column + 2).min(width);
        let values = rows.chunks(width).flat_map(|row| &row[columns.clone()]);
        let known = values.copied().filter(|value| value.is_finite());
        if is_of_classes { most_frequent(known) } else { mean(known) }
    };
    (0..width.div_ceil(2)).map(pixel).collect()
}

/// Mean of at most four values; NaN if there is none.
fn mean(values: impl Iterator<Item = f32>) -> f32 {
    let (sum, count) =
        values.fold((0.0, 0_u8), |(sum, count), value| (sum + f64::from(value), count + 1));
    (sum / f64::from(count)) as f32
}

/// The value that most of at most four are equal to, the first of several; NaN if there is none.
fn most_frequent(values: impl Iterator<Item = f32>) -> f32 {
    let values: Vec<f32> = values.collect();
    let count = |value: &f32| values.iter().filter(|one| one.to_bits() == value.to_bits()).count();
    values.iter().rev().max_by_key(|value| count(value)).copied().unwrap_or(f32::NAN)
}

/// A raster and its overviews, from large to small.
#[derive(Debug)]
pub(super) struct Pyramid {
    pub(super) levels: Vec<Level>,
}

impl Pyramid {
    /// Makes overviews until one fits into a tile; each is in a file of its own.
    pub(super) fn new(
        base: Level,
        bands: usize,
        new_scratch: &dyn Fn() -> io::Result<File>,
    ) -> io::Result<Self> {
        let mut levels = vec![base];
        while let Some(below) = levels.last()
            && below.tiles() != [1, 1]
        {
            let level = below.halved(bands, new_scratch()?)?;
            levels.push(level);
        }
        Ok(Self { levels })
    }
}
