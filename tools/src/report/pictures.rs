//! Pictures of image sensors, as a part of the page.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use anyhow::{Context as _, bail};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};

use super::context::Context;
use super::quantity::Quantity;
use super::words::{definition, measured, name, short, title};

/// Largest file of a picture that is taken as it is, bytes.
const LARGEST: u64 = 450_000;
/// Bytes of all pictures of a page, after which they are smaller, and none.
const COMFORTABLE: usize = 1_600_000;
const ALL: usize = 3_200_000;
/// Longest side of a picture that is made smaller, pixels: at first, and behind many others.
const SIDES: [u32; 2] = [900, 360];
/// Largest picture that is read, pixels along a side.
const MOST_PIXELS: u32 = 100_000;

/// Pictures of all images; `None` of results without images.
pub(super) fn section(context: &Context<'_>) -> Option<Markup> {
    let quantities: Vec<&Quantity> =
        context.results.quantities.iter().filter(|one| one.picture_file().is_some()).collect();
    if quantities.is_empty() {
        return None;
    }
    let mut budget = Budget::default();
    Some(html! {
        p { "Each picture opens large; its colour bar says what the colours mean. A bar that ends in ≤ or ≥ is stretched between the 1st and the 99th percentile of the pixels: values beyond its ends have the colours of the ends." }
        div.gallery {
            @for (number, quantity) in quantities.iter().enumerate() { (picture(context, quantity, number, &mut budget)) }
        }
    })
}

/// Bytes of the pictures so far.
#[derive(Debug, Default)]
pub(super) struct Budget {
    used: usize,
}

/// Picture as the page holds it.
pub(super) struct Embedded {
    /// Address that holds the picture.
    data: String,
    /// Text about what was done to it; empty if it is the file.
    note: &'static str,
}

impl Budget {
    /// Picture in a file; smaller than there if it is large, `None` if there is no more room.
    pub(super) fn embed(&mut self, file: &Path) -> anyhow::Result<Option<Embedded>> {
        if self.used > ALL {
            return Ok(None);
        }
        let is_crowded = self.used > COMFORTABLE;
        let size =
            fs::metadata(file).with_context(|| format!("cannot read {}", file.display()))?.len();
        let (bytes, note) = if size <= LARGEST && !is_crowded {
            let bytes =
                fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
            if !bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
                bail!("{} is no PNG", file.display());
            }
            (bytes, "")
        } else {
            (smaller(file, SIDES[usize::from(is_crowded)])?, "Smaller than the file.")
        };
        self.used += bytes.len();
        Ok(Some(Embedded {
            data: format!("data:image/png;base64,{}", STANDARD.encode(bytes)),
            note,
        }))
    }
}

fn picture(
    context: &Context<'_>,
    quantity: &Quantity,
    number: usize,
    budget: &mut Budget,
) -> Markup {
    let file = quantity.picture_file().unwrap_or_default();
    let about = format!("{}: {}", short(&quantity.sensor), title(&quantity.name));
    let embedded = if context.has(file) {
        budget.embed(&context.results.folder.join(file))
    } else {
        Err(anyhow::anyhow!("the file {} is missing", short(file)))
    };
    let id = format!("picture-{number}");
    let link = context.link(file);
    html! {
        figure.picture id=(id) {
            @match &embedded {
                Ok(Some(Embedded { data, .. })) => {
                    a.open href={ "#" (id) } { img src=(data) alt={ "Picture of " (about) } decoding="async"; }
                    a.close href="#pictures" { "Close" }
                },
                Ok(None) => p.missing { "Not on this page, which would be too large: see the file." },
                Err(error) => p.missing { "No picture: " (short(&format!("{error:#}"))) "." },
            }
            figcaption {
                strong { (name(&quantity.sensor)) ": " (title(&quantity.name)) "." }
                @if let Some(text) = definition(&quantity.name) { " " (text) }
                @if quantity.band_count() == 1 && quantity.place_count() == 1 && quantity.name != "dominant_component" {
                    @let (value, error) = quantity.at(0, 0);
                    " Mean " (measured(value, error)) "."
                }
                @if let Ok(Some(Embedded { note, .. })) = &embedded { @if !note.is_empty() { " " (note) } }
                @if embedded.is_ok() { " File: " a href=(link.address) { (link.name) } "." }
            }
        }
    }
}

/// A picture with means of squares of its pixels, as a PNG.
fn smaller(file: &Path, longest: u32) -> anyhow::Result<Vec<u8>> {
    let failed = || format!("cannot read {}", file.display());
    let mut decoder = png::Decoder::new(BufReader::new(File::open(file).with_context(failed)?));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().with_context(failed)?;
    let (width, height) = (reader.info().width, reader.info().height);
    if width.max(height) > MOST_PIXELS {
        bail!("{} is {width} × {height} pixels", file.display());
    }
    let (colour, _) = reader.output_color_type();
    let channels = colour.samples();
    let step = width.max(height).div_ceil(longest).max(1);
    let (columns, rows) = (width.div_ceil(step), height.div_ceil(step));
    let mut pixels = Vec::with_capacity(columns as usize * rows as usize * channels);
    let mut sums = vec![0_u32; columns as usize * channels];
    let mut counted = 0;
    for row in 0..height {
        let Some(line) = reader.next_row().with_context(failed)? else { break };
        for (at, value) in line.data().iter().enumerate() {
            let (x, channel) = (at / channels, at % channels);
            sums[x / step as usize * channels + channel] += u32::from(*value);
        }
        counted += 1;
        if counted == step || row + 1 == height {
            for (at, sum) in sums.iter_mut().enumerate() {
                let column = (at / channels) as u32;
                let across = step.min(width - column * step);
                pixels.push((*sum / (across * counted)) as u8);
                *sum = 0;
            }
            counted = 0;
        }
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns, rows);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels));
    written.with_context(failed)?;
    Ok(bytes)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    #[test]
    fn a_large_picture_becomes_the_means_of_its_squares() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 5, 2);
        encoder.set_color(png::ColorType::Rgb);
        let pixels: Vec<u8> = (0..10).flat_map(|at| [at * 10, 7, 255]).collect();
        encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
        let bytes = smaller(&path, 3).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let mut found = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut found).unwrap();
        // Columns 0 and 1 of rows 0 and 1: (0 + 10 + 50 + 60) / 4; the last one is single.
        assert_eq!(found, [30, 7, 255, 50, 7, 255, 65, 7, 255]);
    }

    #[test]
    fn a_damaged_picture_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        fs::write(&path, "no picture").unwrap();
        assert!(Budget::default().embed(&path).is_err());
        assert!(smaller(&path, 3).is_err());
    }
}
