//! `sunfleck bench` from outside.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::tempdir;

/// Leaves above soil, so that values have noise.
const LEAVES: &str = r#"Scene(
    format: 1,
    bands: [(name: "nir", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.3)),
        "leaf": Leaf(reflectance: Constant(0.5), transmittance: Constant(0.4)),
    },
    meshes: { "tree": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 6.0,
        leaf: Square(side_m: 0.1), leaf_material: "leaf",
    ) },
    terrain: Plane(size_m: (4.0, 4.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(1.2, 2.0, 0.0)])],
    sun: (zenith_deg: 40.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    sensors: {
        "top": Orthographic(
            size_px: (4, 4), extent_m: (4.0, 4.0), samples_per_px: 64, measure: [Brf, Orders],
        ),
        "photons": Photons(per_m2: 8000.0, measure: [Albedo]),
    },
)"#;

/// Exit code, stdout and stderr of `sunfleck bench`.
fn bench(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).arg("bench").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// *Scene*: leaves above soil. *Expected*: six numbers of samples of each product by each system that can
/// measure it, and errors that fall as they do: of photons followed as a whole by √32 over five doublings.
/// An error of 32 randomisations is known to 1/√62, so the logarithm of the ratio of two to 0.18.
#[test]
fn errors_fall_with_the_number_of_samples() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("leaves.ron"), LEAVES).unwrap();
    let (code, stdout, stderr) = bench(folder.path(), &["leaves.ron", "--repeats", "1"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(stdout.contains("4 files in out/leaves_bench"), "{stdout}");
    let out = folder.path().join("out/leaves_bench");
    let rows = |file: &str| -> Vec<HashMap<String, String>> {
        let mut reader = csv::Reader::from_path(out.join(file)).unwrap();
        reader.deserialize().map(Result::unwrap).collect()
    };
    let key = |row: &HashMap<String, String>| {
        [&row["sensor"], &row["product"], &row["system"]].map(String::as_str).join(" ")
    };
    let fits = rows("bench_fits.csv");
    let curves: Vec<String> = fits.iter().map(key).collect();
    for curve in [
        "top brf backward",
        "top brf forward",
        "top brf, pixels backward",
        "top brf_uc first_order",
        "top brf_co_sgl, pixels first_order",
        "top brf_mlt forward",
        "photons albedo forward",
        "photons albedo analog",
    ] {
        assert!(curves.iter().any(|one| one == curve), "{curve}: {curves:?}");
    }
    assert!(!curves.iter().any(|one| one == "top brf first_order"), "{curves:?}");
    let levels = rows("bench.csv");
    assert_eq!(levels.len(), 6 * curves.len());
    let errors: Vec<f64> = levels
        .iter()
        .filter(|row| key(row) == "photons albedo analog")
        .map(|row| row["reported_relative_error"].parse().unwrap())
        .collect();
    let fall = (errors[0] / errors[5]).ln() - 32_f64.sqrt().ln();
    assert!(fall.abs() < 4.0 * 0.18, "{errors:?}");
    let svg = fs::read_to_string(out.join("bench.svg")).unwrap();
    for text in ["top: brf", "photons: albedo", "seconds", "relative error", "first_order"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn what_cannot_be_measured_is_said() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("leaves.ron"), LEAVES).unwrap();
    let (code, _, stderr) = bench(folder.path(), &[]);
    assert!(code == 2 && stderr.contains("<SCENE>"), "{stderr}");
    let (code, _, stderr) = bench(folder.path(), &["leaves.ron", "--doublings", "1"]);
    assert!(code == 2 && stderr.contains("--doublings"), "{stderr}");
    let few = ["leaves.ron", "--repeats", "1", "--sensor", "top", "--quality", "0.1"];
    let (code, _, stderr) = bench(folder.path(), &[&few[..], &["--systems", "backward"]].concat());
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("sensors.top: "), "{stderr}");
    assert!(stderr.contains("samples of backward cannot be halved 5 times"), "{stderr}");
    // The other benchmark is a command of its own.
    let (code, stdout, stderr) = bench(folder.path(), &["rays", "leaves.ron", "--paths", "1000"]);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("rays"), "{stdout}");
}
