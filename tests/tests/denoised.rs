//! Denoised images beside plain ones: smaller errors, which are told.

use sunfleck::products::{PixelRows, Report};
use sunfleck_tests::{SceneText, product};

/// Two trees and a house of hard edges over soil.
fn scene(sensors: &str) -> Report {
    SceneText::trees_in_daylight("Periodic")
        .with_more("meshes", r#""house": Faces(faces_m: [[(-0.7, -0.5, 0.9), (0.7, -0.5, 0.9), (0.7, 0.5, 0.9), (-0.7, 0.5, 0.9)]], material: "soil")"#)
        .with_more("instances", r#"List(of: "house", at_m: [(1.0, 4.0, 0.0)])"#)
        .with("sensors", sensors)
        .measure()
}

fn pixels(report: &Report, sensor: &str, name: &str) -> PixelRows {
    let image = product(report, sensor, name).image.as_ref().expect("an image");
    image.load().expect("pixels can be read")
}

/// Mean squared error of an image, less that of the truth, and the mean of the squared errors in standard errors.
fn errors(found: &PixelRows, truth: &PixelRows, band: usize) -> (f64, f64) {
    let (mut square, mut standardised, mut count) = (0.0, 0.0, 0.0);
    for at in (band..found.values.len()).step_by(found.columns()) {
        let of = |values: &[f32]| f64::from(values[at]);
        let (error, noise) = (of(&found.standard_error), of(&truth.standard_error));
        if error > 0.0 && noise > 0.0 {
            let deviation = (of(&found.values) - of(&truth.values)).powi(2) - noise * noise;
            square += deviation;
            standardised += deviation / (error * error);
            count += 1.0;
        }
    }
    (square / count, standardised / count)
}

/// *Scene*: trees and hard edges in two bands under sun and sky, at 4 and 64 samples per pixel. *Expected*: squared errors
/// against 1024 samples fall in each band, and are those that the standard errors tell; the mean of the image is that of
/// the plain one; pixels without data stay without.
#[test]
fn denoised_images_have_smaller_errors_and_tell_them() {
    let camera = |keys: &str| {
        format!("Orthographic(size_px: (96, 80), extent_m: (5.0, 5.0), zenith_deg: 10.0, {keys})")
    };
    let few = camera("samples_per_px: 4, measure: [Brf, Radiance], denoised: true");
    let many = camera("samples_per_px: 64, denoised: true");
    let truth = camera("samples_per_px: 1024");
    let report = scene(&format!(r#""few": {few}, "many": {many}, "truth": {truth}"#));
    let truth = pixels(&report, "truth", "hdrf");
    for (sensor, most) in [("few", 0.7), ("many", 1.0)] {
        let [plain, denoised] = ["hdrf", "hdrf_denoised"].map(|name| pixels(&report, sensor, name));
        assert_eq!(plain.coverage, denoised.coverage);
        for band in 0..2 {
            let (before, _) = errors(&plain, &truth, band);
            let (after, standardised) = errors(&denoised, &truth, band);
            let left = after / before;
            assert!(left < most, "{sensor} {band}: {left:.3} left");
            assert!((0.6..1.4).contains(&standardised), "{sensor} {band}: z² {standardised:.3}");
        }
        let [plain, denoised] =
            ["hdrf", "hdrf_denoised"].map(|name| &product(&report, sensor, name).values);
        assert_eq!(plain, denoised);
    }
    let names = report.sensors[0].products.iter().map(|product| product.name.as_str());
    let expected = ["hdrf", "hdrf_denoised", "radiance", "radiance_denoised"];
    assert_eq!(names.collect::<Vec<_>>(), expected);
}

/// *Scene*: the same, measured until the denoised image is good enough. *Expected*: it ends there, with fewer samples than
/// the plain image would need.
#[test]
fn a_measurement_can_end_when_its_denoised_image_is_good_enough() {
    let camera = |name: &str| {
        format!(
            r#""{name}": Orthographic(size_px: (48, 40), extent_m: (5.0, 5.0), denoised: true, until: RelErrors({{ "{name}": 0.2 }}))"#
        )
    };
    let report = scene(&format!("{}, {}", camera("hdrf"), camera("hdrf_denoised")));
    let [plain, denoised] = [0, 1].map(|at| &report.sensors[at]);
    assert!(5 * denoised.samples < 4 * plain.samples, "{} and {}", plain.samples, denoised.samples);
    let error = denoised.products[1].median_relative_error().expect("pixels can be read");
    assert!(error.is_some_and(|error| error <= 0.2), "{error:?}");
}
