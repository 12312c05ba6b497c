//! Files of a run, with provenance; the only module that writes.
//!
//! A folder gets `summary.json`, for each image the formats that the scene asks for (an EXR, two ENVI rasters, two
//! `GeoTIFF`, a PNG with a legend and one without), for each sensor a Zarr store or a `NetCDF` file if it asks for that, for values of triangles a PLY, and for each other product a CSV, with an SVG of values by direction
//! or height. They take the place of older results all at once (`staging`, `swap`).

mod arrays;
mod axes;
mod band_rows;
mod chart;
mod classification;
mod colour;
mod composite;
mod daily;
mod dataset;
mod dataset_files;
mod derivatives;
mod destination;
mod envi;
mod exr;
mod figure;
mod geotiff;
mod image_files;
mod layout;
mod legend;
mod lettering;
mod lines;
mod manifest;
mod names;
mod netcdf;
mod partial;
mod picture;
mod picture_input;
mod ply;
mod point_tables;
mod point_warnings;
mod provenance;
mod results;
mod rows;
mod run_record;
mod scale;
mod size;
mod staged_file;
mod staging;
mod summary;
mod swap;
mod sweep;
mod sweep_datasets;
mod table;
mod titles;
mod tracks;
mod view_plane;
mod web_page;
mod zarr;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use crate::products::{Image, Product, Report, SensorReport};
use provenance::RecipeTexts;

pub use arrays::{ArrayValues, NamedArray, SensorArrays, sensor_arrays};
pub use axes::{AxisCells, AxisColumns, ProductCells};
pub use daily::{DailySums, daily_sums};
pub use dataset::Attribute;
pub use derivatives::{DERIVATIVES, DerivativeTable};
pub(crate) use geotiff::escaped;
pub(crate) use lettering::{Canvas, INK, Letters};
pub use names::folder_name;
pub use partial::clean_up;
pub(crate) use partial::{replace_file, try_file};
pub(crate) use picture::png_bytes;
pub use point_tables::PointTables;
pub use point_warnings::PointWarnings;
pub use provenance::{RecipeRecord, RecordError, read_record};
pub use results::{COEFFICIENTS, Results, ResultsOrigin, Written};
pub use rows::{harmless, number};
pub use run_record::RunRecord;
pub use scale::{are_unlike, axis_title, range_of, tick};
pub use size::{file_size, memory_of_files};
pub use sweep::SweepTable;
pub use table::table;
pub use titles::{product_title, unit_text, value_axis_title};
pub use view_plane::ViewPlane;
pub use web_page::{REPORT, REPORT_HEAD, is_report};

/// Error of writing a report; no part of it is on disk.
#[non_exhaustive]
#[expect(missing_docs, reason = "each variant's message names its fields")]
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("{} is a file: name a folder for the output", path.display())]
    NotAFolder { path: PathBuf },
    #[error("cannot make the folder {}", path.display())]
    Folder { path: PathBuf, source: io::Error },
    #[error("{} is a folder, and a file of that name is to be written: move it, or name another folder for the output", path.display())]
    Taken { path: PathBuf },
    #[error("{} is in the way: a result of that name is to be written, and it is none; move it, or name another folder for the output", path.display())]
    Foreign { path: PathBuf },
    #[error("{} holds results of {found}: name another folder for the output (`--out`), or replace them (`--force`)", path.display())]
    OfAnother { path: PathBuf, found: String },
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read {} again", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("there are no results at {point}, between which derivatives are taken")]
    NoTable { point: String },
    #[error(
        "both sides of `{parameter}` have other products or rows than the scene itself: they have no derivatives; compare values with `sweep: Grid({{ \"{parameter}\": [..] }})`"
    )]
    OtherProducts { parameter: String },
    #[error("cannot read the pixels of {sensor}.{product} from their temporary file")]
    Pixels { sensor: String, product: String, source: io::Error },
    #[error("{sensor}.{product} has {found} {what}, but its axes say {expected}")]
    Shape { sensor: String, product: String, what: &'static str, expected: usize, found: usize },
}

impl OutputError {
    /// Error of reading the pixels of a product.
    fn pixels(source: &Source<'_>) -> impl FnOnce(io::Error) -> Self {
        let (sensor, product) = (source.sensor.to_owned(), source.product.name.clone());
        move |source| Self::Pixels { sensor, product, source }
    }

    /// Returns true if another file or folder has the name of a result.
    fn is_in_the_way(&self) -> bool {
        matches!(self, Self::Taken { .. } | Self::Foreign { .. } | Self::OfAnother { .. })
    }
}

/// Writes all files of `report` into `folder`, which is made if it does not exist, in place of any
/// results that are there; returns their paths, `summary.json` last.
///
/// # Errors
/// If the folder or a file cannot be written, or a product's shape contradicts its axes; then the
/// folder is as it was.
pub fn write(report: &Report, folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    Ok(Results::for_any_scene(folder).write(report)?.files)
}

