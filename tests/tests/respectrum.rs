//! Coefficients that a run keeps give the results of other spectra.

use std::fs;
use std::path::{Path, PathBuf};

use sunfleck::ReadOptions;
use sunfleck::products::Report;
use sunfleck::run::{Failure, Options, Unwatched, respectrum, run_file};
use sunfleck_tests::{Estimate, SceneText, albedo_of_sheets, product};
use tempfile::TempDir;

/// Sheets of leaf over soil with the parameters `r`, `t` and `s`, in one band.
fn sheets() -> SceneText {
    SceneText::sheets(&[(0.0, 0.0, 0.0)], &[1.0, 2.0])
        .with("params", r#""r": 0.4, "t": 0.3, "s": 0.2, "sza": 30.0, "e": 1.0"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=s")), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant("=t"))"#)
        .with("sun", r#"zenith_deg: "=sza", azimuth_deg: 10.0, irradiance: Constant("=e")"#)
        .with(
            "sensors",
            r#""p": Photons(per_m2: 200.0, measure: [Albedo, Fapar(layer_m: 1.0), Exitance]),
            "v": Directions(views: List([(20.0, 190.0), (60.0, 70.0)]), until: Samples(16384), system: Forward)"#,
        )
}

/// A scene file, and the coefficients that a run of it has kept.
struct Kept {
    folder: TempDir,
    report: Report,
}

fn options(set: &[(&str, f64)]) -> Options {
    let set = set.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
    Options { document: ReadOptions { set, ..ReadOptions::default() }, ..Options::default() }
}

impl Kept {
    fn new(scene: &SceneText, set: &[(&str, f64)]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let kept = Self { report: run(&folder, scene, true, set), folder };
        if let Some(bytes) = &kept.report.coefficients {
            fs::write(kept.file(), bytes.as_slice()).expect("a file");
        }
        kept
    }

    fn scene(&self) -> PathBuf {
        self.folder.path().join("scene.ron")
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("coefficients.bin")
    }

    fn at(&self, set: &[(&str, f64)]) -> Result<Report, Failure> {
        respectrum(&self.scene(), &self.file(), &options(set), &Unwatched)
    }
}

fn run(folder: &TempDir, scene: &SceneText, keeps: bool, set: &[(&str, f64)]) -> Report {
    let file: &Path = &folder.path().join("scene.ron");
    fs::write(file, scene.to_string()).expect("a file");
    let options = Options { keeps_coefficients: keeps, ..options(set) };
    run_file(file, &options, &Unwatched).unwrap_or_else(|failure| panic!("{failure}"))
}

/// Values and errors of all products, without the largest imbalance and times.
fn numbers(report: &Report) -> Vec<(String, Vec<f64>, Vec<f64>)> {
    let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
    products.map(|p| (p.name.clone(), p.values.clone(), p.standard_error.clone())).collect()
}

/// *Scene*: two sheets of leaf over soil, once traced. *Expected*: with the spectra of the run its own numbers, bit for bit;
/// with others the albedo by adding layers within 4.5 standard errors, and energy that is accounted for.
#[test]
fn one_run_gives_the_albedo_of_any_leaf_and_soil() {
    let kept = Kept::new(&sheets(), &[]);
    let again = kept.at(&[]).expect("the same scene");
    assert_eq!(numbers(&again), numbers(&kept.report));
    for optics in [(0.5, 0.45, 0.9), (0.1, 0.6, 0.0), (0.0, 0.05, 0.3), (0.45, 0.0, 0.1)] {
        let (r, t, s) = optics;
        let report = kept.at(&[("r", r), ("t", t), ("s", s)]).expect("other spectra");
        let albedo = Estimate::of(product(&report, "p", "albedo"), 0);
        let truth = albedo_of_sheets(optics, 2);
        assert!(
            (albedo.value - truth).abs() < 4.5 * albedo.error + 1e-6,
            "{optics:?} {albedo:?} {truth}"
        );
        let imbalance = report.sensors[0].energy_imbalance.expect("packets");
        assert!(imbalance < 1e-12, "{imbalance:e}");
        let is_bright = [r / 0.4, t / 0.3, s / 0.2].iter().any(|ratio| *ratio > 1.5);
        assert_eq!(report.warnings.iter().any(|text| text.contains("as bright")), is_bright);
    }
}

/// *Expected*: BRF, absorbed fractions and exitance of other spectra, irradiance and bands are those of a run of their own,
/// within the errors of both.
#[test]
fn all_products_are_those_of_a_run_of_their_own() {
    let kept = Kept::new(&sheets(), &[]);
    let set = [("r", 0.45), ("t", 0.1), ("s", 0.25), ("e", 3.0)];
    let report = kept.at(&set).expect("other spectra");
    // Another seed: other paths.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let own = run(&folder, &sheets().with("transport", "seed: 77"), false, &set);
    let (found, own) = (numbers(&report), numbers(&own));
    assert_eq!(found.len(), own.len());
    let mut compared = 0;
    for ((name, values, errors), (other, own, own_errors)) in found.iter().zip(&own) {
        assert_eq!(name, other);
        for at in 0..values.len() {
            let error = errors[at].hypot(own_errors[at]);
            let difference = (values[at] - own[at]).abs();
            assert!(difference < 4.5 * error + 1e-9, "{name} {at}: {difference:e} for {error:e}");
            compared += usize::from(error > 0.0);
        }
    }
    assert!(compared > 15, "{compared} values with an error");
    let exitance = |report: &Report| product(report, "p", "exitance").values[0];
    assert!(exitance(&report) > 1.5 * exitance(&kept.report), "three times the light");
}

/// *Expected*: the scene file may have more bands than the run had; each has the albedo by adding layers.
#[test]
fn coefficients_serve_any_number_of_bands() {
    let kept = Kept::new(&sheets(), &[]);
    let optics = [(0.4, 0.3, 0.2), (0.1, 0.1, 0.25), (0.5, 0.4, 0.1)];
    let list = |of: fn(&(f64, f64, f64)) -> f64| {
        format!("{:?}", optics.iter().map(of).collect::<Vec<_>>())
    };
    let bands = [0, 1, 2].map(|i| format!("(name: \"n{i}\", center_nm: {}.0)", 500 + 100 * i));
    let materials = format!(
        r#""soil": Lambertian(reflectance: Bands({})), "leaf": Leaf(reflectance: Bands({}), transmittance: Bands({}))"#,
        list(|optics| optics.2),
        list(|optics| optics.0),
        list(|optics| optics.1)
    );
    let scene = sheets()
        .with("params", r#""sza": 30.0, "e": 1.0"#)
        .with("bands", bands.join(", "))
        .with("materials", materials);
    fs::write(kept.scene(), scene.to_string()).expect("a file");
    let report = kept.at(&[]).expect("other bands");
    for (band, &optics) in optics.iter().enumerate() {
        let albedo = Estimate::of(product(&report, "p", "albedo"), band);
        let truth = albedo_of_sheets(optics, 2);
        assert!((albedo.value - truth).abs() < 4.5 * albedo.error + 1e-6, "{albedo:?} {truth}");
    }
}

/// Whatever changes the paths is refused, with what to do.
#[test]
fn what_changes_the_paths_is_refused() {
    let kept = Kept::new(&sheets(), &[("t", 0.0)]);
    let text = |set| kept.at(set).expect_err("other paths").to_string();
    let moved = text(&[("sza", 40.0), ("t", 0.0)]);
    assert!(moved.contains("has coefficients of other paths: only spectra"), "{moved}");
    assert!(moved.contains("`--keep-coefficients`"), "{moved}");
    let lit = text(&[("t", 0.1)]);
    assert!(lit.contains("neither reflected nor transmitted"), "{lit}");
    let mut bytes = fs::read(kept.file()).expect("a file");
    bytes[200] ^= 1;
    fs::write(kept.file(), bytes).expect("a file");
    assert!(text(&[]).contains("is damaged"));
}

/// Images and surfaces that depend on directions have no coefficients, and a run says so.
#[test]
fn sensors_without_coefficients_are_named() {
    let rpv = r#""soil": Rpv(rho0: Constant(0.1), k: Constant(0.8), asymmetry: Constant(-0.1)), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant("=t"))"#;
    let scene = sheets()
        .with("materials", rpv)
        .with("params", r#""r": 0.4, "t": 0.3, "sza": 30.0, "e": 1.0"#);
    let report = Kept::new(&scene, &[]).report;
    assert!(report.coefficients.is_none());
    let warned = |report: &Report, names: &str| {
        report
            .warnings
            .iter()
            .any(|text| text.starts_with(&format!("{names} kept no coefficients")))
    };
    assert!(warned(&report, "`p`, `v`"), "{:?}", report.warnings);
    let image = sheets().with_more(
        "sensors",
        r#""i": Orthographic(size_px: (4, 4), cover: WholeScene, samples_per_px: 4)"#,
    );
    let kept = Kept::new(&image, &[]);
    assert!(warned(&kept.report, "`i`"), "{:?}", kept.report.warnings);
    let names = |report: Report| -> Vec<String> {
        report.sensors.into_iter().map(|sensor| sensor.name).collect()
    };
    assert_eq!(names(kept.at(&[("r", 0.2)]).expect("other spectra")), ["p", "v"]);
}
