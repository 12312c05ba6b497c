use super::context::{labels, numbers};
use super::thermal::{brightness, radiance_of_sources};
use super::{Context, Product, ProductAxis, reflectance};
use crate::components::{ImageMeasure, View};
use crate::transport::{DirectionsOutcome, ScatteringOrder};

/// The products of a measurement of directions that are made of light: of what is `reflected`, as
/// `L / E`, and of what is `emitted`, as far as they were measured; both of shape `[views, bands]`, and
/// means over the scene's rectangle.
#[must_use]
pub fn direction_products(
    views: &[View],
    measures: &[ImageMeasure],
    reflected: Option<&DirectionsOutcome>,
    emitted: Option<&DirectionsOutcome>,
    context: &Context,
) -> Vec<Product> {
    type Scale = fn(&[f64], &[f64]) -> Vec<f64>;
    let product = |name: (&str, &str), values: (&[f64], &[f64]), scale: Scale| {
        context.product(name, vec![axes(views)], values, scale)
    };
    let errors = reflected.map(|outcome| outcome.spread.standard_error());
    let relative = reflected
        .zip(errors.as_ref())
        .map(|(outcome, errors)| (outcome.spread.mean(), errors.as_slice()));
    let total = emitted.map(|emitted| {
        let errors = emitted.spread.standard_error();
        radiance_of_sources(relative, (emitted.spread.mean(), &errors), context)
    });
    let radiance = ("radiance", "W m-2 sr-1 nm-1");
    let factor = context.factor();
    let products = |measure: &ImageMeasure| -> Option<Vec<Product>> {
        Some(match measure {
            ImageMeasure::Radiance => vec![match &total {
                Some((values, errors)) => {
                    product(radiance, (values, errors), |values, _| values.to_vec())
                }
                None => product(radiance, relative?, reflectance::radiance),
            }],
            ImageMeasure::Brf => vec![product((factor, "1"), relative?, reflectance::brf)],
            ImageMeasure::Orders => ScatteringOrder::ALL
                .iter()
                .zip(&reflected?.parts)
                .map(|(part, spread)| {
                    let name = format!("{factor}_{}", part.suffix());
                    let errors = spread.standard_error();
                    product((&name, "1"), (spread.mean(), &errors), reflectance::brf)
                })
                .collect(),
            ImageMeasure::BrightnessTemperature => {
                let (values, errors) = total.as_ref()?;
                let (values, standard_error) = brightness((values, errors), context);
                vec![Product {
                    name: "brightness_temperature".to_owned(),
                    unit: "K".to_owned(),
                    dimensions: vec![axes(views), vec![labels("band", &context.emitting())]],
                    values,
                    standard_error,
                    image: None,
                    faces: None,
                    replicates: Vec::new(),
                }]
            }
            ImageMeasure::FourComponents | ImageMeasure::GapFraction => return None,
        })
    };
    measures.iter().filter_map(products).flatten().collect()
}

/// Axes of a list of views.
pub(super) fn axes(views: &[View]) -> Vec<ProductAxis> {
    // Degrees as their author wrote them: the last bits of the conversion are noise.
    let degrees = |radians: f64| (radians.to_degrees() * 1e9).round() / 1e9;
    vec![
        numbers("zenith_deg", views.iter().map(|view| degrees(view.zenith))),
        numbers("azimuth_deg", views.iter().map(|view| degrees(view.azimuth).rem_euclid(360.0))),
    ]
}