/// Writes the files of all products; returns the size of those of each sensor in bytes.
fn put_products(
    report: &Report,
    plan: &[names::SensorNames],
    recipe: &RecipeTexts,
    staging: &mut staging::Staging,
) -> Result<Vec<u64>, OutputError> {
    let mut sizes = Vec::with_capacity(plan.len());
    for (sensor, planned) in report.sensors.iter().zip(plan) {
        let (mut size, mut rasters) = (0, Vec::with_capacity(sensor.products.len()));
        for (product, names) in sensor.products.iter().zip(&planned.products) {
            let source = Source { report, sensor: &sensor.name, product, recipe };
            check_shape(&source)?;
            let (written, of_image) = match (&product.faces, &product.image) {
                (Some(faces), _) => {
                    (staging.file(&names.ply(), |file| ply::write(&source, faces, file))?, None)
                }
                (None, None) => {
                    let table = staging.file(&names.csv(), |file| rows::write(&source, file))?;
                    (table + put_chart(&source, &names.svg(), staging)?, None)
                }
                (None, Some(image)) => image_files::put(&source, image, names, staging)?,
            };
            size += written;
            rasters.push(of_image);
        }
        size +=
            dataset_files::put(&OfSensor { report, sensor, recipe }, planned, &rasters, staging)?;
        sizes.push(size);
    }
    Ok(sizes)
}

/// Writes a chart of values by direction or height; returns its size in bytes, 0 without a chart.
fn put_chart(
    source: &Source<'_>,
    name: &str,
    staging: &mut staging::Staging,
) -> Result<u64, OutputError> {
    let Some(lines) = lines::Lines::new(source.product, source.sun()) else { return Ok(0) };
    let heading = chart::Heading {
        title: format!("{}: {}", source.sensor, product_title(&source.product.name)),
        scene: &source.report.scene,
        values: value_axis_title(&source.product.name, &source.product.unit),
        provenance: &source.provenance_json(),
    };
    staging.file(name, |file| file.write_all(chart::draw(&lines, &heading)?.as_bytes()))
}

/// Replaces the contents of a file in one step: it holds the old ones or the new ones, never a part.
///
/// # Errors
/// If it cannot be written.
pub fn replace(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), OutputError> {
    put_file(file, |file| io::Write::write_all(file, contents.as_ref()))
}

/// Writes a file that appears when it is complete; makes its folder if it does not exist.
pub(crate) fn put_file(
    path: &Path,
    fill: impl FnOnce(&mut fs::File) -> io::Result<()>,
) -> Result<(), OutputError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .map_err(|source| OutputError::Folder { path: folder.to_owned(), source })?;
    replace_file(path, fill).map_err(|source| OutputError::Write { path: path.to_owned(), source })
}

/// Tries whether [`write()`] could write into `folder`, and leaves everything as it was.
///
/// # Errors
/// If the folder cannot be made, or no file in it.
pub fn probe(folder: &Path) -> Result<(), OutputError> {
    staging::Staging::open(folder).map(drop)
}

/// A sensor with its provenance.
struct OfSensor<'a> {
    report: &'a Report,
    sensor: &'a SensorReport,
    recipe: &'a RecipeTexts,
}

/// A product with its provenance.
struct Source<'a> {
    report: &'a Report,
    sensor: &'a str,
    product: &'a Product,
    recipe: &'a RecipeTexts,
}

impl Source<'_> {
    /// Returns an error unless a number is the one that the product's axes say.
    fn equal(&self, what: &'static str, expected: usize, found: usize) -> Result<(), OutputError> {
        if expected == found {
            return Ok(());
        }
        let (sensor, product) = (self.sensor.to_owned(), self.product.name.clone());
        Err(OutputError::Shape { sensor, product, what, expected, found })
    }

    /// Zenith angle and azimuth of the sun, if it is above the horizon.
    fn sun(&self) -> Option<tracks::SunAngles> {
        let Report { sun_zenith_deg, sun_azimuth_deg, .. } = self.report;
        Some(tracks::SunAngles { zenith_deg: (*sun_zenith_deg)?, azimuth_deg: (*sun_azimuth_deg)? })
    }

    /// Centre wavelengths of an image's bands, nm; NaN for a band that the report does not list.
    fn wavelengths(&self, image: &Image) -> Vec<f64> {
        let of = |name: &String| {
            let index = self.report.bands.iter().position(|band| band == name)?;
            self.report.wavelengths.get(index).copied()
        };
        image.bands.iter().map(|name| of(name).unwrap_or(f64::NAN)).collect()
    }
}

/// Checks the shape of all values but pixels, which are checked when they are read.
fn check_shape(source: &Source<'_>) -> Result<(), OutputError> {
    let product = source.product;
    for dimension in &product.dimensions {
        let points = length(dimension);
        for axis in dimension {
            source.equal("points on parallel axes", points, axis.points.len())?;
        }
    }
    let values = product.dimensions.iter().map(|dimension| length(dimension)).product();
    source.equal("values", values, product.values.len())?;
    source.equal("standard errors", values, product.standard_error.len())?;
    if let Some(faces) = &product.faces {
        let values = faces.inventory.faces().count() * faces.bands.len();
        source.equal("values of faces", values, faces.values.len())?;
        source.equal("standard errors of faces", values, faces.standard_error.len())?;
    }
    match &product.image {
        Some(image) if image.width * image.height * image.bands.len() == 0 => {
            source.equal("pixels and bands at least", 1, 0)
        }
        _ => Ok(()),
    }
}

/// Points along a dimension.
fn length(dimension: &[crate::products::ProductAxis]) -> usize {
    dimension.first().map_or(1, |axis| axis.points.len())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;
