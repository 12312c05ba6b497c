use super::context::numbers;
use super::{Axis, Context, Product, reflectance};
use crate::components::{ImageMeasure, View};
use crate::film::Spread;

/// The products of a measurement of directions that are made of light; `spread` is of `L / E`, shape `[views, bands]`.
#[must_use]
pub fn of_directions(
    views: &[View],
    measures: &[ImageMeasure],
    spread: &Spread,
    context: &Context,
) -> Vec<Product> {
    let errors = spread.standard_error();
    let values = (spread.mean(), errors.as_slice());
    measures
        .iter()
        .filter_map(|measure| match measure {
            ImageMeasure::Radiance => Some(context.product(
                ("radiance", "W m-2 sr-1 nm-1"),
                vec![axes(views)],
                values,
                reflectance::radiance,
            )),
            ImageMeasure::Brf => Some(context.product(
                (context.factor(), "1"),
                vec![axes(views)],
                values,
                reflectance::brf,
            )),
            ImageMeasure::FourComponents | ImageMeasure::GapFraction => None,
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
