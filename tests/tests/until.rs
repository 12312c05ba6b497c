//! Measurements that go on until they are good enough.

use sunfleck::products::{Report, SensorReport};
use sunfleck::run::{Options, Unwatched, check_file, run_file};
use sunfleck_tests::SceneText;

/// Every kind of sensor, ending as `until` tells of its name.
fn sensors(until: impl Fn(&str) -> String) -> String {
    let [image, film, camera, eye, back, forth, photons] =
        ["image", "film", "camera", "eye", "back", "forth", "photons"].map(until);
    format!(
        r#"
        "image": Orthographic(size_px: (20, 18), extent_m: (5.0, 5.0), zenith_deg: 20.0, measure: [Brf, Radiance, GapFraction], until: {image}),
        "film": Orthographic(size_px: (5, 4), extent_m: (5.0, 5.0), zenith_deg: 20.0, system: Forward, until: {film}),
        "camera": Perspective(size_px: (17, 9), position_m: (-3.0, 2.5, 4.0), target_m: (2.0, 2.5, 0.5), fov_deg: (40.0, 30.0), until: {camera}),
        "eye": Fisheye(size_px: (16, 16), position_m: (2.5, 2.5, 0.2), measure: [Radiance, GapFraction], until: {eye}),
        "back": Directions(system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), measure: [Brf, Orders, FourComponents], until: {back}),
        "forth": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), measure: [Brf, Orders], system: Forward, until: {forth}),
        "photons": Photons(measure: [Albedo, BrfCells(12), Fapar(layer_m: 1.0), Orders], until: {photons}),
    "#
    )
}

fn run(sensors: &str) -> Report {
    SceneText::trees_in_daylight("Periodic").with("sensors", sensors).measure()
}

/// *Scene*: two trees in a periodic scene, seen by every kind of sensor. *Expected*: each product's
/// median relative standard error is at most that asked for and, since errors are looked at after
/// every eighth, not far below for the worst of them; and the very same bits come out if the number of
/// samples at which it ended is asked for instead, in one round.
#[test]
fn a_sensor_goes_on_until_every_product_is_good_enough() {
    let report = run(&sensors(|_| "RelError(0.15)".to_owned()));
    for sensor in &report.sensors {
        let errors: Vec<f64> = sensor
            .products
            .iter()
            .filter(|product| product.name != "energy")
            .filter_map(|product| product.median_relative_error().expect("pixels can be read"))
            .collect();
        let worst = errors.iter().copied().fold(0.0, f64::max);
        assert!(worst <= 0.15 && worst > 0.08, "{}: {errors:?}", sensor.name);
        assert!(sensor.ended_by.contains("at most 1.50e-1"), "{}", sensor.ended_by);
    }
    let samples = |name: &str| {
        let sensor = report.sensors.iter().find(|sensor| sensor.name == name).expect("it");
        let pixels = sensor.products[0].image.as_ref().map(|image| image.width * image.height);
        let films = if matches!(name, "image" | "eye" | "back") { 2 } else { 1 };
        // Of images, samples a pixel: of one made of packets the next that makes as many.
        format!("Samples({})", sensor.samples.div_ceil(films * pixels.unwrap_or(1) as u64))
    };
    let again = run(&sensors(samples));
    for (sensor, again) in report.sensors.iter().zip(&again.sensors) {
        if sensor.name != "film" {
            assert_eq!(again.samples, sensor.samples, "{}", sensor.name);
            let bits = |sensor: &SensorReport| sensor.bits().expect("pixels can be read");
            assert!(bits(again) == bits(sensor), "{}", sensor.name);
        }
    }
}

/// *Expected*: of several conditions the first that holds ends it, and the report names it; products
/// that are not named in `RelErrors` do not count.
#[test]
fn the_first_condition_that_holds_ends_it() {
    let photons = |until: &str, measure: &str| {
        let report = run(&format!(r#""p": Photons(measure: [{measure}], until: {until})"#));
        let sensor = report.sensors[0].clone();
        (sensor.samples, sensor.ended_by)
    };
    let (samples, text) = photons("[RelError(0.0001), Samples(3200)]", "Albedo");
    assert_eq!((samples, text.as_str()), (3200, "3200 packets"));
    let (samples, text) =
        photons("[Samples(1000000000), RelErrors({ \"albedo\": 0.05 })]", "BrfCells(12), Albedo");
    assert!(text.starts_with("albedo: median relative standard error"), "{text}");
    let (all, _) = photons("[Samples(1000000000), RelError(0.05)]", "BrfCells(12), Albedo");
    assert!(all > 2 * samples, "{all} {samples}");
    let (_, text) = photons("[RelError(0.000001), Seconds(0.2)]", "Albedo");
    assert!(text.starts_with("0.2 s: "), "{text}");
}

/// *Scene*: black soil, black leaves. *Expected*: what is 0 throughout is believed after many samples.
#[test]
fn a_black_scene_ends() {
    let report = SceneText::trees_in_daylight("Periodic")
        .with(
            "materials",
            r#"
        "soil": Lambertian(reflectance: Bands([0.0, 0.0])),
        "leaf": Leaf(reflectance: Bands([0.0, 0.0]), transmittance: Bands([0.0, 0.0]))"#,
        )
        .with("sensors", r#""p": Photons(until: RelError(0.01))"#)
        .measure();
    assert!((1 << 17..1 << 18).contains(&report.sensors[0].samples), "{:?}", report.sensors[0]);
}

/// *Expected*: one error that names the sensor, the product and the nearest one that it reports, and is the
/// same where the scene is run and where it is only checked.
#[test]
fn a_product_that_is_not_there_is_an_error() {
    let sensor = r#""p": Photons(measure: [Albedo], until: RelErrors({ "albdeo": 0.01 }))"#;
    let wrong = SceneText::trees_in_daylight("Periodic").with("sensors", sensor);
    let folder = std::env::temp_dir().join(format!("sunfleck-until-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let file = folder.join("wrong.ron");
    std::fs::write(&file, wrong.to_string()).expect("a scene");
    let failure = run_file(&file, &Options::default(), &Unwatched).expect_err("an error");
    let checked = check_file(&file, &Options::default()).expect_err("an error");
    std::fs::remove_dir_all(&folder).expect("the folder is there");
    let text = failure.to_string();
    assert_eq!(text, checked.to_string());
    for part in ["no product `albdeo`", "wrong.ron:", "did you mean `albedo`?", "sensors.p.until"] {
        assert!(text.contains(part), "{part} in {text}");
    }
}
