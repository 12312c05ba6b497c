//! Reflectance factors and temperatures of radiance files against those that the same run measured.

use std::fs;
use std::path::{Path, PathBuf};

use sunfleck::document::FileFormat;
use sunfleck::output::write;
use sunfleck::products::{PixelRows, Product, Report};
use sunfleck::run::{RadianceQuantity, convert_radiance};
use sunfleck::spectral::BandWindow;
use sunfleck_tests::{SceneText, product};

const FORMATS: [FileFormat; 4] =
    [FileFormat::Exr, FileFormat::Envi, FileFormat::GeoTiff, FileFormat::Png];
const BRF: RadianceQuantity = RadianceQuantity::Brf { irradiance: None };
const TEMPERATURE: RadianceQuantity = RadianceQuantity::BrightnessTemperature { bands: None };

/// Trees under sun in three bands with names out of their order, and in two thermal ones of other responses.
fn measured() -> Report {
    let scene = SceneText::trees_in_daylight("Periodic")
        .with("bands", r#"
            (name: "red", center_nm: 660.0, width_nm: 20.0), (name: "blue", center_nm: 490.0),
            (name: "tir", center_nm: 10500.0, width_nm: 1000.0),
            (name: "tir2", center_nm: 11000.0, width_nm: 800.0, response: Gaussian)"#)
        .with("materials", r#"
            "soil": Lambertian(reflectance: Bands([0.1, 0.2, 0.05, 0.05]), temperature: MeanDelta(mean_k: 305.0, delta_k: 10.0)),
            "leaf": Leaf(reflectance: Bands([0.05, 0.04, 0.02, 0.02]), transmittance: Bands([0.03, 0.02, 0.0, 0.0]), temperature: Uniform(295.0))"#)
        .with("sky", "Fraction([0.0, 0.0, 0.0, 0.0])")
        .with("thermal_sky", "BlackBody(250.0)")
        .with("sensors", r#"
            "nadir": Orthographic(size_px: (20, 14), extent_m: (5.0, 3.5), center_m: (2.5, 2.0), samples_per_px: 8, measure: [Radiance, Brf, BrightnessTemperature])"#);
    let mut report = scene.measure();
    report.formats = FORMATS.to_vec();
    report
}

/// Folder with the files of a run.
fn written(report: &Report) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(report, folder.path()).expect("files");
    folder
}

fn pixels(product: &Product) -> PixelRows {
    product.image.as_ref().expect("an image").load().expect("pixels")
}

/// Rows of all pixels in some bands.
fn bands_of(product: &Product, names: &[&str]) -> (Vec<f32>, Vec<f32>) {
    let image = product.image.as_ref().expect("an image");
    let places: Vec<usize> = names
        .iter()
        .map(|name| image.bands.iter().position(|band| band == name).expect("a band"))
        .collect();
    let pixels = pixels(product);
    let select = |values: &[f32]| -> Vec<f32> {
        values
            .chunks_exact(image.bands.len())
            .flat_map(|pixel| places.iter().map(|&place| pixel[place]))
            .collect()
    };
    (select(&pixels.values), select(&pixels.standard_error))
}

/// Largest relative difference of numbers, and how many are compared.
fn farthest(found: &[f32], expected: &[f32]) -> (f32, usize) {
    assert_eq!(found.len(), expected.len());
    let pairs = found
        .iter()
        .zip(expected)
        .filter(|(_, expected)| **expected != 0.0 && expected.is_finite());
    let differences = pairs.map(|(found, expected)| ((found - expected) / expected).abs());
    let differences: Vec<f32> = differences.collect();
    (differences.iter().copied().fold(0.0, f32::max), differences.len())
}

/// *Expected*: values and standard errors of each format are those that the run measured, to the rounding of f32.
#[test]
fn converted_radiance_is_what_the_run_measured() {
    let report = measured();
    let folder = written(&report);
    for file in ["nadir_radiance.img", "nadir_radiance.tif", "nadir_radiance.exr"] {
        let file = [folder.path().join(file)];
        let brf = convert_radiance(&file, &BRF, &FORMATS).expect("it converts");
        let (found, errors) = bands_of(product(&brf, "nadir", "brf"), &["red", "blue"]);
        let (expected, expected_errors) =
            bands_of(product(&report, "nadir", "brf"), &["red", "blue"]);
        for (found, expected) in [(&found, &expected), (&errors, &expected_errors)] {
            let (difference, count) = farthest(found, expected);
            assert!(
                difference <= 3.0 * f32::EPSILON && count > 500,
                "{}: {difference}, {count}",
                file[0].display()
            );
        }
        let kelvin = convert_radiance(&file, &TEMPERATURE, &FORMATS).expect("it converts");
        let own = product(&report, "nadir", "brightness_temperature");
        let converted = product(&kelvin, "nadir", "brightness_temperature");
        assert_eq!(converted.image.as_ref().expect("an image").bands, ["tir", "tir2"]);
        let (found, errors) = bands_of(converted, &["tir", "tir2"]);
        let (expected, expected_errors) = bands_of(own, &["tir", "tir2"]);
        let (difference, count) = farthest(&found, &expected);
        assert!(difference <= 3.0 * f32::EPSILON && count > 500, "{difference} {count}");
        let (difference, _) = farthest(&errors, &expected_errors);
        assert!(difference <= 1e-5, "{difference}");
        assert!(converted.values.iter().zip(&own.values).all(|(a, b)| (a / b - 1.0).abs() < 1e-6));
    }
    let files: Vec<PathBuf> =
        ["nadir_radiance.img", "nadir_radiance.tif"].map(|name| folder.path().join(name)).into();
    let both = convert_radiance(&files, &BRF, &FORMATS).expect("a batch");
    assert_eq!(both.sensors.len(), 2);
    let place = both.sensors[0].products[0].image.as_ref().expect("an image").georeference;
    assert_eq!(
        place,
        product(&report, "nadir", "brf").image.as_ref().expect("an image").georeference
    );
}

/// *Scene*: an image as LESS writes it: band-sequential ENVI with a list of wavelengths, -1 where nothing was seen.
#[test]
fn images_of_less_need_their_irradiance() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = folder.path().join("spectral_VZ=0_VA=180");
    let values: [f32; 8] = [0.1, 0.2, -1.0, 0.4, 0.01, 0.02, -1.0, 0.04];
    fs::write(&image, values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>())
        .expect("a file");
    let header = "ENVI\nsamples = 2\nlines = 2\nbands = 2\nheader offset = 0\nfile type = ENVI Standard\ndata type = 4\ninterleave = bsq\nbyte order = 0\nwavelength = {660.0, 10500.0}\n";
    fs::write(image.with_file_name("spectral_VZ=0_VA=180.hdr"), header).expect("a file");
    let files = [image.clone()];
    let error = convert_radiance(&files, &BRF, &FORMATS).expect_err("no irradiance").to_string();
    assert!(
        error.contains("does not say its unit") && error.contains("--irradiance 1.2,0.9"),
        "{error}"
    );
    let irradiance = |values: &[f64]| RadianceQuantity::Brf { irradiance: Some(values.to_vec()) };
    let error =
        convert_radiance(&files, &irradiance(&[1.0]), &FORMATS).expect_err("too few").to_string();
    assert!(error.contains("has 2 bands, and --irradiance has 1 value"), "{error}");
    let brf = convert_radiance(&files, &irradiance(&[2.0, 0.5]), &FORMATS).expect("it converts");
    let found = pixels(&brf.sensors[0].products[0]).values;
    let expected =
        |radiance: f64, irradiance: f64| (std::f64::consts::PI * radiance / irradiance) as f32;
    assert!(
        (found[0] - expected(0.1, 2.0)).abs() < 1e-6
            && (found[1] - expected(0.01, 0.5)).abs() < 1e-6
    );
    assert!(found[4].is_nan() && found[5].is_nan());
    assert_eq!(brf.sensors[0].name, "spectral_VZ=0_VA=180");
    assert_eq!(brf.wavelengths, [660.0, 10500.0]);
    let windows =
        [BandWindow { center: 660.0, width: 10.0 }, BandWindow { center: 10_500.0, width: 0.0 }];
    let quantity = RadianceQuantity::BrightnessTemperature { bands: Some(windows.to_vec()) };
    let kelvin = convert_radiance(&files, &quantity, &FORMATS).expect("it converts");
    let found = pixels(&kelvin.sensors[0].products[0]);
    // Planck's law inverted at the centre of the band: c2 / (λ ln(1 + c1 / (λ⁵ L))).
    let (c1, c2) = (1.191_042_972e-16, 1.438_776_877e-2);
    let (wavelength, radiance) = (10.5e-6_f64, 0.01 * 1e9);
    let exact = c2 / (wavelength * (c1 / (wavelength.powi(5) * radiance)).ln_1p());
    assert!((f64::from(found.values[0]) / exact - 1.0).abs() < 1e-6, "{} {exact}", found.values[0]);
}

#[test]
fn what_is_no_radiance_is_refused() {
    let report = measured();
    let folder = written(&report);
    let refused = |name: &str, quantity: &RadianceQuantity| {
        let file = folder.path().join(name);
        convert_radiance(&[file], quantity, &FORMATS).expect_err("it is refused").to_string()
    };
    for file in ["nadir_brf.img", "nadir_brf.tif", "nadir_brf.exr"] {
        let error = refused(file, &BRF);
        assert!(error.contains(r#"holds brf in the unit "1", and no radiance"#), "{error}");
    }
    assert!(refused("nadir_radiance.png", &BRF).contains("is no image of ENVI"));
    assert!(refused("summary.json", &BRF).contains("is no image of ENVI"));
    assert!(refused("none.img", &BRF).contains("none.img"));
    assert!(refused(".", &BRF).contains("name a file"));
    fs::remove_file(folder.path().join("summary.json")).expect("a file");
    let error = refused("nadir_radiance.img", &BRF);
    assert!(error.contains("no `summary.json` beside it") && error.contains("`red`"), "{error}");
    let window = BandWindow { center: 660.0, width: 10.0 };
    let visible = RadianceQuantity::BrightnessTemperature { bands: Some(vec![window; 4]) };
    assert!(refused("nadir_radiance.img", &visible).contains("no band lies beyond 3000 nm"));
    assert!(Path::new(&folder.path().join("nadir_radiance_se.img")).is_file());
}
