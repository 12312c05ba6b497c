//! Images whose pixels have a given side: their number, their place, and what is refused.

use std::path::Path;

use sunfleck::products::{Image, Report};
use sunfleck::run::{Failure, Options, Unwatched, check_file, run};
use sunfleck_tests::{SceneText, product};

/// Ground of 20 m by 12 m under the sun.
fn scene(boundary: &str, sensor: &str) -> SceneText {
    let bands = r#"(name: "a", center_nm: 660.0), (name: "b", center_nm: 860.0)"#;
    SceneText::bare(0.3, "size_m: (20.0, 12.0)")
        .with("frame", "origin_m: (500000.0, 4000000.0, 0.0)")
        .with("bands", bands)
        .with("sun", "zenith_deg: 30.0, irradiance: Constant(1.0)")
        .with("boundary", boundary)
        .with(
            "sensors",
            format!(
                r#""map": Orthographic({sensor}, samples_per_px: 2, measure: [Brf, Radiance])"#
            ),
        )
}

fn traced(boundary: &str, sensor: &str, options: &Options) -> Result<Report, String> {
    let reading = scene(boundary, sensor).read();
    if !reading.is_sound() {
        return Err(reading.render());
    }
    run(&reading.scene, Path::new(""), options, &Unwatched)
        .map_err(|failure: Failure| failure.with_source(&reading.source).to_string())
}

fn image(report: &Report) -> &Image {
    product(report, "map", "brf").image.as_ref().expect("an image")
}

fn grown(report: &Report) -> Vec<&String> {
    report.notes.iter().filter(|note| note.contains("whole pixels")).collect()
}

#[test]
fn whole_pixels_of_a_side_are_the_same_image_as_their_number() {
    let usual = Options::default();
    for (by_side, by_number) in [
        ("pixel_m: 0.1, extent_m: (6.3, 0.7)", "size_px: (63, 7), extent_m: (6.3, 0.7)"),
        ("pixel_m: 0.5, cover: WholeScene", "size_px: (40, 24), cover: WholeScene"),
        (
            "pixel_m: 0.25, extent_m: (10.0, 5.0), zenith_deg: 40.0, azimuth_deg: 30.0",
            "size_px: (40, 20), extent_m: (10.0, 5.0), zenith_deg: 40.0, azimuth_deg: 30.0",
        ),
    ] {
        let found = traced("Periodic", by_side, &usual).expect("an image");
        let expected = traced("Periodic", by_number, &usual).expect("an image");
        let (found_image, expected_image) = (image(&found), image(&expected));
        assert_eq!(found_image.width, expected_image.width, "{by_side}");
        assert_eq!(found_image.height, expected_image.height, "{by_side}");
        let close = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-6;
        let [found_values, expected_values] = [found_image, expected_image]
            .map(|image| image.load().expect("pixels can be read").values);
        assert!(found_values.iter().zip(&expected_values).all(close), "{by_side}");
        assert!(grown(&found).is_empty(), "{:?}", found.notes);
    }
}

/// *Expected*: the fewest whole pixels around the same middle; their side, to the last bit, is the one
/// of the files' georeference; a note says what has grown.
#[test]
fn a_footprint_grows_to_whole_pixels_around_its_middle() {
    for (sensor, size, middle) in [
        ("pixel_m: 0.3, extent_m: (4.0, 2.0), center_m: (8.0, 5.0)", (14, 7), (8.0, 5.0)),
        ("pixel_m: 0.7, cover: WholeScene", (29, 18), (10.0, 6.0)),
        ("pixel_m: 50.0, cover: WholeScene", (1, 1), (10.0, 6.0)),
    ] {
        for boundary in ["Periodic", "Isolated"] {
            let report = traced(boundary, sensor, &Options::default()).expect("an image");
            let image = image(&report);
            assert_eq!((image.width, image.height), size, "{sensor}");
            let side: f64 = sensor[9..sensor.find(',').expect("a list")].parse().expect("a side");
            let place = image.georeference.expect("a nadir view");
            assert_eq!((place.pixel_width, place.pixel_height), (side, side));
            let east = place.west + 0.5 * side * size.0 as f64 - 500_000.0;
            let north = place.north - 0.5 * side * size.1 as f64 - 4_000_000.0;
            assert!((east - middle.0).abs() < 1e-9 && (north - middle.1).abs() < 1e-9, "{place:?}");
            let notes = grown(&report);
            assert_eq!(notes.len(), 1, "{:?}", report.notes);
            assert!(notes[0].contains(&format!("{} x {} pixels", size.0, size.1)), "{notes:?}");
        }
    }
}

