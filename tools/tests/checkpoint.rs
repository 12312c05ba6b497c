//! Runs that are stopped, killed, gone on with, divided and united come out as one long run.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

/// Every kind of film: pixels, packets, views, and what is seen first.
const SCENE: &str = r#"Scene(
    format: 1,
    bands: [(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)],
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
        "image": Orthographic(size_px: (40, 33), extent_m: (5.0, 5.0), zenith_deg: 20.0, samples_per_px: 24, measure: [Brf, GapFraction], denoised: true),
        "film": Orthographic(size_px: (5, 4), extent_m: (5.0, 5.0), zenith_deg: 20.0, system: Forward, samples_per_px: 1500),
        "eye": Fisheye(size_px: (20, 20), position_m: (2.5, 2.5, 0.2), measure: [Radiance, GapFraction], samples_per_px: 37),
        "views": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), measure: [Brf, Orders, FourComponents], until: Samples(9000)),
        "photons": Photons(per_m2: 2000.0, measure: [Albedo, BrfCells(12), Fapar(layer_m: 1.0), Orders]),
    },
)"#;

/// A folder with the scene in it, for one test.
struct Place(PathBuf);

impl Place {
    fn new(name: &str, scene: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("sunfleck-{name}-{}", std::process::id()));
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).expect("a folder");
        fs::write(folder.join("scene.ron"), scene).expect("a scene");
        Self(folder)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
        command.args(arguments).current_dir(&self.0);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("sunfleck starts")
    }

    /// Runs, which must succeed, and returns what was measured.
    fn summary(&self, arguments: &[&str]) -> String {
        let out = self.run(&[arguments, &["--out", "out"]].concat());
        assert!(out.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&out.stderr));
        let text = fs::read_to_string(self.0.join("out/summary.json")).expect("a summary");
        // What the clock tells differs.
        let timed =
            ["\"seconds\"", "\"stages\"", "\"read\"", "\"spawn\"", "\"build\"", "\"trace\""];
        let lines = text.lines().filter(|line| !timed.iter().any(|key| line.contains(key)));
        lines.collect::<Vec<_>>().join("\n")
    }

    /// Runs, which must fail, and returns what it says.
    fn error(&self, arguments: &[&str]) -> String {
        let out = self.run(arguments);
        assert_eq!(out.status.code(), Some(1), "{arguments:?}");
        String::from_utf8_lossy(&out.stderr).into_owned()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

fn same(found: &str, expected: &str, what: &str) {
    let differs = found.lines().zip(expected.lines()).find(|(a, b)| a != b);
    assert!(found == expected, "{what}: {differs:?}");
}

/// *Expected*: a finished run with a larger quality adds samples, with any number of threads; so do
/// parts that are united, and parts that were gone on with.
#[test]
fn samples_are_added_and_parts_united_bit_by_bit() {
    let place = Place::new("grow", SCENE);
    let half = place.summary(&["run", "scene.ron", "--quality", "0.5"]);
    let whole = place.summary(&["run", "scene.ron"]);
    assert_ne!(half, whole);
    let kept = |quality: &str, threads: &str| {
        place.summary(&[
            "run",
            "scene.ron",
            "--quality",
            quality,
            "--checkpoint",
            "c",
            "--threads",
            threads,
        ])
    };
    same(&kept("0.13", "2"), &place.summary(&["run", "scene.ron", "--quality", "0.13"]), "first");
    same(&kept("0.5", "1"), &half, "gone on with");
    same(&kept("1", "3"), &whole, "and again");
    same(&kept("1", "2"), &whole, "with nothing to add");
    for (quality, expected) in [("0.5", &half), ("1", &whole)] {
        for part in ["1/3", "2/3", "3/3"] {
            let file = format!("part{}", &part[..1]);
            let out = place.run(&[
                "run",
                "scene.ron",
                "--quality",
                quality,
                "--part",
                part,
                "--checkpoint",
                &file,
            ]);
            assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        }
        let merged =
            place.summary(&["merge", "scene.ron", "part3", "part1", "part2", "--quality", quality]);
        same(&merged, expected, "united");
    }
}

/// *Expected*: a run that is told to reach an accuracy ends at the same number of samples, and with
/// the same bits, whether or not it was stopped at a lower one before.
#[test]
fn an_accuracy_is_reached_at_the_same_place() {
    let scene = SCENE
        .replace("samples_per_px: 24", "until: RelError(0.2)")
        .replace("until: Samples(9000)", "until: [Samples(1000000), RelErrors({ \"brf\": 0.01 })]")
        .replace("per_m2: 2000.0", "until: RelError(0.05)");
    let place = Place::new("accuracy", &scene);
    let whole = place.summary(&["run", "scene.ron"]);
    for quality in ["0.2", "0.6"] {
        place.summary(&["run", "scene.ron", "--quality", quality, "--checkpoint", "c"]);
    }
    same(&place.summary(&["run", "scene.ron", "--checkpoint", "c"]), &whole, "accuracy");
}

/// *Expected*: after a kill at any moment the file is not there or is whole, and the run that goes on
/// with it ends as one that was never stopped.
#[test]
fn a_killed_run_is_gone_on_with() {
    let place = Place::new("kill", SCENE);
    let whole = place.summary(&["run", "scene.ron"]);
    let arguments = ["run", "scene.ron", "--checkpoint", "c", "--every", "0.01", "--out", "out"];
    let mut sizes = Vec::new();
    for moment in 0..10_u64 {
        let mut child = place.command(&arguments).spawn().expect("sunfleck starts");
        thread::sleep(Duration::from_millis(60 + 97 * moment * moment % 340));
        child.kill().expect("it is there");
        child.wait().expect("it ends");
        let Ok(left) = fs::metadata(place.path("c")) else { continue };
        sizes.push(left.len());
        // Whatever there is can be read: a copy with nothing more to trace says so.
        fs::copy(place.path("c"), place.path("copy")).expect("a copy");
        place.summary(&["run", "scene.ron", "--quality", "0.0001", "--checkpoint", "copy"]);
    }
    assert!(!sizes.is_empty(), "no checkpoint was ever written");
    same(&place.summary(&arguments[..4]), &whole, "after kills");
}

/// *Expected*: one error, and the file stays as it is.
#[test]
fn a_damaged_file_is_an_error_and_stays() {
    let place = Place::new("damage", SCENE);
    let go = ["run", "scene.ron", "--quality", "0.02", "--checkpoint", "c", "--out", "out"];
    assert!(place.run(&go).status.success());
    let good = fs::read(place.path("c")).expect("a file");
    let mut damaged: Vec<Vec<u8>> = [0, 1, 15, 16, 31, 32, 60, good.len() / 2, good.len() - 1]
        .map(|end| good[..end].to_vec())
        .into();
    for (number, byte) in
        [0, 17, 21, 30, 50, 70, 100, good.len() / 3, good.len() - 40, good.len() - 1]
            .into_iter()
            .enumerate()
    {
        let mut bad = good.clone();
        bad[byte] ^= 1 << (number % 8);
        damaged.push(bad);
    }
    damaged.push([good.as_slice(), &[0]].concat());
    for bad in damaged {
        fs::write(place.path("c"), &bad).expect("written");
        let text = place.error(&go);
        let is_clear = text.contains("is damaged") || text.contains("is no checkpoint of sunfleck");
        assert!(text.starts_with("error: c: ") && is_clear, "{text}");
        assert!(fs::read(place.path("c")).expect("a file") == bad, "it was written to");
    }
    fs::write(place.path("c"), &good).expect("written");
    assert!(place.run(&go).status.success());
}

/// *Expected*: each error says what is wrong with which file and what to do.
#[test]
fn what_does_not_fit_together_is_an_error() {
    let place = Place::new("misfit", SCENE);
    let go = |part: &'static str, file: &'static str| {
        vec!["run", "scene.ron", "--quality", "0.02", "--part", part, "--checkpoint", file]
    };
    for (part, file) in [("1/3", "a"), ("2/3", "b"), ("1/2", "other")] {
        assert!(place.run(&go(part, file)).status.success());
    }
    let merge = |files: &[&'static str]| {
        place.error(&[&["merge", "scene.ron", "--quality", "0.02", "--out", "out"], files].concat())
    };
    let expect = |text: &str, parts: &[&str]| {
        assert!(text.starts_with("error: "), "{text}");
        assert!(parts.iter().all(|part| text.contains(part)), "{parts:?} in {text}");
    };
    expect(&merge(&["a", "b"]), &["a: is one of 3, and part 3/3 is missing"]);
    expect(&merge(&["a", "a", "b"]), &["a: holds part 1/3, as a does"]);
    expect(&merge(&["a", "other"]), &["other: holds part 1/2, and a holds part 1/3"]);
    expect(&merge(&["a", "nothing"]), &["nothing: could not be read"]);
    expect(&place.error(&go("3/3", "b")), &["b: holds part 2/3, and part 3/3 is to be traced"]);
    let more =
        place.run(&["run", "scene.ron", "--quality", "0.1", "--part", "2/3", "--checkpoint", "b"]);
    assert!(more.status.success());
    expect(&merge(&["a", "b"]), &["b: has not traced as much as a"]);
    fs::write(place.path("scene.ron"), SCENE.replace("50.0", "51.0")).expect("a scene");
    expect(&place.error(&go("1/3", "a")), &["a: is of another scene"]);
    let open = SCENE.replace("until: Samples(9000)", "until: RelError(0.1)");
    fs::write(place.path("scene.ron"), open).expect("a scene");
    expect(
        &place.error(&go("1/3", "a")),
        &["sensors.views.until", "write `until: Samples(n)` alone"],
    );
    assert!(!Path::new("out").exists(), "no result was written");
}

/// *Expected*: parts that were traced with some sensors come out as a run with those, without naming them again.
#[test]
fn parts_of_some_sensors_are_united() {
    let place = Place::new("some", SCENE);
    let some = ["--quality", "0.02", "--sensor", "photons", "--sensor", "image"];
    let whole = place.summary(&[&["run", "scene.ron"], &some[..]].concat());
    for (part, file) in [("1/2", "a"), ("2/2", "b")] {
        let part = ["--part", part, "--checkpoint", file];
        let out = place.run(&[&["run", "scene.ron"], &some[..], &part[..]].concat());
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    }
    let united = place.summary(&["merge", "scene.ron", "a", "b", "--quality", "0.02", "--force"]);
    assert!(united.contains("photons") && !united.contains("\"views\""), "{united}");
    assert_eq!(united, whole);
    // Parts of other sensors are no parts of one run.
    let other = ["run", "scene.ron", "--quality", "0.02", "--sensor", "eye"];
    let out = place.run(&[&other[..], &["--part", "2/2", "--checkpoint", "c"]].concat());
    assert!(out.status.success());
    let error = place.error(&["merge", "scene.ron", "a", "c", "--out", "out"]);
    assert!(error.contains("c: is of another scene or of other sensors"), "{error}");
}

/// *Expected*: what cannot be a checkpoint is an error before anything is traced, and nothing of it is
/// read to an end that it may not have.
#[test]
fn a_checkpoint_that_cannot_be_is_an_error_at_once() {
    let place = Place::new("nowhere", SCENE);
    let go =
        |file: &str| place.error(&["run", "scene.ron", "--quality", "1000", "--checkpoint", file]);
    let text = go("nodir/c.traced");
    assert!(text.starts_with("error: nodir/c.traced: cannot be written: "), "{text}");
    assert!(text.contains("nodir") && text.contains("folder that exists"), "{text}");
    fs::create_dir(place.path("folder")).expect("a folder");
    fs::write(place.path("file"), "mine").expect("a file");
    let mut odd = vec![("folder", "is no regular file"), ("file", "is no checkpoint of sunfleck")];
    odd.push(("file/c", "cannot be written"));
    if cfg!(unix) {
        odd.extend([("/dev/full", "is no regular file"), ("/dev/zero", "is no regular file")]);
        let made = Command::new("mkfifo").arg(place.path("pipe")).status();
        if made.is_ok_and(|status| status.success()) {
            odd.push(("pipe", "is no regular file"));
            let text = place.error(&["merge", "scene.ron", "pipe"]);
            assert!(text.contains("pipe: is no regular file"), "{text}");
        }
    }
    for (file, what) in odd {
        let text = go(file);
        assert!(text.starts_with(&format!("error: {file}: ")) && text.contains(what), "{text}");
    }
    assert_eq!(fs::read_to_string(place.path("file")).expect("a text"), "mine");
    assert!(!place.path("out").exists());
}

/// *Expected*: results are written although the checkpoint cannot be any more; a part, of which the
/// checkpoint is all, fails.
#[test]
fn a_checkpoint_that_fails_later_does_not_cost_the_run() {
    let place = Place::new("later", SCENE);
    let whole = place.summary(&["run", "scene.ron"]);
    for (more, code) in [(&[][..], 0), (&["--part", "1/2"][..], 1)] {
        fs::create_dir(place.path("c")).expect("a folder");
        let file = ["--checkpoint", "c/c.traced", "--every", "0.01", "--out", "out"];
        let run = place.command(&[&["run", "scene.ron"], &file[..], more].concat()).spawn();
        let run = run.expect("sunfleck starts");
        while !place.path("c/c.traced").exists() {
            thread::sleep(Duration::from_millis(1));
        }
        while fs::remove_dir_all(place.path("c")).is_err() {
            thread::sleep(Duration::from_millis(1));
        }
        let out = run.wait_with_output().expect("it ends");
        let text = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(code), "{text}");
        let warning = "warning: cannot write the checkpoint c/c.traced: ";
        assert!(text.contains(warning) && text.contains("the run goes on"), "{text}");
        assert!(!text.contains("not lost"), "{text}");
        if code == 0 {
            let text = fs::read_to_string(place.path("out/summary.json")).expect("a summary");
            assert!(text.contains("cannot write the checkpoint"), "it is in the summary too");
            let values = |text: &str| -> Vec<String> {
                text.lines().filter(|line| line.contains("\"values\"")).map(str::to_owned).collect()
            };
            assert_eq!(values(&text), values(&whole), "all results");
        } else {
            assert!(
                text.contains("error: c/c.traced: could not be written, and what was traced"),
                "{text}"
            );
        }
    }
}

/// *Expected*: a number of threads that no machine has is an error with the largest one.
#[test]
fn threads_are_limited() {
    let place = Place::new("threads", SCENE);
    let text = place.error(&["run", "scene.ron", "--threads", "1000000"]);
    assert!(text.starts_with("error: could not start 1000000 threads: give 1 to "), "{text}");
    assert!(!place.path("out").exists());
}
