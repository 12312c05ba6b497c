//! Pictures for people: eight bits a channel, stretched, transparent where there is no data.

use std::io::{self, Write};
use std::path::Path;

use super::{OutputError, colour, put_file};
use crate::products::{Channels, Image, Rendering};

/// Shares of the pixels that end up at black and at full brightness.
const STRETCH: (f64, f64) = (0.01, 0.99);
/// Least full brightness of a false colour, as a share of that of the brightest.
const FAINTEST: f32 = 0.5;
/// Of the display.
const GAMMA: f32 = 2.2;
/// Wavelengths that red, green and blue stand for where the image reaches the near infrared, nm:
/// the classic false colours, in which leaves are red.
const FALSE_COLOUR: [f64; 3] = [865.0, 660.0, 560.0];
/// Those of natural colours, nm.
const NATURAL: [f64; 3] = [650.0, 550.0, 450.0];

/// An sRGB picture with opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue and opacity, shape `[rows, columns, 4]`; row 0 is the top.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// `image` as its rendering tells.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub fn of(image: &Image, wavelengths: &[f64]) -> Self {
        match &image.rendering {
            Rendering::Quicklook => Self::quicklook(image, wavelengths),
            Rendering::Colours { channels: Channels::Bands(bands), exposure: None, .. } => {
                let bands = bands.map(|band| band.min(image.bands.len().saturating_sub(1)));
                Self::composite(image, &Composite { bands, natural: true })
            }
            Rendering::Colours { channels, exposure, white } => {
                let mixture = colour::Mixture::of(*channels, wavelengths, white);
                let gain = exposure.map_or_else(|| mixture.automatic(image), f64::exp2);
                let rgba = mixture.rgba(image, gain);
                Self { width: image.width, height: image.height, rgba }
            }
        }
    }

    /// `image` for a first look: one to three of its bands, stretched between the 1st and 99th
    /// percentiles; opacity is the coverage.
    ///
    /// - `wavelengths`: of the image's bands, nm; NaN where unknown
    #[must_use]
    pub fn quicklook(image: &Image, wavelengths: &[f64]) -> Self {
        Self::composite(image, &Composite::of(wavelengths, image.bands.len()))
    }

    fn composite(image: &Image, composite: &Composite) -> Self {
        let bands = image.bands.len();
        let stretches = composite.stretches(image);
        let mut rgba = Vec::with_capacity(4 * image.width * image.height);
        let pixels = image.values.chunks_exact(bands.max(1)).zip(&image.coverage);
        for (pixel, &coverage) in pixels {
            let chosen = composite.bands.map(|band| pixel[band]);
            if !chosen.iter().all(|value| value.is_finite()) {
                rgba.extend([0; 4]);
                continue;
            }
            for (value, stretch) in chosen.into_iter().zip(&stretches) {
                rgba.push(byte(stretch.of(value).powf(GAMMA.recip())));
            }
            rgba.push(byte(coverage));
        }
        Self { width: image.width, height: image.height, rgba }
    }

    /// Writes a PNG with `texts` (keyword, text) as its metadata.
    ///
    /// # Errors
    /// If `file` cannot be written, or `rgba` is not of the picture's shape.
    pub fn encode(&self, texts: &[(&str, String)], file: &mut impl Write) -> io::Result<()> {
        let size = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
        let mut encoder = png::Encoder::new(file, size(self.width)?, size(self.height)?);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
        for (keyword, text) in texts {
            encoder.add_itxt_chunk((*keyword).to_owned(), text.clone()).map_err(plain)?;
        }
        let mut writer = encoder.write_header().map_err(plain)?;
        writer.write_image_data(&self.rgba).map_err(plain)?;
        writer.finish().map_err(plain)
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

/// Which bands are red, green and blue.
#[derive(Debug)]
struct Composite {
    bands: [usize; 3],
    /// Whether the three are stretched alike, which keeps the hues.
    natural: bool,
}

impl Composite {
    fn of(wavelengths: &[f64], bands: usize) -> Self {
        let at = |band: usize| wavelengths.get(band).copied().unwrap_or(f64::NAN);
        // Bands of unknown wavelength are taken in their order.
        let mut order: Vec<usize> = (0..bands).collect();
        if order.iter().all(|&band| at(band).is_finite()) {
            order.sort_by(|&a, &b| at(a).total_cmp(&at(b)));
        }
        let (Some(&shortest), Some(&longest)) = (order.first(), order.last()) else {
            return Self { bands: [0; 3], natural: true };
        };
        if bands < 3 {
            return Self { bands: [longest, shortest, shortest], natural: false };
        }
        let near_infrared = order.iter().any(|&band| (740.0..1400.0).contains(&at(band)));
        let wanted = if near_infrared { FALSE_COLOUR } else { NATURAL };
        let nearest = |wavelength: f64| {
            let distance = |band: usize| (at(band) - wavelength).abs();
            order.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        };
        match wanted.map(nearest) {
            [Some(r), Some(g), Some(b)] if r != g && g != b && r != b => {
                Self { bands: [r, g, b], natural: !near_infrared }
            }
            _ => Self { bands: [longest, order[bands / 2], shortest], natural: false },
        }
    }

    fn stretches(&self, image: &Image) -> [Stretch; 3] {
        let [r, g, b] = self.bands.map(|band| Stretch::between_percentiles(image, band));
        let low = r.low.min(g.low).min(b.low);
        let high = r.high.max(g.high).max(b.high);
        if self.natural {
            return [Stretch { low, high }; 3];
        }
        // A dim band stretched in full would drown the others: bare soil in cyan.
        [r, g, b].map(|one| Stretch { high: one.high.max(FAINTEST * high), ..one })
    }
}

/// What becomes black and what becomes full brightness.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    low: f32,
    high: f32,
}

impl Stretch {
    fn between_percentiles(image: &Image, band: usize) -> Self {
        let all = image.values.iter().skip(band).step_by(image.bands.len().max(1));
        let mut seen: Vec<f32> = all.copied().filter(|value| value.is_finite()).collect();
        if seen.is_empty() {
            return Self { low: 0.0, high: 1.0 };
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
    fn of(self, value: f32) -> f32 {
        ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0)
    }
}

fn byte(fraction: f32) -> u8 {
    (255.0 * fraction.clamp(0.0, 1.0)).round() as u8
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
        Composite::of(wavelengths, wavelengths.len()).bands
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
        let natural = Picture::quicklook(&image, &[450.0, 550.0, 650.0]);
        let grey = |fraction: f32| (255.0 * fraction.powf(1.0 / 2.2)).round() as u8;
        assert_eq!(natural.rgba[4..], [grey(0.5), 255, grey(0.25), 255]);
        let false_colour = Picture::quicklook(&image, &[550.0, 650.0, 850.0]);
        assert_eq!(false_colour.rgba[4..], [255, 255, grey(0.5), 255]);
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
        let picture = Picture::quicklook(&image, &[660.0]);
        assert_eq!(picture.rgba, [186, 186, 186, 255, 0, 0, 0, 0, 186, 186, 186, 128]);
    }
}
