//! The command from outside: exit codes, what is said where, and what is on disk afterwards.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// Smallest scene that measures something: bare soil of reflectance 0.3 below the sun.
const SOIL: &str = r#"Scene(
    format: 1,
    title: "Soil",
    params: { "sza": 30.0 },
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "soil": Lambertian(reflectance: Constant(0.3)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (zenith_deg: "=sza"),
    boundary: Periodic,
    sensors: {
        "top": Orthographic(size_px: (8, 6), extent_m: (8.0, 6.0), samples_per_px: 32),
        "views": Directions(views: List([(0.0, 0.0), (30.0, 90.0)]), until: Samples(4096)),
    },
    variants: { "low": { "sza": 75.0 } },
)"#;

fn sunfleck(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    command.current_dir(folder);
    command
}

fn folder_with(scene: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("soil.ron"), scene).unwrap();
    folder
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = sunfleck(folder).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_run_writes_its_files_and_prints_a_table() {
    let folder = folder_with(SOIL);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "soil.ron"]);
    assert_eq!((code, stderr.as_str()), (0, ""), "no bars in a pipe");
    let expected = [
        "summary.json",
        "top_brf.exr",
        "top_brf.img",
        "top_brf.img.hdr",
        "top_brf.pixels.png",
        "top_brf.png",
        "top_brf_se.img",
        "top_brf_se.img.hdr",
        "views_brf.csv",
        "views_brf.svg",
    ];
    assert_eq!(names(&folder.path().join("out/soil")), expected);
    assert!(stdout.starts_with("sensor "), "{stdout}");
    assert!(stdout.contains("views ") && stdout.contains("10 files in out/soil: "), "{stdout}");
    let text = fs::read_to_string(folder.path().join("out/soil/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    for value in summary["sensors"]["views"]["brf"]["values"].as_array().unwrap() {
        // A Lambertian plane has the BRF of its reflectance, with no noise under a beam.
        assert!((value.as_f64().unwrap() - 0.3).abs() < 1e-6, "{value}");
    }
}