#[test]
fn what_grew_over_the_edge_of_an_isolated_ground_has_no_data_there() {
    let report = traced("Isolated", "pixel_m: 0.7, cover: WholeScene", &Options::default());
    let report = report.expect("an image");
    let coverage = image(&report).load().expect("pixels can be read").coverage;
    let coverage: f64 = coverage.iter().map(|&part| f64::from(part)).sum();
    let expected = 240.0 / (0.7 * 0.7);
    assert!((coverage / expected - 1.0).abs() < 0.03, "{coverage} of {expected} pixels");
}

#[test]
fn check_notes_what_has_grown_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    let scene = scene("Isolated", "pixel_m: 0.7, extent_m: (20.0, 12.0)");
    std::fs::write(&file, scene.to_string()).expect("a file");
    let found = check_file(&file, &Options::default()).expect("a scene").join("\n");
    let note = "note: sensors.map: 20 x 12 m are not whole pixels of 0.7 m; the image shows 20.3 x 12.6 m \
                around the same middle, 29 x 18 pixels";
    assert!(found.contains(note), "{found}");
    assert!(found.contains("6.2 % of the image lies beside the ground"), "{found}");
}

#[test]
fn exactly_one_of_number_and_side_is_given() {
    for (sensor, words) in [
        ("extent_m: (4.0, 4.0)", ["neither `size_px` nor `pixel_m`", "`pixel_m: 0.5`"]),
        (
            "size_px: (8, 8), pixel_m: 0.5, extent_m: (4.0, 4.0)",
            ["test.ron:9:62 (sensors.map.pixel_m)", "take one of the two out"],
        ),
        ("pixel_m: 0.0, extent_m: (4.0, 4.0)", ["sensors.map.pixel_m", "above 0"]),
        ("pixel_m: -1.0, cover: WholeScene", ["sensors.map.pixel_m", "above 0"]),
        ("pixel_m: (0.5, 0.5), cover: WholeScene", ["sensors.map.pixel_m", "a number"]),
    ] {
        let problem = traced("Periodic", sensor, &Options::default()).expect_err("an error");
        assert!(words.iter().all(|word| problem.contains(word)), "{sensor}: {problem}");
        assert_eq!(problem.matches("error: ").count(), 1, "{problem}");
    }
}

/// Images that no memory holds are refused before anything is allocated, with a side that will do.
#[test]
fn too_many_pixels_are_refused_with_a_side_that_will_do() {
    let little = Options { memory: Some(1 << 20), ..Options::default() };
    for (options, sensor) in [
        (&Options::default(), "pixel_m: 1e-5, extent_m: (4.0, 4.0)"),
        (&Options::default(), "pixel_m: 1e-5, cover: WholeScene"),
        (&Options::default(), "pixel_m: 1e-200, cover: WholeScene"),
        (&Options::default(), "pixel_m: 2e-4, cover: WholeScene"),
        (&little, "pixel_m: 0.01, extent_m: (4.0, 4.0)"),
        (&little, "pixel_m: 0.01, cover: WholeScene"),
    ] {
        let problem = traced("Periodic", sensor, options).expect_err("an error");
        assert!(problem.contains("(sensors.map.pixel_m)"), "{sensor}: {problem}");
        let advice = problem.rsplit("pixel_m: ").next().expect("advice");
        let side = advice.split('`').next().expect("a number");
        let better = sensor.replacen(sensor[9..].split(',').next().expect("a side"), side, 1);
        assert!(side.parse::<f64>().is_ok(), "{problem}");
        // Its films alone may still be too many; what is advised then is another, larger side.
        if options.memory.is_some() {
            traced("Periodic", &better, options).expect("what is advised will do");
        }
    }
}
