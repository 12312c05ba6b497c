//! Photon products in absolute units: emitted, reflected or both.

use std::f64::consts::FRAC_1_PI;
use std::io;
use std::ops::Range;

use super::context::labels;
use super::thermal::{brightness, radiance_of_sources};
use super::{Context, PixelRows, Pixels, Product};

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
    let values = |product: &Product| [product.values.clone(), product.standard_error.clone()];
    let [values, standard_error] =
        scaled_sum([reflected.map(values), emitted.map(values)], scale, context);
    let image = one.image.as_ref().map(|image| {
        let of = |product: Option<&Product>| {
            let image = product.map(|one| one.image.as_ref().expect("both are images or none is"));
            image.map(|image| image.pixels.clone())
        };
        let (sources, shared) = ([reflected, emitted].map(of), context.clone());
        let pixels = Pixels::new(move |rows| sum_of_rows(&sources, rows, scale, &shared));
        super::Image { pixels, ..image.clone() }
    });
    let dimensions = one.dimensions.clone();
    Product {
        name,
        unit: unit.to_owned(),
        dimensions,
        values,
        standard_error,
        image,
        faces: None,
        replicates: Vec::new(),
    }
}

/// Sum of reflected and emitted values with its standard error; `scale` multiplies both.
fn scaled_sum(sources: [Option<[Vec<f64>; 2]>; 2], scale: f64, context: &Context) -> [Vec<f64>; 2] {
    let length = sources.iter().flatten().map(|[values, _]| values.len()).next().unwrap_or(0);
    let scaled = |values: Vec<f64>| values.iter().map(|value| value * scale).collect::<Vec<f64>>();
    let [reflected, emitted] = sources.map(|source| source.map(|both| both.map(scaled)));
    let emitted = emitted.unwrap_or_else(|| [(), ()].map(|()| vec![0.0; length]));
    let relative = reflected.as_ref().map(|[value, error]| (&**value, &**error));
    radiance_of_sources(relative, (&emitted[0], &emitted[1]), context).into()
}

/// Sum of reflected and emitted pixels of some rows.
fn sum_of_rows(
    sources: &[Option<Pixels>; 2],
    rows: Range<usize>,
    scale: f64,
    context: &Context,
) -> io::Result<PixelRows> {
    let [reflected, emitted] =
        sources.each_ref().map(|source| source.as_ref().map(|one| one.rows(rows.clone())));
    let (reflected, emitted) = (reflected.transpose()?, emitted.transpose()?);
    let wide = |values: &[f32]| values.iter().map(|&value| value.into()).collect();
    let of = |one: &PixelRows| [wide(&one.values), wide(&one.standard_error)];
    let both = [reflected.as_ref().map(of), emitted.as_ref().map(of)];
    let narrow = |values: Vec<f64>| values.iter().map(|&value| value as f32).collect();
    let [values, standard_error] = scaled_sum(both, scale, context).map(narrow);
    let shown = reflected.or(emitted).expect("one of the two was measured");
    Ok(PixelRows { values, standard_error, ..shown })
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
        replicates: Vec::new(),
    })
}
