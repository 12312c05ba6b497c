//! Shares of sunlit and shaded ground and canopy, and gap fractions.

use super::context::labels;
use super::directions::axes;
use super::images::georeference;
use super::leaf_area::{LAI_2000_RINGS, lai_2000, lai_beer, lai_miller, lai_of_rings};
use super::{Axis, Context, Image, Product, Rendering};
use crate::components::{ImageMeasure, ImageSensor, View};
use crate::extract::Stage;
use crate::transport::{COMPONENT_COLUMNS, GAP_COLUMN, ImageOutcome, ViewsOutcome};

/// Names of the four components in the order of their numbers, from 1.
const COMPONENTS: [&str; 4] = ["sunlit_ground", "sunlit_canopy", "shaded_ground", "shaded_canopy"];

/// Components as an image: their shares, and the number (1 to 4) of that with the largest share,
/// NaN where none is seen; or the share of gaps, and of a fisheye that looks straight up or down the
/// leaf area indices that they imply. Nothing for other measures.
#[must_use]
pub fn components_of_image(
    measure: ImageMeasure,
    sensor: &ImageSensor,
    outcome: &ImageOutcome,
    (stage, context): (&Stage, &Context),
) -> Vec<Product> {
    let image = |names: &[&str], values: Vec<f32>, standard_error: Vec<f32>| Image {
        width: sensor.size.x as usize,
        height: sensor.size.y as usize,
        bands: names.iter().map(|&name| name.to_owned()).collect(),
        values,
        standard_error,
        coverage: outcome.coverage.clone(),
        rendering: Rendering::Quicklook,
        georeference: georeference(sensor, stage, context),
    };
    match measure {
        ImageMeasure::FourComponents => {
            let columns = 0..4;
            let of = |values: &[f32]| pick(values, columns.clone());
            let shares = Product {
                image: Some(image(&COMPONENTS, of(&outcome.pixels), of(&outcome.errors))),
                ..product(
                    "four_components",
                    vec![vec![axis(&COMPONENTS)]],
                    &outcome.mean[columns.clone()],
                    &outcome.mean_error[columns.clone()],
                )
            };
            let classes: Vec<f32> =
                outcome.pixels.chunks_exact(COMPONENT_COLUMNS).map(|p| dominant(&p[..4])).collect();
            let errors = vec![f32::NAN; classes.len()];
            let mean: Vec<f32> = outcome.mean[..4].iter().map(|&share| share as f32).collect();
            let class = Product {
                image: Some(image(&["class"], classes, errors)),
                ..product(
                    "dominant_component",
                    vec![vec![axis(&["class"])]],
                    &[dominant(&mean).into()],
                    &[f64::NAN],
                )
            };
            vec![shares, class]
        }
        ImageMeasure::GapFraction => {
            let column = GAP_COLUMN..GAP_COLUMN + 1;
            let of = |values: &[f32]| pick(values, column.clone());
            let gaps = Product {
                image: Some(image(&["gap"], of(&outcome.pixels), of(&outcome.errors))),
                ..product(
                    "gap_fraction",
                    vec![vec![axis(&["gap"])]],
                    &outcome.mean[column.clone()],
                    &outcome.mean_error[column.clone()],
                )
            };
            let lai = lai_of_rings(outcome.zones.values()).into_iter().map(|(name, lai, error)| {
                product(name, vec![vec![axis(&["lai"])]], &[lai], &[error])
            });
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
pub fn components_of_directions(
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
            let rings = by_zenith(views, &gaps, &errors);
            let single = |name: &str, (lai, error): (f64, f64)| {
                product(name, vec![vec![axis(&["lai"])]], &[lai], &[error])
            };
            if rings.len() > 1 {
                products.push(single("lai_miller", lai_miller(&rings)));
            }
            let ring = |degrees: f64| {
                let found = rings.iter().find(|ring| (ring.0.to_degrees() - degrees).abs() < 1e-6);
                found.map(|&(_, gap, error)| (gap, error))
            };
            if let [Some(a), Some(b), Some(c), Some(d), Some(e)] = LAI_2000_RINGS.map(ring) {
                products.push(single("lai_2000", lai_2000(&[a, b, c, d, e])));
            }
            products
        }
        ImageMeasure::Radiance
        | ImageMeasure::Brf
        | ImageMeasure::Orders
        | ImageMeasure::BrightnessTemperature => Vec::new(),
    }
}

/// Zenith angles, rising, each once, with the mean over its azimuths of gap fraction and error.
fn by_zenith(views: &[View], gaps: &[f64], errors: &[f64]) -> Vec<(f64, f64, f64)> {
    let mut all: Vec<(f64, f64, f64)> = views
        .iter()
        .zip(gaps.iter().zip(errors))
        .map(|(view, (&gap, &error))| (view.zenith, gap, error))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.chunk_by(|a, b| (a.0 - b.0).abs() < 1e-9)
        .map(|same| {
            let mean = |of: fn(&(f64, f64, f64)) -> f64| {
                same.iter().map(of).sum::<f64>() / same.len() as f64
            };
            (same[0].0, mean(|one| one.1), mean(|one| one.2))
        })
        .collect()
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
fn pick<T: Copy>(values: &[T], columns: std::ops::Range<usize>) -> Vec<T> {
    let rows = values.chunks_exact(COMPONENT_COLUMNS);
    let mut picked = Vec::with_capacity(rows.len() * columns.len());
    rows.for_each(|row| picked.extend_from_slice(&row[columns.clone()]));
    picked
}

fn axis(names: &[&str]) -> Axis {
    labels("component", &names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>())
}

fn product(name: &str, dimensions: Vec<Vec<Axis>>, values: &[f64], errors: &[f64]) -> Product {
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
