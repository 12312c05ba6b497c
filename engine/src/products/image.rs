//! Images: pixels that are computed or read when they are needed, some rows at a time.

use std::io;
use std::ops::Range;

use crate::components::Channels;
use crate::transport::{PixelRows, Pixels};

/// Image of a product; row 0 is its top.
#[derive(Clone, Debug)]
pub struct Image {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Names of the bands.
    pub bands: Vec<String>,
    /// Values and standard errors of the bands, and coverage: NaN where nothing was seen, or where there is no error.
    pub pixels: Pixels,
    /// False if the values are exact: files hold no standard errors then.
    pub has_errors: bool,
    /// Colours of its picture.
    pub rendering: Rendering,
    /// Position of the pixels on the ground, for nadir images with north up.
    pub georeference: Option<Georeference>,
}

/// Rows of a block have a multiple of this number, which is the side of the tiles that images are traced in.
const ROWS: usize = 16;

/// Memory of a block of rows that is aimed at, bytes.
const BLOCK: usize = 1 << 20;

impl Image {
    /// Blocks of rows from top to bottom that all pixels may be read in.
    #[must_use]
    pub fn blocks(&self) -> impl ExactSizeIterator<Item = Range<usize>> + use<> {
        let (height, rows) = (self.height, block_rows(self.width, self.bands.len()));
        (0..height.div_ceil(rows)).map(move |block| block * rows..((block + 1) * rows).min(height))
    }

    /// All pixels.
    ///
    /// # Errors
    /// If a temporary file that holds them cannot be read.
    pub fn load(&self) -> io::Result<PixelRows> {
        self.pixels.rows(0..self.height)
    }
}

/// Number of rows of a block of an image.
pub(super) fn block_rows(width: usize, bands: usize) -> usize {
    let row = width.saturating_mul(8 * bands + 4).max(1);
    ROWS * (BLOCK / row / ROWS).max(1)
}

/// Memory of a block of rows of an image, bytes.
pub(super) fn bytes_of_block(width: u64, bands: u64) -> u64 {
    width.saturating_mul(ROWS as u64).saturating_mul(8 * bands + 4).max(BLOCK as u64)
}

impl PartialEq for Image {
    /// Compares all pixels; they differ if they cannot be read.
    fn eq(&self, other: &Self) -> bool {
        let Self { width, height, bands, has_errors, rendering, georeference, .. } = self;
        let is_alike = (*width, *height) == (other.width, other.height)
            && *bands == other.bands
            && *has_errors == other.has_errors
            && *rendering == other.rendering
            && *georeference == other.georeference;
        let is_equal = |rows: Range<usize>| {
            let rows = [self, other].map(|image| image.pixels.rows(rows.clone()));
            matches!(rows, [Ok(one), Ok(other)] if one == other)
        };
        is_alike && self.blocks().all(is_equal)
    }
}

/// Colours of the picture of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Rendering {
    /// By wavelength, stretched.
    Quicklook,
    /// The only band from black to white over the whole range of its values.
    Map {
        /// Meaning of a value of 0, if it has a colour of its own; the range begins there then.
        zero: Option<String>,
    },
    /// The only band holds numbers of classes, from 1.
    Classes(Vec<Class>),
    /// Bands hold the shares of classes.
    Shares(Vec<Class>),
    /// By colours of its own.
    Colours {
        /// Bands or colour-matching functions of red, green and blue.
        channels: Channels,
        /// Stops over the exposure that shows a white surface on the horizontal as white; automatic
        /// if absent.
        exposure: Option<f64>,
        /// Value of the image for that white surface, shape `[bands]`.
        white: Vec<f64>,
    },
}

/// A class of pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Class {
    /// Its name.
    pub name: String,
    /// Red, green and blue, sRGB.
    pub colour: [u8; 3],
}

/// Place of an image on the ground, anchor included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Georeference {
    /// Easting of the image's west edge, m.
    pub west: f64,
    /// Northing of the image's north edge, m.
    pub north: f64,
    /// Width of a pixel, m.
    pub pixel_width: f64,
    /// Height of a pixel, m.
    pub pixel_height: f64,
}
