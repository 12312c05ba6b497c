//! Pictures: eight bits per channel, stretched, transparent where there are no data.

use std::io::{self, Write};
use std::path::Path;

use super::composite::Composite;
use super::legend::Legend;
use super::{OutputError, colour, put_file};
use crate::products::{Channels, Class, Image, Rendering};

/// Exponent of the display.
pub(super) const GAMMA: f32 = 2.2;

/// An sRGB picture with opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RgbaPicture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue and opacity, shape `[rows, columns, 4]`; row 0 is the top.
    pub rgba: Vec<u8>,
}

impl RgbaPicture {
    /// Picture of `image` as its rendering says, with its legend.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub(super) fn with_legend(image: &Image, wavelengths: &[f64]) -> (Self, Legend) {
        let has_data = bands_with_data(image);
        match &image.rendering {
            Rendering::Quicklook => {
                Self::composite(image, wavelengths, &Composite::new(wavelengths, &has_data))
            }
            Rendering::Classes(classes) => {
                let colour = |pixel: &[f32]| class_of(pixel, classes).map(|class| class.colour);
                (Self::painted(image, colour), Legend::classes(classes, "largest share of a pixel"))
            }
            Rendering::Shares(classes) => {
                let colour = |pixel: &[f32]| mixed(pixel, classes);
                (Self::painted(image, colour), Legend::classes(classes, "mixed by their shares"))
            }
            Rendering::Colours { channels: Channels::Bands(bands), exposure: None, .. } => {
                let bands = bands.map(|band| band.min(image.bands.len().saturating_sub(1)));
                let bands = bands.map(|band| Some(band).filter(|band| has_data[*band]));
                Self::composite(image, wavelengths, &Composite { bands, is_natural: true })
            }
            Rendering::Colours { channels, exposure, white } => {
                let mut white = white.clone();
                for (white, _) in
                    white.iter_mut().zip(&has_data).filter(|(_, has_data)| !**has_data)
                {
                    *white = 0.0;
                }
                let mixture = colour::Mixture::new(*channels, wavelengths, &white);
                let gain = exposure.map_or_else(|| mixture.automatic(image), f64::exp2);
                let rgba = mixture.rgba(image, gain);
                let picture = Self { width: image.width, height: image.height, rgba };
                (picture, Legend::exposed(image, *channels, gain))
            }
        }
    }

    /// Picture of `image` as its rendering says.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub fn new(image: &Image, wavelengths: &[f64]) -> Self {
        Self::with_legend(image, wavelengths).0
    }

    /// Picture of one to three bands of `image` that have data, stretched between the 1st and 99th
    /// percentiles. Opacity is the coverage.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub fn quicklook(image: &Image, wavelengths: &[f64]) -> Self {
        let composite = Composite::new(wavelengths, &bands_with_data(image));
        Self::composite(image, wavelengths, &composite).0
    }

    /// Colours each pixel by its values, transparent where it has no colour. Opacity is the coverage.
    fn painted(image: &Image, colour: impl Fn(&[f32]) -> Option<[u8; 3]>) -> Self {
        let pixels = image.values.chunks_exact(image.bands.len().max(1)).zip(&image.coverage);
        let rgba = pixels.flat_map(|(pixel, &coverage)| match colour(pixel) {
            Some([r, g, b]) => [r, g, b, byte(coverage)],
            None => [0; 4],
        });
        Self { width: image.width, height: image.height, rgba: rgba.collect() }
    }

    fn composite(image: &Image, wavelengths: &[f64], composite: &Composite) -> (Self, Legend) {
        let bands = image.bands.len();
        let stretches = composite.stretches(image);
        let legend = composite.legend(image, wavelengths, &stretches);
        let mut rgba = Vec::with_capacity(4 * image.width * image.height);
        let pixels = image.values.chunks_exact(bands.max(1)).zip(&image.coverage);
        for (pixel, &coverage) in pixels {
            let chosen = composite.bands.map(|band| band.map_or(0.0, |band| pixel[band]));
            let is_empty = composite.bands.iter().all(Option::is_none);
            if is_empty || !chosen.iter().all(|value| value.is_finite()) {
                rgba.extend([0; 4]);
                continue;
            }
            for (value, stretch) in chosen.into_iter().zip(&stretches) {
                rgba.push(byte(stretch.apply(value).powf(GAMMA.recip())));
            }
            rgba.push(byte(coverage));
        }
        (Self { width: image.width, height: image.height, rgba }, legend)
    }

    /// Writes a PNG with `texts` (keyword, text) as its metadata.
    ///
    /// # Errors
    /// If `file` cannot be written, or `rgba` is not of the picture's shape.
    pub fn encode(&self, texts: &[(&str, String)], file: &mut impl Write) -> io::Result<()> {
        let (size, colour) = ((self.width, self.height), png::ColorType::Rgba);
        encode_png(&Pixels { size, colour, bytes: &self.rgba }, texts, file)
    }

    /// Writes a PNG to `path`, whose folder is made if it does not exist.
    ///
    /// # Errors
    /// If the file cannot be written; then no part of it is left.
    pub fn save(&self, path: &Path) -> Result<(), OutputError> {
        put_file(path, |file| {
            let mut file = io::BufWriter::new(file);
            self.encode(&[], &mut file)?;
            file.flush()
        })
    }
}

