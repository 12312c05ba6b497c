//! Data sets of a sensor: a Zarr store, a `NetCDF` file.

use std::io;

use super::dataset::{ImageFiles, of_sensor};
use super::names::SensorNames;
use super::staging::Staging;
use super::{OfSensor, OutputError, netcdf, zarr};
use crate::document::FileFormat;

/// Writes the data sets that are asked for; returns their size in bytes.
///
/// - `files`: files of each product, if it is an image
pub(super) fn put(
    measured: &OfSensor<'_>,
    planned: &SensorNames,
    files: &[Option<ImageFiles>],
    staging: &mut Staging,
) -> Result<u64, OutputError> {
    let mut size = 0;
    let asked =
        FileFormat::ALL.into_iter().filter(|format| measured.report.formats.contains(format));
    for format in asked {
        let Some(name) = planned.dataset(format) else { continue };
        let fail = |source: io::Error| OutputError::Write { path: staging.shown(&name), source };
        let rasters =
            |files: &Option<ImageFiles>| files.as_ref().map(ImageFiles::rasters).transpose();
        let rasters = files.iter().map(rasters).collect::<io::Result<_>>().map_err(fail)?;
        let dataset = of_sensor(measured, planned, rasters).map_err(fail)?;
        size += if format == FileFormat::Zarr {
            let folder = staging.folder(&name)?;
            let fail = |source| OutputError::Write { path: staging.shown(&name), source };
            zarr::write(&dataset, &folder).map_err(fail)?
        } else {
            staging.file(&name, |file| netcdf::write(&dataset, file))?
        };
    }
    Ok(size)
}
