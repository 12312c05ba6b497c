//! Pictures: eight bits per channel, stretched, transparent where there are no data.

use std::io::{self, Write};
use std::ops::Range;

use rayon::prelude::*;

use super::colour::Mixture;
use super::composite::{Composite, Stretch};
use super::legend::{Entries, PictureLegend};
use super::picture_input::PictureInput;
use crate::products::{Channels, Class, Rendering};

/// Colour of a value of 0 on a map on which it has one of its own: no grey.
const ZERO: [u8; 3] = [222, 196, 150];

/// Exponent of the display.
pub(super) const GAMMA: f32 = 2.2;

/// An sRGB picture with opacity, painted some rows at a time.
#[derive(Debug)]
pub(super) struct PicturePainter<'a> {
    input: &'a PictureInput<'a>,
    colours: Colours<'a>,
    /// Bands that are read.
    bands: Vec<usize>,
    pub(super) legend: PictureLegend,
}

/// Rule by which pixels are coloured.
#[derive(Debug)]
enum Colours<'a> {
    /// A place among the bands that are read and a stretch for red, green and blue; no place without data.
    Composite([Option<usize>; 3], [Stretch; 3]),
    /// A stretch for greys, and whether 0 has a colour of its own.
    Map(Stretch, bool),
    Classes(&'a [Class]),
    Shares(&'a [Class]),
    Mixture(Mixture, f64),
}

impl<'a> PicturePainter<'a> {
    /// Picture as the rendering of an image says, with its legend.
    ///
    /// # Errors
    /// If the pixels cannot be read.
    pub(super) fn new(input: &'a PictureInput<'a>) -> io::Result<Self> {
        let PictureInput { image, wavelengths, lit, .. } = input;
        let has_data = lit.with_data();
        match &image.rendering {
            Rendering::Quicklook => Self::composite(input, &Composite::new(wavelengths, &has_data)),
            Rendering::Map { zero } => Self::map(input, zero.as_deref()),
            Rendering::Classes(classes) => {
                let legend = PictureLegend::classes(classes, "largest share of a pixel");
                Ok(Self { input, colours: Colours::Classes(classes), bands: vec![0], legend })
            }
            Rendering::Shares(classes) => {
                let (colours, bands) = (Colours::Shares(classes), (0..image.bands.len()).collect());
                let legend = PictureLegend::classes(classes, "mixed by their shares");
                Ok(Self { input, colours, bands, legend })
            }
            Rendering::Colours { channels: Channels::Bands(bands), exposure: None, .. } => {
                let bands = bands.map(|band| band.min(image.bands.len().saturating_sub(1)));
                let bands = bands.map(|band| Some(band).filter(|band| has_data[*band]));
                Self::composite(input, &Composite { bands, is_natural: true })
            }
            Rendering::Colours { channels, exposure, white } => {
                let mut white = white.clone();
                for (white, _) in
                    white.iter_mut().zip(&has_data).filter(|(_, has_data)| !**has_data)
                {
                    *white = 0.0;
                }
                let mixture = Mixture::new(*channels, wavelengths, &white);
                let gain = match exposure {
                    Some(stops) => stops.exp2(),
                    None => mixture.automatic(input)?,
                };
                let (bands, legend) =
                    (mixture.bands(), PictureLegend::exposed(image, *channels, gain));
                Ok(Self { input, colours: Colours::Mixture(mixture, gain), bands, legend })
            }
        }
    }

    /// Picture of the first band, stretched over the whole range of its values.
    ///
    /// - `zero`: meaning of 0, if it has a colour of its own
    fn map(input: &'a PictureInput<'a>, zero: Option<&str>) -> io::Result<Self> {
        let stretch = Stretch::over_all(input, 0, zero.is_some())?;
        let legend = PictureLegend {
            entries: Entries::Bars(vec![stretch.bar(input.image.bands[0].clone())]),
            dark: Vec::new(),
            zero: zero.map(|name| Class { name: format!("0: {name}"), colour: ZERO }),
        };
        let colours = Colours::Map(stretch, zero.is_some());
        Ok(Self { input, colours, bands: vec![0], legend })
    }

    /// Picture of one to three bands, stretched between the 1st and 99th percentiles. Opacity is the coverage.
    fn composite(input: &'a PictureInput<'a>, composite: &Composite) -> io::Result<Self> {
        let stretches = composite.stretches(input)?;
        let legend = composite.legend(input, &stretches);
        let mut bands: Vec<usize> = composite.bands.into_iter().flatten().collect();
        bands.sort_unstable();
        bands.dedup();
        let place = |band: usize| bands.iter().position(|&other| other == band);
        let places = composite.bands.map(|band| band.and_then(place));
        Ok(Self { input, colours: Colours::Composite(places, stretches), bands, legend })
    }

    /// Columns and rows.
    pub(super) const fn size(&self) -> (usize, usize) {
        (self.input.image.width, self.input.image.height)
    }

    /// Blocks of rows that it is painted in.
    pub(super) fn blocks(&self) -> impl ExactSizeIterator<Item = Range<usize>> {
        self.input.image.blocks()
    }

    /// Red, green, blue and opacity of some rows, shape `[rows, columns, 4]`.
    ///
    /// # Errors
    /// If the pixels cannot be read.
    pub(super) fn paint(&self, rows: Range<usize>) -> io::Result<Vec<u8>> {
        let coverage = self.input.coverage(rows.clone())?;
        let read = self.bands.iter().map(|&band| self.input.band(band, rows.clone()));
        let values: Vec<Vec<f32>> = read.collect::<io::Result<_>>()?;
        let mut rgba = vec![0; 4 * coverage.len()];
        rgba.par_chunks_exact_mut(4).zip(&coverage).enumerate().with_min_len(256).for_each(
            |(pixel, (rgba, &coverage))| {
                if let Some([r, g, b]) = self.colour(pixel, &values) {
                    rgba.copy_from_slice(&[r, g, b, self.opacity(coverage)]);
                }
            },
        );
        Ok(rgba)
    }

    /// Colour of a pixel of some rows; `None` if it has none and is transparent.
    fn colour(&self, pixel: usize, values: &[Vec<f32>]) -> Option<[u8; 3]> {
        let mut all = values.iter().map(|values| values[pixel]);
        match &self.colours {
            Colours::Composite(places, stretches) => {
                let chosen = places.map(|place| place.map_or(0.0, |at| values[at][pixel]));
                if places.iter().all(Option::is_none) || !chosen.iter().all(|v| v.is_finite()) {
                    return None;
                }
                let channel = |at: usize| byte(stretches[at].apply(chosen[at]).powf(GAMMA.recip()));
                Some([0, 1, 2].map(channel))
            }
            Colours::Map(stretch, has_zero) => match all.next() {
                Some(value) if *has_zero && value == 0.0 => Some(ZERO),
                Some(value) if value.is_finite() => {
                    Some([byte(stretch.apply(value).powf(GAMMA.recip())); 3])
                }
                _ => None,
            },
            Colours::Classes(classes) => class_of(all.next(), classes).map(|class| class.colour),
            Colours::Shares(classes) => mixed(&all.collect::<Vec<f32>>(), classes),
            Colours::Mixture(mixture, gain) => {
                mixture.rgb(self.bands.iter().copied().zip(all), *gain)
            }
        }
    }

    fn opacity(&self, coverage: f32) -> u8 {
        match self.colours {
            Colours::Mixture(..) => (255.0 * f64::from(coverage).clamp(0.0, 1.0)).round() as u8,
            _ => byte(coverage),
        }
    }

    /// Writes a PNG with `texts` (keyword, text) as its metadata; returns which of its pixels show something.
    ///
    /// # Errors
    /// If `file` cannot be written, or the pixels cannot be read.
    pub(super) fn encode(
        &self,
        texts: &[(&str, String)],
        file: &mut impl Write,
    ) -> io::Result<ShownPixels> {
        let mut shown = ShownPixels { has_holes: false, is_blank: true };
        let compression = png::Compression::Balanced;
        encode_png(self.size(), png::ColorType::Rgba, texts, compression, file, |out| {
            for rows in self.blocks() {
                let rgba = self.paint(rows)?;
                let mut opacity = rgba.iter().skip(3).step_by(4);
                shown.has_holes |= opacity.clone().any(|&opacity| opacity == 0);
                shown.is_blank = shown.is_blank && opacity.all(|&opacity| opacity == 0);
                out.write_all(&rgba)?;
            }
            Ok(())
        })?;
        Ok(shown)
    }
}

/// Pixels of a picture that show something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ShownPixels {
    /// True if a pixel shows nothing.
    pub(super) has_holes: bool,
    /// True if no pixel shows anything.
    pub(super) is_blank: bool,
}

