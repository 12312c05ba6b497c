use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use super::{Faces, Image, Recipe};
use crate::components::Projection;
use crate::document::{FileFormat, Param};
use crate::spectral::BandResponse;

/// One axis of a product's values.
#[derive(Clone, Debug, PartialEq)]
pub struct ProductAxis {
    /// Quantity that varies along the axis, with its unit as suffix: `zenith_deg`, `band`.
    pub name: String,
    /// Positions of its points.
    pub points: AxisPoints,
}

/// Points of an axis.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisPoints {
    /// Numbers, in the unit that the axis' name ends in.
    Numbers(Vec<f64>),
    /// Names.
    Labels(Vec<String>),
}

impl AxisPoints {
    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Labels(labels) => labels.len(),
        }
    }

    /// Returns true if there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A measured quantity.
///
/// Several axes may run along the same dimension (zenith and azimuth of a list of views): each entry
/// of `dimensions` is one dimension with its axes, slowest first, bands last.
#[derive(Clone, Debug, PartialEq)]
pub struct Product {
    /// Name in the field's terms: `brf`, `albedo`.
    pub name: String,
    /// Unit; `1` for a fraction.
    pub unit: String,
    /// Dimensions, slowest first; the last is `band` (or the terms of an energy balance).
    pub dimensions: Vec<Vec<ProductAxis>>,
    /// Values in the order of `dimensions`; of an image, its mean, shape `[bands]`.
    pub values: Vec<f64>,
    /// Standard error of each value; NaN where there is none.
    pub standard_error: Vec<f64>,
    /// Value of each randomisation, shape `[randomisations, values]`: their spread is the error, and their mean is the
    /// value, of a temperature but for its curvature. Empty unless they are asked for
    /// ([`Options::keeps_replicates`](crate::run::Options::keeps_replicates)), and of what is not made of light.
    pub replicates: Vec<f64>,
    /// Pixels, where the quantity is an image.
    pub image: Option<Image>,
    /// Values of triangles and discs, where the quantity is one of theirs; `values` are the mean.
    pub faces: Option<Faces>,
}

/// All that one sensor measured.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorReport {
    /// The sensor's name in the scene.
    pub name: String,
    /// Products of the sensor.
    pub products: Vec<Product>,
    /// Wall time, s.
    pub seconds: f64,
    /// Rays traced.
    pub rays: u64,
    /// Paths or photon packets traced.
    pub samples: u64,
    /// Criterion that ended the measurement: `brf: median relative standard error 4.8e-3 at most 5.0e-3`.
    pub ended_by: String,
    /// Largest fraction of the incident energy of photon packets that is neither reflected, lost, absorbed nor
    /// ended by roulette: the rounding of f64.
    pub energy_imbalance: Option<f64>,
    /// Estimate from the first samples, or the actual cost if the measurement ended with them.
    pub forecast: Forecast,
}

/// Time, memory and file sizes of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Wall time of the measurement, s.
    pub seconds: f64,
    /// Memory of its films and products at most, bytes.
    pub memory: u64,
    /// Size of its files, bytes.
    pub files: u64,
}

impl Forecast {
    /// Returns true if it takes longer than 10 s.
    #[must_use]
    pub fn is_long(&self) -> bool {
        self.seconds > 10.0
    }
}

impl fmt::Display for Forecast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seconds, memory, files, .. } = *self;
        let time = match seconds {
            ..1.0 => "less than a second".to_owned(),
            1.0..120.0 => format!("about {seconds:.0} s"),
            120.0..7200.0 => format!("about {:.0} min", seconds / 60.0),
            7200.0..172_800.0 => format!("about {:.0} h", seconds / 3600.0),
            _ => format!("about {:.0} days", seconds / 86_400.0),
        };
        let [memory, files] = [memory, files].map(data_size);
        write!(f, "{time}, {memory} of memory, {files} of files")
    }
}

/// A number of bytes with a unit: `1.5 GiB`.
#[must_use]
pub fn data_size(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let power = (bytes.max(1).ilog2() as usize / 10).min(UNITS.len() - 1);
    let size = bytes as f64 / 1024_f64.powi(power as i32);
    let digits = usize::from(power > 0);
    format!("{size:.digits$} {}", UNITS[power])
}

