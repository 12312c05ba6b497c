//! Emitted radiance and brightness temperature, against closed forms.

use std::f64::consts::PI;
use std::path::Path;

use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, run};
use sunfleck::spectral::{BandResponse, BandWindow, planck, planck_mean};
use sunfleck_tests::{Estimate, SceneText, product};

fn window(center: f64, width: f64) -> BandResponse {
    BandResponse::Window(BandWindow { center, width })
}

/// *Scene*: a periodic canopy, ground and sky, all at 300 K, of any emissivity.
/// *Expected*: every view and pixel is a black body of 300 K, in bands with and without width.
#[test]
fn an_isothermal_scene_looks_black_whatever_its_emissivity() {
    let report = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("bands", r#"
        (name: "red", center_nm: 660.0),
        (name: "tir", center_nm: 10500.0, width_nm: 1000.0),
        (name: "line", center_nm: 8000.0)"#)
        .with("materials", r#"
        "soil": Lambertian(reflectance: Bands([0.2, 0.06, 0.4]), temperature: Uniform(300.0)),
        "leaf": Leaf(
            reflectance: Bands([0.1, 0.02, 0.5]), back_reflectance: Some(Bands([0.1, 0.3, 0.1])),
            transmittance: Bands([0.1, 0.05, 0.3]), temperature: MeanDelta(mean_k: 300.0, delta_k: 0.0),
        )"#)
        .with("meshes", r#""cloud": Crown(
        shape: Box(size_m: (4.0, 4.0, 1.0)), base_m: 0.1, leaf_area_m2: 24.0,
        leaf: Disc(radius_m: 0.05), leaf_material: "leaf",
    )"#)
        .with("instances", r#"List(of: "cloud", at_m: [(2.0, 2.0, 0.0)])"#)
        .with("sun", "zenith_deg: 40.0, azimuth_deg: 10.0, irradiance: Constant(1.0)")
        .with("thermal_sky", "BlackBody(300.0)")
        .with("boundary", "Periodic")
        .with("sensors", r#"
        "views": Directions(system: Backward, views: List([(0.0, 0.0), (60.0, 90.0)]), until: Samples(30000), measure: [Radiance, BrightnessTemperature]),
        "image": Orthographic(size_px: (4, 4), extent_m: (3.0, 3.0), samples_per_px: 512, measure: [BrightnessTemperature, Brf])"#)
        .measure();
    let black = [planck_mean(&window(10_500.0, 1_000.0), 300.0), planck(8_000.0, 300.0)];
    let radiance = product(&report, "views", "radiance");
    let kelvin = product(&report, "views", "brightness_temperature");
    for view in 0..2 {
        for (band, &truth) in black.iter().enumerate() {
            let l = Estimate::of(radiance, 3 * view + 1 + band);
            // Weights are f32.
            assert!((l.value - truth).abs() < 4.0 * l.error + 1e-6 * truth, "{l:?} for {truth}");
            assert!(l.error < 2e-3 * truth, "{l:?}");
            let t = Estimate::of(kelvin, 2 * view + band);
            assert!((t.value - 300.0).abs() < 4.0 * t.error + 1e-4, "{t:?}");
        }
        // The visible band holds what is reflected of the sun.
        assert!(radiance.values[3 * view] > 0.01 && radiance.values[3 * view] < 0.1);
    }
    let image = product(&report, "image", "brightness_temperature");
    let pixels = image.image.as_ref().expect("pixels");
    assert_eq!(pixels.bands, ["tir", "line"]);
    let pixels = pixels.load().expect("pixels can be read");
    assert_eq!(pixels.values.len(), 32);
    for (kelvin, error) in pixels.values.iter().zip(&pixels.standard_error) {
        // 32 pixels of 32 randomisations each: one in 1000 such images has |t| > 4.7.
        assert!((kelvin - 300.0).abs() < 4.7 * error + 1e-3, "{kelvin} +- {error}");
    }
}

/// A periodic tile of ground that is warm in the sun, and sheets over half of it or all.
fn plates(upper: &str, instances: &str, sensors: &str) -> Report {
    let half = "g sheet\nv 0 -1 0\nv 2 -1 0\nv 2 5 0\nv 0 5 0\nf 1 2 3 4\n";
    let whole = "g sheet\nv -1 -1 0\nv 5 -1 0\nv 5 5 0\nv -1 5 0\nf 1 2 3 4\n";
    SceneText::default()
        .with("bands", r#"(name: "tir", center_nm: 10000.0)"#)
        .with("materials", format!(r#"
        "lower": Lambertian(reflectance: Constant(0.05), temperature: SunlitShaded(sunlit_k: 320.0, shaded_k: 300.0)),
        "upper": {upper}"#))
        .with_obj("half", "upper", half)
        .with_obj("whole", "upper", whole)
        .with("terrain", r#"Plane(size_m: (4.0, 4.0), material: "lower")"#)
        .with("instances", instances)
        .with("sun", "zenith_deg: 45.0, azimuth_deg: 90.0, irradiance: Constant(1.0)")
        .with("boundary", "Periodic")
        .with("sensors", sensors)
        .measure()
}

/// *Scene*: ground (ε = 0.95, in the shade 300 K) below an infinite plate (ε = 0.9 below, 280 K), seen
/// from between them. *Expected*: the radiosity of the exchange of grey plates:
/// J₁ = (ε₁ B₁ + ρ₁ ε₂ B₂) / (1 - ρ₁ ρ₂), and J₁ - J₂ = (B₁ - B₂) / (1/ε₁ + 1/ε₂ - 1).
#[test]
fn infinite_plates_exchange_as_grey_plates_do() {
    let report = plates(
        "Lambertian(reflectance: Constant(0.1), temperature: Uniform(280.0))",
        r#"List(of: "whole", at_m: [(0.0, 0.0, 2.0)])"#,
        r#"
        "down": Perspective(size_px: (2, 2), position_m: (2.0, 2.0, 1.0), target_m: (2.1, 2.0, 0.0), fov_deg: (20.0, 20.0), samples_per_px: 8192, measure: [Radiance]),
        "up": Perspective(size_px: (2, 2), position_m: (2.0, 2.0, 1.0), target_m: (2.1, 2.0, 2.0), fov_deg: (20.0, 20.0), samples_per_px: 8192, measure: [Radiance]),
        "#,
    );
    let black = [planck(10_000.0, 300.0), planck(10_000.0, 280.0)];
    let (e1, e2) = (0.95, 0.9);
    let j1 = (e1 * black[0] + (1.0 - e1) * e2 * black[1]) / (1.0 - (1.0 - e1) * (1.0 - e2));
    let j2 = (e2 * black[1] + (1.0 - e2) * e1 * black[0]) / (1.0 - (1.0 - e1) * (1.0 - e2));
    let net = (black[0] - black[1]) / (1.0 / e1 + 1.0 / e2 - 1.0);
    assert!(((j1 - j2) / net - 1.0).abs() < 1e-12);
    for (sensor, truth) in [("down", j1), ("up", j2)] {
        let l = Estimate::of(product(&report, sensor, "radiance"), 0);
        assert!(l.z(truth).abs() < 4.0 && l.error < 1e-3 * truth, "{sensor}: {l:?} for {truth}");
    }
}

/// *Scene*: a black screen over half of the tile, under the sun at 45°; its shadow takes half of the
/// ground that is seen from above. *Expected*: screen, sunlit and shaded ground at their own
/// temperatures, pixel by pixel, and the mean radiance of these; bandwidth 0 is the centre.
#[test]
fn sunlit_and_shaded_ground_have_their_own_temperatures() {
    let report = plates(
        "Lambertian(reflectance: Constant(0.0), temperature: SunlitShaded(sunlit_k: 310.0, shaded_k: 250.0))",
        r#"List(of: "half", at_m: [(0.0, 0.0, 1.0)])"#,
        r#"
        "image": Orthographic(size_px: (4, 1), extent_m: (4.0, 4.0), samples_per_px: 4096, measure: [Radiance, BrightnessTemperature]),
        "#,
    );
    let image = product(&report, "image", "radiance").image.as_ref().expect("pixels");
    let kelvin =
        product(&report, "image", "brightness_temperature").image.as_ref().expect("pixels");
    let [image, kelvin] = [image, kelvin].map(|image| image.load().expect("pixels can be read"));
    // The screen is black: its upper side is sunlit wherever it is seen.
    for column in 0..2 {
        assert!((kelvin.values[column] - 310.0).abs() < 1e-3, "{:?}", kelvin.values);
    }
    // Ground: ε B of its own, and 0.05 of what comes from the screen's lower side, which is as warm
    // as its upper one, and from a black sky.
    let black = |kelvin: f64| planck(10_000.0, kelvin);
    for (column, own) in [(2, 320.0), (3, 300.0)] {
        let least = 0.95 * black(own);
        let most = least + 0.05 * black(310.0);
        let l = f64::from(image.values[column]);
        assert!(l > least && l < most, "{column}: {l} from {least} to {most}");
    }
}

/// *Scene*: the same without reflection. *Expected*: half of the ground's radiance is that of either
/// temperature.
#[test]
fn half_shaded_ground_has_the_mean_radiance() {
    let wall = "g wall\nv 2 -1 0\nv 2 5 0\nv 2 5 2\nv 2 -1 2\nf 1 2 3 4\n";
    let report = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("bands", r#"(name: "tir", center_nm: 10000.0), (name: "wide", center_nm: 11000.0, width_nm: 6000.0)"#)
        .with("materials", r#"
        "soil": Lambertian(reflectance: Constant(0.0), temperature: MeanDelta(mean_k: 310.0, delta_k: 20.0)),
        "wall": Lambertian(reflectance: Constant(0.0), temperature: SunlitShaded(sunlit_k: 305.0, shaded_k: 100.0))"#)
        .with_obj("wall", "wall", wall)
        .with("instances", r#"List(of: "wall", at_m: [(0.0, 0.0, 0.0)])"#)
        .with("sun", "zenith_deg: 45.0, azimuth_deg: 90.0, irradiance: Constant(0.0)")
        .with("boundary", "Periodic")
        .with("sensors", r#""views": Directions(system: Backward, views: List([(0.0, 0.0), (45.0, 270.0)]), until: Samples(100000), measure: [Radiance])"#)
        .measure();
    let found = product(&report, "views", "radiance");
    for (band, window) in [window(10_000.0, 0.0), window(11_000.0, 6_000.0)].into_iter().enumerate()
    {
        let black = |kelvin: f64| planck_mean(&window, kelvin);
        let nadir = 0.5 * (black(320.0) + black(300.0));
        // From the west half of what is seen is the wall's dark side, as warm as its sunlit one; the
        // other half is its shadow.
        let west = 0.5 * (black(305.0) + black(300.0));
        for (view, truth) in [nadir, west].into_iter().enumerate() {
            let l = Estimate::of(found, 2 * view + band);
            assert!((l.value - truth).abs() < 4.0 * l.error + 1e-6 * truth, "{l:?} for {truth}");
            assert!(l.error < 1e-2 * truth, "{l:?}");
        }
    }
}

/// A plane of emissivity 0.7 at 300 K, in a band at 4 µm of this source.
fn infrared_plane(source: &str) -> SceneText {
    SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("bands", format!(r#"(name: "mir", center_nm: 4000.0, source: {source})"#))
        .with(
            "materials",
            r#""soil": Lambertian(reflectance: Constant(0.3), temperature: Uniform(300.0))"#,
        )
}

/// *Scene*: a plane at 4 µm by day. *Expected*: emission alone, reflection alone, or their sum, as the
/// band asks.
#[test]
fn bands_choose_their_sources() {
    for (source, emits, reflects) in
        [("Auto", 1.0, 0.0), ("Emission", 1.0, 0.0), ("Sunlight", 0.0, 1.0), ("Both", 1.0, 1.0)]
    {
        let report = infrared_plane(source)
            .with("sun", "zenith_deg: 60.0, irradiance: Constant(0.01)")
            .with("thermal_sky", "Radiance(Constant(0.0001))")
            .with("boundary", "Periodic")
            .with("sensors", r#"
        "views": Directions(system: Backward, views: List([(30.0, 0.0)]), until: Samples(2048), measure: [Radiance]),
        "image": Orthographic(size_px: (2, 2), extent_m: (3.0, 3.0), samples_per_px: 64, measure: [Radiance])"#)
            .measure();
        let emitted = 0.7 * planck(4_000.0, 300.0) + 0.3 * 0.0001;
        let truth = emits * emitted + reflects * 0.3 * 0.01 * 0.5 / PI;
        for sensor in ["views", "image"] {
            let l = product(&report, sensor, "radiance").values[0];
            assert!((l / truth - 1.0).abs() < 1e-5, "{source}, {sensor}: {l} for {truth}");
        }
    }
}

/// *Scene*: an isolated plane of 4 m with a speck 3 m above it, at 4 µm by day, from 45° in the east.
/// *Expected*: the footprint at the ground shows the plane alone; of a virtual plane at the height of the
/// speck a quarter shows it. What is emitted, what is reflected and their sum are all the radiance of the
/// plane or a quarter of it, in both systems.
#[test]
fn emitted_and_reflected_light_are_means_over_the_same_rectangle() {
    let speck = "g speck\nv 2 2 3\nv 2.001 2 3\nv 2.001 2.001 3\nf 1 2 3\n";
    let sources = [("Emission", 1.0, 0.0), ("Sunlight", 0.0, 1.0), ("Both", 1.0, 1.0)];
    let planes = [("", 1.0), ("virtual_plane: (),", 0.25)];
    let cases = sources.into_iter().flat_map(|source| planes.map(|plane| (source, plane)));
    for ((source, emits, reflects), (plane, shown)) in cases {
        let report = infrared_plane(source)
            .with_obj("speck", "soil", speck)
            .with("instances", r#"List(of: "speck", at_m: [(0.0, 0.0, 0.0)])"#)
            .with("sun", "zenith_deg: 0.0, irradiance: Constant(0.01)")
            .with("sensors", format!(r#"
        "back": Directions({plane} system: Backward, views: List([(45.0, 90.0)]), until: Samples(32768), measure: [Radiance]),
        "forth": Directions({plane} views: List([(45.0, 90.0)]), until: Samples(65536), measure: [Radiance], system: Forward),
        "photons": Photons({plane} per_m2: 4096.0, measure: [RadianceViews(List([(45.0, 90.0)]))])"#))
            .measure();
        let truth = shown * (emits * 0.7 * planck(4_000.0, 300.0) + reflects * 0.3 * 0.01 / PI);
        for (sensor, name) in
            [("back", "radiance"), ("forth", "radiance"), ("photons", "radiance_views")]
        {
            let l = Estimate::of(product(&report, sensor, name), 0);
            // The speck adds less than 1e-6 of the area.
            let allowed = 4.0 * l.error + 1e-5 * truth;
            assert!((l.value - truth).abs() < allowed, "{source}, {sensor}: {l:?} for {truth}");
            assert!(l.error < 0.02 * truth, "{source}, {sensor}: {l:?} for {truth}");
        }
    }
}

/// What is missing for emission is said, with what to write.
#[test]
fn a_material_that_is_seen_to_emit_needs_a_temperature() {
    let reading = SceneText::bare(0.1, "size_m: (4.0, 4.0)")
        .with("bands", r#"(name: "tir", center_nm: 10000.0)"#)
        .with("sensors", r#""views": Directions(system: Backward, views: List([(0.0, 0.0)]), measure: [BrightnessTemperature])"#)
        .read();
    assert!(reading.is_sound(), "{}", reading.render());
    let failure = run(&reading.scene, Path::new("."), &Options::default(), &Unwatched)
        .expect_err("no temperature");
    assert!(failure.to_string().contains("temperature: Uniform(300.0)"), "{failure}");
}

/// *Scene*: a plane at 4 µm by day, in a band of both kinds of light and one of sunlight, its reflection
/// split by order. *Expected*: each pixel's radiance is its own emission and reflection, whatever else is
/// measured with it, and its factor is the reflectance.
#[test]
fn orders_beside_emission_leave_the_radiance_of_pixels_as_it_is() {
    let report = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("bands", r#"(name: "mir", center_nm: 4000.0, source: Both), (name: "red", center_nm: 660.0)"#)
        .with("materials", r#""soil": Lambertian(reflectance: Bands([0.3, 0.1]), temperature: Uniform(300.0))"#)
        .with("sun", "zenith_deg: 60.0, irradiance: Bands([0.01, 1.0])")
        .with("boundary", "Periodic")
        .with("sensors", r#""image": Orthographic(size_px: (3, 2), extent_m: (3.0, 2.0), samples_per_px: 64, measure: [Radiance, Orders])"#)
        .measure();
    let truth = [0.7 * planck(4_000.0, 300.0) + 0.3 * 0.01 * 0.5 / PI, 0.1 * 0.5 / PI];
    let image = product(&report, "image", "radiance").image.as_ref().expect("pixels");
    let image = image.load().expect("pixels can be read");
    assert_eq!(image.values.len(), 12);
    for (index, value) in image.values.iter().enumerate() {
        let ratio = f64::from(*value) / truth[index % 2];
        assert!((ratio - 1.0).abs() < 1e-5, "{index}: {value} for {truth:?}");
    }
}
