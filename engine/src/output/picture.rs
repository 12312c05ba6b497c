//! Pictures for people: eight bits a channel, stretched, transparent where there is no data.

use std::io::{self, Write};
use std::path::Path;

use super::legend::{Bar, Entries, Legend};
use super::{OutputError, colour, put_file};
use crate::products::{Channels, Class, Image, Rendering};

/// Shares of the pixels that end up at black and at full brightness.
const STRETCH: (f64, f64) = (0.01, 0.99);
/// Least full brightness of a false colour, as a share of that of the brightest.
const FAINTEST: f32 = 0.5;
/// Of the display.
pub(super) const GAMMA: f32 = 2.2;
/// Wavelengths that red, green and blue stand for where the image reaches the near infrared, nm:
/// the classic false colours, in which leaves are red.
const FALSE_COLOUR: [f64; 3] = [865.0, 660.0, 560.0];
/// Those of natural colours, nm.
const NATURAL: [f64; 3] = [650.0, 550.0, 450.0];

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
    /// Picture of `image` as its rendering says, and how to read it.
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
                Self::composite(image, wavelengths, &Composite { bands, natural: true })
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

    /// `image` for a first look: one to three of its bands that have data, stretched between the 1st and 99th
    /// percentiles; opacity is the coverage.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub fn quicklook(image: &Image, wavelengths: &[f64]) -> Self {
        let composite = Composite::new(wavelengths, &bands_with_data(image));
        Self::composite(image, wavelengths, &composite).0
    }

    /// Each pixel in a colour of its own, transparent where it has none; opacity is the coverage.
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

/// For each band whether any of its pixels has a value other than 0; all of them where none has.
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

/// Which bands are red, green and blue; none where that has no data.
#[derive(Debug)]
struct Composite {
    bands: [Option<usize>; 3],
    /// Whether the three are stretched alike, which keeps the hues.
    natural: bool,
}

impl Composite {
    /// Chooses among the bands that have data.
    fn new(wavelengths: &[f64], has_data: &[bool]) -> Self {
        let at = |band: usize| wavelengths.get(band).copied().unwrap_or(f64::NAN);
        // Bands of unknown wavelength are taken in their order.
        let mut order: Vec<usize> = (0..has_data.len()).filter(|&band| has_data[band]).collect();
        if order.iter().all(|&band| at(band).is_finite()) {
            order.sort_by(|&a, &b| at(a).total_cmp(&at(b)));
        }
        let (Some(&shortest), Some(&longest)) = (order.first(), order.last()) else {
            return Self { bands: [None; 3], natural: true };
        };
        let three = |bands: [usize; 3], natural| Self { bands: bands.map(Some), natural };
        if order.len() < 3 {
            return three([longest, shortest, shortest], false);
        }
        let near_infrared = order.iter().any(|&band| (740.0..1400.0).contains(&at(band)));
        let wanted = if near_infrared { FALSE_COLOUR } else { NATURAL };
        let nearest = |wavelength: f64| {
            let distance = |band: usize| (at(band) - wavelength).abs();
            order.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        };
        match wanted.map(nearest) {
            [Some(r), Some(g), Some(b)] if r != g && g != b && r != b => {
                three([r, g, b], !near_infrared)
            }
            _ => three([longest, order[order.len() / 2], shortest], false),
        }
    }

    fn stretches(&self, image: &Image) -> [Stretch; 3] {
        let of = |band: Option<usize>| {
            band.map_or(Stretch::NONE, |band| Stretch::between_percentiles(image, band))
        };
        let [r, g, b] = self.bands.map(of);
        let shown = [r, g, b].into_iter().zip(self.bands).filter(|(_, band)| band.is_some());
        let shown: Vec<Stretch> = shown.map(|(stretch, _)| stretch).collect();
        if shown.is_empty() {
            return [r, g, b];
        }
        let low = shown.iter().map(|one| one.low).fold(f32::INFINITY, f32::min);
        let high = shown.iter().map(|one| one.high).fold(f32::NEG_INFINITY, f32::max);
        if self.natural {
            return [Stretch { low, high }; 3];
        }
        // A dim band stretched in full would drown the others: bare soil in cyan.
        [r, g, b].map(|one| Stretch { high: one.high.max(FAINTEST * high), ..one })
    }

