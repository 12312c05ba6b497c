//! Fractions of sunlit and shaded ground and canopy, and gap fractions.

use std::ops::Range;

use super::context::labels;
use super::directions::axes;
use super::images::georeference;
use super::leaf_area::{GapSums, LeafAreaIndex, lai_beer, lai_of_rings, lai_of_views};
use super::{Class, Context, Image, Product, ProductAxis, Rendering};
use crate::components::{ImageMeasure, ImageSensor, View};
use crate::extract::Stage;
use crate::transport::{COMPONENT_COLUMNS, GAP_COLUMN, ImageOutcome, ViewsOutcome};

/// Names of the four components in the order of their numbers, from 1.
const COMPONENTS: [&str; 4] = ["sunlit_ground", "sunlit_canopy", "shaded_ground", "shaded_canopy"];

/// Colours of the four components in pictures, sRGB.
const COLOURS: [[u8; 3]; 4] = [[226, 192, 120], [104, 187, 67], [110, 84, 54], [22, 82, 44]];

/// The four components as classes of pixels, in the order of their numbers.
fn classes() -> Vec<Class> {
    let class = |(name, colour): (&&str, [u8; 3])| Class { name: name.replace('_', " "), colour };
    COMPONENTS.iter().zip(COLOURS).map(class).collect()
}

/// Components as an image: their shares, and the number (1 to 4) of that with the largest share,
/// NaN where none is seen; or the share of gaps, and of a fisheye that looks straight up or down the
/// leaf area indices that they imply. Nothing for other measures.
#[must_use]
pub fn image_components(
    measure: ImageMeasure,
    sensor: &ImageSensor,
    outcome: &ImageOutcome,
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let image = |names: &[&str], values: Vec<f32>, standard_error, rendering| Image {
        width: sensor.size.x as usize,
        height: sensor.size.y as usize,
        bands: names.iter().map(|&name| name.to_owned()).collect(),
        values,
        standard_error,
        coverage: outcome.coverage.clone(),
        rendering,
        georeference: georeference(sensor, stage, context),
    };
    // A product of some columns, and the image of their pixels.
    let columns = |name: &str, names: &[&str], columns: Range<usize>, rendering| Product {
        image: Some(image(
            names,
            pick(&outcome.pixels, columns.clone()),
            pick(&outcome.errors, columns.clone()),
            rendering,
        )),
        ..product(
            name,
            vec![vec![axis(names)]],
            &outcome.mean[columns.clone()],
            &outcome.mean_error[columns],
        )
    };
    match measure {
        ImageMeasure::FourComponents => {
            let shares =
                columns("four_components", &COMPONENTS, 0..4, Rendering::Shares(classes()));
            let numbers: Vec<f32> =
                outcome.pixels.chunks_exact(COMPONENT_COLUMNS).map(|p| dominant(&p[..4])).collect();
            let errors = vec![f32::NAN; numbers.len()];
            let mean: Vec<f32> = outcome.mean[..4].iter().map(|&share| share as f32).collect();
            let name = "dominant_component";
            let class = Product {
                image: Some(image(&["class"], numbers, errors, Rendering::Classes(classes()))),
                ..product(
                    name,
                    vec![vec![axis(&["class"])]],
                    &[dominant(&mean).into()],
                    &[f64::NAN],
                )
            };
            vec![shares, class]
        }
        ImageMeasure::GapFraction => {
            let column = GAP_COLUMN..GAP_COLUMN + 1;
            let gaps = columns("gap_fraction", &["gap"], column, Rendering::Quicklook);
            let rings = GapSums { sums: &outcome.image_sums, stride: 2, gaps: 0, samples: 1 };
            let lai = lai_of_rings(&rings).into_iter().map(|index| single(&index));
            std::iter::once(gaps).chain(lai).collect()
        }
        ImageMeasure::Radiance
        | ImageMeasure::Brf
        | ImageMeasure::Orders
        | ImageMeasure::BrightnessTemperature => Vec::new(),
    }
}

