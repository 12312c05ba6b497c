//! Files of a run, with provenance; the only module that writes.
//!
//! A folder gets `summary.json`, for each image an EXR, an ENVI pair and a PNG quicklook, for
//! values of triangles a PLY, and for each other product a CSV. Nothing appears under its final name before all of it is complete.

mod colour;
mod envi;
mod exr;
mod names;
mod picture;
mod ply;
mod rows;
mod size;
mod staging;
mod summary;
mod sweep;
mod table;

use std::io;
use std::path::{Path, PathBuf};

use crate::products::{Image, Product, Report};

pub use picture::Picture;
pub use rows::number;
pub use size::file_size;
pub use sweep::{is_complete, place, write_point, write_sweep};
pub use table::table;

/// Why a report is not on disk. Nothing of it is, then.
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
    #[error("cannot write {}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read {} again", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{sensor}.{product} has {found} {what}, but its axes say {expected}")]
    Shape { sensor: String, product: String, what: &'static str, expected: usize, found: usize },
}

/// Writes all files of `report` into `folder`, which is made if it does not exist; returns their
/// paths, `summary.json` last. Files of the same names are replaced.
///
/// # Errors
/// If the folder or a file cannot be written, or a product's shape contradicts its axes; then no
/// file of this report is left.
pub fn write(report: &Report, folder: &Path) -> Result<Vec<PathBuf>, OutputError> {
    for sensor in &report.sensors {
        for product in &sensor.products {
            check_shape(&sensor.name, product)?;
        }
    }
    let plan = names::plan(report);
    let mut staging = staging::Staging::open(folder)?;
    let mut sizes = Vec::with_capacity(plan.len());
    for (sensor, planned) in report.sensors.iter().zip(&plan) {
        let mut size = 0;
        for (product, names) in sensor.products.iter().zip(&planned.products) {
            let source = Source { report, sensor: &sensor.name, product };
            size += match (&product.faces, &product.image) {
                (Some(faces), _) => {
                    staging.file(&names.ply(), |file| ply::write(&source, faces, file))?
                }
                (None, None) => staging.file(&names.csv(), |file| rows::write(&source, file))?,
                (None, Some(image)) => {
                    let [exr, img, hdr, png] = names.image();
                    staging.file(&exr, |file| exr::write(&source, image, file))?
                        + staging.file(&img, |file| envi::write_pixels(image, file))?
                        + staging.file(&hdr, |file| envi::write_header(&source, image, file))?
                        + staging.file(&png, |file| {
                            let picture = Picture::of(image, &source.wavelengths(image));
                            picture.encode(&source.provenance(), file)
                        })?
                }
            };
        }
        sizes.push(size);
    }
    staging.file("summary.json", |file| summary::write(report, (&plan, &sizes), file))?;
    staging.commit()
}

/// Gives a file another text; it has the old one or the new one, never a part.
///
/// # Errors
/// If it cannot be written.
pub fn replace(file: &Path, text: &str) -> Result<(), OutputError> {
    // What a link leads to, not the link.
    let file = &file.canonicalize().unwrap_or_else(|_not_there| file.to_owned());
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let mut staging = staging::Staging::open(file.parent().unwrap_or(Path::new("")))?;
    staging.file(&name, |file| io::Write::write_all(file, text.as_bytes()))?;
    staging.commit().map(drop)
}

/// Tries whether [`write()`] could write into `folder`, and leaves everything as it was.
///
/// # Errors
/// If the folder cannot be made, or no file in it.
pub fn probe(folder: &Path) -> Result<(), OutputError> {
    staging::Staging::open(folder)?.file("summary.json", |_| Ok(())).map(drop)
}

/// A product and what tells where it comes from.
struct Source<'a> {
    report: &'a Report,
    sensor: &'a str,
    product: &'a Product,
}

impl Source<'_> {
    /// Keys and values that stand in every file.
    fn provenance(&self) -> [(&'static str, String); 7] {
        // A line break in a title must not end a comment line.
        let line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        [
            ("scene", line(&self.report.scene)),
            ("hash", line(&self.report.hash)),
            ("version", line(&self.report.version)),
            ("seed", self.report.seed.to_string()),
            ("sensor", line(self.sensor)),
            ("product", line(&self.product.name)),
            ("unit", line(&self.product.unit)),
        ]
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

fn check_shape(sensor: &str, product: &Product) -> Result<(), OutputError> {
    let equal = |what, expected, found| {
        if expected == found {
            return Ok(());
        }
        let (sensor, product) = (sensor.to_owned(), product.name.clone());
        Err(OutputError::Shape { sensor, product, what, expected, found })
    };
    for dimension in &product.dimensions {
        let points = length(dimension);
        for axis in dimension {
            equal("points on parallel axes", points, axis.points.len())?;
        }
    }
    let values = product.dimensions.iter().map(|dimension| length(dimension)).product();
    equal("values", values, product.values.len())?;
    equal("standard errors", values, product.standard_error.len())?;
    if let Some(faces) = &product.faces {
        let values = faces.inventory.faces().count() * faces.bands.len();
        equal("values of faces", values, faces.values.len())?;
        equal("standard errors of faces", values, faces.standard_error.len())?;
    }
    let Some(image) = &product.image else { return Ok(()) };
    let pixels = image.width * image.height;
    let samples = pixels * image.bands.len();
    if samples == 0 {
        equal("pixels and bands at least", 1, 0)?;
    }
    equal("image values", samples, image.values.len())?;
    equal("image standard errors", samples, image.standard_error.len())?;
    equal("image coverages", pixels, image.coverage.len())
}

/// Points along a dimension.
fn length(dimension: &[crate::products::Axis]) -> usize {
    dimension.first().map_or(1, |axis| axis.points.len())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;
