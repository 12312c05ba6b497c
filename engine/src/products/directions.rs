use super::context::numbers;
use super::{Axis, Context, Product, reflectance};
use crate::components::{ImageMeasure, View};
use crate::film::Spread;
use crate::transport::{DirectionsOutcome, Part};

/// The products of a measurement of directions that are made of light.
#[must_use]
pub fn of_directions(
    views: &[View],
    measures: &[ImageMeasure],
    outcome: &DirectionsOutcome,
    context: &Context,
) -> Vec<Product> {
    type Scale = fn(&[f64], &[f64]) -> Vec<f64>;
    let product = |name: String, unit: &str, spread: &Spread, scale: Scale| {
        let errors = spread.standard_error();
        context.product((name, unit), vec![axes(views)], (spread.mean(), &errors), scale)
    };
    let factor = context.factor();
    measures
        .iter()
        .flat_map(|measure| match measure {
            ImageMeasure::Radiance => vec![product(
                "radiance".to_owned(),
                "W m-2 sr-1 nm-1",
                &outcome.spread,
                reflectance::radiance,
            )],
            ImageMeasure::Brf => {
                vec![product(factor.to_owned(), "1", &outcome.spread, reflectance::brf)]
            }
            ImageMeasure::Orders => Part::ALL
                .iter()
                .zip(&outcome.parts)
                .map(|(part, spread)| {
                    product(format!("{factor}_{}", part.suffix()), "1", spread, reflectance::brf)
                })
                .collect(),
            ImageMeasure::FourComponents | ImageMeasure::GapFraction => Vec::new(),
        })
        .collect()
}

/// Axes of a list of views.
pub(super) fn axes(views: &[View]) -> Vec<Axis> {
    // Degrees as their author wrote them: the last bits of the conversion are noise.
    let degrees = |radians: f64| (radians.to_degrees() * 1e9).round() / 1e9;
    vec![
        numbers("zenith_deg", views.iter().map(|view| degrees(view.zenith))),
        numbers("azimuth_deg", views.iter().map(|view| degrees(view.azimuth).rem_euclid(360.0))),
    ]
}
