//! What is seen first: sunlit and shaded ground and canopy, and gap fractions.

use std::fmt::Write as _;

use sunfleck::products::{Product, Report};
use sunfleck::sampling::Key;
use sunfleck_tests::scene_text::BAND;
use sunfleck_tests::{Estimate, SceneText, product};

const SHEET: &str = "g sheet\nv 0 -10 0\nv 2 -10 0\nv 2 10 0\nv 0 10 0\nf 1 2 3 4\n";
const WALL: &str = "g wall\nv 2 -10 0\nv 2 10 0\nv 2 10 1\nv 2 -10 1\nf 1 2 3 4\n";

/// A periodic tile of 4 m with one thing that runs through it from south to north, under a sun in
/// the east at 45°, which shines in no band.
fn tile(object: &str, height: f64, view: &str) -> Report {
    SceneText::bare(0.3, "size_m: (4.0, 4.0)")
        .with_obj("object", "soil", object)
        .with("instances", format!(r#"List(of: "object", at_m: [(0.0, 0.0, {height:?})])"#))
        .with("sun", "zenith_deg: 45.0, azimuth_deg: 90.0, irradiance: Constant(0.0)")
        .with("boundary", "Periodic")
        .with("sensors", format!(r#"
        "views": Directions(system: Backward, views: List([{view}]), until: Samples(20000), measure: [FourComponents, GapFraction]),
        "image": Orthographic(size_px: (4, 1), extent_m: (4.0, 4.0), samples_per_px: 64, measure: [FourComponents, GapFraction])"#))
        .measure()
}

fn assert_shares(product: &Product, expected: &[f64]) {
    for (index, &truth) in expected.iter().enumerate() {
        let share = Estimate::of(product, index);
        let deviation = (share.value - truth).abs();
        assert!(deviation <= 5.0 * share.error + 1e-12, "{index}: {share:?} for {truth}");
        assert!(share.error < 0.01, "{index}: {share:?}");
    }
}

/// *Scene*: a horizontal sheet over half of the tile, 1 m above the ground, seen from above.
/// *Expected*: half is sunlit sheet; of the open ground its shadow, 1 m to the west, takes half.
#[test]
fn a_sheet_hides_half_of_the_ground_and_shades_half_of_the_rest() {
    let report = tile(SHEET, 1.0, "(0.0, 0.0)");
    for sensor in ["views", "image"] {
        assert_shares(product(&report, sensor, "four_components"), &[0.25, 0.5, 0.25, 0.0]);
        assert_shares(product(&report, sensor, "gap_fraction"), &[0.5]);
    }
    // Columns from west to east: sheet, sheet, sunlit ground, shaded ground.
    let class = product(&report, "image", "dominant_component").image.as_ref().expect("pixels");
    let class = class.load().expect("pixels can be read");
    assert_eq!(class.values, [2.0, 2.0, 1.0, 3.0]);
    let shares = product(&report, "image", "four_components").image.as_ref().expect("pixels");
    let shares = shares.load().expect("pixels can be read");
    assert_eq!(shares.values[..4], [0.0, 1.0, 0.0, 0.0]);
    assert_eq!(shares.values[12..], [0.0, 0.0, 1.0, 0.0]);
}

/// *Scene*: a thin wall of 1 m seen from the west at 45°. *Expected*: a quarter of what is seen is
/// its western side, which is shaded although the sun shines on the other; its shadow is a quarter.
#[test]
fn a_surface_seen_from_its_dark_side_is_shaded() {
    let report = tile(WALL, 0.0, "(45.0, 270.0), (45.0, 90.0)");
    let shares = product(&report, "views", "four_components");
    // From the east the wall is sunlit and hides its shadow.
    assert_shares(shares, &[0.5, 0.0, 0.25, 0.25, 0.75, 0.25, 0.0, 0.0]);
    assert_shares(product(&report, "views", "gap_fraction"), &[0.75, 0.75]);
}

/// *Scene*: N discs of all directions at uniform places of a periodic tile.
/// *Expected*: the mean gap fraction over such scenes is (1 - a / (2 A cos θ))^N, exactly.
#[test]
fn gaps_between_random_discs_are_those_of_the_finite_formula() {
    let (discs, radius, side) = (200, 0.16_f64, 4.0);
    let zeniths = [0.0, 7.0, 23.0, 38.0, 53.0, 68.0_f64];
    let mut gaps = vec![Vec::new(); zeniths.len()];
    for seed in 0..16 {
        let key = Key::new(seed).path("discs");
        let mut table = String::new();
        for disc in 0..discs {
            let u = |draw: u64| key.uniform(8 * disc + draw);
            let (x, y, z) = (side * u(0), side * u(1), 0.5 + 2.0 * u(2));
            let up = 2.0 * u(3) - 1.0;
            let (sin, cos) = (std::f64::consts::TAU * u(4)).sin_cos();
            let across = (1.0 - up * up).sqrt();
            let (nx, ny) = (across * cos, across * sin);
            writeln!(table, "{radius},{x},{y},{z},{nx},{ny},{up}").expect("a string");
        }
        let views: Vec<String> =
            zeniths.iter().map(|zenith| format!("({zenith:?}, 30.0)")).collect();
        let views = format!("views: List([{}])", views.join(", "));
        let report = SceneText::default()
            .with("bands", BAND)
            .with("materials", r#""leaf": Lambertian(reflectance: Constant(0.3))"#)
            .with_discs("discs", "leaf", &table)
            .with("terrain", format!(r#"Plane(size_m: ({side:?}, {side:?}), material: "leaf")"#))
            .with("instances", r#"List(of: "discs", at_m: [(0.0, 0.0, 0.0)])"#)
            .with("boundary", "Periodic")
            .with("sensors", format!(r#""gaps": Directions(system: Backward, {views}, until: Samples(16384), measure: [GapFraction])"#))
            .measure();
        let found = product(&report, "gaps", "gap_fraction");
        for (gaps, &gap) in gaps.iter_mut().zip(&found.values) {
            gaps.push(gap);
        }
        let beer = product(&report, "gaps", "lai_beer");
        assert!((beer.values[0] + 2.0 * found.values[0].ln()).abs() < 1e-12);
        for name in ["lai_miller", "lai_2000"] {
            let lai = Estimate::of(product(&report, "gaps", name), 0);
            assert!(lai.value > 0.0 && lai.error > 0.0, "{name}: {lai:?}");
        }
    }
    let area = std::f64::consts::PI * radius * radius;
    for (zenith, gaps) in zeniths.iter().zip(&gaps) {
        let n = gaps.len() as f64;
        let mean = gaps.iter().sum::<f64>() / n;
        let squares: f64 = gaps.iter().map(|gap| (gap - mean).powi(2)).sum();
        let found = Estimate { value: mean, error: (squares / (n * (n - 1.0))).sqrt() };
        let hidden = area / (2.0 * side * side * zenith.to_radians().cos());
        let expected = (1.0 - hidden).powi(discs as i32);
        // Sixteen scenes: one in 1000 has |t| > 4.1.
        assert!(found.z(expected).abs() < 4.1, "{zenith}: {found:?} for {expected}");
        assert!(found.error < 0.05 * expected.max(0.2), "{zenith}: {found:?}");
    }
}

/// Gaps need no light at all; the four components need a sun.
#[test]
fn gaps_are_measured_in_the_dark() {
    let scene = |measure: &str| {
        SceneText::bare(0.3, "size_m: (4.0, 4.0)").with("sensors", format!(r#""gaps": Directions(system: Backward, views: List([(30.0, 0.0)]), measure: [{measure}])"#))
    };
    let report = scene("GapFraction").measure();
    assert!((product(&report, "gaps", "gap_fraction").values[0] - 1.0).abs() < 1e-12);
    let problems = scene("FourComponents").read().render();
    assert!(problems.contains("there is no sun"), "{problems}");
}

/// *Scene*: a sheet over one half of all that a fisheye sees, to the horizon. *Expected*: a gap fraction
/// of a half in every ring, and the leaf area indices that follow from it: 2 ln 2 cos 57.5° by Beer,
/// 2 ln 2 Σ w cos θ over the five rings, and Miller's integral of ln 2 cos θ.
#[test]
fn a_fisheye_tells_the_leaf_area_index_of_its_gaps() {
    let sheet = "g sheet\nv 0 -900 0\nv 900 -900 0\nv 900 900 0\nv 0 900 0\nf 1 2 3 4\n";
    let camera = |size: u32, look: &str, projection: &str| {
        format!(
            "Fisheye(size_px: ({size}, {size}), position_m: (0.0, 0.0, 1.0), look: {look}, \
             projection: {projection}, samples_per_px: 32, measure: [GapFraction])"
        )
    };
    let cameras = [
        camera(64, "Up", "Equisolid"),
        camera(48, "Up", "Orthographic"),
        camera(64, "Down", "Equidistant"),
        camera(8, "Towards(zenith_deg: 60.0, azimuth_deg: 0.0)", "Equidistant"),
    ];
    let [up, wide, down, tilted] = cameras;
    let report = SceneText::bare(0.3, "size_m: (1800.0, 1800.0), corner_m: (-900.0, -900.0)")
        .with_obj("sheet", "soil", sheet)
        .with("instances", r#"List(of: "sheet", at_m: [(0.0, 0.0, 0.9), (0.0, 0.0, 1.1)])"#)
        .with(
            "sensors",
            format!(r#""up": {up}, "wide": {wide}, "down": {down}, "tilted": {tilted}"#),
        )
        .measure();
    let half = 2_f64.ln();
    let rings = [7.0, 23.0, 38.0, 53.0, 68.0_f64].map(|ring| ring.to_radians().cos());
    let weights = [0.034, 0.104, 0.160, 0.218, 0.484];
    let five: f64 =
        rings.iter().zip(weights).map(|(cosine, weight)| 2.0 * half * cosine * weight).sum();
    // Contacts are straight lines between rings of 5°, constant before the first and after the last.
    let contact = |degrees: f64| {
        let place = ((degrees - 2.5) / 5.0).clamp(0.0, 14.0);
        let ring = |index: f64| half * (2.5 + 5.0 * index).to_radians().cos();
        let share = place.fract();
        (1.0 - share) * ring(place.floor()) + share * ring(place.ceil())
    };
    let step = 0.005_f64;
    let miller: f64 = (0..18_000)
        .map(|index| step * (f64::from(index) + 0.5))
        .map(|degrees| 2.0 * contact(degrees) * degrees.to_radians().sin() * step.to_radians())
        .sum();
    for sensor in ["up", "wide", "down"] {
        let beer = 2.0 * half * 57.5_f64.to_radians().cos();
        for (name, truth) in [("lai_beer", beer), ("lai_miller", miller), ("lai_2000", five)] {
            let lai = Estimate::of(product(&report, sensor, name), 0);
            assert!(lai.z(truth).abs() < 4.0, "{sensor}, {name}: {lai:?} for {truth}");
            assert!(lai.error > 0.0 && lai.error < 0.03 * truth, "{sensor}, {name}: {lai:?}");
        }
    }
    let tilted = report.sensors.iter().find(|sensor| sensor.name == "tilted").expect("a sensor");
    assert_eq!(tilted.products.len(), 1, "rings of a tilted camera are not those of the vertical");
}