/// Results of a run with their provenance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Projection of eastings and northings, if the terrain's raster names one.
    pub projection: Option<Projection>,
    /// Title of the scene.
    pub scene: String,
    /// File formats of its images.
    pub formats: Vec<FileFormat>,
    /// Hash of the resolved scene and of all files that it reads, hexadecimal.
    pub hash: String,
    /// Version of sunfleck.
    pub version: String,
    /// Seed of all random streams.
    pub seed: u64,
    /// Wall time, s.
    pub seconds: f64,
    /// Rays traced.
    pub rays: u64,
    /// The bands' names.
    pub bands: Vec<String>,
    /// The bands' centre wavelengths, nm.
    pub wavelengths: Vec<f64>,
    /// The bands' widths, nm.
    pub bandwidths: Vec<f64>,
    /// Total irradiance on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`; empty without results.
    pub irradiance: Vec<f64>,
    /// Responses of the bands, shape `[bands]`; empty without results.
    pub responses: Vec<BandResponse>,
    /// Wall time of each stage, s.
    pub stages: Vec<(String, f64)>,
    /// Steps that the scene did not need and that were skipped.
    pub skipped: Vec<String>,
    /// Values that were assumed without a key in the scene, and contents of files that were left out.
    pub notes: Vec<String>,
    /// Warnings, such as dropped faces.
    pub warnings: Vec<String>,
    /// Results of each sensor, in document order.
    pub sensors: Vec<SensorReport>,
    /// Values of the scene's parameters.
    pub params: Vec<(String, Param)>,
    /// Azimuth of the sun, degrees clockwise from north, if there is one.
    pub sun_azimuth_deg: Option<f64>,
    /// Zenith angle of the sun, degrees, if it is above the horizon.
    pub sun_zenith_deg: Option<f64>,
    /// File that the scene was read from; `None` for a scene that was built.
    pub source: Option<SceneSource>,
    /// Coefficients of products of spectra, as a file that `respectrum` reads, if the run kept some.
    pub coefficients: Option<Arc<Vec<u8>>>,
    /// All that repeats the run; `None` for results of several runs.
    pub recipe: Option<Arc<Recipe>>,
}

/// File that a scene was read from, and what was changed in it.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSource {
    /// The file.
    pub file: PathBuf,
    /// Variant that was applied.
    pub variant: Option<String>,
    /// Parameters with other values than in the scene.
    pub set: Vec<(String, Param)>,
    /// Factor on the numbers of samples.
    pub quality: f64,
}

/// A point of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPoint {
    /// The swept parameters and their values.
    pub params: Vec<(String, Param)>,
    /// Hash of all that decides the results: the scene as it is at this point, the content of every
    /// file that it names, the number of samples and this version of sunfleck. Hexadecimal.
    pub key: String,
    /// Consequence of a sun below the horizon, where it is.
    pub night: Option<Night>,
}

/// Consequence of a sun below the horizon at a point of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Night {
    /// Nothing else gives light: nothing is traced, for this reason.
    Dark(String),
    /// Other light is left: the scene is traced without the sun, with this warning.
    WithoutSun(String),
}

impl Night {
    /// The reason or the warning.
    #[must_use]
    pub fn text(&self) -> &str {
        match self {
            Self::Dark(text) | Self::WithoutSun(text) => text,
        }
    }
}

/// Weights of the points of a sweep for integrals over the hours of one day.
///
/// The integral of a value over time is the sum of value times weight: the trapezoidal rule, in which
/// points without any light count as 0, and which ends at sunrise and sunset beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct Day {
    /// The swept parameters that do not move the sun's clock, and their values.
    pub params: Vec<(String, Param)>,
    /// First and last hour of the sun's clock, h.
    pub span_h: (f64, f64),
    /// Place of each point that was traced in the list of all points, with its weight, h.
    pub weights_h: Vec<(usize, f64)>,
}

/// Points of a sweep at both sides of a parameter, for derivatives of results with respect to it.
#[derive(Clone, Debug, PartialEq)]
pub struct CentralDifference {
    /// The parameter.
    pub parameter: String,
    /// Its value in the scene.
    pub at: f64,
    /// Distance of both sides from it.
    pub step: f64,
    /// Its values at the two points.
    pub sides: [f64; 2],
    /// Places of these points in the list of all; the scene as it is has place 0.
    pub points: [usize; 2],
}

impl SweepPoint {
    /// Reason why nothing was traced here.
    #[must_use]
    pub fn darkness(&self) -> Option<&str> {
        match &self.night {
            Some(Night::Dark(why)) => Some(why),
            Some(Night::WithoutSun(_)) | None => None,
        }
    }
}

impl SweepPoint {
    /// Text of the parameters: `sza=30,lai=2`.
    #[must_use]
    pub fn name(&self) -> String {
        let params: Vec<_> =
            self.params.iter().map(|(name, value)| format!("{name}={value}")).collect();
        params.join(",")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_forecast_has_units_that_fit() {
        let of = |seconds, memory, files| Forecast { seconds, memory, files }.to_string();
        assert_eq!(of(0.4, 0, 1), "less than a second, 0 B of memory, 1 B of files");
        assert_eq!(of(12.4, 3 << 29, 2048), "about 12 s, 1.5 GiB of memory, 2.0 KiB of files");
        assert_eq!(of(600.0, 5 << 20, 12), "about 10 min, 5.0 MiB of memory, 12 B of files");
        assert_eq!(of(7200.0, 0, 1023), "about 2 h, 0 B of memory, 1023 B of files");
        assert_eq!(
            of(1e6, u64::MAX, 1024),
            "about 12 days, 16777216.0 TiB of memory, 1.0 KiB of files"
        );
    }
}
