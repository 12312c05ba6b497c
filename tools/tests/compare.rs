//! `sunfleck compare` from outside.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// Leaves above soil, so that values have noise.
const LEAVES: &str = r#"Scene(
    format: 1,
    title: "Leaves",
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Bands([0.1, 0.3])),
        "leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
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
        "top": Orthographic(size_px: (4, 4), extent_m: (4.0, 4.0), samples_per_px: 256),
        "views": Directions(
            views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), until: Samples(8192),
            measure: [Brf, Orders, GapFraction],
        ),
        "eye": Fisheye(size_px: (8, 8), position_m: (2.0, 2.0, 0.2), samples_per_px: 4),
        "photons": Photons(per_m2: 500.0),
    },
)"#;

fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("leaves.ron"), LEAVES).unwrap();
    folder
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command
        .current_dir(folder)
        .args(["compare", "leaves.ron"])
        .args(arguments)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Rows of a table by the names of its columns.
fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

/// *Scene*: leaves above soil. *Expected*: each sensor by each system that can, and differences that
/// chance explains.
#[test]
fn every_system_that_can_measures_the_same_world() {
    let folder = folder();
    let arguments = ["--systems", "backward,forward", "--pixels", "--out", "c"];
    let (code, stdout, stderr) = outcome(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let rows = rows(&folder.path().join("c/compare.csv"));
    let count = |sensor: &str, product: &str, system: &str| {
        let of = |row: &&HashMap<String, String>| {
            (row["sensor"].as_str(), row["product"].as_str(), row["system"].as_str())
                == (sensor, product, system)
        };
        rows.iter().filter(of).count()
    };
    for system in ["backward", "forward"] {
        assert_eq!(count("top", "brf", system), 2 + 2 * 16, "mean and pixels");
        assert_eq!(count("views", "brf", system), 10);
    }
    assert_eq!(count("views", "gap_fraction", "backward"), 5);
    assert_eq!(count("views", "gap_fraction", "forward"), 0, "gaps are not of light");
    assert_eq!(
        (count("eye", "radiance", "backward"), count("eye", "radiance", "forward")),
        (130, 0)
    );
    assert_eq!(
        (count("photons", "albedo", "backward"), count("photons", "albedo", "forward")),
        (0, 2)
    );
    let scores: Vec<f64> = rows.iter().filter_map(|row| row["z"].parse().ok()).collect();
    assert_eq!(scores.len(), 2 + 2 * 16 + 4 * 10);
    // By Bonferroni one in 500 such runs has a score beyond 5, however they hang together.
    for (z, row) in scores.iter().zip(rows.iter().filter(|row| !row["z"].is_empty())) {
        assert!(z.abs() < 5.0, "{row:?}");
    }
    for line in ["reference", "no other system measures it"] {
        assert!(stdout.contains(line), "{stdout}");
    }
    assert!(stdout.contains("4 files in c: "), "{stdout}");
    let svg = fs::read_to_string(folder.path().join("c/compare.svg")).unwrap();
    for text in ["top: brf", "zenith (°)", "eye: radiance", "difference to backward"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn the_reference_may_be_any_of_the_systems() {
    let folder = folder();
    let arguments = ["--quality", "0.1", "--sensor", "views", "--reference", "forward"];
    let (code, _, stderr) = outcome(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let rows = rows(&folder.path().join("out/leaves_compare/compare_summary.csv"));
    let remark = |system: &str| {
        let of =
            |row: &&HashMap<String, String>| row["product"] == "brf" && row["system"] == system;
        rows.iter().find(of).unwrap()["remark"].clone()
    };
    assert_eq!((remark("forward").as_str(), remark("backward").as_str()), ("reference", ""));
    let once = rows.iter().filter(|row| row["system"] == "first_order");
    let products: Vec<&str> = once.map(|row| row["product"].as_str()).collect();
    assert_eq!(products, ["brf_uc", "brf_co_sgl"]);
}

/// *Scene*: few photons, each of which is counted whole or not at all, so that many directions count none.
/// *Expected*: those have no z-score, the table and the picture say how many they are, and the others agree.
#[test]
fn what_counted_nothing_has_no_score() {
    let folder = tempdir().unwrap();
    let cells = "Photons(per_m2: 500.0, measure: [BrfCells(150)])";
    let scene = LEAVES.replace("Photons(per_m2: 500.0)", cells);
    fs::write(folder.path().join("leaves.ron"), scene).unwrap();
    let arguments =
        ["--systems", "forward,analog", "--sensor", "photons", "--reference", "forward"];
    let (code, stdout, stderr) = outcome(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let rows = rows(&folder.path().join("out/leaves_compare/compare_summary.csv"));
    let analog = rows.iter().find(|row| {
        row["product"].starts_with("brf_cells")
            && row["system"] == "analog"
            && !row["remark"].is_empty()
    });
    let analog = analog.unwrap_or_else(|| panic!("{stdout}"));
    assert!(analog["remark"].ends_with("without a count, not in z"), "{analog:?}");
    assert!(analog["rms z"].parse::<f64>().unwrap() < 2.0, "{analog:?}");
    let svg = fs::read_to_string(folder.path().join("out/leaves_compare/compare.svg")).unwrap();
    assert!(svg.contains("without a count left out"), "{svg}");
}

/// A limit for a product that a system does not measure is one for those that it does.
#[test]
fn limits_by_name_hold_for_what_a_system_measures() {
    let folder = tempdir().unwrap();
    let limits = "until: RelErrors({ \"brf\": 0.02, \"brf_uc\": 0.1 })";
    let scene = LEAVES.replace("until: Samples(8192)", limits);
    fs::write(folder.path().join("leaves.ron"), scene).unwrap();
    let arguments = ["--systems", "backward,first_order", "--sensor", "views"];
    let (code, _, stderr) = outcome(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let rows = rows(&folder.path().join("out/leaves_compare/compare_summary.csv"));
    for row in rows.iter().filter(|row| row["system"] == "first_order") {
        let error: f64 = row["median rel. error"].parse().unwrap();
        assert!(error <= 0.1, "{row:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = folder();
    let message = |arguments: &[&str]| {
        let (code, stdout, stderr) = outcome(folder.path(), arguments);
        assert_ne!(code, 0, "{stdout}");
        stderr
    };
    let text = message(&["--systems", "backwards"]);
    assert!(text.contains("did you mean `backward`?"), "{text}");
    let text = message(&["--sensor", "veiws"]);
    assert!(text.contains("no sensor `veiws`; did you mean `views`?"), "{text}");
    let text = message(&["--systems", "backward", "--sensor", "photons"]);
    assert!(text.contains("sensors.photons: none of backward can measure it; forward"), "{text}");
    let text = message(&["--systems", "backward", "--reference", "forward"]);
    assert!(text.contains("`forward` is not among the systems"), "{text}");
    let text = message(&["--systems", "first_order", "--sensor", "top"]);
    assert!(text.contains("sensors.top: none of first_order can measure it; backward"), "{text}");
    assert!(text.contains("first_order measures `Orders`; add it to `measure`"), "{text}");
    // With others that can be, it is a warning.
    let arguments =
        ["--systems", "forward", "--quality", "0.05", "--sensor", "eye", "--sensor", "photons"];
    let (code, _, stderr) = outcome(folder.path(), &arguments);
    assert_eq!(code, 0);
    assert_eq!(
        stderr,
        "warning: sensors.eye: none of forward can measure it; backward, reference can\n"
    );
}