/// Returns true for each band with a value other than 0, or for all bands if there is none.
fn bands_with_data(image: &Image) -> Vec<bool> {
    let bands = image.bands.len();
    let mut has_data = vec![false; bands];
    for pixel in image.values.chunks_exact(bands.max(1)) {
        for (has_data, value) in has_data.iter_mut().zip(pixel) {
            *has_data |= value.is_finite() && *value != 0.0;
        }
        if has_data.iter().all(|has_data| *has_data) {
            break;
        }
    }
    if has_data.iter().any(|has_data| *has_data) { has_data } else { vec![true; bands] }
}

/// The class whose number a pixel holds, from 1.
fn class_of<'a>(pixel: &[f32], classes: &'a [Class]) -> Option<&'a Class> {
    let number = pixel.first().copied().filter(|number| *number >= 1.0)?;
    classes.get(number as usize - 1)
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

/// Pixels of a PNG.
pub(super) struct Pixels<'a> {
    /// Columns and rows.
    pub(super) size: (usize, usize),
    pub(super) colour: png::ColorType,
    /// Channels of the pixels, shape `[rows, columns, channels]`.
    pub(super) bytes: &'a [u8],
}

/// Writes an sRGB PNG with `texts` (keyword, text) as its metadata.
pub(super) fn encode_png(
    pixels: &Pixels<'_>,
    texts: &[(&str, String)],
    file: &mut impl Write,
) -> io::Result<()> {
    let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let mut encoder = png::Encoder::new(file, size(pixels.size.0)?, size(pixels.size.1)?);
    encoder.set_color(pixels.colour);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    for (keyword, text) in texts {
        encoder.add_itxt_chunk((*keyword).to_owned(), text.clone()).map_err(plain)?;
    }
    let mut writer = encoder.write_header().map_err(plain)?;
    writer.write_image_data(pixels.bytes).map_err(plain)?;
    writer.finish().map_err(plain)
}