/// The class whose number a pixel holds, from 1.
fn class_of(number: Option<f32>, classes: &[Class]) -> Option<&Class> {
    classes.get(number.filter(|number| *number >= 1.0)? as usize - 1)
}

/// Colours of classes mixed by the shares that a pixel holds; none if it holds no share.
fn mixed(pixel: &[f32], classes: &[Class]) -> Option<[u8; 3]> {
    let all: f32 = pixel.iter().sum();
    if !(all.is_finite() && all > 0.0) {
        return None;
    }
    let channel = |channel: usize| {
        let parts = pixel.iter().zip(classes);
        let light = |class: &Class| (f32::from(class.colour[channel]) / 255.0).powf(GAMMA);
        let mean = parts.map(|(share, class)| share / all * light(class)).sum::<f32>();
        byte(mean.powf(GAMMA.recip()))
    };
    Some([0, 1, 2].map(channel))
}

pub(super) fn byte(fraction: f32) -> u8 {
    (255.0 * fraction.clamp(0.0, 1.0)).round() as u8
}

/// Writes an sRGB PNG with `texts` (keyword, text) as its metadata.
///
/// - `paint`: writes all rows, from top to bottom
pub(super) fn encode_png(
    (width, height): (usize, usize),
    colour: png::ColorType,
    texts: &[(&str, String)],
    compression: png::Compression,
    file: &mut impl Write,
    paint: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(file, size(width)?, size(height)?);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    for (keyword, text) in texts {
        encoder.add_itxt_chunk((*keyword).to_owned(), text.clone()).map_err(plain)?;
    }
    let mut writer = encoder.write_header().map_err(plain)?;
    let mut stream = writer.stream_writer_with_size(CHUNK).map_err(plain)?;
    paint(&mut stream)?;
    stream.finish().map_err(plain)?;
    writer.finish().map_err(plain)
}

