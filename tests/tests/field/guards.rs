//! Cases that were right from the start and stay so.

use std::fs;

use sunfleck::output;
use sunfleck::products::{Georeference, Image, Report};
use sunfleck::run::{Options, Unwatched, run_file};
use sunfleck_tests::field::{Case, Right, folder, hold};

fn case<'a>(scene: &'static str, right: &'a [Right]) -> Case<'a> {
    Case { scene, right }
}

/// A plate absorbs `E A cos θ`, whatever its size, its tilt and the sun.
#[test]
fn absorbed_power_grows_with_area_and_the_cosine_of_the_sun() {
    // The terrain is the first instance, and each has two bands.
    let plate = |power| [Right::value("alb", "absorbed_by_instance", 2, power)];
    hold(&[
        case("26-absorbed-by-patch-size/2m_0.ron", &plate(6.0)),
        case("26-absorbed-by-patch-size/1m_0.ron", &plate(1.5)),
        case("26-absorbed-by-patch-size/2m_60.ron", &plate(3.0)),
        case("26-absorbed-by-patch-size/1m_60.ron", &plate(0.75)),
        case("26-absorbed-by-patch-size/near_tilted.ron", &plate(0.75)),
        case("26-absorbed-by-patch-size/near_half_area.ron", &plate(0.375)),
    ]);
}

/// A camera with the same footprint sees the same from 1 km, 700 km and 36 000 km as a parallel
/// projection does, from above and from 60°.
#[test]
fn distance_does_not_change_what_a_camera_sees() {
    let radiance = |red, nir| {
        [(0, red, 1.5e-5), (1, nir, 1.6e-4)].map(|(index, value, within)| Right::Value {
            sensor: "p",
            product: "radiance",
            index,
            value,
            within,
        })
    };
    let nadir = radiance(0.010_711, 0.093_65);
    let slant = [Right::Value {
        sensor: "p",
        product: "radiance",
        index: 0,
        value: 0.006_825,
        within: 1.5e-5,
    }];
    hold(&[
        case("29-camera-far-away/ortho.ron", &nadir),
        case("29-camera-far-away/h1000.ron", &nadir),
        case("29-camera-far-away/h700000.ron", &nadir),
        case("29-camera-far-away/h36000000.ron", &nadir),
        case("29-camera-far-away/near_ortho_60.ron", &slant),
        case("29-camera-far-away/near_far_60.ron", &slant),
    ]);
}

/// BRF and albedo of bare ground are its reflectance under the lowest sun; a sun at the horizon or
/// below it is refused.
#[test]
fn a_sun_just_above_the_horizon_lights_the_ground() {
    let ground: Vec<Right> = [("v", "brf", 0), ("v", "brf", 2), ("alb", "albedo", 0)]
        .into_iter()
        .flat_map(|(sensor, product, first)| {
            [(first, 0.15), (first + 1, 0.25)]
                .map(|(index, value)| Right::value(sensor, product, index, value))
        })
        .collect();
    hold(&[
        case("30-sun-at-horizon/z89.0.ron", &ground),
        case("30-sun-at-horizon/z89.9.ron", &ground),
        case("30-sun-at-horizon/z89.999.ron", &ground),
        case("30-sun-at-horizon/near_view_89.9.ron", &ground),
        case("30-sun-at-horizon/z90.0.ron", &[Right::Fails(&["below 90", "found 90"])]),
        case("30-sun-at-horizon/z95.0.ron", &[Right::Fails(&["below 90", "found 95"])]),
        case("30-sun-at-horizon/near_disc.ron", &[Right::Fails(&["the horizon cuts the disc"])]),
    ]);
}

/// Fisheyes below, and above, a layer of leaves find its leaf area index to within what each method
/// makes of the directions of the leaves.
#[test]
fn a_fisheye_finds_the_leaf_area_index_of_a_layer() {
    let lai =
        |product, value, within| Right::Value { sensor: "f", product, index: 0, value, within };
    // Miller's integral ends at 75°, which horizontal leaves exceed by 1.5 % and more.
    let spherical =
        [lai("lai_beer", 2.0, 0.02), lai("lai_miller", 2.0, 0.02), lai("lai_2000", 2.0, 0.04)];
    let planophile =
        [lai("lai_beer", 2.0, 0.02), lai("lai_miller", 2.0, 0.08), lai("lai_2000", 2.0, 0.13)];
    let erectophile =
        [lai("lai_beer", 2.0, 0.02), lai("lai_miller", 2.0, 0.04), lai("lai_2000", 2.0, 0.07)];
    let one =
        [lai("lai_beer", 1.0, 0.01), lai("lai_miller", 1.0, 0.01), lai("lai_2000", 1.0, 0.02)];
    hold(&[
        case("33-fisheye-lai/spherical.ron", &spherical),
        case("33-fisheye-lai/planophile.ron", &planophile),
        case("33-fisheye-lai/erectophile.ron", &erectophile),
        case("33-fisheye-lai/near_down.ron", &spherical),
        case("33-fisheye-lai/near_lai_1.ron", &one),
    ]);
}