#[test]
fn the_first_scene_of_the_readme_runs() {
    let readme = concat!(env!("CARGO_MANIFEST_DIR"), "/../README.md");
    let text = fs::read_to_string(readme).unwrap();
    let scene = text.split("```ron\n").nth(1).unwrap().split("```").next().unwrap();
    let folder = folder_with(scene);
    let (code, stdout, _) = outcome(folder.path(), &["check", "soil.ron", "--set", "sza=50"]);
    assert_eq!(code, 0);
    assert!(stdout.ends_with("soil.ron: no errors\n"), "{stdout}");
    let (code, _, stderr) = outcome(folder.path(), &["run", "soil.ron", "--quality", "0.01"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(folder.path().join("out/soil/nadir_brf.png").is_file());
}

#[test]
fn the_number_of_threads_changes_no_digit() {
    let folder = folder_with(SOIL);
    let values = |threads: &str| {
        let arguments = ["run", "soil.ron", "--out", threads, "--threads", threads];
        assert_eq!(outcome(folder.path(), &arguments).0, 0);
        fs::read(folder.path().join(threads).join("top_brf.img")).unwrap()
    };
    assert_eq!(values("1"), values("3"));
}

#[test]
fn settings_and_variants_reach_the_scene() {
    let folder = folder_with(SOIL);
    let expand = |more: &[&str]| {
        let (code, stdout, stderr) =
            outcome(folder.path(), &[&["expand", "soil.ron"], more].concat());
        assert_eq!(code, 0, "{stderr}");
        stdout
    };
    assert!(expand(&[]).contains("zenith_deg: 30.0"), "{}", expand(&[]));
    assert!(expand(&["--variant", "low"]).contains("zenith_deg: 75.0"));
    assert!(expand(&["--set", "sza=12.5"]).contains("zenith_deg: 12.5"));
    assert!(expand(&["--variant", "low", "--set", "sza=60"]).contains("zenith_deg: 60.0"));
}

#[test]
fn an_expanded_scene_is_a_scene() {
    let folder = folder_with(SOIL);
    let (_, text, _) = outcome(folder.path(), &["expand", "soil.ron"]);
    fs::write(folder.path().join("again.ron"), &text).unwrap();
    assert_eq!(outcome(folder.path(), &["check", "again.ron"]).0, 0);
    let values = |text: &str| -> Vec<String> {
        let lines = text.lines().map(|line| line.split("  //").next().unwrap().to_owned());
        lines.filter(|line| !line.starts_with("//")).collect()
    };
    let again = outcome(folder.path(), &["expand", "again.ron"]).1;
    assert_eq!(values(&again), values(&text));
    assert!(text.contains("zenith_deg: 30.0),  // soil.ron:8, \"=sza\""), "{text}");
    // The same scene: what it measures has the same hash.
    let hash = |scene: &str| {
        outcome(folder.path(), &["run", scene, "--quality", "0.01", "--out", "out", "--force"]);
        let summary = fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
        summary.lines().find(|line| line.contains("\"hash\"")).unwrap().to_owned()
    };
    assert_eq!(hash("soil.ron"), hash("again.ron"));
}

#[test]
fn a_scene_that_is_not_there_has_a_nearest_name() {
    let folder = folder_with("");
    for command in ["check", "run", "sweep", "stats", "expand"] {
        let (code, _, stderr) = outcome(folder.path(), &[command, "sol.ron"]);
        assert_eq!(code, 1);
        assert_eq!(stderr, "error: there is no file sol.ron: did you mean `soil.ron`?\n");
    }
    let (_, _, stderr) = outcome(folder.path(), &["check", "none/sol.ron"]);
    assert_eq!(
        stderr,
        "error: there is no file none/sol.ron: there is no folder none that can be read\n"
    );
}

/// Two trees of 25 m² of leaves on 100 m² and the sun over Berlin at noon: stems, leaf area, cover and sun are
/// those that follow by hand.
#[test]
fn check_says_what_a_scene_is() {
    let folder = folder_with(
        r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0), (name: "dark", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Constant(0.1), transmittance: Constant(0.1)),
    },
    meshes: {
        "tree": Crown(
            shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 1.0, leaf_area_m2: 25.0,
            leaf: Disc(radius_m: 0.05), leaf_material: "leaf",
        ),
    },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(3.0, 3.0, 0.0), (7.0, 7.0, 0.0)])],
    sun: (
        position: Spa(date: (2026, 6, 21), time: (12, 0, 0), utc_offset_h: 1, latitude_deg: 52.5, longitude_deg: 13.4),
        irradiance: Bands([1.5, 0.0]),
    ),
    sensors: { "top": Orthographic(size_px: (20, 10), extent_m: (10.0, 10.0), samples_per_px: 4) },
)"#,
    );
    let (code, stdout, stderr) = outcome(folder.path(), &["check", "soil.ron"]);
    assert_eq!(code, 0);
    assert!(stderr.starts_with("warning: no light falls on the scene in band `dark`"), "{stderr}");
    assert_eq!(stderr.matches("warning: ").count(), 1, "{stderr}");
    for part in
        ["zenith 29.1", "leaf area index 0.5", "none: dark", "Orthographic", "from place and time"]
    {
        assert!(stdout.contains(part), "{part}: {stdout}");
    }
    let source = |stdout: &str, band: &str| {
        let line = stdout.lines().find(|line| line.trim_start().starts_with(band)).unwrap();
        line.rsplit("  ").next().unwrap().trim().to_owned()
    };
    assert_eq!(source(&stdout, "red"), "sun", "{stdout}");
    let note = "note: sky: none is given, so that shadows receive no light of the sky; \
                `sunfleck keys sky` shows how to write one\n";
    assert_eq!(stdout.matches(note).count(), 1, "{stdout}");
    let scene = fs::read_to_string(folder.path().join("soil.ron")).unwrap();
    let lit = scene.replacen("    sensors:", "    sky: Fraction([0.2, 0.2]),\n    sensors:", 1);
    fs::write(folder.path().join("lit.ron"), lit).unwrap();
    let (_, lit, errors) = outcome(folder.path(), &["check", "lit.ron"]);
    assert!(!lit.contains("note: sky"), "{lit}");
    assert_eq!(source(&lit, "red"), "sun and sky", "{lit}{errors}");
    let (_, stdout, _) = outcome(folder.path(), &["check", "soil.ron", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    let scene = &json["scene"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((number(&scene["meshes"][0]["per_hectare"]) - 200.0).abs() < 1e-9);
    // Leaves fill their area to one leaf; a circle of 1 m radius, but for its gaps.
    assert!((number(&scene["leaf_area_index"]) - 0.5).abs() < 0.01, "{scene}");
    let circles = 2.0 * std::f64::consts::PI / 100.0;
    let cover = number(&scene["canopy_cover"]);
    assert!((0.7 * circles..1.05 * circles).contains(&cover), "{cover}");
    assert_eq!(scene["sensors"][0]["samples"], 800);
    assert_eq!(json["warnings"].as_array().map(Vec::len), Some(1), "the band without light");
}

/// *Scene*: a crown of 2 m with 1200 m² of leaves, 400 in place of 4 m². *Expected*: a warning of each.
#[test]
fn check_warns_of_what_cannot_be() {
    let scene = |leaf_area: f64| {
        format!(
            r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    materials: {{
        "soil": Lambertian(reflectance: Constant(0.2)),
        "leaf": Leaf(reflectance: Constant(0.1), transmittance: Constant(0.1)),
    }},
    meshes: {{
        "tree": Crown(
            shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 1.0, leaf_area_m2: {leaf_area:?},
            leaf: Disc(radius_m: 0.2), leaf_material: "leaf",
        ),
    }},
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(3.0, 3.0, 0.0), (7.0, 7.0, 0.0)])],
    sun: (zenith_deg: 30.0),
    sensors: {{ "top": Orthographic(size_px: (20, 10), extent_m: (10.0, 10.0), samples_per_px: 4) }},
)"#
        )
    };
    let folder = folder_with(&scene(1400.0));
    let (_, stdout, stderr) = outcome(folder.path(), &["check", "soil.ron"]);
    assert!(stderr.contains("`tree` holds") && stderr.contains("leaf area index of"), "{stderr}");
    assert!(stderr.contains("the leaf area index of the scene is 28"), "{stderr}");
    assert!(stdout.ends_with("no errors, 2 warnings\n"), "{stdout}");
    let folder = folder_with(&scene(14.0));
    let (_, _, stderr) = outcome(folder.path(), &["check", "soil.ron"]);
    assert_eq!(stderr, "");
}

