//! Manners on the terminal: progress for people and programs, signals, scenes that are listed, new scenes, help for shells.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::{TempDir, tempdir};

/// A scene of two sensors that takes several seconds. Each of its blocks of samples takes much less.
const SCENE: &str = r#"Scene(
    format: 1,
    title: "Two sensors",
    params: { "packets": 200000 },
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: {
        "soil": Lambertian(reflectance: Bands([0.1, 0.3])),
        "leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
    },
    meshes: { "tree": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 12.0,
        leaf: Rhombus(length_m: 0.1, width_m: 0.07), leaf_material: "leaf",
    ) },
    terrain: Plane(size_m: (5.0, 5.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)])],
    sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    sensors: {
        "image": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), samples_per_px: 8),
        "light": Photons(until: Samples("=packets"), measure: [Albedo]),
    },
)"#;

fn folder_with(scene: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("two.ron"), scene).unwrap();
    folder
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
    command.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    told(&command(folder, arguments).output().unwrap())
}

/// Exit code, stdout and stderr.
fn told(output: &Output) -> (i32, String, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

/// Values and errors of a run's products.
fn values(folder: &Path) -> Value {
    let text = fs::read_to_string(folder.join("summary.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()["sensors"].clone()
}

/// *Expected*: a signal ends the run within seconds with the signal's exit code and a checkpoint; the command that the
/// message names ends with the values of a run that no signal has met.
#[cfg(unix)]
#[test]
fn a_run_that_a_signal_ends_is_resumed_by_the_command_that_it_names() {
    let folder = folder_with(SCENE);
    let packets = "packets=60000000";
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let arguments = ["run", "two.ron", "--set", packets, "--out", "o", "--json"];
        let mut child = command(folder.path(), &arguments).spawn().unwrap();
        let lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut light = lines.map_while(Result::ok).filter(|line| line.contains("\"light\""));
        // The first line comes before the first block of samples is done.
        assert!(light.nth(3).is_some());
        let pid = child.id().to_string();
        assert!(Command::new("kill").args([signal, &pid]).status().unwrap().success());
        let start = Instant::now();
        // Else the pipe fills up.
        let events = light.count();
        let (found, _, stderr) = told(&child.wait_with_output().unwrap());
        assert!(start.elapsed() < Duration::from_secs(20), "{events}");
        assert_eq!(found, code, "{stderr}");
        let resume =
            "sunfleck run two.ron --set packets=60000000 --out o --json --checkpoint o.checkpoint";
        assert!(
            stderr.contains("cancelled at sensor `light`") && stderr.contains(resume),
            "{stderr}"
        );
        assert!(!folder.path().join("o").exists() && folder.path().join("o.checkpoint").exists());
    }
    // With fewer packets the checkpoint already holds too many: what follows needs one of its own.
    fs::remove_file(folder.path().join("o.checkpoint")).unwrap();
    let fewer = ["run", "two.ron", "--set", "packets=3000000", "--out", "o"];
    let child = command(folder.path(), &fewer).spawn().unwrap();
    let wait = Instant::now();
    thread::sleep(Duration::from_millis(1500));
    let pid = child.id().to_string();
    let was_sent = Command::new("kill").args(["-INT", &pid]).status().unwrap().success();
    let (code, _, stderr) = told(&child.wait_with_output().unwrap());
    assert!(was_sent && wait.elapsed() < Duration::from_mins(1));
    if code == 130 && stderr.contains("resume with") {
        let arguments = [&fewer[..], &["--checkpoint", "o.checkpoint"]].concat();
        let (code, _, stderr) = outcome(folder.path(), &arguments);
        assert_eq!(code, 0, "{stderr}");
    }
    let whole = ["run", "two.ron", "--set", "packets=3000000", "--out", "whole"];
    assert_eq!(outcome(folder.path(), &whole).0, 0);
    assert_eq!(values(&folder.path().join("o")), values(&folder.path().join("whole")));
}

#[test]
fn with_json_each_line_is_an_event_and_nothing_else_is_printed() {
    let folder = folder_with(SCENE);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "two.ron", "--json"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    let events: Vec<Value> =
        stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |event: &str| events.iter().filter(|one| one["event"] == event).collect::<Vec<_>>();
    let stages: Vec<&Value> = of("stage").into_iter().map(|event| &event["stage"]).collect();
    assert_eq!(stages, ["reading the scene", "loading", "building", "tracing"]);
    let ends = of("sensor").into_iter().filter(|event| event["done"] == 1.0);
    assert_eq!(ends.map(|event| &event["sensor"]).collect::<Vec<_>>(), ["image", "light"]);
    assert!(of("sensor").iter().any(|event| event["rays_per_second"].as_f64() > Some(0.0)));
    assert_eq!(events.last().unwrap()["event"], "written");
    assert_eq!(events.last().unwrap()["folder"], "out/two");

    let (code, stdout, stderr) = outcome(folder.path(), &["run", "none.ron", "--json"]);
    let event: Value = serde_json::from_str(stdout.lines().last().unwrap()).unwrap();
    assert_eq!((code, &event["event"]), (1, &Value::from("error")));
    assert_eq!(event["text"].as_str().unwrap(), stderr.trim_end(), "people read it on stderr");
}

#[test]
fn with_quiet_a_run_says_nothing_but_warnings() {
    let folder = folder_with(SCENE);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "two.ron", "--quiet"]);
    assert_eq!((code, stdout.as_str(), stderr.as_str()), (0, "", ""));
    let unused =
        SCENE.replace("\"soil\": ", "\"sand\": Lambertian(reflectance: Constant(0.2)), \"soil\": ");
    fs::write(folder.path().join("two.ron"), unused.replace("50.0, azimuth", "89.0, azimuth"))
        .unwrap();
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "two.ron", "--quiet", "--force"]);
    assert_eq!((code, stdout.as_str()), (0, ""), "{stderr}");
    assert!(stderr.lines().all(|line| line.starts_with("warning: ")), "{stderr}");
    assert_eq!(outcome(folder.path(), &["run", "two.ron", "--quiet", "--json"]).0, 2);
}

