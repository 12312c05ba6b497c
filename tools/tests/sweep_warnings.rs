//! Warnings of the points of a sweep: each names its own point, wherever it is shown.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::tempdir;

/// A crown that stands over the edge of a small isolated ground; the camera makes points of all suns share their paths.
const SCENE: &str = r#"Scene(
    format: 1,
    params: { "sza": 30.0 },
    bands: [(name: "red", center_nm: 660.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.3)),
        "leaf": Leaf(reflectance: Constant(0.45), transmittance: Constant(0.45)),
    },
    meshes: { "tree": Crown(
        shape: Ellipsoid(diameter_m: 4.0, height_m: 8.0), base_m: 4.0, leaf_area_m2: 60.0,
        leaf: Disc(radius_m: 0.1), leaf_material: "leaf",
    ) },
    terrain: TERRAIN,
    instances: [List(of: "tree", at_m: [(3.0, 3.0, 0.0)])],
    sun: (zenith_deg: "=sza", azimuth_deg: 270.0),
    boundary: Isolated,
    sensors: {
        "image": Orthographic(size_px: (4, 4), cover: WholeScene, until: Samples(4)),
        "photons": Photons(per_m2: 20.0, measure: [Albedo]),
    },
    sweep: Grid({ "sza": [0.0, 75.0, 80.0] }),
)"#;

const LEVEL: &str = r#"Plane(size_m: (6.0, 6.0), material: "soil")"#;

/// Runs a command that succeeds; returns its warnings.
fn warnings(folder: &Path, arguments: &[&str]) -> Vec<String> {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{errors}");
    errors.lines().filter_map(|line| line.strip_prefix("warning: ")).map(str::to_owned).collect()
}

/// Warnings in the summary of the results in `out`.
fn summarised(folder: &Path) -> Vec<String> {
    let summary = fs::read(folder.join("out/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    serde_json::from_value(summary["warnings"].clone()).unwrap()
}

/// *Expected*: each point has the warnings of its own run, on the terminal, in `summary.json` and on the page; a sweep that
/// goes on with kept points has them in `summary.json` too.
#[test]
fn each_point_of_a_sweep_has_the_warnings_of_its_own_run() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("edge.ron"), SCENE.replace("TERRAIN", LEVEL)).unwrap();
    let mut expected = Vec::new();
    for point in ["sza=0", "sza=75", "sza=80"] {
        let of_run = warnings(folder, &["run", "edge.ron", "--set", point, "--out", "run"]);
        assert!(of_run.iter().any(|text| text.contains("beside the rectangle")), "{of_run:?}");
        expected.extend(of_run.into_iter().map(|text| format!("at {point}: {text}")));
    }
    let sweep = ["sweep", "edge.ron", "--out", "out"];
    assert_eq!(warnings(folder, &sweep), expected);
    assert_eq!(summarised(folder), expected);
    assert_eq!(warnings(folder, &sweep), [""; 0]);
    assert_eq!(summarised(folder), expected);

    warnings(folder, &["report", "out"]);
    let page = fs::read_to_string(folder.join("out/report.html")).unwrap();
    let shown = page.split("<h2>Warnings</h2>").nth(1).unwrap().split("</section>").next().unwrap();
    assert_eq!(shown.matches("<li>").count(), expected.len(), "{shown}");
}

/// *Scene*: a level ground, and a slope that rises by 3 m from west to east. *Expected*: `Periodic` is proposed where it
/// needs no walls, and nowhere else.
#[test]
fn what_avoids_light_beside_the_ground_depends_on_whether_its_sides_meet() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let rows: String = (0..4).map(|_| "0 1 2 3\n").collect();
    let slope = format!("ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 1.5\n{rows}");
    fs::write(folder.join("slope.asc"), slope).unwrap();
    let remedy = |terrain: &str| {
        fs::write(folder.join("edge.ron"), SCENE.replace("TERRAIN", terrain)).unwrap();
        let of_run = warnings(folder, &["run", "edge.ron", "--out", "run", "--force"]);
        let beside: Vec<_> =
            of_run.iter().filter(|text| text.contains("beside the rectangle")).collect();
        assert!(!beside.is_empty(), "{of_run:?}");
        let mut remedies: Vec<_> =
            beside.iter().map(|text| text.rsplit("; ").next().unwrap().to_owned()).collect();
        remedies.dedup();
        remedies.join("|")
    };
    assert_eq!(
        remedy(LEVEL),
        "a larger terrain or `boundary: Periodic` avoids it (scenes/ISOLATED.md)"
    );
    let slope = r#"Raster(file: "slope.asc", material: "soil")"#;
    assert_eq!(
        remedy(slope),
        "take a larger terrain than the area that is measured, or read the BRF of an `Orthographic` camera over its middle \
         (scenes/ISOLATED.md): `boundary: Periodic` would put walls of up to 4.0 m between opposite sides of the ground"
    );
}
