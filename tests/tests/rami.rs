//! The abstract canopies of RAMI, from `scenes/rami`, against independent solutions.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use sunfleck::document::{self, Scene, Sensor, System};
use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, run};
use sunfleck_tests::{Estimate, product, shared};

/// Standard errors that an estimate may be off: two-sided significance 6e-5.
const MOST: f64 = 4.0;

fn folder() -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/rami")).to_owned()
}

/// A RAMI scene that keeps these sensors alone.
fn scene(name: &str, set: &[(&str, f64)], sensors: &[&str]) -> Scene {
    let set = set.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
    let options = document::Options { set, ..document::Options::default() };
    let reading = document::read_file(&folder().join(name), &options).expect("a file");
    assert!(reading.is_sound(), "{}", reading.render());
    let mut scene = reading.scene;
    scene.sensors.retain(|name, _| sensors.contains(&name.as_str()));
    // Views that share their packets would err together, and so would their mean.
    let apart = |sensor: &Sensor| sensor.measured_by(System::Backward, &scene);
    let apart: Vec<_> = scene.sensors.values().map(apart).collect();
    for (sensor, apart) in scene.sensors.values_mut().zip(apart) {
        *sensor = apart.unwrap_or_else(|| sensor.clone());
    }
    scene
}

fn measure(scene: &Scene, quality: f64) -> Report {
    let options = Options { quality, ..Options::default() };
    match run(scene, &folder(), &options, &Unwatched) {
        Ok(report) => report,
        Err(failure) => panic!("{failure}"),
    }
}

/// Rows of a table without its header, by the first `keys` columns.
fn table(path: &Path, keys: usize) -> HashMap<String, Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("a table");
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let numbers = cells[keys..].iter().filter_map(|cell| cell.parse().ok()).collect();
        (cells[..keys].join(","), numbers)
    };
    text.lines().skip(1).map(row).collect()
}

/// Asserts that estimates are within `share` of what is expected, but for their errors; and so is
/// their mean deviation.
fn assert_within(share: f64, what: &str, pairs: &[(Estimate, f64)]) {
    let (mut sum, mut squares) = (0.0, 0.0);
    for &(estimate, expected) in pairs {
        let (deviation, error) = (estimate.value / expected - 1.0, estimate.error / expected);
        assert!(
            deviation.abs() < share + MOST * error,
            "{what}: {} ± {}, expected {expected}",
            estimate.value,
            estimate.error
        );
        sum += deviation;
        squares += error * error;
    }
    let (mean, error) = (sum / pairs.len() as f64, squares.sqrt() / pairs.len() as f64);
    assert!(mean.abs() < share + MOST * error, "{what}: {mean} ± {error} on average");
}

/// *Scene*: fifteen floating spheres of discs, NIR, sun at 20°. *Expected*: the 76 values of another
/// path tracer in the principal plane within 1 %, each but for its error and on average.
#[test]
fn floating_spheres_have_the_brf_of_another_program() {
    let Some(shared) = shared() else { return };
    let reference = table(&shared.join("reference/het01_dis_uni_nir_20_brfpp.csv"), 1);
    let report = measure(&scene("het01.ron", &[], &["rami.brfpp"]), 0.05);
    let brf = product(&report, "rami.brfpp", "brf");
    let angles = (1..=75).rev().step_by(2).map(|zenith| -zenith).chain((1..=75).step_by(2));
    let pairs: Vec<_> = angles
        .enumerate()
        .map(|(view, zenith)| (Estimate::of(brf, view), reference[&zenith.to_string()][0]))
        .collect();
    assert_eq!(pairs.len(), 76);
    assert_within(0.01, "HET01", &pairs);
}

/// *Scene*: the homogeneous layers of LAI 3 with leaves of 0.01 m. *Expected*: albedo, absorption and
/// transmission of the turbid layer (adding-doubling), and away from the hot spot its BRF, within
/// 0.5 % and their errors; of erectophile leaves, which the tables lack, uncollided transmission
/// `exp(-G LAI / cos θ)` with G(20°) = 0.43692.
#[test]
fn small_leaves_in_a_homogeneous_layer_are_a_turbid_medium() {
    let Some(shared) = shared() else { return };
    let fluxes = table(&shared.join("reference/turbid_flux.csv"), 2);
    let views = table(&shared.join("reference/turbid_brf.csv"), 4);
    let small = [("radius", 0.01), ("size", 4.0)];
    for (file, lad, case) in [
        ("hom_uniform.ron", "spherical", "HOM03_TUR_UNI_NIR_20"),
        ("hom_planophile.ron", "planophile", "HOM03_TUR_PLA_NIR_20"),
    ] {
        let report = measure(&scene(file, &small, &["fluxes", "rami.brfpp"]), 0.08);
        let row = &fluxes[&format!("{case},{lad}")];
        let of = |name: &str, index: usize| Estimate::of(product(&report, "fluxes", name), index);
        // Behind case and kind of leaf: LAI, optics, angle and G, then what is measured.
        assert_within(0.005, &format!("{case} albedo"), &[(of("albedo", 0), row[6])]);
        assert_within(0.005, &format!("{case} fapar"), &[(of("fapar_vegetation", 0), row[7])]);
        assert_within(0.005, &format!("{case} ftran"), &[(of("ftran", 0), row[8])]);
        assert_within(0.005, &format!("{case} uncollided"), &[(of("ftran", 1), row[9])]);
        let brf = product(&report, "rami.brfpp", "brf");
        // The far side: 1° to 75° are the last 38 views.
        let forward = (1..=75).step_by(2).enumerate().map(|(view, zenith)| {
            (Estimate::of(brf, 38 + view), views[&format!("{case},20,{zenith},180")][0])
        });
        let far: Vec<_> = forward.skip(5).collect();
        assert_within(0.005, &format!("{case} BRF"), &far);
    }
    let report = measure(&scene("hom_erectophile.ron", &small, &["fluxes"]), 0.08);
    let uncollided = Estimate::of(product(&report, "fluxes", "ftran"), 1);
    let expected = (-0.43692 * 3.0 / 20_f64.to_radians().cos()).exp();
    assert_within(0.005, "erectophile uncollided", &[(uncollided, expected)]);
}
