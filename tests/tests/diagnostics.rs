//! What a person reads of errors that show only when files are read and values resolved.

use std::fs;
use std::path::Path;

use sunfleck::run::{Options, Unwatched, check_file, run_file};

const SCENE: &str = r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: {
        "leaf": Leaf(reflectance: Bands([0.5, 0.6]), transmittance: Constant(0.45)),
        "soil": Lambertian(reflectance: Table(file: "soil.csv")),
    },
    meshes: { "tree": Obj(file: "t.obj", up: Z, unit_m: 1.0, parts: { "laef": "leaf" }) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(1.0, 2.0, 0.0)])],
    sun: (zenith_deg: 20.0, azimuth_deg: 270.0, irradiance: Constant(1.0)),
    sensors: { "a": Photons(per_m2: 100.0) },
)
"#;

/// Lines of the failure that say where something is: `line:column (path)`.
fn places(folder: &Path) -> Vec<String> {
    let path = folder.join("scene.ron");
    let failure = run_file(&path, &Options::default(), &Unwatched).expect_err("the scene is wrong");
    let text = failure.to_string();
    let places = text.lines().filter_map(|line| line.trim().strip_prefix("--> "));
    places.map(|place| place.rsplit_once("scene.ron:").expect("a place").1.to_owned()).collect()
}

#[test]
fn every_error_beyond_the_text_is_told_at_once_with_its_place() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    fs::write(dir.path().join("scene.ron"), SCENE).expect("a file");
    // Files first: nothing else can be told before they are there.
    assert_eq!(
        places(dir.path()),
        ["6:53 (materials.soil.reflectance.file)", "8:33 (meshes.tree.file)"]
    );
    fs::write(dir.path().join("soil.csv"), "wavelength_nm,value\n400,0.1\n700,0.2\n")
        .expect("a file");
    fs::write(dir.path().join("t.obj"), "g leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        .expect("a file");
    // A face that names no vertex, ρ + τ above 1 although the mesh is not there to wear it, and a
    // band beyond the spectrum.
    assert_eq!(
        places(dir.path()),
        [
            "8:33 (meshes.tree.file)",
            "5:17 (materials.leaf)",
            "6:53 (materials.soil.reflectance.file)"
        ]
    );
    fs::write(dir.path().join("t.obj"), "g leaf\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("a file");
    assert_eq!(
        places(dir.path()),
        [
            "8:71 (meshes.tree.parts.laef)",
            "8:23 (meshes.tree)",
            "5:17 (materials.leaf)",
            "6:53 (materials.soil.reflectance.file)"
        ]
    );
}

#[test]
fn ground_under_ground_is_told() {
    let text = r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "soil": Lambertian(reflectance: Constant(0.5)) },
    meshes: { "hill": Obj(file: "hill.obj", up: Z, unit_m: 1.0, material: "soil") },
    terrain: Mesh(mesh: "hill", at_m: (100.0, 0.0, 0.0)),
    sun: (zenith_deg: 20.0, irradiance: Constant(1.0)),
    sensors: { "a": Photons },
)
"#;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.ron");
    fs::write(&path, text).expect("a file");
    let warnings = |hill: &str| {
        fs::write(folder.path().join("hill.obj"), hill).expect("a file");
        let found = check_file(&path, &Options::default());
        found.unwrap_or_else(|failure| panic!("{failure}")).join("\n")
    };
    // A slope of two triangles and a wall, which no place is under.
    let slope = "v 0 0 0\nv 9 0 3\nv 9 9 3\nv 0 9 0\nv 0 0 5\nf 1 2 3 4\nf 1 4 5\n";
    assert_eq!(warnings(slope), "");
    // A roof of one triangle covers the middle of neither; it is the slope that covers a cellar.
    let with =
        |height: i32| format!("{slope}v 6 2 {height}\nv 7 2 {height}\nv 7 3 {height}\nf 6 7 8\n");
    let told = warnings(&with(-4));
    assert!(told.starts_with("warning: 1 triangle of `hill` lies under another one\n"), "{told}");
    assert!(told.contains("one lies at (106.67, 2.33, -4.00): what is placed there"), "{told}");
    // The middle of one of the slope's triangles is (6, 3).
    let roof = warnings(&with(9).replace("v 6 2", "v 5 3.5").replace("v 7 3", "v 7 4"));
    assert!(roof.contains("one lies at (106.00, 3.00, 2.00)"), "{roof}");
}

#[test]
fn what_is_most_likely_not_meant_is_told() {
    let text = r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "leaf": Lambertian(reflectance: Constant(0.5)) },
    meshes: { "tree": Obj(file: "t.obj", up: Z, unit_m: 1.0, material: "leaf") },
    terrain: Plane(size_m: (10.0, 20.0), material: "leaf"),
    instances: [List(of: "tree", at_m: [(1.0, 2.0, 0.0), (11.0, 2.0, 0.0)])],
    sun: (zenith_deg: 20.0, irradiance: Constant(1.0)),
    sensors: {
        "beside": Orthographic(size_px: (8, 8), extent_m: (4.0, 4.0), center_m: (5.0, 21.0)),
        "wide": Orthographic(size_px: (8, 8), extent_m: (20.0, 20.0), azimuth_deg: 90.0),
        "whole": Orthographic(size_px: (8, 8), extent_m: (10.0, 20.0)),
    },
)
"#;
    let dir = tempfile::tempdir().expect("a temporary folder");
    let path = dir.path().join("scene.ron");
    fs::write(dir.path().join("t.obj"), "g leaf\nv 0 0 0\nv 100 0 0\nv 0 0 850\nf 1 2 3\n")
        .expect("a file");
    let warnings = |text: &str| -> Vec<String> {
        fs::write(&path, text).expect("a file");
        let found = check_file(&path, &Options::default());
        let found = found.unwrap_or_else(|failure| panic!("{failure}")).join("\n");
        let found = found.replace(&format!("{}/", dir.path().display()), "");
        // All but the quoted lines.
        found
            .lines()
            .filter(|line| !line.contains('|'))
            .map(|line| line.trim().to_owned())
            .collect()
    };
    let expected = [
        "warning: 1 of `tree` stand beside the ground",
        "--> scene.ron:7:16 (instances)",
        "= help: one stands at (11, 2), and the ground reaches from (0, 0) to (10, 20) m: make it \
         larger, or move them",
        "",
        "warning: `tree` is 850 m large",
        "--> scene.ron:5:23 (meshes.tree)",
        "= help: if its file is in centimetres, write `unit_m: 0.01`; in millimetres, \
         `unit_m: 0.001`",
        "",
        "warning: the middle of the image lies beside the ground",
        "--> scene.ron:10:59 (sensors.beside.extent_m)",
        "= help: the ground reaches from (0, 0) to (10, 20) m",
        "",
        "warning: 50.0 % of the image lies beside the ground",
        "--> scene.ron:11:57 (sensors.wide.extent_m)",
        "= help: the ground reaches from (0, 0) to (10, 20) m; what lies beside it holds no data",
    ];
    assert_eq!(warnings(text), expected);
    // Without an end, the ground is everywhere.
    let periodic = text.replace("terrain:", "boundary: Periodic, terrain:");
    assert_eq!(warnings(&periodic), expected[4..7]);
}
