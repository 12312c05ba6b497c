//! Pixels that a picture is made of: some bands, some rows at a time.

use std::fs::File;
use std::io;
use std::ops::Range;

use super::band_rows::BandRows;
use super::classification::{self, classes_of};
use super::envi;
use crate::products::Image;

/// Bands of an image that hold something to show.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct BandsWithData {
    /// True for each band with a value other than 0.
    is_lit: Vec<bool>,
    /// True if any value is finite.
    has_values: bool,
}

impl BandsWithData {
    /// None of so many bands, before any pixel.
    pub(super) fn new(bands: usize) -> Self {
        Self { is_lit: vec![false; bands], has_values: false }
    }

    /// Adds rows.
    pub(super) fn add(&mut self, block: &BandRows) {
        for (band, is_lit) in self.is_lit.iter_mut().enumerate() {
            let values = block.values(band);
            self.has_values |= values.iter().any(|value| value.is_finite());
            *is_lit = *is_lit || values.iter().any(|value| value.is_finite() && *value != 0.0);
        }
    }

    /// True for each band with a value other than 0, or for all bands if there is none.
    pub(super) fn with_data(&self) -> Vec<bool> {
        if self.is_lit.contains(&true) {
            return self.is_lit.clone();
        }
        vec![true; self.is_lit.len()]
    }

    /// True for each band without light in an image that shows something.
    pub(super) fn dark(&self) -> impl Iterator<Item = bool> + '_ {
        self.is_lit.iter().map(|is_lit| self.has_values && !is_lit)
    }
}

/// Image whose rasters were written, as what its picture is made of.
#[derive(Debug)]
pub(super) struct PictureInput<'a> {
    pub(super) image: &'a Image,
    /// Centre wavelengths of its bands, nm; NaN where unknown.
    pub(super) wavelengths: Vec<f64>,
    pub(super) lit: BandsWithData,
    /// Rasters of values, and of errors and coverage.
    pub(super) values: File,
    pub(super) errors: File,
}

impl PictureInput<'_> {
    /// Values of a band in some rows; NaN where there are no data.
    pub(super) fn band(&self, band: usize, rows: Range<usize>) -> io::Result<Vec<f32>> {
        if classes_of(self.image).is_some() {
            return classification::read_rows(self.image.into(), rows, &self.values);
        }
        envi::read_rows(self.image.into(), band, rows, &self.values)
    }

    /// Fraction of each pixel that shows the scene.
    pub(super) fn coverage(&self, rows: Range<usize>) -> io::Result<Vec<f32>> {
        envi::read_rows(self.image.into(), self.image.bands.len(), rows, &self.errors)
    }

    /// Visits all finite values of a band.
    pub(super) fn visit_band(&self, band: usize, each: &mut dyn FnMut(f64)) -> io::Result<()> {
        for rows in self.image.blocks() {
            let finite = self.band(band, rows)?.into_iter().filter(|value| value.is_finite());
            finite.for_each(|value| each(value.into()));
        }
        Ok(())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
pub(super) mod tests {
    use super::super::envi::ImageRaster;
    use super::super::picture::PicturePainter;
    use super::*;
    use crate::products::{PixelRows, Rendering};

    /// One row of pixels that show the scene where they have a first value.
    pub(in crate::output) fn image(bands: &[&str], values: Vec<f32>) -> Image {
        let shows = |pixel: &[f32]| f32::from(u8::from(!pixel[0].is_nan()));
        let coverage: Vec<f32> = values.chunks_exact(bands.len()).map(shows).collect();
        image_with_coverage(bands, values, coverage)
    }

    /// One row of pixels.
    pub(in crate::output) fn image_with_coverage(
        bands: &[&str],
        values: Vec<f32>,
        coverage: Vec<f32>,
    ) -> Image {
        let (width, standard_error) = (coverage.len(), vec![0.0; values.len()]);
        Image {
            width,
            height: 1,
            bands: bands.iter().map(|&band| band.to_owned()).collect(),
            pixels: PixelRows { width, values, standard_error, coverage }.into(),
            has_errors: true,
            rendering: Rendering::Quicklook,
            georeference: None,
        }
    }

    /// The pixels of an image in rows of another width.
    pub(in crate::output) fn in_rows_of(width: usize, image: Image) -> Image {
        let pixels = PixelRows { width, ..image.load().unwrap() };
        Image { width, height: pixels.coverage.len() / width, pixels: pixels.into(), ..image }
    }

    /// Input for the picture of an image, whose rasters are written to temporary files.
    pub(in crate::output) fn input<'a>(image: &'a Image, wavelengths: &[f64]) -> PictureInput<'a> {
        let mut lit = BandsWithData::new(image.bands.len());
        let [mut values, mut errors] = [(); 2].map(|()| tempfile::tempfile().unwrap());
        for rows in image.blocks() {
            let block = BandRows::new(image, rows.clone(), image.pixels.rows(rows).unwrap());
            lit.add(&block);
            envi::write_rows(image, ImageRaster::Values, &block, &mut values).unwrap();
            envi::write_rows(image, ImageRaster::Errors, &block, &mut errors).unwrap();
        }
        PictureInput { image, wavelengths: wavelengths.to_vec(), lit, values, errors }
    }

    /// Pixels and dark bands of the picture of an image.
    pub(in crate::output) fn painted(image: &Image, wavelengths: &[f64]) -> (Vec<u8>, Vec<String>) {
        let input = input(image, wavelengths);
        let picture = PicturePainter::new(&input).unwrap();
        (picture.paint(0..image.height).unwrap(), picture.legend.dark.clone())
    }
}
