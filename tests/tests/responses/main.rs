//! Bands of real sensors: means against numpy's with published curves, and what scenes make of them.

use std::collections::BTreeMap;
use std::path::Path;

use sunfleck::document::{self, ReadOptions};
use sunfleck::products::Report;
use sunfleck::run::Options;
use sunfleck_tests::{measure, product};

/// Means of each band: of a spectrum, of it weighted with the sun, and of the sun. `reference.py` writes them.
type Reference = BTreeMap<String, BTreeMap<String, [f64; 3]>>;

fn reference() -> Reference {
    serde_json::from_str(include_str!("reference.json")).expect("numbers by sensor and band")
}

/// A level Lambertian ground: its BRF is its reflectance.
fn ground(bands: &str, reflectance: &str, more: &str) -> Report {
    let text = format!(
        r#"Scene(
            format: 1, bands: {bands},
            materials: {{ "soil": Lambertian(reflectance: {reflectance}{more}) }},
            terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
            sensors: {{ "view": Directions(views: List([(0.0, 0.0)]), until: Samples(512), measure: [{}]) }},
        "#,
        if more.contains("temperature") { "Radiance, BrightnessTemperature" } else { "Brf" },
    );
    let sun = if more.contains("sun") { "" } else { "sun: (zenith_deg: 0.0, azimuth_deg: 0.0)," };
    measure(&format!("{text}{sun})"), Path::new("."), &Options::default())
}

/// The spectrum of `reference.py`, known at whole nanometres.
fn spectrum() -> String {
    let value = |nm: f64| 0.05 + 0.4 / (1.0 + (-(nm - 715.0) / 12.0).exp());
    let points = (350..=2600).map(|nm| format!("({nm}.0, {:?})", value(f64::from(nm))));
    format!("Points([{}])", points.collect::<Vec<_>>().join(", "))
}

/// *Scene*: bare ground under the sun in all bands of Sentinel-2A, 2B and Landsat 8.
/// *Expected*: BRF and irradiance are means by numpy's trapezoidal rule, BRF weighted with the irradiance.
#[test]
fn means_over_bands_are_those_of_the_published_curves() {
    for (sensor, bands) in reference() {
        let names: Vec<String> = bands.keys().map(|band| format!("{band:?}")).collect();
        let bands_text = format!("Sensor({sensor:?}, [{}])", names.join(", "));
        let report = ground(&bands_text, &spectrum(), "");
        assert_eq!(report.bands, bands.keys().cloned().collect::<Vec<_>>());
        let brf = &product(&report, "view", "brf").values;
        for (index, (band, [_, weighted, sun])) in bands.iter().enumerate() {
            // Reflectances are f32 in the engine.
            assert!((brf[index] / weighted - 1.0).abs() < 2e-7, "{sensor} {band}: {}", brf[index]);
            let irradiance = report.irradiance[index];
            assert!((irradiance / sun - 1.0).abs() < 1e-9, "{sensor} {band}: {irradiance}");
        }
    }
}

/// *Expected*: where the irradiance has no wavelengths, reflectances are plain means.
#[test]
fn without_a_spectrum_of_light_reflectances_are_plain_means() {
    let sensor = "Sentinel-2A MSI";
    let bands = &reference()[sensor];
    let text = format!(
        r#"Scene(
            format: 1, bands: Sensor({sensor:?}, []),
            materials: {{ "soil": Lambertian(reflectance: {}) }},
            terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
            sun: (zenith_deg: 0.0, azimuth_deg: 0.0, irradiance: Constant(1.0)),
            sensors: {{ "view": Directions(views: List([(0.0, 0.0)]), until: Samples(512)) }},
        )"#,
        spectrum()
    );
    let report = measure(&text, Path::new("."), &Options::default());
    assert_eq!(report.bands.len(), 13);
    let brf = &product(&report, "view", "brf").values;
    for (band, brf) in report.bands.iter().zip(brf) {
        let [mean, ..] = bands[band];
        assert!((brf / mean - 1.0).abs() < 2e-7, "{band}: {brf} {mean}");
    }
}

/// *Scene*: ground of 300 K that emits as a black body, in the thermal bands of Landsat 8 and MODIS and a normal curve.
/// *Expected*: its brightness temperature is its temperature.
#[test]
fn a_black_ground_is_as_bright_as_it_is_warm() {
    let bands = r#"[
        (name: "tirs", response: Sensor("Landsat 8 TIRS", "B10")),
        (name: "modis", response: Sensor("Terra MODIS", "B29")),
        (name: "normal", center_nm: 11000.0, width_nm: 800.0, response: Gaussian),
        (name: "lines", source: Emission, response: Points([(9000.0, 0.0), (10000.0, 1.0), (12000.0, 0.0)])),
    ]"#;
    let report = ground(bands, "Constant(0.0)", ", temperature: Uniform(300.0)");
    let kelvin = &product(&report, "view", "brightness_temperature").values;
    for (band, kelvin) in report.bands.iter().zip(kelvin) {
        assert!((kelvin - 300.0).abs() < 2e-4, "{band}: {kelvin}");
    }
    let wavelengths: Vec<f64> = report.wavelengths.iter().map(|nm| nm.round()).collect();
    assert_eq!(wavelengths[2..], [11_000.0, 10_333.0]);
}

/// *Expected*: normal curves at even steps with the names of their centres.
#[test]
fn hyperspectral_bands_are_at_even_steps() {
    let text = "Hyperspectral(from_nm: 400.1, to_nm: 400.5, step_nm: 0.1, fwhm_nm: 0.2)";
    let report = ground(text, "Points([(300.0, 0.1), (500.0, 0.3)])", "");
    assert_eq!(report.bands, ["400.1nm", "400.2nm", "400.3nm", "400.4nm", "400.5nm"]);
    for (nm, brf) in
        [400.1, 400.2, 400.3, 400.4, 400.5].iter().zip(&product(&report, "view", "brf").values)
    {
        // On a straight line the weight of the sun moves little.
        assert!((brf - (0.1 + 0.2 * (nm - 300.0) / 200.0)).abs() < 2e-5, "{nm}: {brf}");
    }
}

/// *Expected*: bands of a sensor are written as a list, which is read as the same bands.
#[test]
fn bands_of_a_sensor_become_a_list() {
    let text = r#"Scene(
        format: 1, bands: Sensor("EnMAP HSI", ["B1", "B224"]),
        materials: { "soil": Lambertian(reflectance: Constant(0.2)) },
        terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
        sun: (zenith_deg: 0.0, azimuth_deg: 0.0),
        sensors: { "view": Directions(views: List([(0.0, 0.0)])) },
    )"#;
    let read =
        |text: &str| document::read_text("a.ron", text, &ReadOptions::default()).expect("text");
    let scene = read(text).scene;
    let written = scene.to_ron();
    assert!(written.contains(r#"response: Sensor("EnMAP HSI", "B224")"#), "{written}");
    assert_eq!(read(&written).scene.bands, scene.bands);
    let center = scene.bands[1].nominal_nm().expect("the sensor is known");
    assert!((2430.0..2460.0).contains(&center), "{center}");
}
