//! Rasters of an image as values of variables.

use std::fs::File;
use std::io;

use super::super::classification::classes_of;
use super::super::envi::NO_DATA;
use super::values::{StoredForm, StoredValues, Values};
use crate::products::Image;

/// Rasters of an image that were written: of values, and of errors and coverage.
#[derive(Debug)]
pub(in crate::output) struct ImageRasters {
    pub(in crate::output) values: File,
    pub(in crate::output) errors: File,
}

impl ImageRasters {
    /// Values, shape `[bands, rows, columns]`.
    pub(super) fn values(&self, image: &Image) -> io::Result<Values<'static>> {
        let form = match classes_of(image) {
            Some(_) => StoredForm::Classes,
            None => StoredForm::Floats { no_data: NO_DATA },
        };
        Ok(Values::Stored(StoredValues { file: self.values.try_clone()?, start: 0, form }))
    }

    /// Standard errors, shape `[bands, rows, columns]`.
    pub(super) fn errors(&self) -> io::Result<Values<'static>> {
        self.of_errors(0)
    }

    /// Fraction of each pixel that shows the scene, shape `[rows, columns]`.
    pub(super) fn coverage(&self, image: &Image) -> io::Result<Values<'static>> {
        let values = image.bands.len() * image.height * image.width;
        self.of_errors((values * size_of::<f32>()) as u64)
    }

    fn of_errors(&self, start: u64) -> io::Result<Values<'static>> {
        let form = StoredForm::Floats { no_data: NO_DATA };
        Ok(Values::Stored(StoredValues { file: self.errors.try_clone()?, start, form }))
    }
}
