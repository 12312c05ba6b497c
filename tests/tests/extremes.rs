//! Scenes at the edges: borders, grazing light, thin gaps far from the origin.

use sunfleck::products::Report;
use sunfleck_tests::scene_text::LEAF;
use sunfleck_tests::{Estimate, SceneText, product};

fn forest(x: f64, sun_zenith_deg: f64, view_zenith_deg: f64) -> Report {
    SceneText::two_trees()
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)"#)
        .with("materials", format!(r#""soil": Lambertian(reflectance: Bands([0.127, 0.159])), {LEAF}"#))
        .with("meshes", r#""tree": Crown(
        shape: Ellipsoid(diameter_m: 3.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 15.0,
        leaf: Square(side_m: 0.1), leaf_material: "leaf",
    )"#)
        .with("terrain", r#"Plane(size_m: (5.0, 4.0), material: "soil")"#)
        .with("instances", format!(r#"List(of: "tree", at_m: [({x:?}, 3.9, 0.0), (3.2, 1.0, 0.0)])"#))
        .with("sun", format!("zenith_deg: {sun_zenith_deg:?}, azimuth_deg: 110.0, irradiance: Constant(1.0)"))
        .with("boundary", "Periodic")
        .with("sensors", format!(r#"
        "views": Directions(system: Backward, views: List([(0.0, 0.0), ({view_zenith_deg:?}, 77.0)]), until: Samples(65536)),
        "photons": Photons(per_m2: 3000.0, measure: [Albedo])"#))
        .measure()
}

/// *Scene*: a crown that overhangs the border, at x and at x moved by one and by three periods.
/// *Expected*: the same scene, so the same BRF within 4 standard errors of the difference.
#[test]
fn a_crown_moved_by_whole_periods_is_the_same_scene() {
    let here = forest(4.6, 40.0, 50.0);
    for x in [-0.4, 9.6, -10.4] {
        let there = forest(x, 40.0, 50.0);
        for (sensor, name) in [("views", "brf"), ("photons", "albedo")] {
            let (a, b) = (product(&here, sensor, name), product(&there, sensor, name));
            for index in 0..a.values.len() {
                // Streams are the same: most paths are too, and the difference has less noise.
                let z = Estimate::of(a, index).z_against(Estimate::of(b, index));
                assert!(z.abs() < 4.0, "x = {x}: {sensor}[{index}]: z = {z:.2}");
            }
        }
    }
}

/// *Scene*: sun and view at 89.9°. *Expected*: an end, energy that closes, and finite values: rays
/// wrap through some 500 tiles before they find the ground.
#[test]
fn light_and_views_at_89_9_degrees_end() {
    let report = forest(4.6, 89.9, 89.9);
    for (sensor, name) in [("views", "brf"), ("photons", "albedo")] {
        for value in &product(&report, sensor, name).values {
            assert!(value.is_finite() && *value > 0.0, "{sensor}: {value}");
        }
    }
    let energy = product(&report, "photons", "energy");
    for band in 0..2 {
        let term = |index: usize| energy.values[index * 2 + band];
        let balance = term(0) - (1..energy.values.len() / 2).map(term).sum::<f64>();
        assert!(balance.abs() < 1e-9, "{balance}");
        assert!(term(2).abs() < 1e-12, "nothing is lost in a periodic scene: {}", term(2));
    }
}

/// *Scene*: two leaf sheets 0.1 mm apart over black ground, at the origin, at 1 km, at 100 km and at
/// a UTM position, written as local coordinates.
/// *Expected*: albedo of two sheets by adding layers: none is skipped, none is hit twice.
#[test]
fn sheets_a_tenth_of_a_millimetre_apart_are_two_anywhere() {
    let (r, t) = (0.3, 0.4);
    let both = r + t * t * r / (1.0 - r * r);
    let sheet = "g sheet\nv -10 -10 0\nv 10 -10 1\nv 10 10 1\nv -10 10 0\nf 1 2 3 4\n";
    for (x, y) in [(0.0, 0.0), (1e3, -1e3), (1e5, 1e5), (5e5, 5.5e6)] {
        let at = [2.0, 2.0001].map(|height| (x + 0.5, y + 0.5, height));
        let report = SceneText::bare(0.0, &format!("size_m: (1.0, 1.0), corner_m: ({x:?}, {y:?})"))
            .with_leaf(r, t)
            .with_obj("sheet", "leaf", sheet)
            .with("instances", format!(r#"List(of: "sheet", at_m: {at:?})"#))
            .with("sun", "zenith_deg: 20.0, azimuth_deg: 10.0, irradiance: Constant(1.0)")
            .with("sensors", r#""view": Orthographic(size_px: (16, 16), extent_m: (1.0, 1.0), samples_per_px: 512)"#)
            .measure();
        // The sheets lean by atan(1/20) towards the west: cos i over cos θ of the sun scales what
        // they receive.
        let lean = (1.0_f64 / 20.0).atan();
        let (sun, azimuth) = (20_f64.to_radians(), 10_f64.to_radians());
        let cos_i = sun.cos() * lean.cos() - sun.sin() * lean.sin() * azimuth.sin();
        let expected = both * cos_i / sun.cos();
        let brf = Estimate::of(product(&report, "view", "brf"), 0);
        assert!(brf.error < 2e-3 * expected, "{brf:?}");
        assert!(brf.z(expected).abs() < 4.0, "({x}, {y}): {brf:?} for {expected}");
    }
}
