//! Fractions of sunlit and shaded ground and canopy, and gap fractions.

use std::ops::Range;

use super::context::labels;
use super::directions::axes;
use super::images::georeference;
use super::leaf_area::{GapSums, LeafAreaIndex, lai_beer, lai_of_rings, lai_of_views};
use super::{Class, Context, Image, PixelRows, Pixels, Product, ProductAxis, Rendering};
use crate::components::{ImageMeasure, ImageSensor, View};
use crate::extract::Stage;
use crate::transport::{ComponentColumns, ImageOutcome, ViewsOutcome};

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
    let image = |names: &[&str], pixels: Pixels, rendering| Image {
        width: sensor.size.x as usize,
        height: sensor.size.y as usize,
        bands: names.iter().map(|&name| name.to_owned()).collect(),
        pixels,
        has_errors: true,
        rendering,
        georeference: georeference(sensor, stage, context),
    };
    let columns = ComponentColumns::new(stage);
    let row = columns.count();
    // A product of some columns, and the image of their pixels.
    let product_of = |name: &str, names: &[&str], columns: &[usize], rendering| Product {
        image: Some(image(names, pick_pixels(&outcome.pixels, columns), rendering)),
        ..product(
            name,
            vec![vec![axis(names)]],
            &pick(&outcome.mean, row, columns),
            &pick(&outcome.mean_error, row, columns),
        )
    };
    match measure {
        ImageMeasure::FourComponents => {
            let of_scenes = columns_of_scenes(columns, stage, context);
            let names = COMPONENTS.repeat(of_scenes.len());
            let components: Vec<usize> = of_scenes.iter().cloned().flatten().collect();
            let rendering = Rendering::Shares(classes());
            let shares = product_of("four_components", &names, &components, rendering);
            let dominant = move |row: &[f32]| -> Vec<f32> {
                of_scenes.iter().map(|components| dominant(&row[components.clone()])).collect()
            };
            let mean: Vec<f32> = outcome.mean.iter().map(|&share| share as f32).collect();
            let mean: Vec<f64> = dominant(&mean).into_iter().map(f64::from).collect();
            let numbers = outcome.pixels.map(move |pixels| {
                let values: Vec<f32> =
                    pixels.values.chunks_exact(row).flat_map(&dominant).collect();
                let standard_error = vec![f32::NAN; values.len()];
                PixelRows { values, standard_error, ..pixels }
            });
            let (name, names) = ("dominant_component", ["class"].repeat(mean.len()));
            let unknown = vec![f64::NAN; mean.len()];
            let class = Product {
                image: Some(image(&names, numbers, Rendering::Classes(classes()))),
                ..product(name, vec![vec![axis(&names)]], &mean, &unknown)
            };
            vec![shares, class]
        }
        ImageMeasure::GapFraction => {
            let gap = [columns.gap()];
            let gaps = product_of("gap_fraction", &["gap"], &gap, Rendering::Quicklook);
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
    stage: &Stage,
    context: &Context,
) -> Vec<Product> {
    let columns = ComponentColumns::new(stage);
    let row = columns.count();
    match measure {
        ImageMeasure::FourComponents => {
            let of_scenes = columns_of_scenes(columns, stage, context);
            let names = COMPONENTS.repeat(of_scenes.len());
            let components: Vec<usize> = of_scenes.into_iter().flatten().collect();
            vec![product(
                "four_components",
                vec![axes(views), vec![axis(&names)]],
                &pick(&outcome.mean, row, &components),
                &pick(&outcome.error, row, &components),
            )]
        }
        ImageMeasure::GapFraction => {
            let gap = [columns.gap()];
            let gaps = pick(&outcome.mean, row, &gap);
            let errors = pick(&outcome.error, row, &gap);
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
            let sums = &outcome.sums;
            let sums = GapSums { sums, stride: row + 1, gaps: columns.gap(), samples: row };
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

/// Columns of the components of each scene; those of one if all have the same sun.
fn columns_of_scenes(
    columns: ComponentColumns,
    stage: &Stage,
    context: &Context,
) -> Vec<Range<usize>> {
    let suns = &stage.light.suns;
    if suns.len() <= 1 {
        return vec![columns.of_sun(0)];
    }
    let first_band = |scene: usize| scene * stage.bands / context.scenes;
    let sun_of = |band: usize| suns.partition_point(|sun| sun.bands.end <= band);
    (0..context.scenes).map(|scene| columns.of_sun(sun_of(first_band(scene)))).collect()
}

/// Number of components of all scenes.
pub(super) fn component_count(stage: &Stage, context: &Context) -> usize {
    let columns = ComponentColumns::new(stage);
    columns_of_scenes(columns, stage, context).len() * ComponentColumns::COMPONENTS
}

/// Some columns of each row of this length.
fn pick<T: Copy>(values: &[T], row: usize, columns: &[usize]) -> Vec<T> {
    let rows = values.chunks_exact(row);
    let mut picked = Vec::with_capacity(rows.len() * columns.len());
    rows.for_each(|row| picked.extend(columns.iter().map(|&column| row[column])));
    picked
}

/// Some columns of the pixels of an image.
fn pick_pixels(pixels: &Pixels, columns: &[usize]) -> Pixels {
    let columns = columns.to_vec();
    pixels.map(move |pixels| {
        let row = pixels.columns().max(1);
        PixelRows {
            values: pick(&pixels.values, row, &columns),
            standard_error: pick(&pixels.standard_error, row, &columns),
            ..pixels
        }
    })
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
        replicates: Vec::new(),
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