#[test]
fn a_command_without_a_scene_lists_those_that_are_here() {
    let folder = folder_with(SCENE);
    fs::create_dir_all(folder.path().join("plots/old")).unwrap();
    fs::write(folder.path().join("plots/old/a.ron"), format!("// An old one.\n\n{SCENE}")).unwrap();
    fs::write(folder.path().join("plots/lib.ron"), "Library(materials: {})").unwrap();
    fs::write(folder.path().join("plots/broken.ron"), "Scene(format: 1").unwrap();
    for command in ["run", "check", "sweep"] {
        let (code, stdout, stderr) = outcome(folder.path(), &[command]);
        assert_eq!((code, stdout.as_str()), (2, ""));
        let expected = "\nScenes here:\n  two.ron           Two sensors\n  \
                        plots/broken.ron  (has errors: `sunfleck check` shows them)\n  \
                        plots/old/a.ron   Two sensors\n";
        assert!(stderr.contains("<SCENE>") && stderr.ends_with(expected), "{stderr}");
    }
    let empty = tempdir().unwrap();
    let (code, _, stderr) = outcome(empty.path(), &["run"]);
    assert_eq!(code, 2);
    assert!(stderr.ends_with("\nThere is no scene here; `sunfleck new stand` writes one.\n"));
}

#[test]
fn a_new_scene_is_formatted_and_runs_without_a_word() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let (code, stdout, stderr) = outcome(here, &["new", "my stand"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    assert!(stdout.contains("sunfleck check 'my stand.ron'"), "{stdout}");
    assert_eq!(outcome(here, &["fmt", "--check", "my stand.ron"]).0, 0);
    let (code, stdout, stderr) =
        outcome(here, &["run", "my stand.ron", "--quality", "0.05", "--quiet"]);
    assert_eq!((code, stderr.as_str()), (0, ""), "{stdout}");
    let (code, _, stderr) = outcome(here, &["new", "my stand.ron"]);
    assert_eq!((code, stderr.as_str()), (1, "error: my stand.ron exists: choose another name\n"));
    assert_eq!(outcome(here, &["new", "plots/b"]).0, 0);
    assert!(here.join("plots/b.ron").is_file());
    assert_eq!(outcome(here, &["new", ".."]).0, 1);
}

/// *Expected*: scripts that the shells accept (bash, where it is there), and a page for each command.
#[test]
fn shells_get_completions_and_pages() {
    let folder = tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (code, script, _) = outcome(folder.path(), &["completions", shell]);
        assert!(code == 0 && script.contains("respectrum") && script.contains("keep-coefficients"));
        if shell == "bash" {
            fs::write(folder.path().join("script"), script).unwrap();
            let mut bash = Command::new("bash");
            let checked = bash.args(["-n", "script"]).current_dir(folder.path()).status();
            assert!(checked.is_ok_and(|status| status.success()));
        }
    }
    let (code, page, _) = outcome(folder.path(), &["man"]);
    assert!(
        code == 0 && page.contains(".TH sunfleck 1") && page.contains("sunfleck\\-run"),
        "{page}"
    );
    assert_eq!(outcome(folder.path(), &["man", "--out", "pages"]).0, 0);
    let names = fs::read_dir(folder.path().join("pages")).unwrap();
    let names: Vec<_> = names.map(|entry| entry.unwrap().file_name()).collect();
    for name in ["sunfleck.1", "sunfleck-run.1", "sunfleck-sweep.1"] {
        assert!(names.iter().any(|found| found == name), "{names:?}");
    }
}
