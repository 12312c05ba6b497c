use std::f64::consts::FRAC_1_PI;

use glam::DVec2;

use super::{Context, Georeference, Image, Product, Rendering, reflectance};
use crate::components::{ImageMeasure, ImageSensor, Optics, Picture};
use crate::extract::Stage;
use crate::transport::{ImageOutcome, Part, footprint};

/// The products of an image measurement that are made of light.
#[must_use]
pub fn of_image(
    sensor: &ImageSensor,
    outcome: &ImageOutcome,
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let place = georeference(sensor, stage, context);
    let of = |name: (&str, &str), spectrum, scale| {
        image(name, sensor, (outcome, spectrum), (context, place), scale)
    };
    sensor
        .measure
        .iter()
        .flat_map(|measure| match measure {
            ImageMeasure::Radiance => {
                vec![of(("radiance", "W m-2 sr-1 nm-1"), 0, reflectance::radiance)]
            }
            ImageMeasure::Brf => vec![of((context.factor(), "1"), 0, reflectance::brf)],
            ImageMeasure::Orders => Part::ALL
                .iter()
                .zip(1..)
                .map(|(part, spectrum)| {
                    let name = format!("{}_{}", context.factor(), part.suffix());
                    of((&name, "1"), spectrum, reflectance::brf)
                })
                .collect(),
            ImageMeasure::FourComponents | ImageMeasure::GapFraction => Vec::new(),
        })
        .collect()
}

fn image(
    name: (&str, &str),
    sensor: &ImageSensor,
    (outcome, spectrum): (&ImageOutcome, usize),
    (context, georeference): (&Context, Option<Georeference>),
    scale: fn(&[f64], &[f64]) -> Vec<f64>,
) -> Product {
    // Of one pixel at a time: an image is large, and f64 is needed only in between.
    let bands = context.bands.len();
    let of_spectrum = spectrum * bands..(spectrum + 1) * bands;
    let scaled = |pixels: &[f32]| -> Vec<f32> {
        pixels
            .chunks_exact(outcome.mean.len())
            .flat_map(|pixel| {
                let pixel: Vec<f64> =
                    pixel[of_spectrum.clone()].iter().map(|&value| f64::from(value)).collect();
                scale(&pixel, &context.irradiance)
            })
            .map(|value| value as f32)
            .collect()
    };
    // `π L / E` of a white Lambertian surface on the horizontal is 1.
    let white = scale(&vec![FRAC_1_PI; bands], &context.irradiance);
    let rendering = match sensor.picture {
        Picture::Quicklook => Rendering::Quicklook,
        Picture::Colours { channels, exposure } => Rendering::Colours { channels, exposure, white },
    };
    let pixels = Image {
        width: sensor.size.x as usize,
        height: sensor.size.y as usize,
        bands: context.bands.clone(),
        values: scaled(&outcome.pixels),
        standard_error: scaled(&outcome.errors),
        coverage: outcome.coverage.clone(),
        rendering,
        georeference,
    };
    let mean = (&outcome.mean[of_spectrum.clone()], &outcome.mean_error[of_spectrum.clone()]);
    Product { image: Some(pixels), ..context.product(name, Vec::new(), mean, scale) }
}

/// Place of a nadir image with north up; others lie askew on the ground.
pub(super) fn georeference(
    sensor: &ImageSensor,
    stage: &Stage,
    context: &Context,
) -> Option<Georeference> {
    let Optics::Orthographic(optics) = &sensor.optics else { return None };
    let is_nadir = optics.view.zenith == 0.0;
    let north_up = (optics.view.azimuth.to_degrees() - 180.0).abs() < 1e-9;
    let (middle, extent) = footprint(optics, stage);
    let corner = middle.truncate() + extent * DVec2::new(-0.5, 0.5);
    (is_nadir && north_up).then(|| Georeference {
        west: context.origin.0 + corner.x,
        north: context.origin.1 + corner.y,
        pixel_width: extent.x / f64::from(sensor.size.x),
        pixel_height: extent.y / f64::from(sensor.size.y),
    })
}
