//! Denoised images, with errors that include the bias of the filter.
//!
//! A pixel `y` has independent noise of the known variance `V` (from the two randomisations of each pixel,
//! `transport/films/tile.rs`). Gaussian filters `G_k` of four widths are combined to
//!
//! `D = y + Σ a_k (G_k y - y)`.
//!
//! The weights `a_k` minimise Stein's unbiased estimate of the risk, `(D - y)² + V (2 w - 1)` with the own weight `w` of the
//! pixel in `D`, summed over cells of 8 × 8 pixels around each place: a Wiener filter whose response follows what the
//! image holds there. Weights that are not worth their noise come out as 0, so that the result is the plain image.
//!
//! The squared error of `D` is its variance, that of the fitted weights, and the squared bias: what the risk, summed over a
//! wider window, has beyond them. It is a mean over the surroundings of a pixel.
//!
//! Sources: Stein (1981), "Estimation of the mean of a multivariate normal distribution", Ann. Stat. 9, 1135-1151;
//! Wiener (1949), "Extrapolation, interpolation, and smoothing of stationary time series"; for images of paths Li, Wu &
//! Chuang (2012), "SURE-based optimization for adaptive sampling and reconstruction", ACM Trans. Graph. 31 (6), and
//! Rousselle, Knaus & Zwicker (2012), "Adaptive rendering with non-local means filtering", ibid.

mod block;
mod plane;
mod solve;
#[cfg(test)]
mod tests;

use std::io;
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use self::block::{FilterBlock, denoise};
use self::plane::Size;
use super::image::block_rows;
use super::{Image, PixelRows, Pixels, Product};

/// Pixels around a block that its filter sees: a multiple of the side of a cell.
const HALO: usize = 64;

/// Columns of a block.
const BLOCK_COLUMNS: usize = 256;

/// Maximum and minimum number of rows of a strip.
const STRIP_ROWS: usize = 128;
const LEAST_ROWS: usize = 16;

/// Memory that the bands of a strip may take, filtered and unfiltered each, bytes; one band of the minimum of rows may
/// take more.
const MEMORY: usize = 64 << 20;

/// End of the names of denoised products.
const SUFFIX: &str = "_denoised";

/// Product of an image with denoised pixels. Its mean over the image stays that of the plain pixels, which has no bias.
/// `None` for a product that is no image.
#[must_use]
pub(super) fn denoised(product: &Product) -> Option<Product> {
    let image = product.image.as_ref()?;
    let layout = Layout::new(image.width, image.height, image.bands.len());
    let source = Strips { layout, plain: image.pixels.clone(), last: Mutex::new(None) };
    let source = Arc::new(source);
    let pixels = Pixels::new(move |rows| source.rows(rows));
    let image = Image { pixels, ..image.clone() };
    let name = format!("{}{SUFFIX}", product.name);
    Some(Product { name, image: Some(image), ..product.clone() })
}

/// Memory for filtering an image of this size, bytes.
pub(super) fn bytes(width: u64, height: u64, bands: u64) -> u64 {
    let [width, height, bands] =
        [width, height, bands].map(|count| usize::try_from(count).unwrap_or(usize::MAX).max(1));
    let layout = Layout::new(width, height, bands);
    let rows = layout.rows + 2 * HALO;
    let block = (BLOCK_COLUMNS + 2 * HALO).min(width) * rows.min(height);
    // The last strip and the next one, the bands that it is made of, and what each thread holds of a block.
    let strips = 2 * layout.rows.min(height).saturating_mul(width).saturating_mul(8 * bands + 4);
    let chunk = layout.chunk.min(bands).saturating_mul(8) + 4;
    let plain = rows.min(height).saturating_mul(width).saturating_mul(chunk);
    let threads = rayon::current_num_threads() * block * BYTES_OF_PIXEL;
    [plain, threads].into_iter().fold(strips, usize::saturating_add) as u64
}

/// Memory of a pixel while its block is filtered, and of results of blocks that wait to be sorted in, bytes.
const BYTES_OF_PIXEL: usize = 136;

/// How an image is cut into parts that are filtered one after the other.
#[derive(Clone, Copy, Debug)]
struct Layout {
    size: Size,
    bands: usize,
    /// Rows of a strip.
    rows: usize,
    /// Bands that are filtered together.
    chunk: usize,
}

impl Layout {
    fn new(width: usize, height: usize, bands: usize) -> Self {
        let size = Size { width, height };
        let row = width.saturating_mul(8).max(1);
        let mut rows = STRIP_ROWS;
        while rows > LEAST_ROWS && rows.saturating_mul(row).saturating_mul(bands) > MEMORY {
            rows /= 2;
        }
        let chunk = (MEMORY / (rows + 2 * HALO).saturating_mul(row)).max(1);
        Self { size, bands, rows, chunk }
    }

    /// Rows of a strip, and these with those around that its filter sees.
    fn strip(&self, strip: usize) -> (Range<usize>, Range<usize>) {
        let rows = strip * self.rows..((strip + 1) * self.rows).min(self.size.height);
        let seen = with_halo(&rows, self.size.height);
        (rows, seen)
    }
}

/// Rows or columns with those around them, of a number.
fn with_halo(range: &Range<usize>, end: usize) -> Range<usize> {
    range.start.saturating_sub(HALO)..(range.end + HALO).min(end)
}

