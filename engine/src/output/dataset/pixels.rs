//! Rasters of an image as values of variables.

use std::fs::File;
use std::io;

use super::super::classification::classes_of;
use super::super::envi::NO_DATA;
use super::values::{StoredForm, StoredValues, Values};
use crate::products::Image;

/// Files with the rasters of an image: of values, and of errors and coverage.
#[derive(Debug)]
pub(in crate::output) struct ImageFiles {
    pub(in crate::output) values: File,
    pub(in crate::output) errors: File,
}

/// Rasters of an image.
#[derive(Debug)]
pub(in crate::output) enum ImageRasters {
    /// Files that were written.
    Files(ImageFiles),
    /// Arrays for a program that takes them over.
    Arrays(PixelArrays),
}

/// Pixels of an image in memory; NaN where nothing was seen, or where there is no error.
#[derive(Debug)]
pub(in crate::output) struct PixelArrays {
    /// Values, shape `[bands, rows, columns]`.
    pub(in crate::output) values: Vec<f32>,
    /// Standard errors, same shape; empty if the image has none.
    pub(in crate::output) errors: Vec<f32>,
    /// Fraction of each pixel that shows the scene, shape `[rows, columns]`.
    pub(in crate::output) coverage: Vec<f32>,
}

/// Values of the variables of an image.
#[derive(Debug)]
pub(super) struct PixelValues {
    /// Values, shape `[bands, rows, columns]`.
    pub(super) values: Values<'static>,
    /// Standard errors, same shape, if it has some.
    pub(super) errors: Option<Values<'static>>,
    /// Fraction of each pixel that shows the scene, shape `[rows, columns]`.
    pub(super) coverage: Values<'static>,
}

impl ImageFiles {
    /// Rasters that are read from the files.
    ///
    /// # Errors
    /// If a file cannot be opened again.
    pub(in crate::output) fn rasters(&self) -> io::Result<ImageRasters> {
        let Self { values, errors } = self;
        Ok(ImageRasters::Files(Self { values: values.try_clone()?, errors: errors.try_clone()? }))
    }
}

impl ImageRasters {
    /// Values of the variables of an image.
    ///
    /// # Errors
    /// If a file cannot be opened again.
    pub(super) fn into_values(self, image: &Image) -> io::Result<PixelValues> {
        match self {
            Self::Files(ImageFiles { values, errors }) => {
                let form = match classes_of(image) {
                    Some(_) => StoredForm::Classes,
                    None => StoredForm::Floats { no_data: NO_DATA },
                };
                let of_errors = |start: u64| -> io::Result<Values<'static>> {
                    let form = StoredForm::Floats { no_data: NO_DATA };
                    Ok(Values::Stored(StoredValues { file: errors.try_clone()?, start, form }))
                };
                let count = image.bands.len() * image.height * image.width;
                Ok(PixelValues {
                    errors: image.has_errors.then(|| of_errors(0)).transpose()?,
                    coverage: of_errors((count * size_of::<f32>()) as u64)?,
                    values: Values::Stored(StoredValues { file: values, start: 0, form }),
                })
            }
            Self::Arrays(PixelArrays { values, errors, coverage }) => Ok(PixelValues {
                values: Values::Floats(values),
                errors: image.has_errors.then_some(Values::Floats(errors)),
                coverage: Values::Floats(coverage),
            }),
        }
    }
}
