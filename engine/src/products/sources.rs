//! Photon products in absolute units: emitted, reflected or both.

use std::f64::consts::FRAC_1_PI;

use super::context::labels;
use super::thermal::{brightness, radiance_of_sources};
use super::{Context, Product};

/// Exitance, flux densities or radiance, in each band from the sources that it holds.
///
/// - `reflected`: a product of reflected light (albedo, flux density, BRF) under an irradiance of 1,
///   as [`Context::with_unit_irradiance`] gives it
/// - `emitted`: the same product of emitted light; a "BRF" of it is π times the radiance
///
/// # Panics
/// If there is neither.
#[must_use]
pub fn combine_sources(
    reflected: Option<&Product>,
    emitted: Option<&Product>,
    context: &Context,
) -> Product {
    let one = reflected.or(emitted).expect("one of the two was measured");
    let factor = one.name.strip_prefix(context.factor());
    let (name, unit, scale) = match (factor, one.name.as_str()) {
        (Some(kind), _) => (format!("radiance{kind}"), "W m-2 sr-1 nm-1", FRAC_1_PI),
        (None, "albedo") => ("exitance".to_owned(), "W m-2 nm-1", 1.0),
        (None, name) => (name.to_owned(), "W m-2 nm-1", 1.0),
    };
    let sum = |of: &dyn Fn(&Product) -> [Vec<f64>; 2]| {
        let scaled = |product: &Product| {
            of(product).map(|values| values.iter().map(|value| value * scale).collect::<Vec<_>>())
        };
        let reflected = reflected.map(scaled);
        let nothing = || of(one).map(|values| vec![0.0; values.len()]);
        let emitted = emitted.map_or_else(nothing, scaled);
        let relative = reflected.as_ref().map(|[value, error]| (&**value, &**error));
        radiance_of_sources(relative, (&emitted[0], &emitted[1]), context)
    };
    let (values, standard_error) = sum(&|one| [one.values.clone(), one.standard_error.clone()]);
    let image = one.image.as_ref().map(|image| {
        let wide = |values: &[f32]| values.iter().map(|&value| value.into()).collect();
        let (pixels, errors) = sum(&|one| {
            let image = one.image.as_ref().expect("both are images or none is");
            [wide(&image.values), wide(&image.standard_error)]
        });
        let narrow = |values: Vec<f64>| values.iter().map(|&value| value as f32).collect();
        super::Image { values: narrow(pixels), standard_error: narrow(errors), ..image.clone() }
    });
    let dimensions = one.dimensions.clone();
    Product { name, unit: unit.to_owned(), dimensions, values, standard_error, image, faces: None }
}

/// Brightness temperature of a product of radiance, K, in the bands that hold emission; `None` for
/// any other product.
#[must_use]
pub fn brightness_product(radiance: &Product, context: &Context) -> Option<Product> {
    let kind = radiance.name.strip_prefix("radiance")?;
    let (values, standard_error) =
        brightness((&radiance.values, &radiance.standard_error), context);
    let mut dimensions = radiance.dimensions.clone();
    *dimensions.last_mut()? = vec![labels("band", &context.emitting())];
    Some(Product {
        name: format!("brightness_temperature{kind}"),
        unit: "K".to_owned(),
        dimensions,
        values,
        standard_error,
        image: None,
        faces: None,
    })
}
