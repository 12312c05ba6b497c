//! Chunks: boxes of values, all of one size; those at the ends are filled up.

use std::io::{self, Write as _};
use std::ops::Range;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::super::dataset::{Dimension, ValueType, Variable};

/// Rows and columns of a chunk of an image.
pub(in crate::output) const TILE: usize = 512;

/// Number of values of a chunk of other variables.
const VALUES: usize = 1 << 17;

/// Noise hardly compresses: higher levels take longer for files of the same size.
pub(super) const LEVEL: u32 = 1;

/// Division of a variable into chunks.
///
/// Chunks hold a single point of each of the slowest dimensions, a range of one, and all of the faster ones; those of
/// images a range of the fastest, too. So the values of one chunk, or of a row of chunks, lie together.
#[derive(Debug)]
pub(super) struct Chunking {
    shape: Vec<usize>,
    chunk: Vec<usize>,
    /// Size of a value, bytes.
    size: usize,
    fill: Fill,
}

/// Bytes that fill up chunks at the ends.
#[derive(Clone, Copy, Debug)]
enum Fill {
    Zero,
    Float,
    Double,
}

/// Values that lie together and belong to one chunk or a row of chunks.
pub(super) struct Slab<'a> {
    chunking: &'a Chunking,
    /// Place of its chunks along each dimension; the last one is 0 for a row of chunks.
    chunk: Vec<usize>,
}

impl Chunking {
    pub(super) fn new(variable: &Variable<'_>, dimensions: &[Dimension]) -> Self {
        let shape = variable.shape(dimensions);
        let mut chunk = vec![1; shape.len()];
        let mut inner = 1;
        for (length, chunk) in shape.iter().zip(&mut chunk).rev() {
            *chunk = (VALUES / inner).clamp(1, *length);
            // Dimensions outside one that is cut have single points.
            inner = if *chunk < *length { VALUES } else { inner * length };
        }
        if variable.is_raster {
            let rows = shape.len().saturating_sub(2);
            chunk[..rows].fill(1);
            chunk[rows..].iter_mut().zip(&shape[rows..]).for_each(|(c, s)| *c = TILE.min(*s));
        }
        let (size, fill) = match variable.values.value_type() {
            ValueType::Float => (4, Fill::Float),
            ValueType::Double => (8, Fill::Double),
            ValueType::Integer => (4, Fill::Zero),
            ValueType::Text { letters, .. } => (4 * letters, Fill::Zero),
        };
        Self { shape, chunk, size, fill }
    }

    pub(super) fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Shape of a chunk.
    pub(super) fn chunk(&self) -> &[usize] {
        &self.chunk
    }

    /// All slabs in order.
    pub(super) fn slabs(&self) -> impl Iterator<Item = Slab<'_>> {
        let counts: Vec<usize> = (0..self.shape.len())
            .map(|place| if place == self.cut_dimension() { 1 } else { self.count(place) })
            .collect();
        (0..counts.iter().product()).map(move |row| Slab {
            chunking: self,
            chunk: super::super::rows::indices(&counts, row),
        })
    }

    /// Number of chunks along a dimension.
    fn count(&self, place: usize) -> usize {
        self.shape[place].div_ceil(self.chunk[place])
    }

    /// The last dimension, if it is cut and another one, too; else behind all.
    fn cut_dimension(&self) -> usize {
        let last = self.shape.len().saturating_sub(1);
        let outer = self.chunk.iter().take(last).any(|chunk| *chunk > 1);
        if outer && self.chunk[last] < self.shape[last] { last } else { self.shape.len() }
    }
}

impl Slab<'_> {
    /// Places of its values among all.
    pub(super) fn places(&self) -> Range<usize> {
        let Chunking { shape, chunk, .. } = self.chunking;
        let (mut start, mut end, mut inner) = (0, 1, 1);
        for (place, length) in shape.iter().enumerate().rev() {
            let range = if place == self.chunking.cut_dimension() {
                0..*length
            } else {
                self.along(place, chunk[place])
            };
            start += range.start * inner;
            // Only the outermost dimension of more than one point is not full.
            end = if range.len() > 1 || inner == 1 { range.len() * inner } else { end };
            inner *= length;
        }
        start..start + end
    }

    fn along(&self, place: usize, chunk: usize) -> Range<usize> {
        let start = self.chunk[place] * chunk;
        start..(start + chunk).min(self.chunking.shape[place])
    }

    /// Places of its chunks along the last dimension.
    pub(super) fn columns(&self) -> Range<usize> {
        let cut = self.chunking.cut_dimension();
        if cut < self.chunking.shape.len() { 0..self.chunking.count(cut) } else { 0..1 }
    }

    /// Name of the file of a chunk.
    pub(super) fn key(&self, column: usize) -> String {
        let mut chunk = self.chunk.clone();
        if self.chunking.cut_dimension() < chunk.len() {
            *chunk.last_mut().expect("a dimension is cut") = column;
        }
        if chunk.is_empty() {
            return "0".to_owned();
        }
        chunk.iter().map(usize::to_string).collect::<Vec<_>>().join(".")
    }

    /// Bytes of a chunk, cut from those of the slab.
    pub(super) fn cut(&self, bytes: &[u8], column: usize) -> Vec<u8> {
        let Chunking { shape, chunk, size, .. } = self.chunking;
        let whole: usize = chunk.iter().product::<usize>() * size;
        let cut = self.chunking.cut_dimension();
        let mut cut_out = Vec::with_capacity(whole);
        let (Some(length), Some(width)) = (shape.last(), chunk.last()) else {
            return bytes.to_vec();
        };
        if cut < shape.len() {
            let start = column * width;
            let end = (start + width).min(*length);
            for row in bytes.chunks_exact(length * size) {
                cut_out.extend_from_slice(&row[start * size..end * size]);
                self.fill(&mut cut_out, (width - (end - start)) * size);
            }
        } else {
            cut_out.extend_from_slice(bytes);
        }
        let rest = whole - cut_out.len();
        self.fill(&mut cut_out, rest);
        cut_out
    }

    fn fill(&self, bytes: &mut Vec<u8>, count: usize) {
        match self.chunking.fill {
            Fill::Zero => bytes.resize(bytes.len() + count, 0),
            Fill::Float => bytes.extend(f32::NAN.to_le_bytes().iter().cycle().take(count)),
            Fill::Double => bytes.extend(f64::NAN.to_le_bytes().iter().cycle().take(count)),
        }
    }
}

/// Bytes of a chunk as its file holds them.
pub(super) fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
    encoder.write_all(bytes)?;
    encoder.finish()
}
