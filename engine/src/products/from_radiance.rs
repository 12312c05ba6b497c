//! Reflectance factors and brightness temperatures of radiance that was measured before.

use std::f64::consts::PI;

use super::context::labels;
use super::{Georeference, Image, PixelRows, Product, Rendering};
use crate::spectral::{BandResponse, brightness_temperature, planck_mean_slope};

/// Radiance image with its standard errors.
#[derive(Clone, Debug, PartialEq)]
pub struct RadianceImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Names of the bands.
    pub bands: Vec<String>,
    /// Radiance, W m⁻² sr⁻¹ nm⁻¹, its standard errors, and coverage; shape `[rows, width, bands]`.
    pub pixels: PixelRows,
    /// Position of the pixels on the ground, if it is known.
    pub georeference: Option<Georeference>,
}

/// Value of a quantity, and its derivative by radiance.
struct Converted {
    value: f64,
    slope: f64,
}

/// Bidirectional reflectance factor `π L / E` of radiance, with standard errors `π σ / E`; NaN where `E` is 0. Under
/// light of the sky it is the HDRF.
///
/// - `irradiance`: `E` on the horizontal plane, W m⁻² nm⁻¹, shape `[bands]`
#[must_use]
pub fn brf_of_radiance(radiance: &RadianceImage, irradiance: &[f64]) -> Product {
    let convert = |band: usize, radiance: f64| {
        // A band without light has no reflectance factor.
        let slope = if irradiance[band] > 0.0 { PI / irradiance[band] } else { f64::NAN };
        Converted { value: radiance * slope, slope }
    };
    let all: Vec<usize> = (0..radiance.bands.len()).collect();
    converted(radiance, &all, ("brf", "1"), convert)
}

/// Brightness temperature of radiance, K: that of the black body with the same mean radiance over the band; standard
/// errors are `σ / (dB/dT)`.
///
/// - `bands`: places of the bands that are converted, with their responses
///
/// # Panics
/// If a place is none of a band.
#[must_use]
pub fn temperature_of_radiance(
    radiance: &RadianceImage,
    bands: &[(usize, BandResponse)],
) -> Product {
    let convert = |band: usize, radiance: f64| {
        let response = &bands.iter().find(|one| one.0 == band).expect("bands are among these").1;
        let value = brightness_temperature(response, radiance);
        Converted { value, slope: 1.0 / planck_mean_slope(response, value) }
    };
    let places: Vec<usize> = bands.iter().map(|band| band.0).collect();
    converted(radiance, &places, ("brightness_temperature", "K"), convert)
}

/// Image of a function of radiance in some bands; its mean is the function of the mean radiance of all pixels with data.
fn converted(
    radiance: &RadianceImage,
    bands: &[usize],
    (name, unit): (&str, &str),
    convert: impl Fn(usize, f64) -> Converted,
) -> Product {
    let PixelRows { width, values, standard_error, coverage } = &radiance.pixels;
    let all = radiance.bands.len();
    let pixels = || values.chunks_exact(all).zip(standard_error.chunks_exact(all));
    let mut shown = PixelRows { width: *width, coverage: coverage.clone(), ..PixelRows::default() };
    for (values, errors) in pixels() {
        for &band in bands {
            let Converted { value, slope } = convert(band, values[band].into());
            shown.values.push(value as f32);
            shown.standard_error.push((f64::from(errors[band]) * slope) as f32);
        }
    }
    let mean = |band: usize| {
        let known = pixels().map(|(values, errors)| (values[band], errors[band]));
        let known = known.filter(|(value, _)| !value.is_nan());
        let (mut sum, mut variance, mut count) = (0.0, 0.0, 0.0);
        for (value, error) in known {
            sum += f64::from(value);
            variance += f64::from(error).powi(2);
            count += 1.0;
        }
        let Converted { value, slope } = convert(band, sum / count);
        (value, variance.sqrt() / count * slope)
    };
    let (means, mean_errors) = bands.iter().map(|&band| mean(band)).unzip();
    let names: Vec<String> = bands.iter().map(|&band| radiance.bands[band].clone()).collect();
    Product {
        name: name.to_owned(),
        unit: unit.to_owned(),
        dimensions: vec![vec![labels("band", &names)]],
        values: means,
        standard_error: mean_errors,
        image: Some(Image {
            width: radiance.width,
            height: radiance.height,
            bands: names,
            pixels: shown.into(),
            has_errors: true,
            rendering: Rendering::Quicklook,
            georeference: radiance.georeference,
        }),
        faces: None,
        replicates: Vec::new(),
    }
}