/// A camera that sees the sky in the thermal infrared measures the sky's temperature, and above
/// ground of emissivity `ε` that of `ε B(300 K) + (1 - ε) B(260 K)`.
#[test]
fn a_camera_measures_the_temperature_of_the_sky() {
    let kelvin = |up, nadir| {
        [("up", up), ("nadir", nadir)].map(|(sensor, value)| Right::Value {
            sensor,
            product: "brightness_temperature",
            index: 0,
            value,
            within: 0.005,
        })
    };
    hold(&[
        case("48-thermal-sky-in-camera/fish.ron", &kelvin(260.0, 298.339)),
        case("48-thermal-sky-in-camera/near_grey.ron", &kelvin(260.0, 282.092)),
        case("48-thermal-sky-in-camera/near_warm_sky.ron", &kelvin(300.0, 300.0)),
    ]);
}

fn run(scene: &str) -> Report {
    let path = folder().join(scene);
    run_file(&path, &Options::default(), &Unwatched).expect("the scene runs")
}

fn image<'a>(report: &'a Report, product: &str) -> &'a Image {
    let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
    let found = products.into_iter().find(|one| one.name == product);
    found.and_then(|one| one.image.as_ref()).expect("the product is an image")
}

/// Middle of the pixels that are darker than half the brightest one, on the map.
fn middle_of_shadow(image: &Image, place: &Georeference) -> (f64, f64) {
    let bands = image.bands.len();
    let values = image.load().expect("pixels can be read").values;
    let first = |pixel: usize| values[pixel * bands];
    let pixels = image.width * image.height;
    let brightest = (0..pixels).map(first).filter(|value| value.is_finite()).fold(0.0, f32::max);
    let dark: Vec<usize> = (0..pixels).filter(|&pixel| first(pixel) < 0.5 * brightest).collect();
    let mean = |at: &dyn Fn(usize) -> f64| {
        dark.iter().map(|&pixel| at(pixel)).sum::<f64>() / dark.len() as f64
    };
    (
        mean(&|pixel| place.west + ((pixel % image.width) as f64 + 0.5) * place.pixel_width),
        mean(&|pixel| place.north - ((pixel / image.width) as f64 + 0.5) * place.pixel_height),
    )
}

fn assert_at((x, y): (f64, f64), expected: (f64, f64), within: f64, scene: &str) {
    let distance = (x - expected.0).hypot(y - expected.1);
    assert!(distance <= within, "{scene}: at ({x}, {y}), not {expected:?}");
}

/// An image that lies on the map as GIS read it has its marker at its place; one that is turned has
/// no georeference.
#[test]
fn images_lie_on_the_map_or_have_no_georeference() {
    let folder = "35-envi-image-georeference";
    let (here, on_earth) = ((8.5, 6.5), (500_008.5, 4_000_006.5));
    for (file, expected) in [
        ("az180", Some(here)),
        ("center", Some(here)),
        ("cover", Some(here)),
        ("nonsq", Some(here)),
        ("near_wide", Some(here)),
        ("utm", Some(on_earth)),
        ("near_corner", Some(on_earth)),
        ("az0", None),
        ("az90", None),
        ("az135", None),
        ("az270", None),
    ] {
        let report = run(&format!("{folder}/{file}.ron"));
        let image = image(&report, "brf");
        match (&image.georeference, expected) {
            (Some(place), Some(expected)) => {
                assert_at(middle_of_shadow(image, place), expected, 0.11, file);
            }
            (place, expected) => {
                assert_eq!(place.is_some(), expected.is_some(), "{file}: {place:?}");
            }
        }
    }
}

/// The shadow of a plate of 4 m² on maps of light lies at the plate's place, and takes its area of
/// all light.
#[test]
fn maps_of_light_lie_on_the_map() {
    let folder = "53-flux-raster-georeference";
    for (file, expected, within) in [
        ("plain", (15.0, 3.0), 0.01),
        ("odd", (15.0, 3.0), 0.25),
        ("vplane", (15.0, 3.0), 0.01),
        ("corner", (500_115.0, 4_000_053.0), 0.01),
        ("near_north", (500_103.0, 4_000_058.0), 0.01),
        ("near_fine", (15.0, 3.0), 0.01),
    ] {
        let report = run(&format!("{folder}/{file}.ron"));
        let image = image(&report, "downwelling_terrain");
        let place = image.georeference.as_ref().expect("maps of light lie on the map");
        assert_at(middle_of_shadow(image, place), expected, within, file);
    }
}

/// Number of fields of a line of CSV, its quotes closed.
fn fields(line: &str) -> usize {
    let mut is_quoted = false;
    let mut count = 1;
    for letter in line.chars() {
        match letter {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => count += 1,
            _ => {}
        }
    }
    assert!(!is_quoted, "quotes are closed: {line}");
    count
}

/// Every row of a table has as many fields as its header, whatever bands and meshes are called.
#[test]
fn rows_have_as_many_fields_as_their_header() {
    for file in ["n", "near_lines", "near_spaces"] {
        let report = run(&format!("45-csv-output-names/{file}.ron"));
        let out = tempfile::tempdir().expect("a folder for results");
        output::write(&report, out.path()).expect("results are written");
        let mut tables = 0;
        for entry in fs::read_dir(out.path()).expect("results are there") {
            let path = entry.expect("a file").path();
            if path.extension().is_none_or(|extension| extension != "csv") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("tables are text");
            let mut lines = text.lines().filter(|line| !line.starts_with('#'));
            let header = fields(lines.next().expect("a header"));
            let rows: Vec<_> = lines.map(fields).collect();
            assert!(!rows.is_empty() && rows.iter().all(|&row| row == header), "{file}: {text}");
            tables += 1;
        }
        assert!(tables >= 2, "{file}: {tables} tables");
    }
}
