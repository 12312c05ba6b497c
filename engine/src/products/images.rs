use std::f64::consts::FRAC_1_PI;

use glam::DVec2;

use super::context::labels;
use super::denoising::denoised;
use super::thermal::{brightness, radiance_of_sources};
use super::{Context, Georeference, Image, PixelRows, Pixels, Product, Rendering, reflectance};
use crate::components::{ImageMeasure, ImageSensor, Optics, PictureColours};
use crate::extract::Stage;
use crate::transport::{ImageOutcome, ScatteringOrder, footprint};

/// The products of an image measurement that are made of light: of what is `reflected`, as `L / E`,
/// and of what is `emitted`, as far as they were measured. A denoised image follows each if the sensor asks for it.
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
    let products = sensor.measure.iter().filter_map(products).flatten();
    let with_denoised = |product: Product| {
        let filtered = if sensor.is_denoised { denoised(&product) } else { None };
        std::iter::once(product).chain(filtered)
    };
    products.flat_map(with_denoised).collect()
}

/// Values of `L / E` and irradiance to those of a product, shape `[.., bands]`.
type Scale = fn(&[f64], &[f64]) -> Vec<f64>;

/// Radiance of all sources, absolute.
fn total(
    reflected: Option<&ImageOutcome>,
    emitted: &ImageOutcome,
    context: &Context,
) -> ImageOutcome {
    let whole = 0..context.bands.len();
    let (of_emitted, of_reflected) =
        (emitted.pixels.clone(), reflected.map(|image| image.pixels.clone()));
    let (shared, of_whole) = (context.clone(), whole.clone());
    let pixels = Pixels::new(move |rows| {
        let of_emitted = of_emitted.rows(rows.clone())?;
        // The whole; its parts may stand behind it.
        let of_reflected = of_reflected.as_ref().map(|pixels| pixels.rows(rows)).transpose()?;
        let of_reflected = of_reflected.map(|pixels| pixels.select_columns(of_whole.clone()));
        Ok(total_of_rows(of_reflected.as_ref(), of_emitted, &shared))
    });
    let reflected =
        reflected.map(|image| (&image.mean[whole.clone()], &image.mean_error[whole.clone()]));
    let mean = (emitted.mean.as_slice(), emitted.mean_error.as_slice());
    let (mean, mean_error) = radiance_of_sources(reflected, mean, context);
    ImageOutcome { pixels, mean, mean_error, image_sums: emitted.image_sums.clone() }
}

/// Radiance of all sources in some rows.
fn total_of_rows(
    reflected: Option<&PixelRows>,
    emitted: PixelRows,
    context: &Context,
) -> PixelRows {
    let wide = |values: &[f32]| -> Vec<f64> { values.iter().map(|&value| value.into()).collect() };
    let of = |pixels: &PixelRows| (wide(&pixels.values), wide(&pixels.standard_error));
    let reflected_values = reflected.map(of);
    let relative = reflected_values.as_ref().map(|(l, error)| (l.as_slice(), error.as_slice()));
    let (l, error) = of(&emitted);
    let (l, error) = radiance_of_sources(relative, (&l, &error), context);
    let narrow = |values: Vec<f64>| values.iter().map(|&value| value as f32).collect();
    let mut total = PixelRows { values: narrow(l), standard_error: narrow(error), ..emitted };
    let bands = context.bands.len();
    for (pixel, coverage) in total.coverage.iter_mut().enumerate() {
        let is_known =
            *coverage > 0.0 && reflected.is_none_or(|reflected| reflected.coverage[pixel] > 0.0);
        if !is_known {
            // Samples of one source alone have met the scene: the sum is not known.
            *coverage = 0.0;
            total.values[pixel * bands..(pixel + 1) * bands].fill(f32::NAN);
            total.standard_error[pixel * bands..(pixel + 1) * bands].fill(f32::NAN);
        }
    }
    total
}

/// Brightness temperature of absolute radiance.
fn brightness_image(
    sensor: &ImageSensor,
    total: &ImageOutcome,
    (context, georeference): (&Context, Option<Georeference>),
) -> Product {
    let emitting = context.emitting();
    let shared = context.clone();
    let pixels = total.pixels.map(move |total| {
        let wide =
            |values: &[f32]| -> Vec<f64> { values.iter().map(|&value| value.into()).collect() };
        let (kelvin, error) =
            brightness((&wide(&total.values), &wide(&total.standard_error)), &shared);
        let narrow = |values: Vec<f64>| values.iter().map(|&value| value as f32).collect();
        PixelRows { values: narrow(kelvin), standard_error: narrow(error), ..total }
    });
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
            pixels,
            has_errors: true,
            rendering: Rendering::Quicklook,
            georeference,
        }),
        faces: None,
        replicates: Vec::new(),
    }
}

fn image(
    name: (&str, &str),
    sensor: &ImageSensor,
    (outcome, spectrum): (&ImageOutcome, usize),
    (context, georeference): (&Context, Option<Georeference>),
    (scale, of_white): (Scale, Scale),
) -> Product {
    let bands = context.bands.len();
    let of_spectrum = spectrum * bands..(spectrum + 1) * bands;
    let irradiance = context.irradiance.clone();
    let pixels = outcome.pixels.select_columns(of_spectrum.clone());
    let pixels = pixels.map(move |pixels| pixels.scaled(|values| scale(values, &irradiance)));
    // `π L / E` of a white Lambertian surface on the horizontal is 1.
    let white = of_white(&vec![FRAC_1_PI; bands], &context.irradiance);
    let rendering = match sensor.picture {
        PictureColours::Quicklook => Rendering::Quicklook,
        PictureColours::Colours { channels, exposure } => {
            Rendering::Colours { channels, exposure, white }
        }
    };
    let image = Image {
        width: sensor.size.x as usize,
        height: sensor.size.y as usize,
        bands: context.bands.clone(),
        pixels,
        has_errors: true,
        rendering,
        georeference,
    };
    let mean = (&outcome.mean[of_spectrum.clone()], &outcome.mean_error[of_spectrum]);
    Product { image: Some(image), ..context.product(name, Vec::new(), mean, scale) }
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
