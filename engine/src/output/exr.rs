//! EXR: one f32 channel a band, its standard error, and the coverage.

use std::io::{self, Seek, Write};

use ::exr::block::writer::{ChunksWriter as _, write_chunks_with};
use ::exr::block::{BlockIndex, UncompressedBlock, chunk::Chunk};
use ::exr::error::Error;
use ::exr::meta::header::{Header, LayerAttributes};
use ::exr::meta::{BlockDescription, Headers};
use ::exr::prelude::{ChannelDescription, Compression, LineOrder, SampleType, Text, Vec2};
use rayon::prelude::*;

use super::Source;
use super::band_rows::BandRows;
use super::names::Distinct;
use crate::products::Image;

/// Monte Carlo noise hardly compresses: ZIP takes 17 times as long as run lengths for a file 9 %
/// smaller.
const COMPRESSION: Compression = Compression::RLE;

/// Values of a channel.
#[derive(Clone, Copy, Debug)]
enum Content {
    Values(usize),
    Errors(usize),
    Coverage,
}

impl Content {
    /// Values of a row of a block.
    fn row(self, block: &BandRows, row: usize) -> &[f32] {
        let all = match self {
            Self::Values(band) => block.values(band),
            Self::Errors(band) => block.standard_error(band),
            Self::Coverage => &block.coverage,
        };
        &all[row * block.width..(row + 1) * block.width]
    }
}

/// Writes channels `<band>`, `<band>.se` unless values are exact, and `coverage`, block by block; the attribute `comments` holds the provenance
/// as JSON. Rows in order keep the pixels' bytes the same from run to run.
///
/// - `blocks`: all rows of the image, from top to bottom
pub(super) fn write(
    source: &Source<'_>,
    image: &Image,
    blocks: impl Iterator<Item = io::Result<BandRows>>,
    file: &mut (impl Write + Seek),
) -> io::Result<()> {
    let channels = channels(image);
    let headers: Headers = std::iter::once(header(source, image, &channels)).collect();
    let written = write_chunks_with(file, headers, true, |meta, writer| {
        for block in blocks {
            let block = block?;
            let rows: Vec<usize> = (0..block.rows.len()).collect();
            let chunks =
                rows.into_par_iter().map(|row| chunk(&block, row, &channels, &meta.headers));
            for (row, chunk) in block.rows.clone().zip(chunks.collect::<Vec<_>>()) {
                writer.write_chunk(row, chunk?)?;
            }
        }
        Ok(())
    });
    written.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// Names and contents of the channels, in the order of their names.
fn channels(image: &Image) -> Vec<(Text, Content)> {
    let mut names = Distinct::default();
    // Taken first, so that no band of that name can take it.
    let coverage = names.take("coverage");
    let mut channels = vec![(text(&coverage), Content::Coverage)];
    for (index, band) in image.bands.iter().enumerate() {
        // A full stop in a channel's name parts layers: only `.se` shall.
        let name = names.take(&channel_name(band));
        channels.push((text(&name), Content::Values(index)));
        if image.has_errors {
            channels.push((text(&format!("{name}.se")), Content::Errors(index)));
        }
    }
    channels.sort_by(|(one, _), (other, _)| one.cmp(other));
    channels
}

fn header(source: &Source<'_>, image: &Image, channels: &[(Text, Content)]) -> Header {
    // One text: the crate writes several attributes of its user in an order that differs from run to run.
    let attributes = LayerAttributes {
        comments: Some(text(&source.provenance_json())),
        software_name: Some(text(&format!("sunfleck {}", source.report.version))),
        ..LayerAttributes::default()
    };
    let described =
        |(name, _): &(Text, Content)| ChannelDescription::named(name.clone(), SampleType::F32);
    let list = channels.iter().map(described).collect();
    let header = Header::new(Text::from(""), (image.width, image.height), list);
    let header =
        header.with_encoding(COMPRESSION, BlockDescription::ScanLines, LineOrder::Increasing);
    header.with_attributes(attributes)
}

/// A row of a block, compressed.
fn chunk(
    block: &BandRows,
    row: usize,
    channels: &[(Text, Content)],
    headers: &[Header],
) -> Result<Chunk, Error> {
    const BYTES: usize = size_of::<f32>();
    let mut data = vec![0; channels.len() * block.width * BYTES];
    for (bytes, (_, content)) in data.chunks_exact_mut(block.width * BYTES).zip(channels) {
        for (bytes, value) in bytes.chunks_exact_mut(BYTES).zip(content.row(block, row)) {
            bytes.copy_from_slice(&value.to_ne_bytes());
        }
    }
    let index = BlockIndex {
        layer: 0,
        pixel_position: Vec2(0, block.rows.start + row),
        pixel_size: Vec2(block.width, 1),
        level: Vec2(0, 0),
    };
    UncompressedBlock { index, data }.compress_to_chunk(headers)
}

/// `band` as a channel's name: a full stop parts layers there, and only `.se` shall.
fn channel_name(band: &str) -> String {
    // EXR allows 255 bytes for the name and what is appended to it.
    const LONGEST: usize = 200;
    let mut name = band.replace(['.', '\0'], "_");
    name.truncate(name.floor_char_boundary(LONGEST));
    if name.is_empty() { "_".to_owned() } else { name }
}

/// UTF-8, as EXR has it; the crate's own constructors take Latin-1 alone and panic otherwise.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