/// Denoised pixels, which are computed in strips of rows when they are asked for.
struct Strips {
    layout: Layout,
    plain: Pixels,
    /// The last strip: rows are asked for in order. No thread computes while it holds the lock.
    last: Mutex<Option<(usize, Arc<PixelRows>)>>,
}

impl Strips {
    fn rows(&self, rows: Range<usize>) -> io::Result<PixelRows> {
        let Layout { size, bands, rows: height, .. } = self.layout;
        let mut all = empty(size.width, rows.len(), bands);
        if rows.is_empty() {
            return Ok(all);
        }
        for strip in rows.start / height..=(rows.end - 1) / height {
            let first = strip * height;
            let pixels = self.strip(strip)?;
            let end = rows.end.min(first + height) - first;
            let part = pixels.select(rows.start.max(first) - first..end, 0..bands);
            append(&mut all, part);
        }
        Ok(all)
    }

    fn strip(&self, strip: usize) -> io::Result<Arc<PixelRows>> {
        let held = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some((_, pixels)) = held.filter(|(of, _)| *of == strip) {
            return Ok(pixels);
        }
        let pixels = Arc::new(self.denoise_strip(strip)?);
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) =
            Some((strip, Arc::clone(&pixels)));
        Ok(pixels)
    }

    fn denoise_strip(&self, strip: usize) -> io::Result<PixelRows> {
        let Layout { size: Size { width, .. }, bands, chunk, .. } = self.layout;
        let (rows, seen) = self.layout.strip(strip);
        let count = rows.len() * width;
        let mut pixels = PixelRows {
            width,
            values: vec![f32::NAN; count * bands],
            standard_error: vec![f32::NAN; count * bands],
            coverage: vec![0.0; count],
        };
        for first in (0..bands).step_by(chunk) {
            let columns = first..(first + chunk).min(bands);
            let plain = self.read(seen.clone(), columns.clone())?;
            let own = (rows.start - seen.start) * width..(rows.end - seen.start) * width;
            pixels.coverage.copy_from_slice(&plain.coverage[own]);
            let columns_of_blocks = (0..width).step_by(BLOCK_COLUMNS);
            let jobs: Vec<(usize, usize)> = columns_of_blocks
                .flat_map(|left| columns.clone().map(move |band| (left, band)))
                .collect();
            let place = |left: usize| left..(left + BLOCK_COLUMNS).min(width);
            // Memory holds the blocks of these jobs alone.
            for jobs in jobs.chunks(4 * rayon::current_num_threads()) {
                let blocks = jobs.par_iter().map(|&(left, band)| {
                    denoise_block(&plain, band - first, (&rows, seen.start), &place(left))
                });
                let blocks: Vec<(Vec<f32>, Vec<f32>)> = blocks.collect();
                for (&(left, band), (values, errors)) in jobs.iter().zip(blocks) {
                    let columns = place(left);
                    for (at, (value, error)) in values.into_iter().zip(errors).enumerate() {
                        let (row, column) = (at / columns.len(), at % columns.len());
                        let at = (row * width + left + column) * bands + band;
                        pixels.values[at] = value;
                        pixels.standard_error[at] = error;
                    }
                }
            }
        }
        Ok(pixels)
    }

    /// Some columns of plain pixels, which are computed a few rows at a time.
    fn read(&self, rows: Range<usize>, columns: Range<usize>) -> io::Result<PixelRows> {
        let Layout { size, bands, .. } = self.layout;
        let step = block_rows(size.width, bands);
        let mut all = empty(size.width, rows.len(), columns.len());
        for first in rows.clone().step_by(step) {
            let part = self.plain.rows(first..(first + step).min(rows.end))?;
            let part = part.select_columns(columns.clone());
            append(&mut all, part);
        }
        Ok(all)
    }
}

/// No pixels, with memory for a number of rows.
fn empty(width: usize, rows: usize, columns: usize) -> PixelRows {
    let values = || Vec::with_capacity(rows * width * columns);
    let coverage = Vec::with_capacity(rows * width);
    PixelRows { width, values: values(), standard_error: values(), coverage }
}

/// Adds rows below others.
fn append(all: &mut PixelRows, part: PixelRows) {
    all.values.extend(part.values);
    all.standard_error.extend(part.standard_error);
    all.coverage.extend(part.coverage);
}

/// Values and errors of a band of a block of a strip, shape `[rows, columns]`. `plain` starts at a row above it.
fn denoise_block(
    plain: &PixelRows,
    band: usize,
    (rows, top): (&Range<usize>, usize),
    columns: &Range<usize>,
) -> (Vec<f32>, Vec<f32>) {
    let bands = plain.columns();
    let seen = with_halo(columns, plain.width);
    let height = plain.coverage.len() / plain.width;
    let size = Size { width: seen.len(), height };
    let pixels: Vec<usize> =
        (0..height).flat_map(|row| seen.clone().map(move |at| row * plain.width + at)).collect();
    let of_band = |values: &[f32]| pixels.iter().map(|at| values[at * bands + band]).collect();
    let (filtered, errors) = denoise(&FilterBlock {
        size,
        values: of_band(&plain.values),
        errors: of_band(&plain.standard_error),
        coverage: pixels.iter().map(|&at| plain.coverage[at]).collect(),
    });
    let own = |values: Vec<f32>| -> Vec<f32> {
        let rows = values.chunks_exact(size.width).skip(rows.start - top).take(rows.len());
        let first = columns.start - seen.start;
        rows.flat_map(|row| &row[first..first + columns.len()]).copied().collect()
    };
    (own(filtered), own(errors))
}