#[test]
fn check_writes_nothing() {
    let folder = folder_with(SOIL);
    let (code, stdout, stderr) = outcome(folder.path(), &["check", "soil.ron"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(stdout.ends_with("soil.ron: no errors\n"), "{stdout}");
    assert_eq!(names(folder.path()), ["soil.ron"]);
}

#[test]
fn a_faulty_scene_fails_with_its_place_and_writes_nothing() {
    let folder = folder_with(&SOIL.replace("material: \"soil\"", "material: \"sand\""));
    for command in ["run", "check"] {
        let (code, stdout, stderr) = outcome(folder.path(), &[command, "soil.ron"]);
        assert_eq!((code, stdout.as_str()), (1, ""), "{stderr}");
        assert!(stderr.starts_with("error: "), "{stderr}");
        assert!(stderr.contains("soil.ron:7:") && stderr.contains("sand"), "{stderr}");
        assert_eq!(names(folder.path()), ["soil.ron"]);
    }
    let folder = folder_with(&SOIL.replace("terrain:", "terain:"));
    let (code, _, stderr) = outcome(folder.path(), &["expand", "soil.ron"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("soil.ron:7:") && stderr.contains("terrain"), "{stderr}");
}

#[test]
fn a_missing_scene_or_parameter_or_variant_is_an_error_that_names_it() {
    let folder = folder_with(SOIL);
    let cases: [(&[&str], &str); 4] = [
        (&["run", "birch.ron"], "birch.ron"),
        (&["run", "soil.ron", "--set", "sta=1"], "sta"),
        (&["check", "soil.ron", "--variant", "lwo"], "lwo"),
        (&["expand", "."], "."),
    ];
    for (arguments, name) in cases {
        let (code, stdout, stderr) = outcome(folder.path(), arguments);
        assert_eq!((code, stdout.as_str()), (1, ""), "{arguments:?}: {stderr}");
        assert!(stderr.starts_with("error: ") && stderr.contains(name), "{stderr}");
        assert_eq!(names(folder.path()), ["soil.ron"]);
    }
}

#[test]
fn an_output_folder_that_cannot_be_is_an_error_before_tracing() {
    let folder = folder_with(SOIL);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "soil.ron", "--out", "soil.ron"]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    assert_eq!(stderr, "error: soil.ron is a file: name a folder for the output\n");
    let below = ["run", "soil.ron", "--out", "soil.ron/out"];
    let (code, _, stderr) = outcome(folder.path(), &below);
    assert_eq!(code, 1);
    assert!(stderr.starts_with("error: cannot make the folder soil.ron/out: "), "{stderr}");
    assert_eq!(fs::read_to_string(folder.path().join("soil.ron")).unwrap(), SOIL);
}

#[test]
fn wrong_usage_has_its_own_exit_code() {
    let folder = folder_with(SOIL);
    let cases: [&[&str]; 9] = [
        &[],
        &["trace"],
        &["run"],
        &["run", "soil.ron", "--fast"],
        &["run", "soil.ron", "--set", "sza"],
        &["run", "soil.ron", "--set", "sza="],
        &["run", "soil.ron", "--threads", "0"],
        &["run", "soil.ron", "--quality", "0"],
        &["check", "soil.ron", "--out", "x"],
    ];
    for arguments in cases {
        let (code, stdout, stderr) = outcome(folder.path(), arguments);
        assert_eq!((code, stdout.as_str()), (2, ""), "{arguments:?}: {stderr}");
        assert!(stderr.contains("--help") || stderr.contains("Usage: "), "{arguments:?}: {stderr}");
        assert_eq!(names(folder.path()), ["soil.ron"]);
    }
}

#[test]
fn help_tells_every_command_and_option() {
    let folder = tempdir().unwrap();
    let (code, stdout, _) = outcome(folder.path(), &["--help"]);
    assert_eq!(code, 0);
    for word in ["run", "check", "expand", "First steps:"] {
        assert!(stdout.contains(word), "no {word} in\n{stdout}");
    }
    let (code, stdout, _) = outcome(folder.path(), &["run", "--help"]);
    assert_eq!(code, 0);
    for option in
        ["--out", "--set", "--variant", "--threads", "--quality", "out/<name of the scene"]
    {
        assert!(stdout.contains(option), "no {option} in\n{stdout}");
    }
    let (code, stdout, _) = outcome(folder.path(), &["--version"]);
    assert_eq!((code, stdout.as_str()), (0, concat!("sunfleck ", env!("CARGO_PKG_VERSION"), "\n")));
}

/// A sweep over the sun's zenith angle and the soil, of which only the soil's height is geometry.
fn swept() -> String {
    SOIL.replace("\"sza\": 30.0 }", "\"sza\": 30.0, \"height\": 0.0 }")
        .replace("material: \"soil\")", "material: \"soil\", height_m: \"=height\")")
        .replace("variants:", "sweep: Grid({ \"sza\": [0.0, 60.0] }), variants:")
}

#[test]
fn a_sweep_writes_one_table_and_goes_on_where_it_stopped() {
    let folder = folder_with(&swept());
    let (code, stdout, stderr) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert_eq!(stdout, "out/soil_sweep/sweep.csv: 2 points run, 0 kept; geometry built once\n");
    let out = folder.path().join("out/soil_sweep");
    assert_eq!(names(&out), ["points", "summary.json", "sweep.csv"]);
    assert_eq!(names(&out.join("points")), ["sza=0", "sza=60"]);
    let table = || fs::read_to_string(out.join("sweep.csv")).unwrap();
    let first = table();
    let mut lines = first.lines();
    assert_eq!(
        lines.next(),
        Some(
            "sza,sensor,product,unit,zenith_deg,azimuth_deg,signed_zenith_deg,band,value,standard_error"
        ),
        "{first}"
    );
    assert!(lines.next().is_some_and(|line| line.starts_with("0.0,top,brf,1,,,,red,")), "{first}");
    assert!(first.contains("\n60.0,views,brf,1,30.0,90.0,30.0,red,"), "{first}");

    // A point of a run that was interrupted has no table yet.
    fs::remove_file(out.join("points/sza=60/point.csv")).unwrap();
    fs::remove_file(out.join("sweep.csv")).unwrap();
    let (_, stdout, _) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert!(stdout.contains("1 point run, 1 kept"), "{stdout}");
    assert_eq!(table(), first, "the same numbers");
    // Another value is another result.
    let sweep = |more: &[&str]| {
        let arguments = ["sweep", "soil.ron", "--out", "out/soil_sweep"];
        outcome(folder.path(), &[&arguments, more].concat()).1
    };
    let stdout = sweep(&["--set", "height=1"]);
    assert!(stdout.contains("2 points run, 0 kept"), "{stdout}");
    // Points that share paths depend on each other; those of other geometry do not.
    let write = |values: &str| {
        let text = swept().replace("\"sza\": [0.0, 60.0]", values);
        fs::write(folder.path().join("soil.ron"), text).unwrap();
    };
    write("\"sza\": [60.0, 45.0]");
    let stdout = sweep(&["--set", "height=1"]);
    assert!(stdout.contains("2 points run, 0 kept"), "{stdout}");
    write("\"height\": [1.0, 2.0]");
    assert!(sweep(&[]).contains("2 points run, 0 kept"));
    write("\"height\": [2.0, 3.0]");
    let stdout = sweep(&["--threads", "1"]);
    assert!(stdout.contains("1 point run, 1 kept"), "{stdout}");
    // What `--set` gives is not varied.
    let stdout = sweep(&["--set", "height=3"]);
    assert!(stdout.contains("0 points run, 1 kept"), "{stdout}");
}

#[test]
fn geometry_that_a_sweep_changes_is_built_anew() {
    // The heights change fastest; points of one height run one after the other. A value that stands twice is one point.
    let text = swept().replace("60.0] })", "60.0], \"height\": [0.0, 2.0, 2.0] })");
    assert!(text.contains("height\": [0.0, 2.0"), "{text}");
    let folder = folder_with(&text);
    let (code, stdout, _) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert_eq!(code, 0);
    assert!(stdout.contains("4 points run, 0 kept; geometry built 2 times"), "{stdout}");
}

#[test]
fn a_sweep_that_is_wrong_somewhere_runs_nowhere() {
    let folder = folder_with(&swept().replace("60.0]", "60.0, 95.0]"));
    let (code, _, stderr) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert_eq!(code, 1);
    assert!(stderr.starts_with("error: at sza=95: expected an angle"), "{stderr}");
    assert_eq!(names(folder.path()), ["soil.ron"]);
    let folder = folder_with(SOIL);
    let (code, _, stderr) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert_eq!(code, 1);
    assert!(stderr.starts_with("error: soil.ron has no `sweep`: write, for example"), "{stderr}");
    let folder = folder_with(&swept().replace("\"=sza\"", "30.0"));
    let (code, _, stderr) = outcome(folder.path(), &["sweep", "soil.ron"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("no formula uses the parameter `sza`"), "{stderr}");
}

#[test]
fn fmt_changes_what_is_not_in_normal_form_and_check_says_so() {
    let folder = folder_with("Scene(format:1, // one\n)");
    let (code, stdout, stderr) = outcome(folder.path(), &["fmt", "--check", "soil.ron"]);
    assert_eq!((code, stdout.as_str()), (1, "soil.ron\n"));
    assert_eq!(stderr, "error: not formatted: run `sunfleck fmt` on these files\n");
    let (code, stdout, stderr) = outcome(folder.path(), &["fmt", "soil.ron"]);
    assert_eq!((code, stdout.as_str(), stderr.as_str()), (0, "soil.ron\n", ""));
    let text = fs::read_to_string(folder.path().join("soil.ron")).unwrap();
    assert_eq!(text, "Scene(\n    format: 1, // one\n)\n");
    let (code, stdout, stderr) = outcome(folder.path(), &["fmt", "--check", "soil.ron"]);
    assert_eq!((code, stdout.as_str(), stderr.as_str()), (0, "", ""));
    assert_eq!(names(folder.path()), ["soil.ron"]);
    fs::write(folder.path().join("soil.ron"), "Scene(format: 1").unwrap();
    let (code, _, stderr) = outcome(folder.path(), &["fmt", "soil.ron"]);
    assert_eq!(code, 1);
    assert!(stderr.contains("is closed"), "{stderr}");
    assert_eq!(fs::read_to_string(folder.path().join("soil.ron")).unwrap(), "Scene(format: 1");
}

#[test]
fn verify_says_what_it_measured_and_whether_it_holds() {
    let folder = tempdir().unwrap();
    let arguments = ["verify", "--only", "energy", "--json"];
    let (code, stdout, stderr) = outcome(folder.path(), &arguments);
    assert_eq!((code, stderr.as_str()), (0, ""), "{stdout}");
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(report["passes"], true);
    let findings = report["checks"][0]["findings"].as_array().unwrap();
    assert!(findings.len() > 10 && findings.iter().all(|finding| finding["holds"] == true));
    let (code, stdout, _) = outcome(folder.path(), &["verify", "--only", "closed"]);
    assert_eq!(code, 0, "{stdout}");
    assert!(stdout.contains("pass slope: radiance under the sky"), "{stdout}");
    let (code, _, stderr) = outcome(folder.path(), &["verify", "--only", "truth"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("reciprocity") && stderr.contains("turbid"), "{stderr}");
    assert_eq!(names(folder.path()), Vec::<String>::new(), "it writes nothing");
}

#[test]
fn sensors_are_chosen_by_their_names() {
    let folder = folder_with(SOIL);
    let arguments = ["run", "soil.ron", "--sensor", "views", "--out", "views"];
    let (code, stdout, stderr) = outcome(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    assert!(stdout.contains("views") && !stdout.contains("top"), "{stdout}");
    let (code, _, stderr) = outcome(folder.path(), &["run", "soil.ron", "--sensor", "view"]);
    assert_eq!(code, 1);
    assert!(
        stderr.contains("no sensor `view`") && stderr.contains("did you mean `views`"),
        "{stderr}"
    );
}
