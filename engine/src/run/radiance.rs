//! Radiance images that were written before, of sunfleck or of LESS, to reflectance factors and temperatures.

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::assets::{AssetError, BandRaster, RasterBand, read_bands};
use crate::counts::counted;
use crate::document::{FileFormat, THERMAL_NM, nearest};
use crate::output::RunRecord;
use crate::products::{
    Forecast, Georeference, PixelRows, Product, RadianceImage, Report, SensorReport,
    brf_of_radiance, temperature_of_radiance,
};
use crate::spectral::{BandResponse, BandWindow};

/// Quantity that radiance is converted to.
#[derive(Clone, Debug, PartialEq)]
pub enum RadianceQuantity {
    /// Bidirectional reflectance factor.
    Brf {
        /// Irradiance of each band on the horizontal plane, W m⁻² nm⁻¹, in place of that of the run.
        irradiance: Option<Vec<f64>>,
    },
    /// Brightness temperature.
    BrightnessTemperature {
        /// Windows of all bands, in place of the responses of the run.
        bands: Option<Vec<BandWindow>>,
    },
}

/// Reason why a file is not converted.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum RadianceError {
    #[error(transparent)]
    Asset(#[from] AssetError),
    #[error(
        "{}: holds {product} in the unit {unit:?}, and no radiance in W m-2 sr-1 nm-1; measure `Radiance` and name its image",
        file.display()
    )]
    NotRadiance { file: PathBuf, product: String, unit: String },
    #[error(
        "{}: does not say its unit, as an image of sunfleck does: if it is radiance in W m⁻² sr⁻¹ nm⁻¹, write {option}",
        file.display()
    )]
    NoUnit { file: PathBuf, option: &'static str },
    #[error(
        "{}: has {}, and {option} has {}; write one for each band: {names}",
        file.display(),
        counted(.found, "band"),
        counted(.given, "value")
    )]
    Count { file: PathBuf, found: usize, given: usize, option: &'static str, names: String },
    #[error(
        "{}: there is no `summary.json` beside it that says the {what} of band `{band}`{near}; write {option}",
        file.display()
    )]
    Unknown { file: PathBuf, what: &'static str, band: String, near: String, option: &'static str },
    #[error("{}: no band lies beyond 3000 nm, where surfaces emit: {names}", file.display())]
    NotThermal { file: PathBuf, names: String },
    #[error("{}: has {found} x {wide} pixels, and its image {columns} x {rows}", file.display())]
    ErrorsOfAnother { file: PathBuf, wide: usize, found: usize, columns: usize, rows: usize },
    #[error("name a file")]
    NoFiles,
}

/// Unit of radiance in files.
const RADIANCE: &str = "W m-2 sr-1 nm-1";

/// Ending of the name of an EXR channel of standard errors.
const ERROR_CHANNEL: &str = ".se";

/// Ending of the names of files and bands of standard errors.
const ERRORS: &str = "_se";

const IRRADIANCE_OPTION: &str =
    "the irradiance of each band on the horizontal plane, W m⁻² nm⁻¹: --irradiance 1.2,0.9";
const BAND_OPTION: &str = "centre and width of each band, nm: --band 10500:1000,12000:1000";