    /// A bar for each band that is shown, in the colours that it has where the others are dark.
    fn legend(&self, image: &Image, wavelengths: &[f64], stretches: &[Stretch; 3]) -> Legend {
        let mut bars: Vec<Bar> = Vec::new();
        let mut shown: Vec<usize> = Vec::new();
        for (channel, (band, stretch)) in self.bands.into_iter().zip(stretches).enumerate() {
            let Some(band) = band else { continue };
            if let Some(at) = shown.iter().position(|&other| other == band) {
                bars[at].channels[channel] = true;
                continue;
            }
            let mut channels = [false; 3];
            channels[channel] = true;
            let wavelength = wavelengths.get(band).copied().filter(|nm| nm.is_finite());
            let name = image.bands[band].clone();
            bars.push(Bar { name, wavelength, channels, low: stretch.low, high: stretch.high });
            shown.push(band);
        }
        let has_data = image.values.iter().any(|value| value.is_finite());
        let is_dark = |(band, name): (usize, &String)| {
            let mut values = image.values.iter().skip(band).step_by(image.bands.len());
            // Pixels without data tell nothing of the light.
            let is_dark = has_data && values.all(|value| !value.is_finite() || *value == 0.0);
            is_dark.then(|| name.clone())
        };
        let dark = image.bands.iter().enumerate().filter_map(is_dark).collect();
        Legend { entries: Entries::Bars(bars), dark }
    }
}

/// What becomes black and what becomes full brightness.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    low: f32,
    high: f32,
}

impl Stretch {
    /// Stretch of a channel that shows nothing.
    const NONE: Self = Self { low: 0.0, high: 1.0 };

    fn between_percentiles(image: &Image, band: usize) -> Self {
        let all = image.values.iter().skip(band).step_by(image.bands.len().max(1));
        let mut seen: Vec<f32> = all.copied().filter(|value| value.is_finite()).collect();
        if seen.is_empty() {
            return Self::NONE;
        }
        let last = seen.len() - 1;
        let mut percentile = |share: f64| {
            let index = (share * last as f64).round() as usize;
            *seen.select_nth_unstable_by(index, f32::total_cmp).1
        };
        let (low, high) = (percentile(STRETCH.0), percentile(STRETCH.1));
        // A plain image is neither black nor white; differences in its last digits are no picture.
        let plain = high - low <= 1e-5 * high.abs();
        if plain {
            Self { low: 0.0, high: (2.0 * high).max(f32::MIN_POSITIVE) }
        } else {
            Self { low, high }
        }
    }

    /// `value` in [0, 1].
    fn apply(self, value: f32) -> f32 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

pub(super) fn byte(fraction: f32) -> u8 {
    (255.0 * fraction.clamp(0.0, 1.0)).round() as u8
}

/// What a PNG holds.
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

    fn bands_of(wavelengths: &[f64]) -> [usize; 3] {
        Composite::new(wavelengths, &vec![true; wavelengths.len()])
            .bands
            .map(Option::unwrap_or_default)
    }

    #[test]
    fn colours_follow_the_wavelengths() {
        assert_eq!(bands_of(&[660.0]), [0, 0, 0], "grey");
        assert_eq!(bands_of(&[865.0, 660.0]), [0, 1, 1], "near infrared is red");
        assert_eq!(bands_of(&[660.0, 865.0]), [1, 0, 0]);
        assert_eq!(bands_of(&[450.0, 550.0, 650.0]), [2, 1, 0], "natural");
        assert_eq!(bands_of(&[490.0, 560.0, 665.0, 842.0]), [3, 2, 1], "false colours");
        assert_eq!(bands_of(&[8000.0, 10_000.0, 12_000.0]), [2, 1, 0], "longest is red");
        assert_eq!(bands_of(&[f64::NAN; 4]), [3, 2, 0], "unknown");
    }

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
