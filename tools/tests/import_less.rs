//! Projects of LESS 1.8.8 as scenes. The projects are made up, from what is documented of the format.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::float_cmp, reason = "what is read back is exact")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

const GROVE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/less/grove/Parameters");
const DEFAULT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/less/default");

/// A folder with a copy of the project, its `input.conf` changed.
fn project(changes: &[(&str, &str)]) -> TempDir {
    let folder = tempdir().unwrap();
    let parameters = folder.path().join("grove/Parameters");
    fs::create_dir_all(&parameters).unwrap();
    for entry in fs::read_dir(GROVE).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, parameters.join(path.file_name().unwrap())).unwrap();
    }
    let mut text = read(folder.path(), "grove/Parameters/input.conf");
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    fs::write(parameters.join("input.conf"), text).unwrap();
    folder
}

fn read(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap()
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Imports `grove` and checks the scene; what was printed.
fn import(folder: &TempDir) -> String {
    let (code, printed, errors) = outcome(folder.path(), &["import-less", "grove"]);
    assert_eq!((code, errors.as_str()), (0, ""));
    let (code, _, errors) = outcome(folder.path(), &["check", "imported/grove/scene.ron"]);
    assert_eq!(code, 0, "{errors}");
    printed
}

/// The scene without the remarks above it, from a line on that starts with `from`.
fn scene_from(folder: &TempDir, file: &str, from: &str) -> String {
    let text = read(folder.path(), &format!("imported/grove/{file}"));
    text[text.find(&format!("\n    {from}")).unwrap() + 1..].to_owned()
}

/// What a person reads when a project cannot be imported, with one file written anew.
fn broken(changes: &[(&str, &str)], files: &[(&str, &str)]) -> String {
    let folder = project(changes);
    for (file, text) in files {
        fs::write(folder.path().join("grove/Parameters").join(file), text).unwrap();
    }
    let (code, _, errors) = outcome(folder.path(), &["import-less", "grove"]);
    assert_eq!(code, 1, "{errors}");
    assert!(!folder.path().join("imported/grove/scene.ron").exists());
    errors.trim_end().to_owned()
}

#[test]
fn a_project_becomes_a_scene_and_nothing_is_left_out_silently() {
    let folder = project(&[]);
    insta::assert_snapshot!("printed", import(&folder));
    insta::assert_snapshot!("scene", read(folder.path(), "imported/grove/scene.ron"));
}

/// x runs to the east and y to the south from the north-west corner; of models x to the west, y up
/// and z to the north.
#[test]
fn places_and_models_are_turned_into_the_frame_of_sunfleck() {
    let folder = project(&[]);
    import(&folder);
    insta::assert_snapshot!("places", read(folder.path(), "imported/grove/assets/places_pine.csv"));
    insta::assert_snapshot!("model", read(folder.path(), "imported/grove/assets/pine.obj"));
}

#[test]
fn a_batch_becomes_a_sweep_over_parameters() {
    let folder = project(&[]);
    import(&folder);
    let text = scene_from(&folder, "angles.ron", "sun: ");
    insta::assert_snapshot!("batch", text);
    let (code, printed, errors) = outcome(
        folder.path(),
        &["sweep", "imported/grove/angles.ron", "--quality", "0.1", "--out", "out"],
    );
    assert_eq!(code, 0, "{errors}");
    assert!(printed.contains("6 points run"), "{printed}");
}

#[test]
fn cameras_and_photons_become_sensors() {
    let pose = |z: &str| {
        format!(
            r#""observation": {{ "obs_o_x": 4, "obs_o_y": 3, "obs_o_z": 9, "obs_t_x": 4, "obs_t_y": 3, "obs_t_z": {z}, "relative_height": true }}"#
        )
    };
    let nadir = r#""observation": { "obs_zenith": 10, "obs_azimuth": 200, "obs_R": 3000 }"#;
    let own = "\"orthographic\": {\n";
    let kind = r#""sensor_type": "orthographic""#;
    let camera = |name: &str, keys: &str, z: &str| {
        let folder = project(&[
            (nadir, &pose(z)),
            (kind, &format!(r#""sensor_type": "{name}""#)),
            (own, &format!("\"{name}\": {{ {keys},\n")),
        ]);
        import(&folder);
        scene_from(&folder, "scene.ron", "sensors: ")
    };
    let perspective =
        camera("perspective", r#""fovx": 40, "fovy": 30, "fovAxis": "diagonal""#, "1");
    insta::assert_snapshot!("perspective", perspective);
    let keys = r#""angular_fov": 165, "projection_type": "equisolid""#;
    insta::assert_snapshot!("fisheye", camera("CircularFisheye", keys, "20"));
    let keys = r#""sunRayResolution": 0.2, "BRFProduct": true, "UpDownProduct": true, "fPARProduct": true,
        "virtualDirections": "0:0;30:90", "virtualDetectorDirections": "10,20;0,90,180;5",
        "NumberOfDirections": 100, "LayerDefinition": "0:2:5""#;
    insta::assert_snapshot!("photons", camera("PhotonTracing", keys, "1"));
}

#[test]
fn thermal_projects_measure_what_surfaces_emit() {
    let folder = project(&[
        (r#""thermal_radiation": false"#, r#""thermal_radiation": true"#),
        ("660:10,865:20", "10000:100,11000:100"),
        (r#""record_only_direct": 2,"#, r#""record_only_direct": 200,"#),
    ]);
    import(&folder);
    insta::assert_snapshot!("thermal", scene_from(&folder, "scene.ron", "sun: "));
}

#[test]
fn meshes_may_be_the_ground() {
    let folder = project(&[
        (r#""terrain_type": "RASTER""#, r#""terrain_type": "MESH""#),
        (r#""terr_file": "hills""#, r#""terr_file": "ground.obj""#),
    ]);
    let ground = "v 10 0 -5\nv -10 1 -5\nv -10 1 5\nv 10 0 5\nf 1 4 3\nf 1 3 2\n";
    fs::write(folder.path().join("grove/Parameters/ground.obj"), ground).unwrap();
    import(&folder);
    let text = scene_from(&folder, "scene.ron", "meshes: ");
    assert!(
        text.contains(r#"terrain: Mesh(mesh: "the ground", at_m: (10.0, 5.0, 0.0))"#),
        "{text}"
    );
    let obj = read(folder.path(), "imported/grove/assets/terrain.obj");
    assert!(obj.starts_with("g terrain\nv -10 -5 0\nv 10 -5 1\n"), "{obj}");
}

/// *Scene*: a Lambertian plane, imported, below sun and sky.
/// *Expected*: its BRF, or under a sky its HDRF, is its reflectance in each band.
#[test]
fn an_imported_plane_has_the_brf_of_its_reflectance() {
    let folder = project(&[
        (r#""terrain_type": "RASTER""#, r#""terrain_type": "PLANE""#),
        (r#""landcover": "classes","#, ""),
        (r#""terrBRDFType": "Soilspect""#, r#""terrBRDFType": "Lambertian""#),
        (r#""RepetitiveScene": 15"#, r#""RepetitiveScene": 3"#),
    ]);
    fs::write(folder.path().join("grove/Parameters/instances.txt"), "").unwrap();
    import(&folder);
    let arguments = ["run", "imported/grove/scene.ron", "--out", "out"];
    let (code, _, errors) = outcome(folder.path(), &arguments);
    assert_eq!(code, 0, "{errors}");
    let summary: serde_json::Value =
        serde_json::from_str(&read(folder.path(), "out/summary.json")).unwrap();
    let values = summary["sensors"]["image"]["hdrf"]["values"].as_array().unwrap();
    assert_eq!(values.len(), 2);
    for (value, rho) in values.iter().zip([0.1, 0.2]) {
        assert!((value.as_f64().unwrap() - rho).abs() < 1e-6, "{value} is not {rho}");
    }
}

#[test]
fn broken_projects_are_told_by_file_and_line() {
    let leaf = r#""0.05,0.45;0.07,0.44;0.04,0.4""#;
    let told = [
        broken(&[(leaf, r#""0.05;0.07;0.04""#)], &[]),
        broken(&[(leaf, r#""0.65,0.45;0.07,0.44;0.4,0.4""#)], &[]),
        broken(&[(leaf, r#""0.05,0.45;0.07,0.44""#)], &[]),
        broken(&[(r#""percentage": "0.2,0.1""#, r#""percentage": "0.2,0.1,0.3""#)], &[]),
        broken(
            &[
                (r#""albedo": "0.45,0.6""#, r#""albedo": "0.45,1.6""#),
                (r#""landcover": "classes","#, ""),
            ],
            &[],
        ),
        broken(
            &[
                (r#""albedo": "0.45,0.6""#, r#""albedo": "0.45,1""#),
                (r#""landcover": "classes","#, ""),
            ],
            &[],
        ),
        broken(&[(r#""h2": "0.114""#, r#""h2": "0""#), (r#""landcover": "classes","#, "")], &[]),
        broken(&[(r#""sun_zenith": 40"#, r#""sun_zenith": "ninety""#)], &[]),
        broken(&[("660:10,865:20", "660:10,red")], &[]),
        broken(
            &[
                (r#""optical": "loam""#, r#""optical": "laom""#),
                (r#""landcover": "classes","#, ""),
                (r#""terrBRDFType": "Soilspect","#, ""),
            ],
            &[],
        ),
        broken(&[(r#""terr_file": "hills""#, r#""terr_file": "hill""#)], &[]),
        broken(&[(r#""Advanced": {"#, r#""Advanced": {,"#)], &[]),
        broken(&[], &[("objects.txt", "\npine pine_crwn.obj leaf\n")]),
        broken(&[], &[("objects.txt", "pine pine_crown.obj leef\n")]),
        broken(&[], &[("objects.txt", "pine pine_crown.obj leaf T3000\n")]),
        broken(&[], &[("pine_stem.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")]),
        broken(&[], &[("pine_stem.obj", "v 0 0 zero\n")]),
        broken(&[], &[("instances.txt", "pine 1 2 0\npin 3 4 0\n")]),
        broken(&[], &[("instances.txt", "pine 1 2\n")]),
        broken(&[], &[("instances.txt", "pine 21 2 0\n")]),
        broken(
            &[],
            &[("angles.json", r#"{"a": {"sun_zenith": "LIST:1,2", "sun_azimuth": "LIST:1"}}"#)],
        ),
        broken(&[], &[("angles.json", r#"{"a": {"sun_zenith": "LIST:30,95"}}"#)]),
        broken(
            &[],
            &[("angles.json", r#"{"a": {"sun_zenith": "LIST:30,40", "sun_azimuth": "10"}}"#)],
        ),
    ];
    insta::assert_snapshot!("broken", told.join("\n"));
    let folder = tempdir().unwrap();
    let (code, _, errors) = outcome(folder.path(), &["import-less", "."]);
    assert_eq!(code, 1);
    assert!(errors.contains("is no LESS project"), "{errors}");
}

/// *Projects*: what LESS writes when a new project is made, in two versions.
/// *Expected*: bare soil of 100 m x 100 m in an image of 100 x 100 pixels, whose BRF is the soil's.
#[test]
fn the_default_projects_of_less_are_bare_soil() {
    for version in ["newer", "older"] {
        let folder = tempdir().unwrap();
        let parameters = folder.path().join("grove/Parameters");
        fs::create_dir_all(&parameters).unwrap();
        let file = format!("{DEFAULT}/{version}/Parameters/input.conf");
        fs::copy(file, parameters.join("input.conf")).unwrap();
        import(&folder);
        let scene = read(folder.path(), "imported/grove/scene.ron");
        assert!(scene.contains("Plane(size_m: (100.0, 100.0), material: \"dark_soil_mollisol\")"));
        assert!(scene.contains("size_px: (100, 100)") && !scene.contains("max_order"), "{scene}");
        let arguments = ["run", "imported/grove/scene.ron", "--quality", "0.02", "--out", "out"];
        let (code, _, errors) = outcome(folder.path(), &arguments);
        assert_eq!(code, 0, "{errors}");
        let summary: serde_json::Value =
            serde_json::from_str(&read(folder.path(), "out/summary.json")).unwrap();
        let values = summary["sensors"]["image"]["brf"]["values"].as_array().unwrap();
        assert_eq!(values.len(), 2);
        for (value, rho) in values.iter().zip([0.188, 0.351]) {
            assert!((value.as_f64().unwrap() - rho).abs() < 1e-6, "{value} is not {rho}");
        }
    }
}

/// *Scene*: a SOILSPECT plane without trees, imported, one albedo for both bands.
/// *Expected*: the material `Soilspect` with LESS's parameters, and the BRF of the formula at nadir, where
/// `g = g' = θs` and `BRF = ω / [4 (μs + 1)] {[1 + B] P + H(μs) H(1) - 1}`.
#[test]
fn a_soilspect_ground_is_imported_with_its_parameters() {
    let folder = project(&[
        (r#""terrain_type": "RASTER""#, r#""terrain_type": "PLANE""#),
        (r#""landcover": "classes","#, ""),
        (r#""albedo": "0.45,0.6""#, r#""albedo": "0.45""#),
        (r#""percentage": "0.2,0.1""#, r#""percentage": "0,0""#),
        (r#""obs_zenith": 10"#, r#""obs_zenith": 0"#),
        (r#""RepetitiveScene": 15"#, r#""RepetitiveScene": 3"#),
    ]);
    fs::write(folder.path().join("grove/Parameters/instances.txt"), "").unwrap();
    let printed = import(&folder);
    assert!(!printed.contains("STAND-IN"), "{printed}");
    let scene = read(folder.path(), "imported/grove/scene.ron");
    for key in [
        "albedo: Bands([0.45, 0.45])",
        "b: Bands([1.492, 1.492])",
        "c: Bands([0.56, 0.56])",
        "b_prime: Bands([0.238, 0.238])",
        "c_prime: Bands([-0.06, -0.06])",
        "hot_spot: Bands([1.0, 1.0])",
        "roughness: Bands([0.114, 0.114])",
    ] {
        assert!(scene.contains(key), "{key}: {scene}");
    }
    let arguments = ["run", "imported/grove/scene.ron", "--out", "out"];
    let (code, _, errors) = outcome(folder.path(), &arguments);
    assert_eq!(code, 0, "{errors}");
    let summary: serde_json::Value =
        serde_json::from_str(&read(folder.path(), "out/summary.json")).unwrap();
    let values = summary["sensors"]["image"]["brf"]["values"].as_array().unwrap();
    let sun = 40.0_f64.to_radians();
    let cosine = sun.cos();
    let legendre = 0.5 * (3.0 * cosine * cosine - 1.0);
    let phase = 1.0 + (1.492 + 0.238) * cosine + (0.56 - 0.06) * legendre;
    let hot_spot = 1.0 / (1.0 + (0.5 * sun).tan() / 0.114);
    let multiple = |x: f64| (1.0 + 2.0 * x) / (1.0 + 2.0 * x * 0.55_f64.sqrt());
    let expected = 0.45 / (4.0 * (cosine + 1.0))
        * ((1.0 + hot_spot) * phase + multiple(cosine) * multiple(1.0) - 1.0);
    assert_eq!(values.len(), 2);
    for value in values {
        assert!((value.as_f64().unwrap() - expected).abs() < 1e-5, "{value} is not {expected}");
    }
}

#[test]
fn an_import_that_fails_leaves_nothing_behind() {
    let folder = project(&[]);
    fs::write(folder.path().join("grove/Parameters/objects.txt"), "pine gone.obj leaf\n").unwrap();
    let (code, _, errors) = outcome(folder.path(), &["import-less", "grove"]);
    assert_eq!(code, 1, "{errors}");
    assert_eq!(fs::read_dir(folder.path().join("imported")).unwrap().count(), 0);
}

#[test]
fn a_scene_that_is_there_is_kept() {
    let folder = project(&[]);
    import(&folder);
    let (code, _, errors) = outcome(folder.path(), &["import-less", "grove"]);
    assert_eq!(code, 1);
    assert!(errors.contains("is there already: name another folder with `--out`"), "{errors}");
}
