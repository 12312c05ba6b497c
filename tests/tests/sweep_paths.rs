//! Points of a sweep that differ in optics, light or temperature alone are traced on the same paths.

use sunfleck::products::{Product, Report};
use sunfleck::run::{Checkpoint, Options, Partition, SaveRule};
use sunfleck_tests::{Estimate, SceneText, albedo_of_sheets, product};

/// Text of a list of numbers.
fn list(values: impl IntoIterator<Item = f64>) -> String {
    format!("{:?}", values.into_iter().collect::<Vec<_>>())
}

/// Sheets of leaf over soil with the parameters `r`, `t` and `s`, in one band.
fn sheets() -> SceneText {
    SceneText::sheets(&[(0.0, 0.0, 0.0)], &[1.0, 2.0])
        .with("params", r#""r": 0.1, "t": 0.1, "s": 0.1, "sza": 30.0"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=s")), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant("=t"))"#)
        .with("sun", r#"zenith_deg: "=sza", azimuth_deg: 10.0, irradiance: Constant(1.0)"#)
        .with("sensors", r#""p": Photons(per_m2: 200.0, measure: [Albedo])"#)
}

/// *Scene*: two sheets of leaf over soil at 300 points with reflectances and transmittances from black to white, more than
/// there are representative bands. *Expected*: the albedo of each point by adding layers, within 4.5 standard errors; and
/// at five points a standard error that is at most twice that of a run of their own (measured: 1.6, where a leaf transmits
/// much less than those that it shares paths with).
#[test]
fn every_point_has_its_own_values_and_errors() {
    let points: Vec<(f64, f64, f64)> = (0..300_u32)
        .map(|i| {
            let place = |step: u32| f64::from(i * step % 300) / 299.0;
            let r = 0.9 * place(1);
            (r, (0.95 - r) * place(7), 0.95 * place(77))
        })
        .collect();
    let of = |value: fn(&(f64, f64, f64)) -> f64| list(points.iter().map(value));
    let values = format!(
        r#"Zip({{ "r": {}, "t": {}, "s": {} }})"#,
        of(|point| point.0),
        of(|point| point.1),
        of(|point| point.2)
    );
    let (groups, reports) = sheets().with("sweep", values).sweep();
    assert_eq!(groups, [(0..300).collect::<Vec<_>>()]);
    for (&optics, report) in points.iter().zip(&reports) {
        let albedo = Estimate::of(product(report, "p", "albedo"), 0);
        let truth = albedo_of_sheets(optics, 2);
        assert!(
            (albedo.value - truth).abs() < 4.5 * albedo.error + 1e-6,
            "{optics:?} {albedo:?} {truth}"
        );
        assert_eq!(report.bands, ["b0"]);
        assert!(report.warnings.iter().all(|text| text.contains("float above")), "{report:?}");
    }
    for place in [3, 100, 150, 220, 299] {
        let (r, t, s) = points[place];
        let own = sheets()
            .with("params", format!(r#""r": {r:?}, "t": {t:?}, "s": {s:?}, "sza": 30.0"#))
            .measure();
        let [own, joined] =
            [&own, &reports[place]].map(|report| product(report, "p", "albedo").standard_error[0]);
        assert!(joined < 2.0 * own, "{place}: {joined:e} for {own:e}");
    }
}

/// Whatever decides the paths makes a group of its own; photons that carry one band each, and limits of time, are traced
/// point by point.
#[test]
fn points_share_paths_if_nothing_but_values_by_band_differs() {
    let grid = r#"Grid({ "r": [0.1, 0.2], "sza": [10.0, 50.0] })"#;
    let (groups, _) = sheets().with("sweep", grid).sweep();
    assert_eq!(groups, [[0, 2], [1, 3]]);
    let alone = [
        r#""p": Photons(per_m2: 2.0, measure: [Albedo], system: Analog)"#,
        r#""p": Photons(until: Seconds(0.01), measure: [Albedo])"#,
    ];
    for sensors in alone {
        let (groups, _) = sheets().with("sweep", grid).with("sensors", sensors).sweep();
        assert_eq!(groups.len(), 4, "{sensors}");
    }
}

/// An error that is asked for holds at each point.
#[test]
fn the_error_that_is_asked_for_holds_at_every_point() {
    let sensors = r#""p": Photons(until: RelErrors({ "albedo": 0.02 }), measure: [Albedo])"#;
    let sweep = r#"Grid({ "r": [0.02, 0.5], "s": [0.02, 0.9] })"#;
    let (groups, reports) = sheets().with("sensors", sensors).with("sweep", sweep).sweep();
    assert_eq!(groups.len(), 1);
    for report in &reports {
        let albedo = Estimate::of(product(report, "p", "albedo"), 0);
        assert!(albedo.error <= 0.02 * albedo.value, "{albedo:?}");
    }
}

/// Bare soil that reflects in one band and emits in another, with images and maps of it.
fn soil() -> SceneText {
    SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("params", r#""r": 0.1, "e": 1.0, "sky": 0.1, "kelvin": 300.0"#)
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10500.0)"#)
        .with("materials", r#""soil": Lambertian(reflectance: Bands(["=r", 0.3, 0.0]), temperature: Uniform("=kelvin"))"#)
        .with("sun", r#"zenith_deg: 30.0, irradiance: Bands(["=e", "=2*e", 0.0])"#)
        .with("sky", r#"Fraction(["=sky", 0.2, 0.0])"#)
        .with("boundary", "Periodic")
        .with("sensors", r#"
        "image": Orthographic(size_px: (3, 2), extent_m: (3.0, 2.0), samples_per_px: 8, measure: [Brf, Radiance, BrightnessTemperature, GapFraction], denoised: true),
        "views": Directions(views: List([(0.0, 0.0), (40.0, 90.0)]), until: Samples(2000), measure: [Brf, Radiance, BrightnessTemperature]),
        "map": Photons(per_m2: 50.0, measure: [Fluxes(pixel_m: 2.0), Absorbed(per: Triangle)])"#)
}

fn values<'a>(report: &'a Report, sensor: &str, name: &str) -> &'a Product {
    product(report, sensor, name)
}

/// *Scene*: bare soil at points of other reflectances, irradiances, shares of the sky and temperatures. *Expected*:
/// reflectance factors, flux densities and brightness temperatures of each point, in images, tables and maps; and products
/// without bands alike at all.
#[test]
fn images_maps_and_temperatures_are_those_of_the_point() {
    let sweep = r#"Zip({ "r": [0.1, 0.4, 0.25], "e": [1.0, 0.5, 1.5], "sky": [0.1, 0.6, 0.3], "kelvin": [280.0, 300.0, 310.0] })"#;
    let (groups, reports) = soil().with("sweep", sweep).sweep();
    assert_eq!(groups.len(), 1);
    let points = [(0.1, 1.0, 280.0), (0.4, 0.5, 300.0), (0.25, 1.5, 310.0)];
    let near = |a: f64, b: f64| (a - b).abs() < 1e-4 * b.abs();
    let down = 30_f64.to_radians().cos();
    for (report, (r, e, kelvin)) in reports.iter().zip(points) {
        let brf = values(report, "image", "hdrf");
        let image = brf.image.as_ref().expect("pixels");
        assert_eq!(image.bands, ["red", "nir", "tir"]);
        let image = image.load().expect("pixels can be read");
        assert_eq!(image.values.len(), 3 * 2 * 3);
        assert!(
            image
                .values
                .chunks(3)
                .all(|pixel| near(pixel[0].into(), r) && near(pixel[1].into(), 0.3))
        );
        let radiance = values(report, "image", "radiance");
        assert!(
            near(radiance.values[0], r * e * down / std::f64::consts::PI),
            "{:?}",
            radiance.values
        );
        let warmth = values(report, "image", "brightness_temperature");
        let pixels = warmth.image.as_ref().expect("pixels");
        assert_eq!(pixels.bands, ["tir"]);
        let pixels = pixels.load().expect("pixels can be read");
        assert!(pixels.values.iter().all(|value| near((*value).into(), kelvin)), "{pixels:?}");
        let views = values(report, "views", "hdrf");
        for view in 0..2 {
            let factor = Estimate::of(views, 3 * view);
            assert!((factor.value - r).abs() < 4.5 * factor.error + 1e-6, "{factor:?} for {r}");
        }
        let warmth = values(report, "views", "brightness_temperature");
        assert!(warmth.values.iter().all(|value| near(*value, kelvin)), "{:?}", warmth.values);
        let down_map = values(report, "map", "downwelling_terrain");
        let flux = Estimate::of(down_map, 1);
        assert!(flux.z(2.0 * e * down).abs() < 4.5, "{flux:?}");
        let faces = values(report, "map", "absorbed_by_triangle").faces.as_ref().expect("faces");
        assert_eq!(faces.bands, ["red", "nir", "tir"]);
        assert_eq!(faces.values.len(), 3 * faces.inventory.faces().count());
        assert_eq!(report.irradiance.len(), 3);
        assert_eq!(
            values(report, "image", "gap_fraction"),
            values(&reports[0], "image", "gap_fraction")
        );
    }
}

/// *Scene*: SOILSPECT soils whose shapes differ and whose albedos are alike, at 150 points, under a leaf. *Expected*: the albedo
/// of every 15th point as in a run of its own, within 4.5 standard errors of the difference.
#[test]
fn soils_of_other_shapes_are_not_ruled_out() {
    let soil = r#""soil": Soilspect(albedo: Constant(0.6), roughness: Constant(0.2), b: Constant("=b"), b_prime: Constant("=p"))"#;
    let scene = sheets()
        .with("params", r#""b": 0.1, "p": 0.0"#)
        .with(
            "materials",
            format!(
                r#"{soil}, "leaf": Leaf(reflectance: Constant(0.3), transmittance: Constant(0.3))"#
            ),
        )
        .with("sun", "zenith_deg: 30.0, azimuth_deg: 10.0, irradiance: Constant(1.0)");
    let points: Vec<(f64, f64)> = (0..150_u32)
        .map(|i| {
            let share = f64::from(i) / 149.0;
            if i % 2 == 0 { (0.9 * share, 0.0) } else { (0.0, 0.9 * share) }
        })
        .collect();
    let [b, p] = [|point: &(f64, f64)| point.0, |point: &(f64, f64)| point.1]
        .map(|value| list(points.iter().map(value)));
    let sweep = format!(r#"Zip({{ "b": {b}, "p": {p} }})"#);
    let (groups, reports) = scene.clone().with("sweep", sweep).sweep();
    assert_eq!(groups.len(), 1);
    for (place, (b, p)) in points.iter().enumerate().step_by(15) {
        let own = scene
            .clone()
            .with("params", format!(r#""b": {b:?}, "p": {p:?}"#))
            .with("transport", "seed: 7")
            .measure();
        let [own, joined] =
            [&own, &reports[place]].map(|report| Estimate::of(product(report, "p", "albedo"), 0));
        assert!(own.z_against(joined).abs() < 4.5, "{b} {p}: {own:?} {joined:?}");
    }
}

/// A point without light of the sky has a BRF, one with such light an HDRF.
#[test]
fn factors_are_called_by_the_light_of_the_point() {
    let sensors = r#""v": Directions(views: List([(0.0, 0.0)]), until: Samples(200))"#;
    let (groups, reports) = sheets()
        .with("params", r#""e": 0.0, "r": 0.1, "t": 0.1, "s": 0.1, "sza": 30.0"#)
        .with("sky", r#"Isotropic(irradiance: Constant("=e"))"#)
        .with("sensors", sensors)
        .with("sweep", r#"Grid({ "e": [0.0, 0.5] })"#)
        .sweep();
    assert_eq!(groups.len(), 1);
    let name = |report: &Report| report.sensors[0].products[0].name.clone();
    assert_eq!([name(&reports[0]), name(&reports[1])], ["brf", "hdrf"]);
}

/// *Scene*: leaf sheets in 700 bands, whose coefficients are evaluated at the end. *Expected*: the albedo of every 50th band
/// by adding layers; and the same bits in one round, in rounds that are saved and resumed, and united from two parts.
#[test]
fn coefficients_are_evaluated_late_and_travel_in_checkpoints() {
    let optics: Vec<(f64, f64, f64)> = (0..700_u32)
        .map(|band| {
            let share = f64::from(band) / 699.0;
            (0.05 + 0.4 * share, 0.5 * share * (1.0 - share), 0.6 * (1.0 - share))
        })
        .collect();
    let scene = SceneText::sheets(&optics, &[1.0, 2.0]).with(
        "sensors",
        r#""p": Photons(until: Samples(60000), measure: [Albedo, Fapar(layer_m: 1.0)])"#,
    );
    let whole = scene.measure();
    for (band, optics) in optics.iter().enumerate().step_by(50) {
        let albedo = Estimate::of(product(&whole, "p", "albedo"), band);
        let truth = albedo_of_sheets(*optics, 2);
        assert!((albedo.value - truth).abs() < 4.5 * albedo.error + 1e-6, "{optics:?} {albedo:?}");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let part = |index| {
        let file = folder.path().join(format!("part{index}"));
        let share = Partition { index, count: 2 };
        let checkpoint =
            Some(Checkpoint { file: file.clone(), saves: SaveRule::Every(0.0), share });
        drop(scene.measure_with(&Options { checkpoint, ..Options::default() }));
        file
    };
    let unite = vec![part(0), part(1)];
    let united = scene.measure_with(&Options { unite, ..Options::default() });
    let file = folder.path().join("whole");
    let shorter = scene.clone().with(
        "sensors",
        r#""p": Photons(until: Samples(20480), measure: [Albedo, Fapar(layer_m: 1.0)])"#,
    );
    let saved = |scene: &SceneText| {
        let share = Partition::ALL;
        let checkpoint =
            Some(Checkpoint { file: file.clone(), saves: SaveRule::Every(0.0), share });
        scene.measure_with(&Options { checkpoint, ..Options::default() })
    };
    drop(saved(&shorter));
    let resumed = saved(&scene);
    let bits = |report: &Report| report.sensors[0].bits().expect("pixels can be read");
    assert!(bits(&whole) == bits(&united), "united");
    assert!(bits(&whole) == bits(&resumed), "resumed");
}
