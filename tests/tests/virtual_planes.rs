//! Light that leaves through a rectangle of the scene, and what lies below it.

use sunfleck::products::{Product, Report};
use sunfleck::run::Options;
use sunfleck_tests::{Estimate, SceneText, product};

const VIEWS: &str = "List([(0.0, 0.0), (40.0, 100.0), (65.0, 200.0)])";
const CONES: &str = "[(0.0, 0.0, 16.0), (40.0, 100.0, 16.0), (65.0, 200.0, 16.0)]";

/// Trees of two bands under sun and sky, one of them over the edge of the tile; `plane` is a key of
/// all sensors.
fn trees(boundary: &str, plane: &str, quality: f64) -> Report {
    SceneText::trees_in_daylight(boundary)
        .with("terrain", r#"Plane(size_m: (6.0, 5.0), corner_m: (-1.0, 2.0), material: "soil")"#)
        .with("instances", r#"List(of: "tree", at_m: [(-0.8, 4.0, 0.0), (2.0, 6.9, 0.0)])"#)
        .with("sensors", format!(r#"
        "back": Directions(system: Backward, {plane} views: {VIEWS}, until: Samples(20000), measure: [Brf, GapFraction]),
        "forth": Directions({plane} views: {VIEWS}, until: Samples(60000), system: Forward),
        "image": Orthographic({plane} size_px: (6, 5), extent_m: (8.0, 4.0), center_m: (4.0, 4.1), zenith_deg: 40.0, azimuth_deg: 280.0, samples_per_px: 512),
        "film": Orthographic({plane} size_px: (6, 5), extent_m: (8.0, 4.0), center_m: (4.0, 4.1), zenith_deg: 40.0, azimuth_deg: 280.0, samples_per_px: 2048, system: Forward),
        "photons": Photons({plane} per_m2: 3000.0, measure: [
            Albedo, BrfCells(40), BrfViews({VIEWS}), BrfCones({CONES}),
            Fapar(layer_m: 0.7), Fluxes(pixel_m: 0.5, heights_m: [1.5]),
        ]),
        "cones": Photons({plane} per_m2: 10000.0, measure: [BrfCones({CONES})])"#))
        .measure_with(&Options { quality, ..Options::default() })
}

fn bits(product: &Product) -> Vec<u64> {
    let image = product.image.iter();
    let image = image.flat_map(|image| image.load().expect("pixels can be read").values);
    let pixels = image.map(|value| u64::from(value.to_bits()));
    product.values.iter().map(|value| value.to_bits()).chain(pixels).collect()
}

/// *Scene*: trees without a plane, and with one as large as the scene. *Expected*: the same bits. An
/// isolated scene without a plane measures at the ground, so there two ways to write the same plane agree.
#[test]
fn a_plane_over_the_whole_scene_changes_nothing() {
    for boundary in ["Periodic", "Isolated"] {
        let default =
            if boundary == "Isolated" { "virtual_plane: (size_m: (6.0, 5.0))," } else { "" };
        let without = trees(boundary, default, 0.02);
        let written = "virtual_plane: (center_m: (2.0, 4.5), size_m: (6.0, 5.0)),";
        for plane in ["virtual_plane: (),", written] {
            let with = trees(boundary, plane, 0.02);
            for sensor in ["back", "forth", "film", "photons"] {
                let of = |report: &Report| -> Vec<(String, Vec<u64>)> {
                    let sensor = report.sensors.iter().find(|one| one.name == sensor);
                    let products = &sensor.expect("a sensor").products;
                    products.iter().map(|one| (one.name.clone(), bits(one))).collect()
                };
                // An image of a larger area than the isolated scene loses what lies beside it.
                if sensor != "film" || boundary == "Periodic" {
                    assert_eq!(of(&without), of(&with), "{boundary}, {plane}, {sensor}");
                }
            }
            let image = |report| bits(product(report, "image", "hdrf"));
            assert!(boundary == "Isolated" || image(&without) == image(&with));
        }
    }
}

/// *Scene*: four planes that together are the scene, seen by the very same packets. *Expected*: the
/// mean of what they measure is what the scene does, to rounding.
#[test]
fn planes_that_make_up_the_scene_measure_it_together() {
    for boundary in ["Periodic", "Isolated"] {
        let whole = trees(boundary, "virtual_plane: (),", 0.02);
        let parts: Vec<Report> = [(0.5, 3.25), (3.5, 3.25), (0.5, 5.75), (3.5, 5.75)]
            .map(|at| format!("virtual_plane: (center_m: {at:?}, size_m: (3.0, 2.5)),"))
            .iter()
            .map(|plane| trees(boundary, plane, 0.02))
            .collect();
        let mut names = vec!["albedo", "hdrf_cells", "hdrf_cones", "hdrf_views", "upwelling_top"];
        names.extend(["downwelling_terrain", "upwelling_1.5m"]);
        if boundary == "Periodic" {
            // In an isolated scene something stands out over its edge.
            names.extend(["fapar", "fapar_material", "fapar_vegetation"]);
        }
        names.push("ftran");
        for name in names {
            let of = |report| product(report, "photons", name);
            let mut most = 0.0_f64;
            for (index, value) in of(&whole).values.iter().enumerate() {
                let mean = parts.iter().map(|part| of(part).values[index]).sum::<f64>() / 4.0;
                most = most.max((mean - value).abs() / value.abs().max(1e-3));
            }
            assert!(most < 1e-9, "{boundary}, {name}: {most}");
            let unlike = parts.iter().any(|part| of(part).values != of(&parts[0]).values);
            assert!(unlike, "the trees stand where they stand: {name}");
        }
    }
}

/// *Scene*: trees under planes at the top of the scene and amid the crowns. *Expected*: backward and
/// forward paths, virtual photons, cones and images agree within four standard errors.
#[test]
fn all_estimators_see_the_same_light_leave_through_a_plane() {
    for boundary in ["Periodic", "Isolated"] {
        for height in ["", ", height_m: 2.2", ", height_m: 7.0"] {
            let plane =
                format!("virtual_plane: (center_m: (0.4, 4.1), size_m: (2.6, 3.4){height}),");
            let report = trees(boundary, &plane, 1.0);
            let back = product(&report, "back", "hdrf");
            let others = [
                product(&report, "forth", "hdrf"),
                product(&report, "photons", "hdrf_views"),
                product(&report, "cones", "hdrf_cones"),
            ];
            for (which, other) in others.into_iter().enumerate() {
                for index in 0..6 {
                    let (one, other) = (Estimate::of(back, index), Estimate::of(other, index));
                    // Over a cone of 16° the factor bends by less than this.
                    let bend = if which == 2 { 0.01 * one.value } else { 0.0 };
                    let allowed = 4.0 * one.error.hypot(other.error) + bend + 1e-6;
                    assert!(
                        (one.value - other.value).abs() < allowed,
                        "{boundary}{height}, {which}, {index}: {one:?} {other:?}"
                    );
                }
            }
            // Images have no data beside the plane.
            let (image, film) =
                (product(&report, "image", "hdrf"), product(&report, "film", "hdrf"));
            let pixels = |product: &Product| {
                let image = product.image.as_ref().expect("an image");
                image.load().expect("pixels can be read")
            };
            let (image, film) = (pixels(image), pixels(film));
            let seen = image.coverage.iter().filter(|share| **share > 0.0).count();
            assert!(seen > 2 && seen < 30, "{boundary}{height}: {seen} of 30 pixels");
            for (pixel, &share) in image.coverage.iter().enumerate() {
                for index in [2 * pixel, 2 * pixel + 1] {
                    let black = share == 0.0;
                    assert_eq!(image.values[index].is_nan(), black);
                    let is_shown_forward = film.coverage[pixel] > 0.0;
                    assert_eq!(film.values[index].is_nan(), !is_shown_forward);
                    if black || !is_shown_forward {
                        // One of 512 samples may meet what none of 64 does.
                        assert!(share.max(film.coverage[pixel]) < 0.03);
                        continue;
                    }
                    let one = f64::from(image.values[index]);
                    let known = f64::from(image.standard_error[index]);
                    // A pixel that one sample met has no error: it may be off by all that it is.
                    let error = if known.is_nan() { one } else { known };
                    let other = f64::from(film.values[index]);
                    let spread = error.hypot(f64::from(film.standard_error[index]));
                    // Of 360 pixels in all, with 31 degrees of freedom: one in 10⁴ such runs.
                    assert!(
                        (one - other).abs() < 6.0 * spread + 1e-4,
                        "{boundary}{height}, {index}: {one} {other} +- {spread}"
                    );
                }
            }
        }
    }
}

/// *Scene*: a Lambertian plain of reflectance ρ under sun and sky, and a plane over a part of it.
/// *Expected*: BRF and albedo ρ, absorption 1 - ρ, transmission to the ground 1, fluxes E and ρ E.
#[test]
fn a_plane_over_a_lambertian_plain_has_its_reflectance() {
    for boundary in ["Isolated", "Periodic"] {
        let plane = "virtual_plane: (center_m: (0.0, 4.0), size_m: (3.0, 1.7))";
        let report = SceneText::bare(0.37, "size_m: (10.0, 7.3), corner_m: (-3.1, 2.0), height_m: 12.7")
            .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0)")
            .with("sky", "Fraction([0.25])")
            .with("boundary", boundary)
            .with("sensors", format!(r#"
        "back": Directions(system: Backward, views: {VIEWS}, until: Samples(4096), {plane}),
        "photons": Photons(
            per_m2: 2000.0, {plane},
            measure: [Albedo, BrfViews({VIEWS}), BrfCells(4), Fapar(layer_m: 1.0), Fluxes(pixel_m: 0.5)],
        )"#))
            .measure();
        let rho = 0.37;
        let sun = 40_f64.to_radians().cos();
        let sure = |sensor: &str, name: &str, truth: f64| {
            let product = product(&report, sensor, name);
            for index in 0..product.values.len() {
                let one = Estimate::of(product, index);
                let allowed = 4.0 * one.error + 1e-6;
                assert!((one.value - truth).abs() < allowed, "{boundary}, {name}: {one:?}");
                assert!(one.error < 0.03, "{name}: {one:?}");
            }
        };
        sure("back", "hdrf", rho);
        sure("photons", "albedo", rho);
        sure("photons", "hdrf_views", rho);
        sure("photons", "hdrf_cells", rho);
        sure("photons", "fapar_material", 1.0 - rho);
        let total = Estimate::of(product(&report, "photons", "ftran"), 0);
        assert!((total.value - 1.0).abs() < 4.0 * total.error, "{boundary}: {total:?}");
        for level in ["terrain", "top"] {
            sure("photons", &format!("downwelling_{level}"), sun);
            sure("photons", &format!("upwelling_{level}"), rho * sun);
        }
        let image = product(&report, "photons", "upwelling_top").image.as_ref().expect("a raster");
        assert_eq!((image.width, image.height), (6, 3), "a raster of the plane alone");
        let place = image.georeference.expect("a place");
        assert!((place.west + 1.5).abs() < 1e-12 && (place.north - 4.85).abs() < 1e-12);
    }
}

/// *Scene*: a white-ish sheet at 2 m over the eastern half of a tile, the sun overhead, light of the
/// first order. *Expected*: over the sheet a plane at the top sees the sheet, and one at 1 m nothing;
/// beside it both see the soil; one at 1 m over all sees the soil in half of its area.
#[test]
fn a_low_plane_is_left_only_by_what_comes_from_below_it() {
    let sheet = "g sheet\nv 2 0 2\nv 4 0 2\nv 4 4 2\nv 2 4 2\nf 1 2 3\nf 1 3 4\n";
    let east = "center_m: (3.0, 2.0), size_m: (2.0, 4.0)";
    let west = "center_m: (1.0, 2.0), size_m: (2.0, 4.0)";
    let cases = [
        (format!("({east})"), 0.5),
        (format!("({east}, height_m: 1.0)"), 0.0),
        (format!("({west})"), 0.2),
        (format!("({west}, height_m: 1.0)"), 0.2),
        // A surface at the plane's own height lies below it.
        (format!("({west}, height_m: 0.0)"), 0.2),
        (format!("({east}, height_m: 2.0)"), 0.5),
        ("(height_m: 1.0)".to_owned(), 0.1),
        ("()".to_owned(), 0.35),
    ];
    for boundary in ["Isolated", "Periodic"] {
        for (plane, truth) in &cases {
            let report = SceneText::bare(0.2, "size_m: (4.0, 4.0)")
                .with_more("materials", r#""sheet": Lambertian(reflectance: Constant(0.5))"#)
                .with("meshes", r#""sheet": Obj(file: "sheet.obj", up: Z, unit_m: 1.0, parts: { "sheet": "sheet" })"#)
                .with_file("sheet.obj", sheet)
                .with("instances", r#"List(of: "sheet", at_m: [(0.0, 0.0, 0.0)])"#)
                .with("sun", "zenith_deg: 0.0, irradiance: Constant(1.0)")
                .with("boundary", boundary)
                .with("transport", "first_order_only: true")
                .with("sensors", format!(r#"
        "back": Directions(system: Backward, views: List([(0.0, 0.0)]), until: Samples(2048), virtual_plane: {plane}),
        "forth": Directions(views: List([(0.0, 0.0)]), until: Samples(4096), virtual_plane: {plane}, system: Forward)"#))
                .measure();
            for sensor in ["back", "forth"] {
                let one = Estimate::of(product(&report, sensor, "brf"), 0);
                let allowed = 4.0 * one.error + 1e-6;
                assert!(
                    (one.value - truth).abs() < allowed && one.error < 0.01,
                    "{boundary}, {sensor}, {plane}: {one:?}"
                );
            }
        }
    }
}
