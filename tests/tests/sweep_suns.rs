//! Points of a sweep that differ in the sun's position share the paths that start at sensors.

use std::f64::consts::PI;

use sunfleck::products::{Product, Report};
use sunfleck_tests::{Estimate, SceneText, product};

/// Zenith and azimuth angles of the suns of the tests, degrees.
const SUNS: [[f64; 2]; 5] =
    [[10.0, 30.0], [35.0, 120.0], [62.0, 200.0], [48.0, 290.0], [75.0, 350.0]];

/// `Zip` of zenith and azimuth angles.
fn zip(suns: &[[f64; 2]]) -> String {
    let [zenith, azimuth] =
        [0, 1].map(|at| suns.iter().map(|angles| angles[at]).collect::<Vec<_>>());
    format!(r#"Zip({{ "sza": {zenith:?}, "saa": {azimuth:?} }})"#)
}

/// A scene whose sun is at `sza` and `saa`.
fn with_sun(scene: SceneText, more: &str) -> SceneText {
    let sun = r#"zenith_deg: "=sza", azimuth_deg: "=saa", irradiance: Constant(1.5)"#;
    scene.with("params", r#""sza": 30.0, "saa": 0.0"#).with("sun", format!("{sun}{more}"))
}

/// The scene at one of the suns, in a run of its own.
fn own_run(scene: &SceneText, sun: [f64; 2], seed: u64) -> Report {
    let [zenith, azimuth] = sun;
    scene
        .clone()
        .with("params", format!(r#""sza": {zenith:?}, "saa": {azimuth:?}"#))
        .with("transport", format!("seed: {seed}"))
        .measure()
}

/// *Scene*: a level and an inclined Lambertian square under parallel light, in images. *Expected*: `ρ cos θ' / cos θ` in
/// each pixel with the angle of incidence `θ'`, exactly, and the radiance of the sun's irradiance.
#[test]
fn lambertian_faces_have_the_reflectance_of_the_incidence_of_each_sun() {
    let slope = 20_f64.to_radians();
    let (low, high) = (1.0 - slope.tan(), 1.0 + slope.tan());
    let scene = with_sun(SceneText::bare(0.4, "size_m: (2.0, 2.0)"), "");
    // The ground rises to the east.
    let inclined = with_sun(SceneText::bare(0.0, "size_m: (9.0, 9.0)"), "")
        .with_more("materials", r#""rock": Lambertian(reflectance: Constant(0.4))"#)
        .with("meshes", format!(r#""face": Faces(faces_m: [[(-1.0, -1.0, {low}), (1.0, -1.0, {high}), (1.0, 1.0, {high}), (-1.0, 1.0, {low})]], material: "rock")"#))
        .with("instances", r#"List(of: "face", at_m: [(4.5, 4.5, 0.0)])"#);
    for (scene, slope) in [(scene, 0.0), (inclined, slope)] {
        let sensors = r#"
            "image": Orthographic(size_px: (4, 3), extent_m: (1.0, 1.0), samples_per_px: 2, measure: [Brf, Radiance]),
            "first": Orthographic(size_px: (4, 3), extent_m: (1.0, 1.0), samples_per_px: 2, system: FirstOrder, measure: [Orders]),
            "plain": Orthographic(size_px: (4, 3), extent_m: (1.0, 1.0), samples_per_px: 2, system: Reference)"#;
        let (groups, reports) = scene.with("sensors", sensors).with("sweep", zip(&SUNS)).sweep();
        assert_eq!(groups, [[0, 1, 2, 3, 4]]);
        for ([zenith, azimuth], report) in SUNS.into_iter().zip(&reports) {
            let (zenith, azimuth) = (zenith.to_radians(), azimuth.to_radians());
            // Towards the east the normal is -sin(slope).
            let incidence = zenith.cos() * slope.cos() - zenith.sin() * azimuth.sin() * slope.sin();
            let expected = 0.4 * incidence.max(0.0) / zenith.cos();
            let near = |value: f64, expected: f64| (value - expected).abs() < 1e-6;
            let single = if slope > 0.0 { "brf_co_sgl" } else { "brf_uc" };
            for (sensor, name) in [("image", "brf"), ("first", single), ("plain", "brf")] {
                let brf = product(report, sensor, name);
                let image = brf.image.as_ref().expect("pixels");
                let pixels = image.load().expect("pixels can be read").values;
                assert!(pixels.iter().all(|&pixel| near(pixel.into(), expected)), "{brf:?}");
            }
            let radiance = product(report, "image", "radiance").values[0];
            assert!(near(radiance, expected * 1.5 * zenith.cos() / PI), "{radiance}");
        }
    }
}

/// Sensors of all kinds that start paths.
const SENSORS: &str = r#"
    "image": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0), samples_per_px: 200, measure: [Brf, Radiance, Orders, FourComponents, GapFraction, BrightnessTemperature]),
    "slanted": Orthographic(zenith_deg: 40.0, azimuth_deg: 100.0, size_px: (3, 3), extent_m: (5.0, 5.0), samples_per_px: 200, measure: [Brf, FourComponents]),
    "sky": Fisheye(position_m: (2.5, 2.5, 0.4), size_px: (8, 8), samples_per_px: 60, measure: [Radiance, FourComponents, GapFraction]),
    "first": Orthographic(size_px: (3, 3), extent_m: (5.0, 5.0), samples_per_px: 200, system: FirstOrder, measure: [Orders]),
    "plain": Orthographic(size_px: (3, 3), extent_m: (5.0, 5.0), samples_per_px: 100, system: Reference),
    "views": Directions(views: List([(0.0, 0.0), (45.0, 90.0)]), until: Samples(4000), system: Backward, measure: [Brf, Radiance, Orders, FourComponents, GapFraction, BrightnessTemperature])"#;

/// Trees, warmer where the sun shines, in reflected and emitted light.
fn trees() -> SceneText {
    let trees = SceneText::two_trees()
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10500.0)"#)
        .with("materials", r#"
            "soil": Lambertian(reflectance: Bands([0.1, 0.3, 0.05]), temperature: SunlitShaded(sunlit_k: 320.0, shaded_k: 290.0)),
            "leaf": Leaf(reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]), temperature: SunlitShaded(sunlit_k: 303.0, shaded_k: 295.0))"#)
        .with("thermal_sky", "BlackBody(250.0)");
    with_sun(trees, ", disc_deg: 3.0").with("boundary", "Periodic").with("sensors", SENSORS)
}

/// Values and errors of all products of a report, pixels too, with their names.
fn entries(report: &Report) -> Vec<(String, Vec<Estimate>)> {
    let of = |sensor: &str, product: &Product| {
        let values = product.values.iter().zip(&product.standard_error);
        let mut all: Vec<Estimate> =
            values.map(|(&value, &error)| Estimate { value, error }).collect();
        if let Some(image) = &product.image {
            let image = image.load().expect("pixels can be read");
            let pixels = image.values.iter().zip(&image.standard_error);
            all.extend(pixels.map(|(&v, &e)| Estimate { value: v.into(), error: e.into() }));
        }
        (format!("{sensor} {}", product.name), all)
    };
    let sensors = report.sensors.iter();
    sensors.flat_map(|s| s.products.iter().map(move |one| of(&s.name, one))).collect()
}

/// *Scene*: trees at sensors of all kinds, under five suns with and without a sky. *Expected*: a run of each sun of its own with the
/// same seed has the same values and errors but for rounding, as a path of one sun takes the same way.
#[test]
fn every_point_is_a_run_of_its_own_but_for_rounding() {
    for sky in
        ["None", "Fraction([0.3, 0.1, 0.0])", "Isotropic(irradiance: Bands([0.2, 0.1, 0.0]))"]
    {
        let scene = trees().with("sky", sky);
        let (groups, reports) = scene.clone().with("sweep", zip(&SUNS)).sweep();
        assert_eq!(groups.len(), 1);
        for (sun, report) in SUNS.into_iter().zip(&reports) {
            let own = own_run(&scene, sun, 1);
            let (own, joined) = (entries(&own), entries(report));
            assert_eq!(own.len(), joined.len());
            for ((name, own), (joined_name, joined)) in own.iter().zip(&joined) {
                assert_eq!((name, own.len()), (joined_name, joined.len()));
                for (own, joined) in own.iter().zip(joined) {
                    let is_near = |a: f64, b: f64| {
                        (a - b).abs() <= 1e-5 * b.abs() + 1e-9 || a.is_nan() && b.is_nan()
                    };
                    assert!(is_near(joined.value, own.value), "{sun:?} {name}: {joined:?} {own:?}");
                }
            }
        }
    }
}

/// *Scene*: the same with an isolated plot, under suns and optics that both differ. *Expected*: means of each point within 4.5
/// standard errors of a run of its own with another seed, and `Σ z²` within 5 standard deviations of its number.
#[test]
fn points_of_other_suns_and_optics_agree_with_runs_of_their_own() {
    let scene = trees()
        .with("boundary", "Isolated")
        .with("sky", "Fraction([0.3, 0.1, 0.0])")
        .with("params", r#""sza": 30.0, "saa": 0.0, "r": 0.5"#)
        .with("materials", r#"
            "soil": Lambertian(reflectance: Bands([0.1, 0.3, 0.05]), temperature: SunlitShaded(sunlit_k: 320.0, shaded_k: 290.0)),
            "leaf": Leaf(reflectance: Bands([0.05, "=r", 0.02]), transmittance: Bands([0.03, 0.45, 0.0]), temperature: SunlitShaded(sunlit_k: 303.0, shaded_k: 295.0))"#);
    let (groups, reports) = scene
        .clone()
        .with("sweep", r#"Grid({ "r": [0.2, 0.5], "sza": [20.0, 50.0, 65.0] })"#)
        .sweep();
    // Points of one sun follow each other.
    assert_eq!(groups, [[0, 3, 1, 4, 2, 5]]);
    let (mut squares, mut count) = (0.0, 0.0);
    for (place, report) in reports.iter().enumerate() {
        let (r, zenith) = ([0.2, 0.5][place / 3], [20.0, 50.0, 65.0][place % 3]);
        let own = scene
            .clone()
            .with("params", format!(r#""sza": {zenith:?}, "saa": 0.0, "r": {r:?}"#))
            .with("transport", "seed: 7")
            .measure();
        for sensor in ["image", "slanted", "first", "plain", "views"] {
            let name = if sensor == "first" { "hdrf_co_sgl" } else { "hdrf" };
            let [own, joined] = [&own, report].map(|report| product(report, sensor, name));
            for at in 0..own.values.len().min(2) {
                let z = Estimate::of(own, at).z_against(Estimate::of(joined, at));
                assert!(z.abs() < 4.5, "{sensor} {place}: {z}");
                squares += z * z;
                count += 1.0;
            }
        }
    }
    let excess: f64 = (squares - count) / (2.0_f64 * count).sqrt();
    assert!(excess.abs() < 5.0, "{squares} of {count}");
}

/// *Scene*: the trees at sensors that start paths and at sensors of photons in turn, at points of suns and optics. *Expected*:
/// all points share paths; sensors keep their order; and values of photons are those of points of one sun that share
/// paths without the others, but for rounding.
#[test]
fn sensors_of_photons_are_traced_sun_by_sun() {
    let sensors = r#"
        "brf": Directions(views: List([(0.0, 0.0), (45.0, 90.0)]), until: Samples(2000)),
        "image": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0), samples_per_px: 8, measure: [Brf, FourComponents]),
        "map": Photons(per_m2: 40.0, measure: [Albedo, Fapar(layer_m: 1.0)]),
        "fisheye": Fisheye(position_m: (2.5, 2.5, 0.4), size_px: (4, 4), samples_per_px: 8, measure: [Radiance])"#;
    let scene = trees()
        .with("sky", "Fraction([0.3, 0.1, 0.0])")
        .with("sensors", sensors)
        .with("params", r#""sza": 30.0, "saa": 40.0, "s": 0.1"#)
        .with("materials", r#"
            "soil": Lambertian(reflectance: Bands(["=s", 0.3, 0.05]), temperature: SunlitShaded(sunlit_k: 320.0, shaded_k: 290.0)),
            "leaf": Leaf(reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]), temperature: Uniform(300.0))"#);
    let grid = |suns: &str| format!(r#"Grid({{ "s": [0.1, 0.2], "sza": {suns} }})"#);
    let (groups, reports) = scene.clone().with("sweep", grid("[15.0, 40.0, 70.0]")).sweep();
    assert_eq!(groups, [[0, 3, 1, 4, 2, 5]]);
    for (place, zenith) in [15.0, 40.0, 70.0].into_iter().enumerate() {
        let (_, alone) = scene.clone().with("sweep", grid(&format!("[{zenith:?}]"))).sweep();
        for (alone, report) in alone.iter().zip([&reports[place], &reports[place + 3]]) {
            let names = |report: &Report| -> Vec<String> {
                report.sensors.iter().map(|sensor| sensor.name.clone()).collect()
            };
            assert_eq!(names(report), ["brf", "image", "map", "fisheye"]);
            assert_eq!(report.irradiance, alone.irradiance);
            let (alone, joined) = (entries(alone), entries(report));
            assert_eq!(alone.len(), joined.len());
            for ((name, alone), (_, joined)) in alone.iter().zip(&joined) {
                for (a, b) in alone.iter().zip(joined) {
                    let is_near = (a.value - b.value).abs() <= 1e-5 * a.value.abs() + 1e-9;
                    assert!(is_near || a.value.is_nan(), "{zenith} {name}: {a:?} {b:?}");
                }
            }
        }
    }
}

/// *Scene*: 70 suns in two bands, more bands than there are representative ones. *Expected*: groups of at most 64 suns, of about
/// the same size; and some points as in runs of their own but for rounding.
#[test]
fn suns_do_not_use_up_representative_bands() {
    let suns: Vec<[f64; 2]> =
        (0..70_u32).map(|i| [10.0 + f64::from(i), f64::from(i * 37 % 360)]).collect();
    let scene = with_sun(SceneText::two_trees(), "")
        .with("sky", "Isotropic(irradiance: Bands([0.2, 0.1]))")
        .with("boundary", "Periodic")
        .with(
            "sensors",
            r#""image": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0), samples_per_px: 40)"#,
        );
    let (groups, reports) = scene.clone().with("sweep", zip(&suns)).sweep();
    assert_eq!(groups.iter().map(Vec::len).collect::<Vec<_>>(), [35, 35]);
    for place in [0, 20, 34, 35, 69] {
        let own = own_run(&scene, suns[place], 1);
        let [own, joined] = [&own, &reports[place]].map(|report| product(report, "image", "hdrf"));
        for (a, b) in own.values.iter().zip(&joined.values) {
            assert!((a - b).abs() < 1e-5 * a, "{place}: {a} {b}");
        }
    }
}

/// Suns share paths if some sensor starts any; directions that follow the sun need its azimuth. Points at night share paths
/// too.
#[test]
fn points_share_paths_among_suns_if_some_start_at_sensors() {
    let scene = with_sun(SceneText::bare(0.3, "size_m: (2.0, 2.0)"), "")
        .with("sky", "Isotropic(irradiance: Constant(0.3))")
        .with("sweep", r#"Grid({ "sza": [10.0, 50.0], "saa": [0.0, 90.0] })"#);
    let image = r#""i": Orthographic(size_px: (1, 1), extent_m: (1.0, 1.0), samples_per_px: 2"#;
    let views = "until: Samples(64), views: ";
    for (sensors, groups) in [
        (format!("{image})"), 1),
        (format!("{image}, system: Forward)"), 4),
        (format!(r#"{image}), "p": Photons(per_m2: 9.0, measure: [Albedo])"#), 1),
        (format!(r#""d": Directions({views} List([(0.0, 0.0), (9.0, 0.0)]))"#), 4),
        (format!(r#""d": Directions({views} List([(0.0, 0.0)]))"#), 1),
        (
            format!(r#""d": Directions({views} PrincipalPlane(step_deg: 40.0), system: Backward)"#),
            2,
        ),
    ] {
        let (found, reports) = scene.clone().with("sensors", &*sensors).sweep();
        assert_eq!(found.len(), groups, "{sensors}");
        for report in &reports {
            let sensor = &report.sensors[0].name;
            let hdrf = product(report, sensor, "hdrf");
            let z = Estimate::of(hdrf, 0).z(0.3);
            assert!(z.abs() < 4.5 || (hdrf.values[0] - 0.3).abs() < 1e-6, "{sensors}: {hdrf:?}");
        }
    }
    let day = r#"position: Spa(date: (2026, 6, 21), time: ("=h", 0, 0), latitude_deg: 52.5, longitude_deg: 13.4, utc_offset_h: 2.0), irradiance: Constant(1.5)"#;
    let (groups, reports) = scene
        .with("params", r#""h": 12.0"#)
        .with("sun", day)
        .with("sensors", format!("{image})"))
        .with("sweep", r#"Grid({ "h": [0.0, 1.0, 9.0, 12.0, 23.5] })"#)
        .sweep();
    assert_eq!(groups, [vec![0, 1, 4], vec![2, 3]]);
    for report in &reports {
        assert!((product(report, "i", "hdrf").values[0] - 0.3).abs() < 1e-6);
    }
}
