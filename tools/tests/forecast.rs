//! What a run says of itself before it takes it, and what it refuses.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use sunfleck::output;
use sunfleck::run::{Options, Unwatched, run_file};
use tempfile::{TempDir, tempdir};

/// Bare soil, seen by sensors of very different size.
const SOIL: &str = r#"Scene(
    format: 1,
    params: { "pixel": 2.5 },
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: { "soil": Lambertian(reflectance: Constant(0.3)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (zenith_deg: 30.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    sensors: {
        "views": Directions(views: List([(0.0, 0.0), (30.0, 90.0)]), until: Samples(4096)),
        "top": Orthographic(size_px: (500, 500), extent_m: (8.0, 6.0), samples_per_px: 2),
        "cells": Photons(per_m2: 20.0, measure: [BrfCells(10000), Fluxes(pixel_m: "=pixel")]),
    },
    sweep: Grid({ "pixel": [2.5, 0.02] }),
)"#;

fn folder_with(scene: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("soil.ron"), scene).unwrap();
    folder
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    // With more threads more results wait for their turn.
    command.current_dir(folder).args(arguments).env("RAYON_NUM_THREADS", "2");
    let output = command.output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_run_that_does_not_fit_is_refused_with_the_numbers() {
    let folder = folder_with(SOIL);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "soil.ron", "--memory", "16MiB"]);
    assert_eq!((code, stdout.as_str()), (1, ""));
    insta::assert_snapshot!(stderr);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing was written");
    let (code, _, stderr) = outcome(folder.path(), &["run", "soil.ron", "--memory", "20MB"]);
    assert_eq!(code, 2);
    assert!(stderr.contains("such as 4GiB"), "{stderr}");
}

/// The size that is advised is one that fits, and not much less than what does.
#[test]
fn what_is_advised_fits() {
    let folder = folder_with(SOIL);
    let limit = ["run", "soil.ron", "--memory", "16MiB"];
    let (_, _, stderr) = outcome(folder.path(), &limit);
    let advice = stderr.split("write `size_px: (").nth(1).unwrap();
    let pixels: u32 = advice.split(',').next().unwrap().parse().unwrap();
    let with = |pixels: u32| {
        let size = format!("({pixels}, {pixels})");
        let folder = folder_with(&SOIL.replace("(500, 500)", &size));
        outcome(folder.path(), &limit).0
    };
    assert_eq!((with(pixels), with(pixels + pixels / 20)), (0, 1), "{pixels} pixels");
}

#[test]
fn a_sweep_stops_at_the_point_that_does_not_fit() {
    let folder = folder_with(&SOIL.replace("(500, 500)", "(20, 20)"));
    let (code, _, stderr) = outcome(folder.path(), &["sweep", "soil.ron", "--memory", "16MiB"]);
    assert_eq!(code, 1);
    let message = "error: at pixel=0.02: films and results take";
    assert!(stderr.starts_with(message), "{stderr}");
    assert!(folder.path().join("out/soil_sweep/points/pixel=2.5/point.csv").is_file());
}

/// A part holds only what it traces; a checkpoint holds it twice.
#[test]
fn parts_and_checkpoints_are_counted_too() {
    let folder = folder_with(&SOIL.replace("(500, 500)", "(20, 20)"));
    let run = |more: &[&str]| outcome(folder.path(), &[&["run", "soil.ron"], more].concat());
    assert_eq!(run(&["--memory", "12MiB"]).0, 0);
    assert_eq!(run(&["--memory", "12MiB", "--checkpoint", "whole"]).0, 1);
    assert_eq!(run(&["--memory", "5MiB"]).0, 1);
    assert_eq!(run(&["--memory", "5MiB", "--checkpoint", "part", "--part", "3/16"]).0, 0);
}

#[test]
fn a_forecast_tells_time_memory_and_files_and_writes_nothing() {
    let folder = folder_with(SOIL);
    let (code, stdout, stderr) = outcome(folder.path(), &["run", "soil.ron", "--forecast"]);
    assert_eq!((code, stderr.as_str()), (0, ""));
    // Seconds depend on the machine.
    let timeless = |line: &str| {
        let (name, rest) = line.split_once(": ").expect("a name, then what it takes");
        format!("{name}: {}", rest.split_once(", ").unwrap().1)
    };
    let lines: Vec<String> = stdout.lines().map(timeless).collect();
    insta::assert_snapshot!(lines.join("\n"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing was written");
}

/// Files are within a quarter of what was foretold.
#[test]
fn files_are_as_large_as_was_foretold() {
    let scenes = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes"));
    for (scene, quality) in
        [("sensors.ron", 0.25), ("products.ron", 0.05), ("birch_stand.ron", 0.01)]
    {
        let options = Options { quality, ..Options::default() };
        let report = run_file(&scenes.join(scene), &options, &Unwatched).unwrap();
        let foretold: u64 = report.sensors.iter().map(|sensor| sensor.forecast.files).sum();
        let folder = tempdir().unwrap();
        let files = output::write(&report, folder.path()).unwrap();
        let found: u64 = files.iter().map(|file| fs::metadata(file).unwrap().len()).sum();
        let ratio = foretold as f64 / found as f64;
        assert!((0.75..1.25).contains(&ratio), "{scene}: {foretold} for {found}, {ratio}");
    }
}