/// Converts radiance images; each becomes a sensor of the report.
///
/// Images of sunfleck (ENVI, `GeoTIFF`, EXR) bring their standard errors, and the irradiance and the responses of their
/// bands from `summary.json` beside them. Other images, such as those of LESS, need them from `quantity`; there, values below 0
/// are no data.
///
/// # Errors
/// The first file that cannot be read, is no radiance, or lacks irradiance or wavelengths.
pub fn convert_radiance(
    files: &[PathBuf],
    quantity: &RadianceQuantity,
    formats: &[FileFormat],
) -> Result<Report, RadianceError> {
    let start = Instant::now();
    let first = files.first().ok_or(RadianceError::NoFiles)?;
    let mut report = Report {
        formats: formats.to_vec(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        ..Report::default()
    };
    for file in files {
        let image = SourceImage::read(file, quantity)?;
        if file == first {
            image.describe(&mut report);
        }
        for (name, nm) in image.radiance.bands.iter().zip(&image.wavelengths) {
            if !report.bands.contains(name) {
                report.bands.push(name.clone());
                report.wavelengths.push(*nm);
            }
        }
        let product = image.converted(file, quantity)?;
        report.sensors.push(sensor(file, product));
    }
    report.seconds = start.elapsed().as_secs_f64();
    Ok(report)
}

fn sensor(file: &Path, product: Product) -> SensorReport {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let stem = stem.strip_suffix(".img").unwrap_or(&stem);
    SensorReport {
        name: stem.strip_suffix("_radiance").unwrap_or(stem).to_owned(),
        products: vec![product],
        seconds: 0.0,
        rays: 0,
        samples: 0,
        ended_by: "converted".to_owned(),
        energy_imbalance: None,
        forecast: Forecast { seconds: 0.0, memory: 0, files: 0 },
    }
}

/// A radiance image with what is known about it.
struct SourceImage {
    radiance: RadianceImage,
    /// Centre wavelengths, nm; NaN where unknown.
    wavelengths: Vec<f64>,
    /// The run that it is of.
    record: Option<RunRecord>,
    provenance: String,
    projection: Option<crate::components::Projection>,
}

impl SourceImage {
    fn read(file: &Path, quantity: &RadianceQuantity) -> Result<Self, RadianceError> {
        let mut raster = read_bands(file)?;
        let provenance = std::mem::take(&mut raster.description);
        check_unit(file, &provenance, quantity)?;
        let (mut bands, errors) = with_errors(file, &mut raster)?;
        let (columns, rows) = (raster.columns, raster.rows);
        let record = file.parent().and_then(RunRecord::read);
        if let Some(record) = &record {
            // EXR sorts channels by name.
            let place = |band: &RasterBand| record.bands.iter().position(|name| *name == band.name);
            bands.sort_by_key(|band| place(band).unwrap_or(usize::MAX));
        }
        let known = |band: &RasterBand| {
            let place = record.as_ref()?.bands.iter().position(|name| *name == band.name)?;
            record.as_ref()?.wavelengths_nm.get(place).copied()
        };
        let wavelengths = bands
            .iter()
            .map(|band| known(band).or(band.wavelength_nm).unwrap_or(f64::NAN))
            .collect();
        let pixels = pixels(&bands, &errors, columns * rows, columns);
        let place = raster.place.as_ref();
        let georeference = place.map(|place| Georeference {
            west: place.corner.x,
            north: place.corner.y + rows as f64 * place.cell.y,
            pixel_width: place.cell.x,
            pixel_height: place.cell.y,
        });
        let projection = place.and_then(|place| place.projection.clone());
        let names = bands.into_iter().map(|band| band.name).collect();
        let radiance =
            RadianceImage { width: columns, height: rows, bands: names, pixels, georeference };
        Ok(Self { radiance, wavelengths, record, provenance, projection })
    }

    /// Tells the report about the run.
    fn describe(&self, report: &mut Report) {
        report.projection.clone_from(&self.projection);
        report.scene = entry(&self.provenance, "scene").unwrap_or_default();
        report.hash = entry(&self.provenance, "hash").unwrap_or_default();
        report.seed =
            entry(&self.provenance, "seed").and_then(|seed| seed.parse().ok()).unwrap_or_default();
    }

    fn converted(
        &self,
        file: &Path,
        quantity: &RadianceQuantity,
    ) -> Result<Product, RadianceError> {
        match quantity {
            RadianceQuantity::Brf { irradiance } => {
                let irradiance = match irradiance {
                    Some(given) => self.counted(file, given, "--irradiance")?,
                    None => self.recorded(file, "irradiance", IRRADIANCE_OPTION, |record| {
                        &record.irradiance
                    })?,
                };
                Ok(brf_of_radiance(&self.radiance, &irradiance))
            }
            RadianceQuantity::BrightnessTemperature { bands } => {
                let responses: Vec<BandResponse> = match bands {
                    Some(given) => {
                        let given = self.counted(file, given, "--band")?;
                        given.into_iter().map(BandResponse::Window).collect()
                    }
                    None => {
                        self.recorded(file, "response", BAND_OPTION, |record| &record.responses)?
                    }
                };
                let thermal = responses.into_iter().enumerate();
                let thermal: Vec<(usize, BandResponse)> =
                    thermal.filter(|(_, response)| response.center() > THERMAL_NM).collect();
                if thermal.is_empty() {
                    let names = self.radiance.bands.join(", ");
                    return Err(RadianceError::NotThermal { file: file.to_owned(), names });
                }
                Ok(temperature_of_radiance(&self.radiance, &thermal))
            }
        }
    }

    /// Values of the command line, one for each band.
    fn counted<T: Clone>(
        &self,
        file: &Path,
        given: &[T],
        option: &'static str,
    ) -> Result<Vec<T>, RadianceError> {
        let found = self.radiance.bands.len();
        if given.len() == found {
            return Ok(given.to_vec());
        }
        let names = self.radiance.bands.join(", ");
        Err(RadianceError::Count {
            file: file.to_owned(),
            found,
            given: given.len(),
            option,
            names,
        })
    }

    /// Values of the run, one for each band.
    fn recorded<T: Clone>(
        &self,
        file: &Path,
        what: &'static str,
        option: &'static str,
        values: impl Fn(&RunRecord) -> &Vec<T>,
    ) -> Result<Vec<T>, RadianceError> {
        let of_band = |band: &String| {
            let value = self.record.as_ref().and_then(|record| {
                let place = record.bands.iter().position(|name| name == band)?;
                values(record).get(place).cloned()
            });
            value.ok_or_else(|| {
                let names = self.record.iter().flat_map(|record| &record.bands);
                let near = nearest(band, names.map(String::as_str));
                RadianceError::Unknown {
                    file: file.to_owned(),
                    what,
                    band: band.clone(),
                    near: near.map_or_else(String::new, |near| format!(" (it knows `{near}`)")),
                    option,
                }
            })
        };
        self.radiance.bands.iter().map(of_band).collect()
    }
}

/// Refuses what is no radiance, or says no unit and is not described by the command line.
fn check_unit(
    file: &Path,
    provenance: &str,
    quantity: &RadianceQuantity,
) -> Result<(), RadianceError> {
    let (is_described, option) = match quantity {
        RadianceQuantity::Brf { irradiance } => (irradiance.is_some(), IRRADIANCE_OPTION),
        RadianceQuantity::BrightnessTemperature { bands } => (bands.is_some(), BAND_OPTION),
    };
    let file = file.to_owned();
    match entry(provenance, "unit") {
        Some(unit) if unit == RADIANCE => Ok(()),
        Some(unit) => {
            let product = entry(provenance, "product").unwrap_or_else(|| "values".to_owned());
            Err(RadianceError::NotRadiance { file, product, unit })
        }
        None if is_described => Ok(()),
        None => Err(RadianceError::NoUnit { file, option }),
    }
}

/// Value of a key of the provenance: of `key: value; key: value`, or of JSON.
fn entry(provenance: &str, key: &str) -> Option<String> {
    if let Ok(serde_json::Value::Object(all)) = serde_json::from_str(provenance) {
        return all.get(key)?.as_str().map(str::to_owned);
    }
    let items = provenance.split("; ");
    // A title may hold anything; sunfleck's own keys stand behind it.
    let found = items.filter_map(|item| item.strip_prefix(key)?.strip_prefix(": "));
    found.last().map(|value| value.trim().to_owned())
}

/// Bands of radiance, and those of errors and coverage: of the same file, or of that beside it.
fn with_errors(
    file: &Path,
    raster: &mut BandRaster,
) -> Result<(Vec<RasterBand>, Vec<RasterBand>), RadianceError> {
    let bands = std::mem::take(&mut raster.bands);
    let is_error = |band: &RasterBand| {
        band.name.strip_suffix(ERROR_CHANNEL).is_some() || band.name == "coverage"
    };
    let (errors, values): (Vec<_>, Vec<_>) = bands.into_iter().partition(is_error);
    if !errors.is_empty() {
        return Ok((values, errors));
    }
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let ending = file.extension().unwrap_or_default().to_string_lossy();
    let beside = file.with_file_name(format!("{stem}{ERRORS}.{ending}"));
    if !beside.is_file() {
        return Ok((values, Vec::new()));
    }
    let found = read_bands(&beside)?;
    let (columns, rows) = (raster.columns, raster.rows);
    if (found.columns, found.rows) != (columns, rows) {
        let (wide, found) = (found.rows, found.columns);
        return Err(RadianceError::ErrorsOfAnother { file: beside, wide, found, columns, rows });
    }
    Ok((values, found.bands))
}

/// Pixels of some bands; radiance below 0 is no data, as in images of LESS.
fn pixels(bands: &[RasterBand], errors: &[RasterBand], count: usize, width: usize) -> PixelRows {
    let error_of = |band: &RasterBand| {
        let names = [format!("{}{ERROR_CHANNEL}", band.name), format!("{}{ERRORS}", band.name)];
        errors.iter().find(|error| names.contains(&error.name))
    };
    let errors_of: Vec<Option<&RasterBand>> = bands.iter().map(error_of).collect();
    let coverage = errors.iter().find(|band| band.name == "coverage");
    let mut pixels = PixelRows { width, ..PixelRows::default() };
    for pixel in 0..count {
        let values = bands.iter().map(|band| band.values[pixel]);
        let values = values.map(|value| if value < 0.0 { f32::NAN } else { value });
        pixels.values.extend(values);
        let errors = errors_of.iter().map(|band| band.map_or(f32::NAN, |band| band.values[pixel]));
        pixels.standard_error.extend(errors);
        let known = pixels.values[pixel * bands.len()..].iter().any(|value| !value.is_nan());
        let covered = coverage.map_or(f32::from(u8::from(known)), |band| band.values[pixel]);
        pixels.coverage.push(covered);
    }
    pixels
}