/// PNG in memory of pixels of three or four channels of eight bits, shape `[rows, columns, channels]`. It is made
/// quickly, for who waits for it, and is some tenths larger than it could be.
pub(crate) fn png_bytes(width: usize, height: usize, pixels: &[u8]) -> Vec<u8> {
    let channels = pixels.len() / (width * height).max(1);
    let colour = if channels == 4 { png::ColorType::Rgba } else { png::ColorType::Rgb };
    let mut bytes = Vec::new();
    let compression = png::Compression::Fast;
    encode_png((width, height), colour, &[], compression, &mut bytes, |out| out.write_all(pixels))
        .expect("memory takes what is written, and sizes of pictures fit into 32 bits");
    bytes
}

/// Size of a chunk of data in a PNG, bytes.
const CHUNK: usize = 1 << 20;

fn plain(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::super::picture_input::tests::{
        image, image_with_coverage, in_rows_of, input, painted,
    };
    use super::*;
    use crate::products::Image;

    #[test]
    fn natural_colours_keep_their_hues_and_false_ones_gain_contrast() {
        let image = image(&["b", "g", "r"], vec![0.0, 0.0, 0.0, 0.1, 0.4, 0.2]);
        let (natural, _) = painted(&image, &[450.0, 550.0, 650.0]);
        let grey = |fraction: f32| (255.0 * fraction.powf(1.0 / 2.2)).round() as u8;
        assert_eq!(natural[4..], [grey(0.5), 255, grey(0.25), 255]);
        let (false_colour, _) = painted(&image, &[550.0, 650.0, 850.0]);
        assert_eq!(false_colour[4..], [255, 255, grey(0.5), 255]);
    }

    #[test]
    fn a_band_without_light_leaves_the_picture_to_the_others() {
        let nan = f32::NAN;
        let image = image(&["red", "tir"], vec![0.1, nan, 0.3, nan]);
        let (rgba, dark) = painted(&image, &[660.0, 10_500.0]);
        assert_eq!(rgba, [0, 0, 0, 255, 255, 255, 255, 255], "grey, of the red band");
        assert_eq!(dark, ["tir"]);
        let colours = |bands| Rendering::Colours {
            channels: Channels::Bands(bands),
            exposure: Some(0.0),
            white: vec![1.0, 1.0],
        };
        let image = Image { rendering: colours([1, 0, 0]), ..image };
        let (rgba, _) = painted(&image, &[660.0, 10_500.0]);
        assert!(rgba[0] == 0 && rgba[1] > 0 && rgba[1] == rgba[2] && rgba[3] == 255, "{rgba:?}");
    }

    #[test]
    fn classes_and_their_shares_have_their_colours() {
        let class = |name: &str, colour| Class { name: name.to_owned(), colour };
        let classes = vec![class("a", [255, 0, 0]), class("b", [0, 0, 255])];
        let image = Image {
            rendering: Rendering::Classes(classes.clone()),
            ..image(&["class"], vec![1.0, f32::NAN, 2.0])
        };
        let (rgba, _) = painted(&image, &[]);
        assert_eq!(rgba, [255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 255, 255]);
        let half = mixed(&[0.5, 0.5], &classes);
        assert_eq!(half, Some([byte(0.5_f32.powf(1.0 / 2.2)), 0, byte(0.5_f32.powf(1.0 / 2.2))]));
        assert_eq!(mixed(&[f32::NAN, 0.0], &classes), None);
    }

    #[test]
    fn pixels_without_data_are_transparent_and_a_plain_image_is_grey() {
        let image = image_with_coverage(&["red"], vec![0.3, f32::NAN, 0.3], vec![1.0, 0.0, 0.5]);
        let (rgba, _) = painted(&image, &[660.0]);
        assert_eq!(rgba, [186, 186, 186, 255, 0, 0, 0, 0, 186, 186, 186, 128]);
    }

    #[test]
    fn maps_show_zero_in_its_own_colour_and_the_whole_range() {
        let painted_map = |zero: Option<&str>, values: Vec<f32>| {
            let rendering = Rendering::Map { zero: zero.map(str::to_owned) };
            painted(&Image { rendering, ..image(&["x"], values) }, &[]).0
        };
        let quarter = byte(0.25_f32.powf(GAMMA.recip()));
        let rgba = painted_map(Some("nothing"), vec![0.0, f32::NAN, 1.0, 4.0]);
        let expected = [ZERO, [0; 3], [quarter; 3], [255; 3]];
        let found: Vec<[u8; 3]> =
            rgba.chunks_exact(4).map(|one| [one[0], one[1], one[2]]).collect();
        assert_eq!(found, expected);
        let opacity: Vec<u8> = rgba.iter().skip(3).step_by(4).copied().collect();
        assert_eq!(opacity, [255, 0, 255, 255]);
        let rgba = painted_map(None, vec![-2.0, 0.0, 6.0]);
        assert_eq!(rgba, [0, 0, 0, 255, quarter, quarter, quarter, 255, 255, 255, 255, 255]);
    }

    /// An image that shows nothing of the scene is not dark.
    #[test]
    fn only_bands_with_data_are_dark() {
        let dark = |value: f32| painted(&image(&["red"], vec![value]), &[660.0]).1;
        assert_eq!((dark(f32::NAN), dark(0.0)), (Vec::new(), vec!["red".to_owned()]));
    }

    /// A picture is the same whatever blocks of rows it is painted in.
    #[test]
    fn rows_of_a_picture_are_painted_alone() {
        let one = image(&["b", "g", "r"], (0..3 * 70).map(|i| (i * 37 % 101) as f32).collect());
        let tall = in_rows_of(2, one);
        let input = input(&tall, &[450.0, 550.0, 650.0]);
        let picture = PicturePainter::new(&input).expect("a picture");
        let whole = picture.paint(0..35).expect("rows");
        let parts = [0..16, 16..32, 32..35].map(|rows| picture.paint(rows).expect("rows"));
        assert_eq!(whole, parts.concat());
    }
}
