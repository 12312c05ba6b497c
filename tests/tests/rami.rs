//! The abstract canopies of RAMI, from `scenes/rami`, against independent solutions.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use sunfleck::assets::grow_crown;
use sunfleck::document::{self, GeneratedCrown, Prototype, Scene, Sensor, System};
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
    let options = document::ReadOptions { set, ..document::ReadOptions::default() };
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

/// The scene with leaves that are independent of one another, as those of a turbid medium are.
fn with_independent_leaves(mut scene: Scene) -> Scene {
    for mesh in scene.meshes.values_mut() {
        if let Prototype::Crown(GeneratedCrown { overlap, .. }) = mesh {
            *overlap = true;
        }
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

/// BRF in the 76 directions of the principal plane beside those of another path tracer, which traced RAMI's leaves.
fn principal_plane(scene: &Scene, shared: &Path) -> Vec<(Estimate, f64)> {
    let reference = table(&shared.join("reference/het01_dis_uni_nir_20_brfpp.csv"), 1);
    let report = measure(scene, 0.5);
    let brf = product(&report, "rami.brfpp", "brf");
    let angles = (1..=75).rev().step_by(2).map(|zenith| -zenith).chain((1..=75).step_by(2));
    let pairs: Vec<_> = angles
        .enumerate()
        .map(|(view, zenith)| (Estimate::of(brf, view), reference[&zenith.to_string()][0]))
        .collect();
    assert_eq!(pairs.len(), 76);
    pairs
}

/// *Scene*: fifteen floating spheres of discs, NIR, sun at 20°, with leaves that keep the distance of RAMI's.
/// *Expected*: the 76 values of another path tracer on RAMI's leaves within 0.1 %, each but for its error and on
/// average, where the error is 0.08 %. Leaves that may overlap are 0.56 % below it on average.
#[test]
fn floating_spheres_have_the_brf_of_another_program() {
    let Some(shared) = shared() else { return };
    let pairs = principal_plane(&scene("het01.ron", &[], &["rami.brfpp"]), &shared);
    assert_within(0.001, "HET01", &pairs);
}

/// *Scene*: these spheres with the leaves of RAMI's own file. *Expected*: the same values within 0.1 %.
#[test]
fn leaves_of_rami_have_the_brf_of_another_program() {
    let Some(shared) = shared() else { return };
    let mut scene = scene("het01.ron", &[], &["rami.brfpp"]);
    let file = shared.join("data/rami/het01_sphere_leaves.def");
    let file = file.to_str().expect("the path is UTF-8").to_owned();
    let sphere = Prototype::Discs { file: file.into(), material: "rami.leaf".into() };
    scene.meshes.insert("sphere".to_owned(), sphere).expect("the scene has this mesh");
    assert_within(0.001, "RAMI's leaves", &principal_plane(&scene, &shared));
}

/// Smallest distance of two centres of leaves [m].
fn nearest(mut centers: Vec<[f64; 3]>) -> f64 {
    centers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut nearest = f64::INFINITY;
    for (index, a) in centers.iter().enumerate() {
        let near = centers[index + 1..].iter().take_while(|b| b[0] - a[0] < nearest);
        let squares = near.map(|b| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>());
        nearest = nearest.min(squares.fold(f64::INFINITY, f64::min).sqrt());
    }
    nearest
}

/// Leaves of `het01.ron` are as far apart as those of RAMI's file, which has three decimals: a diameter.
#[test]
fn floating_spheres_have_leaves_a_diameter_apart() {
    let scene = scene("het01.ron", &[], &[]);
    let Prototype::Crown(crown) = &scene.meshes["sphere"] else { panic!("a generated crown") };
    let discs = grow_crown(crown).expect("the leaves find room").discs;
    let distance = nearest(discs.iter().map(|disc| disc.center.as_dvec3().to_array()).collect());
    assert!((0.2..0.201).contains(&distance), "{distance}");
    let Some(shared) = shared() else { return };
    let text = std::fs::read_to_string(shared.join("data/rami/het01_sphere_leaves.def"));
    let center = |line: &str| -> [f64; 3] {
        let numbers: Vec<f64> =
            line.split_whitespace().map(|cell| cell.parse().expect("a number")).collect();
        [numbers[1], numbers[2], numbers[3]]
    };
    let centers: Vec<_> = text.expect("a file").lines().map(center).collect();
    assert_eq!(centers.len(), discs.len());
    let distance = nearest(centers);
    assert!((0.199..0.201).contains(&distance), "{distance}");
}

/// *Scene*: the homogeneous layers of LAI 3 with independent leaves of 0.01 m. *Expected*: albedo, absorption and
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
        let small = scene(file, &small, &["fluxes", "rami.brfpp"]);
        let report = measure(&with_independent_leaves(small), 0.08);
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
    let small = scene("hom_erectophile.ron", &small, &["fluxes"]);
    let report = measure(&with_independent_leaves(small), 0.08);
    let uncollided = Estimate::of(product(&report, "fluxes", "ftran"), 1);
    let expected = (-0.43692 * 3.0 / 20_f64.to_radians().cos()).exp();
    assert_within(0.005, "erectophile uncollided", &[(uncollided, expected)]);
}