/// Components by view; gap fractions with the leaf area indices that they imply: by Beer's law with
/// `G = 0.5` for each view, by Miller's integral where there are two zenith angles or more, and by
/// the rings of a LAI-2000 where the views have all of their angles. Nothing for other measures.
#[must_use]
pub fn direction_components(
    measure: ImageMeasure,
    views: &[View],
    outcome: &ViewsOutcome,
) -> Vec<Product> {
    match measure {
        ImageMeasure::FourComponents => vec![product(
            "four_components",
            vec![axes(views), vec![axis(&COMPONENTS)]],
            &pick(&outcome.mean, 0..4),
            &pick(&outcome.error, 0..4),
        )],
        ImageMeasure::GapFraction => {
            let column = GAP_COLUMN..GAP_COLUMN + 1;
            let gaps = pick(&outcome.mean, column.clone());
            let errors = pick(&outcome.error, column);
            let by_view = |name: &str, column: &str, values: &[f64], errors: &[f64]| {
                product(name, vec![axes(views), vec![axis(&[column])]], values, errors)
            };
            let (lai, lai_errors): (Vec<f64>, Vec<f64>) = views
                .iter()
                .zip(gaps.iter().zip(&errors))
                .map(|(view, (&gap, &error))| lai_beer((gap, error), view.zenith, 0.5))
                .unzip();
            let mut products = vec![
                by_view("gap_fraction", "gap", &gaps, &errors),
                by_view("lai_beer", "lai", &lai, &lai_errors),
            ];
            let zeniths: Vec<f64> = views.iter().map(|view| view.zenith).collect();
            let stride = COMPONENT_COLUMNS + 1;
            let sums = &outcome.sums;
            let sums = GapSums { sums, stride, gaps: GAP_COLUMN, samples: COMPONENT_COLUMNS };
            products.extend(lai_of_views(&zeniths, &sums).iter().map(single));
            products
        }
        ImageMeasure::Radiance
        | ImageMeasure::Brf
        | ImageMeasure::Orders
        | ImageMeasure::BrightnessTemperature => Vec::new(),
    }
}

/// A product of one number.
fn single(index: &LeafAreaIndex) -> Product {
    let dimensions = vec![vec![axis(&["lai"])]];
    product(index.name, dimensions, &[index.value], &[index.standard_error])
}

/// Number, from 1, of the largest share; NaN if none of them was seen.
fn dominant(shares: &[f32]) -> f32 {
    let mut largest = (f32::NAN, 0.0);
    for (number, &share) in (1_u8..).zip(shares) {
        if share > largest.1 {
            largest = (f32::from(number), share);
        }
    }
    largest.0
}

/// Some columns of each row.
fn pick<T: Copy>(values: &[T], columns: Range<usize>) -> Vec<T> {
    let rows = values.chunks_exact(COMPONENT_COLUMNS);
    let mut picked = Vec::with_capacity(rows.len() * columns.len());
    rows.for_each(|row| picked.extend_from_slice(&row[columns.clone()]));
    picked
}

fn axis(names: &[&str]) -> ProductAxis {
    labels("component", &names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>())
}

fn product(
    name: &str,
    dimensions: Vec<Vec<ProductAxis>>,
    values: &[f64],
    errors: &[f64],
) -> Product {
    Product {
        name: name.to_owned(),
        unit: "1".to_owned(),
        dimensions,
        values: values.to_vec(),
        standard_error: errors.to_vec(),
        image: None,
        faces: None,
    }
}

#[cfg(test)]
mod tests {
    use super::dominant;

    #[test]
    fn the_largest_share_dominates() {
        assert_eq!(dominant(&[0.1, 0.2, 0.5, 0.2]).to_bits(), 3.0_f32.to_bits());
        assert_eq!(dominant(&[0.5, 0.5, 0.0, 0.0]).to_bits(), 1.0_f32.to_bits());
        assert!(dominant(&[f32::NAN; 4]).is_nan());
        assert!(dominant(&[0.0; 4]).is_nan());
    }
}
