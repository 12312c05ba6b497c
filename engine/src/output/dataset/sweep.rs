//! Data set of a sensor over all points of a sweep: the swept parameters are dimensions.

use std::fs::File;
use std::io;

use super::super::provenance::RecipeTexts;
use super::axes::{AlongDimension, DatasetAxes};
use super::names::{VariableNames, in_words};
use super::sensor::{ProductKeys, ProductVariables, global};
use super::values::{StoredForm, StoredValues};
use super::{Dataset, Values};
use crate::document::Param;
use crate::products::{AxisPoints, Product, ProductAxis, Report, SweepPoint};

/// A product at all points, with the place of its numbers in a file of `f64`.
#[derive(Debug)]
pub(in crate::output) struct SweptProduct {
    /// Name, unit and dimensions of the product at one point; it has no values.
    pub(in crate::output) product: Product,
    /// True if the values are means over an image.
    pub(in crate::output) is_mean: bool,
    /// Places of the values and of the standard errors, shape `[points, ..]`, bytes.
    pub(in crate::output) starts: [u64; 2],
}

/// Data set of all products of a sensor.
///
/// - `report`: report of the sweep, with the bands of its points
/// - `file`: numbers of all products
///
/// # Errors
/// If the file cannot be opened again.
pub(in crate::output) fn of_sweep(
    report: &Report,
    sensor: &str,
    points: &[SweepPoint],
    products: &[SweptProduct],
    file: &File,
) -> io::Result<Dataset<'static>> {
    let mut names = VariableNames::default();
    let key = |swept: &SweptProduct| {
        let ending = if swept.is_mean { "_mean" } else { "" };
        format!("{}{ending}", swept.product.name)
    };
    let keys: Vec<ProductKeys> =
        products.iter().map(|swept| ProductKeys::new(&key(swept), &mut names)).collect();
    let mut axes = DatasetAxes::of_sweep(report, names);
    let swept = along_points(points, &mut axes);
    let mut variables = Vec::new();
    for (SweptProduct { product, is_mean, starts }, keys) in products.iter().zip(&keys) {
        let stored = |start| -> io::Result<Values<'static>> {
            let form = StoredForm::Doubles;
            Ok(Values::Stored(StoredValues { file: file.try_clone()?, start, form }))
        };
        let values = (stored(starts[0])?, Some(stored(starts[1])?));
        let mut of_product =
            ProductVariables { product, keys, axes: &mut axes, variables: &mut variables };
        let along: Vec<_> = swept.iter().cloned().chain(of_product.along()).collect();
        let name = in_words(&product.name);
        let long_name = if *is_mean { format!("mean of {name} over the image") } else { name };
        let names = [keys.values.clone(), keys.errors.clone()];
        of_product.add_pair(names, &long_name, &along, values, "");
    }
    let DatasetAxes { dimensions, coordinates, .. } = axes;
    let attributes = global(report, sensor, &RecipeTexts::default());
    let variables = coordinates.into_iter().chain(variables).collect();
    Ok(Dataset { dimensions, attributes, variables })
}

/// Dimensions of the points: one per parameter, if the points are all combinations of their values in order, the last
/// parameter fastest; else one, `point`, along which all parameters run.
fn along_points(points: &[SweepPoint], axes: &mut DatasetAxes<'_>) -> Vec<AlongDimension> {
    let Some(first) = points.first() else { return Vec::new() };
    let values = |place: usize| -> Vec<&Param> {
        points.iter().filter_map(|point| Some(&point.params.get(place)?.1)).collect()
    };
    let distinct = |place: usize| {
        let mut distinct: Vec<&Param> = Vec::new();
        for value in values(place) {
            if !distinct.contains(&value) {
                distinct.push(value);
            }
        }
        distinct
    };
    let grid: Vec<Vec<&Param>> = (0..first.params.len()).map(distinct).collect();
    let lengths: Vec<usize> = grid.iter().map(Vec::len).collect();
    let is_at = |(row, point): (usize, &SweepPoint)| {
        let indices = super::super::rows::indices(&lengths, row);
        let of_point = point.params.iter().map(|(_, value)| value);
        of_point.eq(grid.iter().zip(indices).map(|(values, index)| values[index]))
    };
    let is_grid =
        lengths.iter().product::<usize>() == points.len() && points.iter().enumerate().all(is_at);
    let axis = |place: usize, values: &[&Param]| {
        let name = first.params[place].0.clone();
        ProductAxis { name, points: axis_points(values) }
    };
    if is_grid {
        let each = grid.iter().enumerate().map(|(place, values)| axis(place, values));
        return each.map(|one| axes.along(&[one], "swept")).collect();
    }
    let all: Vec<ProductAxis> =
        (0..first.params.len()).map(|place| axis(place, &values(place))).collect();
    vec![axes.along_named("point", &all, "swept")]
}

/// Numbers, if all are.
fn axis_points(values: &[&Param]) -> AxisPoints {
    match values.iter().map(|value| value.number()).collect() {
        Some(numbers) => AxisPoints::Numbers(numbers),
        None => AxisPoints::Labels(values.iter().map(ToString::to_string).collect()),
    }
}
