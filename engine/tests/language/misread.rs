//! What people write who come from another language or program, and the advice that they get.

use std::fs;

use sunfleck::document::{ReadOptions, read_file, read_text};

const SCENE: &str = r#"Scene(
    format: 1,
    params: { "sza": 30.0, "soil": "dirt" },
    bands: [(name: "red", center_nm: 660.0, width_nm: 10.0)],
    spectra: { "dirt": Constant(0.2) },
    materials: { "soil": Lambertian(reflectance: Named("dirt")) },
    meshes: { "rock": Faces(faces_m: [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)]], material: "soil") },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    instances: [Scatter(of: { "rock": 1.0 }, rule: Uniform, stems: Count(3))],
    sun: (zenith_deg: "=sza", azimuth_deg: 270.0),
    sensors: { "view": Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0)) },
)"#;

fn shown(text: &str) -> String {
    match read_text("scene.ron", text, &ReadOptions::default()) {
        Ok(reading) => reading.render(),
        Err(error) => format!("error: {error}\n"),
    }
}

#[test]
fn each_slip_gets_the_advice_that_mends_it() {
    assert!(!shown(SCENE).contains("error"), "{}", shown(SCENE));
    for (written, wrong, parts) in [
        ("format: 1,", "# a comment\nformat: 1,", &["comments start with `//`"][..]),
        ("zenith_deg: \"=sza\"", "zenith_deg = 30.0", &["write `key: value`"]),
        ("format: 1,", "format: 1;", &["by commas"]),
        ("\"sza\": 30.0", "\"sza\": 30,0", &["write `30.0`"]),
        ("zenith_deg: \"=sza\"", "zenith_deg: 30,5", &["write `30.5`"]),
        ("(5.0, 5.0)", "(5,25, 5,0)", &["expected 2 values, found 4", "write `5.25`"]),
        ("\"=sza\"", "30°", &["write the number alone"]),
        ("\"=sza\"", "−30", &["minus sign of the keyboard"]),
        ("\"=sza\"", "90 * 2", &["formulas stand in a string"]),
        ("\"dirt\": C", "“dirt”: C", &["double quotes"]),
        ("Scene(", "Scene{", &["expected `(` after `Scene`", "`Scene(..)`"]),
        ("Plane(", "Plane[", &["`Plane([..])`"]),
        ("\"soil\": L", "soil: L", &["the key `soil` of a map needs quotes", "\"soil\": .."]),
        ("zenith_deg: \"=sza\"", "elevation_deg: 35.0", &["`zenith_deg: 55.0`"]),
        ("zenith_deg: \"=sza\"", "altitude_deg: 20", &["`zenith_deg: 70.0`"]),
        ("Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0))", "BRF()", &["`Directions("]),
        ("Orthographic(size_px: (4, 4), extent_m: (5.0, 5.0))", "Pinhole()", &["`Perspective("]),
        ("Lambertian(", "Diffuse(", &["`Lambertian(..)` is opaque"]),
        ("\"=sza\"", "\"sza\"", &["write `\"=sza\"`"]),
        ("\"=sza\"", "sza", &["write `\"=sza\"`"]),
        ("\"=sza\"", "\"90 - sza\"", &["write `\"=90 - sza\"`"]),
        ("\"=sza\"", "\"30.0\"", &["write `30.0`, without quotes"]),
        ("\"=sza\"", "\"30 deg\"", &["write `30`", "names of keys"]),
        ("Named(\"dirt\")", "\"dirt\"", &["write `Named(\"dirt\")`"]),
        ("Named(\"dirt\")", "dirt", &["write `Named(\"dirt\")`"]),
        ("Named(\"dirt\")", "\"soil.csv\"", &["write `Table(file: \"soil.csv\")`"]),
        ("Named(\"dirt\")", "0.3", &["write `Constant(0.3)`"]),
        ("Named(\"dirt\")", "[0.3]", &["write `Bands([..])`"]),
        (
            "660.0, width_nm: 10.0",
            "0.66, width_nm: 0.01",
            &["`center_nm: 660.0`", "`width_nm: 10.0`"],
        ),
        ("660.0", "10.5", &["`center_nm: 10500.0`"]),
    ] {
        assert!(SCENE.contains(written), "{written}");
        let found = shown(&SCENE.replacen(written, wrong, 1));
        assert!(found.starts_with("error: "), "{wrong}: {found}");
        for part in parts {
            assert!(found.contains(part), "{wrong} without {part:?}:\n{found}");
        }
    }
}

/// *Expected*: what is wrong with a key is shown at the key.
#[test]
fn an_unknown_name_in_a_key_is_underlined_there() {
    let wrong =
        SCENE.replace("format: 1,", "format: 1, variants: { \"dry\": { \"szaa\": 40.0 } },");
    let found = shown(&wrong);
    let line = found.lines().position(|line| line.contains("\"szaa\": 40.0")).expect("the line");
    let lines: Vec<&str> = found.lines().collect();
    let key = lines[line].find("\"szaa\"");
    assert_eq!(lines[line + 1].find('^'), key, "{found}");
}

#[test]
fn a_parameter_that_cannot_stand_there_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    for include in ["{ \"a\": \"=soil\" }", "{ \"a\": (file: \"=soil\") }"] {
        let text = SCENE.replace("format: 1,", &format!("format: 1, include: {include},"));
        fs::write(&file, text).expect("a scene");
        let found = read_file(&file, &ReadOptions::default()).expect("RON").render();
        assert!(found.contains("`=soil` cannot name an included file"), "{found}");
        assert!(found.contains("before parameters have values"), "{found}");
    }
}
