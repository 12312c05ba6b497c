use std::f64::consts::FRAC_1_PI;

use glam::DVec2;

use super::context::labels;
use super::thermal::{brightness, radiance_of_sources};
use super::{Context, Georeference, Image, Product, Rendering, reflectance};
use crate::components::{ImageMeasure, ImageSensor, Optics, PictureColours};
use crate::extract::Stage;
use crate::transport::{ImageOutcome, ScatteringOrder, footprint};

/// The products of an image measurement that are made of light: of what is `reflected`, as `L / E`,
/// and of what is `emitted`, as far as they were measured.
#[must_use]
pub fn image_products(
    sensor: &ImageSensor,
    reflected: Option<&ImageOutcome>,
    emitted: Option<&ImageOutcome>,
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let place = georeference(sensor, stage, context);
    let image = |name: (&str, &str), (outcome, spectrum), scale| {
        image(name, sensor, (outcome, spectrum), (context, place), scale)
    };
    let total = emitted.map(|emitted| total(reflected, emitted, context));
    let as_it_is: Scale = |values, _| values.to_vec();
    let relative: (Scale, Scale) = (reflectance::radiance, reflectance::radiance);
    let brf: (Scale, Scale) = (reflectance::brf, reflectance::brf);
    let radiance = ("radiance", "W m-2 sr-1 nm-1");
    let factor = context.factor();
    let products = |measure: &ImageMeasure| -> Option<Vec<Product>> {
        Some(match measure {
            ImageMeasure::Radiance => vec![match &total {
                Some(total) => image(radiance, (total, 0), (as_it_is, reflectance::radiance)),
                None => image(radiance, (reflected?, 0), relative),
            }],
            ImageMeasure::Brf => vec![image((factor, "1"), (reflected?, 0), brf)],
            ImageMeasure::Orders => {
                let outcome = reflected?;
                let of_part = |(part, spectrum): (&ScatteringOrder, usize)| {
                    let name = format!("{factor}_{}", part.suffix());
                    image((&name, "1"), (outcome, spectrum), brf)
                };
                let spectra = outcome.mean.len() / context.bands.len();
                ScatteringOrder::ALL.iter().zip(1..spectra).map(of_part).collect()
            }
            ImageMeasure::BrightnessTemperature => {
                vec![brightness_image(sensor, total.as_ref()?, (context, place))]
            }
            ImageMeasure::FourComponents | ImageMeasure::GapFraction => return None,
        })
    };
    sensor.measure.iter().filter_map(products).flatten().collect()
}

/// Values of `L / E` and irradiance to those of a product, shape `[.., bands]`.
type Scale = fn(&[f64], &[f64]) -> Vec<f64>;

/// Radiance of all sources, absolute.
fn total(
    reflected: Option<&ImageOutcome>,
    emitted: &ImageOutcome,
    context: &Context,
) -> ImageOutcome {
    let bands = context.bands.len();
    let wide = |pixel: &[f32]| -> Vec<f64> { pixel.iter().map(|&value| value.into()).collect() };
    let mut outcome = emitted.clone();
    let has_both = |pixel: usize| {
        let is_known = |image: &ImageOutcome| image.coverage[pixel] > 0.0;
        is_known(emitted) && reflected.is_none_or(is_known)
    };
    for (index, start) in (0..emitted.pixels.len()).step_by(bands).enumerate() {
        // The whole; its parts may stand behind it.
        let of = |image: &ImageOutcome| {
            let whole = index * image.mean.len()..index * image.mean.len() + bands;
            (wide(&image.pixels[whole.clone()]), wide(&image.errors[whole]))
        };
        let reflected = reflected.map(of);
        let reflected = reflected.as_ref().map(|(l, error)| (l.as_slice(), error.as_slice()));
        let (l, error) = of(emitted);
        let (mut l, mut error) = radiance_of_sources(reflected, (&l, &error), context);
        if !has_both(index) {
            // Samples of one source alone have met the scene: the sum is not known.
            outcome.coverage[index] = 0.0;
            l.fill(f64::NAN);
            error.fill(f64::NAN);
        }
        for (band, (l, error)) in l.iter().zip(&error).enumerate() {
            outcome.pixels[start + band] = *l as f32;
            outcome.errors[start + band] = *error as f32;
        }
    }
    let reflected = reflected.map(|image| (image.mean.as_slice(), image.mean_error.as_slice()));
    let mean = (emitted.mean.as_slice(), emitted.mean_error.as_slice());
    (outcome.mean, outcome.mean_error) = radiance_of_sources(reflected, mean, context);
    outcome
}

/// Brightness temperature of absolute radiance.
fn brightness_image(
    sensor: &ImageSensor,
    total: &ImageOutcome,
    (context, georeference): (&Context, Option<Georeference>),
) -> Product {
    let (bands, emitting) = (context.bands.len(), context.emitting());
    let space = || Vec::with_capacity(total.coverage.len() * emitting.len());
    let mut pixels = (space(), space());
    for (pixel, errors) in total.pixels.chunks_exact(bands).zip(total.errors.chunks_exact(bands)) {
        let wide = |values: &[f32]| -> Vec<f64> { values.iter().map(|&v| v.into()).collect() };
        let (kelvin, error) = brightness((&wide(pixel), &wide(errors)), context);
        pixels.0.extend(kelvin.iter().map(|&value| value as f32));
        pixels.1.extend(error.iter().map(|&value| value as f32));
    }
    let (values, standard_error) = brightness((&total.mean, &total.mean_error), context);
    Product {
        name: "brightness_temperature".to_owned(),
        unit: "K".to_owned(),
        dimensions: vec![vec![labels("band", &emitting)]],
        values,
        standard_error,
        image: Some(Image {
            width: sensor.size.x as usize,
            height: sensor.size.y as usize,
            bands: emitting,
            values: pixels.0,
            standard_error: pixels.1,
            coverage: total.coverage.clone(),
            rendering: Rendering::Quicklook,
            georeference,
        }),
        faces: None,
    }
}

fn image(
    name: (&str, &str),
    sensor: &ImageSensor,
    (outcome, spectrum): (&ImageOutcome, usize),
    (context, georeference): (&Context, Option<Georeference>),
    (scale, of_white): (Scale, Scale),
) -> Product {
    // Of one pixel at a time: an image is large, and f64 is needed only in between.
    let bands = context.bands.len();
    let of_spectrum = spectrum * bands..(spectrum + 1) * bands;
    let scaled = |pixels: &[f32]| -> Vec<f32> {
        let pixels = pixels.chunks_exact(outcome.mean.len());
        let mut scaled = Vec::with_capacity(pixels.len() * bands);
        for pixel in pixels {
            let pixel: Vec<f64> =
                pixel[of_spectrum.clone()].iter().map(|&value| f64::from(value)).collect();
            let values = scale(&pixel, &context.irradiance);
            scaled.extend(values.into_iter().map(|value| value as f32));
        }
        scaled
    };
    // `π L / E` of a white Lambertian surface on the horizontal is 1.
    let white = of_white(&vec![FRAC_1_PI; bands], &context.irradiance);
    let rendering = match sensor.picture {
        PictureColours::Quicklook => Rendering::Quicklook,
        PictureColours::Colours { channels, exposure } => {
            Rendering::Colours { channels, exposure, white }
        }
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
        pixel_width: optics.pixel.unwrap_or(extent.x / f64::from(sensor.size.x)),
        pixel_height: optics.pixel.unwrap_or(extent.y / f64::from(sensor.size.y)),
    })
}
