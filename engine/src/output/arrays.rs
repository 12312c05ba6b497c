//! What sensors measured as named arrays in memory, for programs that call the engine.

use std::io;
use std::path::Path;

use super::band_rows::BandRows;
use super::dataset::{Attribute, Dataset, ImageRasters, PixelArrays, Values, of_sensor};
use super::provenance::{RecipeRecord, RecipeTexts};
use super::{OfSensor, OutputError, Source, check_shape, names};
use crate::products::{Image, Report};

/// All products of a sensor as arrays over common dimensions, after the CF conventions 1.10: what
/// `<sensor>.zarr` and `<sensor>.nc` hold.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorArrays {
    /// Name of the sensor.
    pub name: String,
    /// Names of the dimensions and their lengths.
    pub dimensions: Vec<(String, usize)>,
    /// Attributes of all, in order: conventions, title, hash, seed, version, scene.
    pub attributes: Vec<(String, Attribute)>,
    /// Coordinates, values and standard errors.
    pub arrays: Vec<NamedArray>,
}

/// A named array.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedArray {
    /// Name.
    pub name: String,
    /// Places of its dimensions among all, slowest first; none of a scalar.
    pub dimensions: Vec<usize>,
    /// Attributes in order: quantity, unit, names of its errors.
    pub attributes: Vec<(String, Attribute)>,
    /// Values in the order of the dimensions, the last one fastest.
    pub values: ArrayValues,
}

/// Values of an array.
#[derive(Clone, Debug, PartialEq)]
pub enum ArrayValues {
    /// Numbers.
    Doubles(Vec<f64>),
    /// Pixels; NaN where nothing was seen.
    Floats(Vec<f32>),
    /// Texts.
    Texts(Vec<String>),
    /// The 0 of an array of which attributes are all.
    Nothing,
}

/// Arrays of each sensor of a report. Pixels are computed here, row by row, and held once.
///
/// - `folder`: folder from which the paths of the recipe are told
///
/// # Errors
/// If a product's shape contradicts its axes, or a temporary file with pixels cannot be read.
pub fn sensor_arrays(report: &Report, folder: &Path) -> Result<Vec<SensorArrays>, OutputError> {
    let fail = |source: io::Error| OutputError::Read { path: folder.to_owned(), source };
    let record = RecipeRecord::new(report, folder);
    let recipe = RecipeTexts::new(record.as_ref()).map_err(fail)?;
    let planned = names::plan(report);
    let of = report.sensors.iter().zip(&planned).map(|(sensor, planned)| {
        let mut rasters = Vec::with_capacity(sensor.products.len());
        for product in &sensor.products {
            let source = Source { report, sensor: &sensor.name, product, recipe: &recipe };
            check_shape(&source)?;
            let pixels = product.image.as_ref().map(|image| pixels(&source, image)).transpose()?;
            rasters.push(pixels.map(ImageRasters::Arrays));
        }
        let measured = OfSensor { report, sensor, recipe: &recipe };
        let dataset = of_sensor(&measured, planned, rasters).map_err(fail)?;
        Ok(SensorArrays::new(&sensor.name, dataset))
    });
    of.collect()
}

/// All pixels of an image, band by band.
fn pixels(source: &Source<'_>, image: &Image) -> Result<PixelArrays, OutputError> {
    let pixels = image.height * image.width;
    let all = || vec![0.0; pixels * image.bands.len()];
    let mut values = all();
    let mut errors = if image.has_errors { all() } else { Vec::new() };
    let mut coverage = Vec::with_capacity(pixels);
    for rows in image.blocks() {
        let block = BandRows::read(source, image, rows.clone())?;
        let count = block.coverage.len();
        for band in 0..image.bands.len() {
            let start = band * pixels + rows.start * image.width;
            values[start..start + count].copy_from_slice(block.values(band));
            if image.has_errors {
                errors[start..start + count].copy_from_slice(block.standard_error(band));
            }
        }
        coverage.extend_from_slice(&block.coverage);
    }
    Ok(PixelArrays { values, errors, coverage })
}

impl SensorArrays {
    fn new(name: &str, dataset: Dataset<'_>) -> Self {
        let Dataset { dimensions, attributes, variables } = dataset;
        let arrays = variables.into_iter().map(|variable| NamedArray {
            name: variable.name,
            dimensions: variable.dimensions,
            attributes: variable.attributes.0,
            values: match variable.values {
                Values::Doubles(values) => ArrayValues::Doubles(values.into_owned()),
                Values::Floats(values) => ArrayValues::Floats(values),
                Values::Texts(texts) => ArrayValues::Texts(texts),
                // Pixels are arrays here.
                Values::Stored(_) | Values::Nothing => ArrayValues::Nothing,
            },
        });
        Self {
            name: name.to_owned(),
            dimensions: dimensions.into_iter().map(|one| (one.name, one.length)).collect(),
            attributes: attributes.0,
            arrays: arrays.collect(),
        }
    }
}
