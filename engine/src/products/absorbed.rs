use std::sync::Arc;

use super::context::{labels, numbers};
use super::{Context, Product, reflectance};
use crate::extract::{Inventory, Stage};
use crate::statistics::Spread;
use crate::transport::{AbsorbedCounter, Counter as _};

/// Power that triangles and discs absorb.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Inventory whose [`Inventory::faces`] they are.
    pub inventory: Arc<Inventory>,
    /// Easting and northing of the local frame's origin, m.
    pub origin: (f64, f64),
    /// Names of the bands.
    pub bands: Vec<String>,
    /// Absorbed power over the one-sided area, W m⁻² nm⁻¹, shape `[faces, bands]`; 0 of a face
    /// without area.
    pub values: Vec<f32>,
    /// Standard errors, same shape.
    pub standard_error: Vec<f32>,
}

/// Power that each instance absorbs below the reference plane, `P = a E A`, W nm⁻¹, with `a` its
/// share of what falls on the scene's rectangle, `E` the irradiance there and `A` its area; and, if
/// they were counted, what each triangle and disc absorbs over its own one-sided area, W m⁻² nm⁻¹.
#[must_use]
pub fn absorbed(
    spread: &Spread,
    counter: &AbsorbedCounter,
    inventory: &Arc<Inventory>,
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let bands = context.bands.len();
    let errors = spread.standard_error();
    // Watts of each band, of any number of cells.
    let power = |cells: std::ops::Range<usize>| {
        let range = cells.start * bands..cells.end * bands;
        [spread.mean(), &errors].map(|values| -> Vec<f64> {
            let power = reflectance::flux_density(&values[range.clone()], &context.irradiance);
            power.into_iter().map(|value| value * stage.area()).collect()
        })
    };
    let product = |(name, unit), dimensions, [values, errors]: [Vec<f64>; 2]| {
        context.product((name, unit), dimensions, (&values, &errors), |values, _| values.to_vec())
    };
    let standing = &inventory.instances;
    let names: Vec<String> = standing.iter().map(|one| one.name.clone()).collect();
    let at = |axis: usize| standing.iter().map(move |one| one.origin[axis]);
    let mut axes = vec![labels("instance", &names)];
    axes.extend(["x_m", "y_m", "z_m"].iter().zip(0..).map(|(name, axis)| numbers(name, at(axis))));
    let by_instance = ("absorbed_by_instance", "W nm-1");
    let mut products = vec![product(by_instance, vec![axes], power(0..counter.instances))];
    if counter.has_faces() {
        let areas: Vec<f64> = inventory.faces().map(|face| face.area).collect();
        let density = |power: Vec<f64>| -> Vec<f32> {
            let per_area = |power: f64, area: f64| if area > 0.0 { power / area } else { 0.0 };
            let area_of = |index: usize| areas[index / bands];
            let of = |(index, power): (usize, &f64)| per_area(*power, area_of(index)) as f32;
            power.iter().enumerate().map(of).collect()
        };
        let [values, standard_error] = power(counter.total() + 1..counter.cells()).map(density);
        let area: f64 = areas.iter().sum();
        let mean = power(counter.total()..counter.total() + 1)
            .map(|power| power.into_iter().map(|power| power / area).collect());
        let faces = Faces {
            inventory: Arc::clone(inventory),
            origin: context.origin,
            bands: context.bands.clone(),
            values,
            standard_error,
        };
        let mean = product(("absorbed_by_triangle", "W m-2 nm-1"), Vec::new(), mean);
        products.push(Product { faces: Some(faces), ..mean });
    }
    products
}