fn plain(error: png::EncodingError) -> io::Error {
    match error {
        png::EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn natural_colours_keep_their_hues_and_false_ones_gain_contrast() {
        let image = Image {
            width: 2,
            height: 1,
            bands: ["b", "g", "r"].map(str::to_owned).into(),
            values: vec![0.0, 0.0, 0.0, 0.1, 0.4, 0.2],
            standard_error: vec![0.0; 6],
            coverage: vec![1.0; 2],
            rendering: Rendering::Quicklook,
            georeference: None,
        };
        let natural = RgbaPicture::quicklook(&image, &[450.0, 550.0, 650.0]);
        let grey = |fraction: f32| (255.0 * fraction.powf(1.0 / 2.2)).round() as u8;
        assert_eq!(natural.rgba[4..], [grey(0.5), 255, grey(0.25), 255]);
        let false_colour = RgbaPicture::quicklook(&image, &[550.0, 650.0, 850.0]);
        assert_eq!(false_colour.rgba[4..], [255, 255, grey(0.5), 255]);
    }

    #[test]
    fn a_band_without_light_leaves_the_picture_to_the_others() {
        let nan = f32::NAN;
        let image = Image {
            width: 2,
            height: 1,
            bands: ["red", "tir"].map(str::to_owned).into(),
            values: vec![0.1, nan, 0.3, nan],
            standard_error: vec![0.0; 4],
            coverage: vec![1.0; 2],
            rendering: Rendering::Quicklook,
            georeference: None,
        };
        let (picture, legend) = RgbaPicture::with_legend(&image, &[660.0, 10_500.0]);
        assert_eq!(picture.rgba, [0, 0, 0, 255, 255, 255, 255, 255], "grey, of the red band");
        assert_eq!(legend.dark, ["tir"]);
        let colours = |bands| Rendering::Colours {
            channels: Channels::Bands(bands),
            exposure: Some(0.0),
            white: vec![1.0, 1.0],
        };
        let image = Image { rendering: colours([1, 0, 0]), ..image };
        let rgba = RgbaPicture::new(&image, &[660.0, 10_500.0]).rgba;
        assert!(rgba[0] == 0 && rgba[1] > 0 && rgba[1] == rgba[2] && rgba[3] == 255, "{rgba:?}");
    }

    #[test]
    fn classes_and_their_shares_have_their_colours() {
        let class = |name: &str, colour| Class { name: name.to_owned(), colour };
        let classes = vec![class("a", [255, 0, 0]), class("b", [0, 0, 255])];
        let image = Image {
            width: 3,
            height: 1,
            bands: vec!["class".to_owned()],
            values: vec![1.0, f32::NAN, 2.0],
            standard_error: vec![f32::NAN; 3],
            coverage: vec![1.0, 0.0, 1.0],
            rendering: Rendering::Classes(classes.clone()),
            georeference: None,
        };
        assert_eq!(
            RgbaPicture::new(&image, &[]).rgba,
            [255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 255, 255]
        );
        let half = mixed(&[0.5, 0.5], &classes);
        assert_eq!(half, Some([byte(0.5_f32.powf(1.0 / 2.2)), 0, byte(0.5_f32.powf(1.0 / 2.2))]));
        assert_eq!(mixed(&[f32::NAN, 0.0], &classes), None);
    }

    #[test]
    fn pixels_without_data_are_transparent_and_a_plain_image_is_grey() {
        let image = Image {
            width: 3,
            height: 1,
            bands: vec!["red".to_owned()],
            values: vec![0.3, f32::NAN, 0.3],
            standard_error: vec![f32::NAN; 3],
            coverage: vec![1.0, 0.0, 0.5],
            rendering: Rendering::Quicklook,
            georeference: None,
        };
        let picture = RgbaPicture::quicklook(&image, &[660.0]);
        assert_eq!(picture.rgba, [186, 186, 186, 255, 0, 0, 0, 0, 186, 186, 186, 128]);
    }

    /// An image that shows nothing of the scene is not dark.
    #[test]
    fn only_bands_with_data_are_dark() {
        let dark = |value: f32| {
            let image = Image {
                width: 1,
                height: 1,
                bands: vec!["red".to_owned()],
                values: vec![value],
                standard_error: vec![f32::NAN],
                coverage: vec![1.0],
                rendering: Rendering::Quicklook,
                georeference: None,
            };
            RgbaPicture::with_legend(&image, &[660.0]).1.dark
        };
        assert_eq!((dark(f32::NAN), dark(0.0)), (Vec::new(), vec!["red".to_owned()]));
    }
}
