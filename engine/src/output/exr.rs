//! EXR: one f32 channel a band, its standard error, and the coverage.

use std::io::{self, Seek, Write};

use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image as ExrImage, Layer,
    LayerAttributes, LineOrder, Text, WritableImage as _,
};

use super::Source;
use super::names::Distinct;
use crate::products::Image;

/// Monte Carlo noise hardly compresses: ZIP takes 17 times as long as run lengths for a file 9 %
/// smaller. Rows in order keep the pixels' bytes the same from run to run.
const ENCODING: Encoding = Encoding {
    compression: Compression::RLE,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Writes channels `<band>`, `<band>.se` and `coverage`; the attribute `comments` holds the provenance as
/// JSON.
pub(super) fn write(
    source: &Source<'_>,
    image: &Image,
    file: &mut (impl Write + Seek),
) -> io::Result<()> {
    let bands = image.bands.len();
    let mut names = Distinct::default();
    // Taken first, so that no band of that name can take it.
    let coverage = names.take("coverage");
    let mut channels = Vec::with_capacity(2 * bands + 1);
    for (index, band) in image.bands.iter().enumerate() {
        // A full stop in a channel's name parts layers: only `.se` shall.
        let name = names.take(&channel_name(band));
        let of = |values: &[f32]| values.iter().skip(index).step_by(bands).copied().collect();
        let errors = format!("{name}.se");
        channels.push(channel(&name, of(&image.values)));
        channels.push(channel(&errors, of(&image.standard_error)));
    }
    channels.push(channel(&coverage, image.coverage.clone()));

    // One text: the crate writes several attributes of its user in an order that differs from run to run.
    let provenance: serde_json::Map<_, _> = source
        .provenance()
        .into_iter()
        .map(|(key, value)| (key.to_owned(), value.into()))
        .collect();
    let attributes = LayerAttributes {
        comments: Some(text(&serde_json::Value::Object(provenance).to_string())),
        software_name: Some(text(&format!("sunfleck {}", source.report.version))),
        ..LayerAttributes::default()
    };
    let layer = Layer::new(
        (image.width, image.height),
        attributes,
        ENCODING,
        AnyChannels::sort(channels.into()),
    );
    ExrImage::from_layer(layer).write().to_buffered(file).map_err(|error| match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// `band` as a channel's name: a full stop parts layers there, and only `.se` shall.
fn channel_name(band: &str) -> String {
    // EXR allows 255 bytes for the name and what is appended to it.
    const LONGEST: usize = 200;
    let mut name = band.replace(['.', '\0'], "_");
    name.truncate(name.floor_char_boundary(LONGEST));
    if name.is_empty() { "_".to_owned() } else { name }
}

fn channel(name: &str, values: Vec<f32>) -> AnyChannel<FlatSamples> {
    AnyChannel::new(text(name), FlatSamples::F32(values))
}

/// UTF-8, as EXR has it; the crate's own constructors take Latin-1 alone and panic otherwise.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
