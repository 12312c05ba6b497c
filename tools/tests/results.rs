//! What a run leaves on the disk, whatever was there before and whenever it ends. The inputs are those
//! of the field (`tests/field`, 36, 37 and 45) and neighbours of theirs.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::{TempDir, tempdir};

/// A copy of inputs of the field, in a folder of its own.
struct Place(TempDir);

impl Place {
    fn of(case: &str) -> Self {
        let place = Self(tempdir().unwrap());
        let from = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/field")).join(case);
        copy(&from, place.0.path());
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
        command.args(arguments.split(' ')).current_dir(self.0.path());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs, which must succeed; returns what it prints.
    fn done(&self, arguments: &str) -> String {
        let out = self.run(arguments);
        assert!(out.status.success(), "{arguments}: {}", String::from_utf8_lossy(&out.stderr));
        String::from_utf8(out.stdout).unwrap()
    }

    /// Runs, which must fail; returns what it says.
    fn refused(&self, arguments: &str) -> String {
        let out = self.run(arguments);
        assert_eq!(out.status.code(), Some(1), "{arguments}");
        String::from_utf8(out.stderr).unwrap()
    }

    fn names(&self, folder: &str) -> Vec<String> {
        names(&self.path(folder))
    }

    fn summary(&self, folder: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(folder).join("summary.json")).unwrap()).unwrap()
    }
}

fn copy(from: &Path, to: &Path) {
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let to = to.join(entry.file_name());
        if entry.path().is_dir() {
            fs::create_dir(&to).unwrap();
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Names of the files of an image.
fn image(stem: &str) -> Vec<String> {
    [".exr", ".img", ".img.hdr", ".pixels.png", ".png", "_se.img", "_se.img.hdr"]
        .map(|ending| format!("{stem}{ending}"))
        .to_vec()
}

#[test]
fn sensors_that_are_gone_leave_no_files_and_other_files_stay() {
    let place = Place::of("36-output-folder");
    place.done("run stale_first.ron --out o");
    fs::rename(place.path("stale.ron"), place.path("stale_first.ron")).unwrap();
    fs::write(place.path("o/notes.txt"), "mine").unwrap();
    fs::write(place.path("o/keep_brf.img.aux.xml"), "of another program").unwrap();
    place.done("run stale_first.ron --out o");
    let mut expected = image("keep_brf");
    expected.extend(["keep_brf.img.aux.xml", "notes.txt", "summary.json"].map(str::to_owned));
    expected.sort();
    assert_eq!(place.names("o"), expected);
    assert_eq!(fs::read_to_string(place.path("o/notes.txt")).unwrap(), "mine");
}

#[test]
fn results_of_another_scene_are_not_replaced_without_a_word() {
    let place = Place::of("36-output-folder");
    place.done("run a/plot.ron");
    let before = fs::read(place.path("out/plot/summary.json")).unwrap();
    for command in
        ["run b/plot.ron", "run b/plot.ron --quality 0.5", "compare b/plot.ron --out out/plot"]
    {
        let text = place.refused(command);
        let start = "error: out/plot holds results of `sunfleck run` of ";
        assert!(
            text.starts_with(start) && text.contains("a/plot.ron: name another folder"),
            "{text}"
        );
        assert!(text.contains("--out") && text.contains("--force"), "{text}");
        assert_eq!(fs::read(place.path("out/plot/summary.json")).unwrap(), before);
        assert_eq!(place.names("out"), ["plot"]);
    }
    let text = place.done("run b/plot.ron --force");
    assert!(text.contains("out/plot held results of `sunfleck run` of "), "{text}");
    assert_eq!(place.summary("out/plot")["scene_file"], "../../b/plot.ron");
    // The same scene by another way is the same.
    let text = place.done("run ./a/../b/plot.ron");
    assert!(!text.contains("held"), "{text}");
    // So it is where the whole project was moved to.
    let moved = tempdir().unwrap();
    copy(place.0.path(), moved.path());
    let mut command = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
    assert!(
        command
            .args(["run", "b/plot.ron"])
            .current_dir(moved.path())
            .output()
            .unwrap()
            .status
            .success()
    );
}

#[test]
fn changed_parameters_have_folders_of_their_own_and_are_told() {
    let place = Place::of("36-output-folder");
    for r in ["0.2", "0.3"] {
        place.done(&format!("run par.ron --set r={r}"));
        let summary = place.summary(&format!("out/par_r={r}"));
        let value: f64 = r.parse().unwrap();
        assert_eq!(summary["params"], serde_json::json!({ "r": value }));
        assert_eq!(summary["set"], serde_json::json!({ "r": value }));
        assert_eq!(summary["variant"], Value::Null);
        assert_eq!(summary["scene_file"], "../../par.ron");
    }
    place.done("run par.ron");
    assert_eq!(place.summary("out/par")["params"], serde_json::json!({ "r": 0.1 }));
    assert_eq!(place.names("out"), ["par", "par_r=0.2", "par_r=0.3"]);
    // In a folder that was named, a word says what was there.
    place.done("run par.ron --set r=0.2 --out o");
    let text = place.done("run par.ron --set r=0.3 --out o");
    assert!(text.contains("8 files in o (o held results with r = 0.2): "), "{text}");
    let text = place.done("run par.ron --set r=0.3 --out o --quality 0.5");
    assert!(text.contains("(o held results with r = 0.3)"), "{text}");
    let text = place.done("run par.ron --set r=0.3 --out o --quality 0.5");
    assert!(text.contains("8 files in o: "), "{text}");
}

/// Neighbours: names of variants, and commands with folders of their own.
#[test]
fn variants_and_commands_have_folders_of_their_own() {
    let place = Place::of("36-output-folder");
    let text = fs::read_to_string(place.path("par.ron")).unwrap();
    let more =
        "variants: { \"dark\": { \"r\": 0.01 } }, sweep: Grid({ \"r\": [0.1, 0.4] }), sensors:";
    fs::write(place.path("near_variant.ron"), text.replace("sensors:", more)).unwrap();
    place.done("run near_variant.ron");
    place.done("run near_variant.ron --variant dark");
    place.done("run near_variant.ron --variant dark --set r=0.02");
    place.done("sweep near_variant.ron");
    place.done("compare near_variant.ron");
    let expected = [
        "near_variant",
        "near_variant_compare",
        "near_variant_dark",
        "near_variant_dark_r=0.02",
        "near_variant_sweep",
    ];
    assert_eq!(place.names("out"), expected);
    let summary = place.summary("out/near_variant_dark");
    assert_eq!(summary["variant"], "dark");
    assert_eq!(summary["params"], serde_json::json!({ "r": 0.01 }));
    for (folder, command) in [("near_variant_sweep", "sweep"), ("near_variant_compare", "compare")]
    {
        assert_eq!(place.summary(&format!("out/{folder}"))["command"], command);
    }
    let text = place.refused("run near_variant.ron --out out/near_variant_sweep");
    assert!(text.contains("holds results of `sunfleck sweep` of "), "{text}");
}

/// Neighbours: what is in the way of results, and results that nobody knows.
#[test]
fn what_is_none_of_ours_stays_and_results_are_not_lost_for_it() {
    let place = Place::of("36-output-folder");
    fs::create_dir_all(place.path("o/k_brf.exr")).unwrap();
    fs::write(place.path("o/summary.json"), "[\"of another program\"]").unwrap();
    let text = place.done("run a/plot.ron --out o");
    assert!(text.contains("8 files in o_2: "), "{text}");
    assert_eq!(place.names("o"), ["k_brf.exr", "summary.json"]);
    assert!(place.path("o_2/summary.json").is_file());
    // A folder of a person's own work, which is the working folder too.
    fs::write(place.path("k_brf.csv"), "mine").unwrap();
    let before = place.names("");
    place.done("run par.ron --out .");
    let mut after = place.names("");
    after.retain(|name| !before.contains(name));
    let mut expected = image("k_brf");
    expected.push("summary.json".to_owned());
    assert_eq!(after, expected);
    place.done("run par.ron --out .");
    assert_eq!(fs::read_to_string(place.path("k_brf.csv")).unwrap(), "mine");
}

#[test]
fn names_that_become_the_same_are_told_apart() {
    let place = Place::of("36-output-folder");
    place.done("run collide.ron");
    let mut expected: Vec<String> =
        ["n_1_brf", "n_1_brf_2", "n_1_brf_3"].iter().flat_map(|stem| image(stem)).collect();
    expected.push("summary.json".to_owned());
    expected.sort();
    assert_eq!(place.names("out/collide"), expected);
}

/// Rows of a table without its comments.
fn table(path: &Path) -> Vec<Vec<String>> {
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).has_headers(false).from_path(path).unwrap();
    // A row with another number of cells than the first is an error of the reader.
    reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn every_row_has_as_many_cells_as_the_header() {
    let place = Place::of("45-csv-output-names");
    place.done("run n.ron --out o");
    let rows = table(&place.path("o/v_brf.csv"));
    assert_eq!(rows[0][..4], ["zenith_deg", "azimuth_deg", "signed_zenith_deg", "nir, 865 nm"]);
    let column = |at: usize| rows[1..].iter().map(|row| row[at].clone()).collect::<Vec<_>>();
    assert_eq!(column(2), ["-30.0", "-15.0", "0.0", "15.0", "30.0"], "through the nadir");
    let rows = table(&place.path("o/alb_absorbed_by_instance.csv"));
    assert_eq!(rows[2][0], "tree, \"old\" #1[0]");
    // Neighbours: names that a spreadsheet would reckon with, and that a comment starts with.
    let text = fs::read_to_string(place.path("n.ron")).unwrap();
    let text = text.replace("nir, 865 nm", "-1+1").replace("tree, \\\"old\\\" #1", "#@tree");
    let text = text.replace("format: 1,", "format: 1, title: \"x, =HYPERLINK()\", params: { \"sza\": 0.0 }, sweep: Grid({ \"sza\": [0.0, 60.0] }),");
    let text = text.replace("zenith_deg: 0.0", "zenith_deg: \"=sza\"");
    fs::write(place.path("near_formula.ron"), text).unwrap();
    place.done("run near_formula.ron --out f");
    place.done("sweep near_formula.ron --out s");
    place.done("compare near_formula.ron --out c --sensor v");
    let files = ["f/v_brf.csv", "f/alb_absorbed_by_instance.csv", "s/sweep.csv", "c/compare.csv"];
    for file in files {
        for row in table(&place.path(file)) {
            for cell in row {
                let is_number = cell.parse::<f64>().is_ok();
                assert!(is_number || !cell.starts_with(['=', '+', '-', '@']), "{file}: {cell}");
            }
        }
        assert!(!fs::read_to_string(place.path(file)).unwrap().contains(", ="), "{file}");
    }
    let rows = table(&place.path("s/sweep.csv"));
    let expected = "sza,sensor,product,unit,zenith_deg,azimuth_deg,signed_zenith_deg,instance,x_m,y_m,z_m,term,band,value,standard_error";
    assert_eq!(rows[0].join(","), expected);
    let terms = table(&place.path("f/alb_energy.csv")).len() - 1;
    assert_eq!(rows.len(), 1 + 2 * (5 + 2 + terms) * 2);
}

/// Starts a run that takes minutes.
fn long(place: &Place) -> Child {
    place.command("run long.ron --out new/o").spawn().unwrap()
}

#[cfg(unix)]
fn send(child: &Child, signal: &str) {
    let pid = child.id().to_string();
    assert!(Command::new("kill").args([signal, &pid]).status().unwrap().success());
}

/// *Expected*: what was traced is in a checkpoint, unless the signal came before the first block of samples.
#[cfg(unix)]
#[test]
fn a_signal_ends_a_run_with_its_exit_code_and_leaves_a_checkpoint_at_most() {
    let place = Place::of("37-run-failures");
    let before = place.names("");
    for (signal, code) in [("-INT", 130), ("-TERM", 143), ("-HUP", 129)] {
        let mut child = long(&place);
        thread::sleep(Duration::from_millis(700));
        send(&child, signal);
        let start = Instant::now();
        assert_eq!(child.wait().unwrap().code(), Some(code));
        assert!(start.elapsed() < Duration::from_secs(20), "at once");
        if place.path("new").exists() {
            assert_eq!(place.names("new"), ["o.checkpoint"]);
            fs::remove_dir_all(place.path("new")).unwrap();
        }
        assert_eq!(place.names(""), before);
    }
}

/// *Expected*: at whatever moment of writing it comes, nothing of the run is left.
#[cfg(unix)]
#[test]
fn a_signal_while_files_are_written_takes_them_away() {
    let place = Place::of("37-run-failures");
    let time = Instant::now();
    place.done("run big.ron --out o");
    let time = time.elapsed();
    let mut old = contents(&place.path("o"));
    for moment in 0..12 {
        let mut child = place.command("run big.ron --out o").spawn().unwrap();
        thread::sleep(time.mul_f64(f64::from(moment) / 11.0));
        let code = {
            send(&child, "-TERM");
            child.wait().unwrap().code()
        };
        // At the first moment the program may not yet handle signals: then it has written nothing.
        let is_early = moment == 0 && code.is_none();
        assert!(is_early || code == Some(143) || code == Some(0), "{moment}: {code:?}");
        assert_eq!(place.names(""), ["big.ron", "long.ron", "mid.ron", "o"]);
        let now = contents(&place.path("o"));
        assert!(code == Some(0) || now == old || now.len() == old.len());
        old = now;
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_results_that_were_there() {
    let place = Place::of("37-run-failures");
    place.done("run big.ron --out o");
    let before = contents(&place.path("o"));
    let limited = |arguments: &str| {
        let line = format!("ulimit -f 64; exec {} {arguments}", env!("CARGO_BIN_EXE_sunfleck"));
        let mut shell = Command::new("sh");
        shell.args(["-c", &line]).current_dir(place.0.path()).output().unwrap()
    };
    for folder in ["o", "fresh/o"] {
        let out = limited(&format!("run big.ron --out {folder}"));
        assert_eq!(out.status.code(), Some(1), "{out:?}");
        let text = String::from_utf8(out.stderr).unwrap();
        assert!(
            text.contains(&format!("error: cannot write {folder}/img_brf."))
                && text.contains(": File too large"),
            "{text}"
        );
        assert_eq!(place.names(""), ["big.ron", "long.ron", "mid.ron", "o"]);
        assert!(contents(&place.path("o")) == before);
    }
}

/// All files of a folder.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    names(folder)
        .into_iter()
        .map(|name| (name.clone(), fs::read(folder.join(name)).unwrap()))
        .collect()
}

/// Whose results a folder holds, which must be those of one run alone.
fn whole(folder: &Path) -> String {
    let files = contents(folder);
    let summary: Value = serde_json::from_slice(&files["summary.json"]).unwrap();
    let mut listed: Vec<&str> =
        summary["files"].as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect();
    listed.sort_unstable();
    let others = ["notes.txt"];
    let found: Vec<&str> =
        files.keys().map(String::as_str).filter(|name| !others.contains(name)).collect();
    assert_eq!(found, listed, "{}", folder.display());
    assert!(files.contains_key("notes.txt"), "a file that is no result");
    let hash = summary["hash"].as_str().unwrap().to_owned();
    for (name, bytes) in &files {
        let holds = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
        let ending = Path::new(name).extension().and_then(|ending| ending.to_str());
        if matches!(ending, Some("exr" | "hdr" | "csv")) {
            assert!(holds(&hash), "{name} is of another run");
        }
    }
    hash
}

/// *Scene*: a run that replaces results with others of other sensors, killed at a random moment, again
/// and again. *Expected*: the folder holds the old results or the new ones. `SUNFLECK_KILLS` says how
/// often.
#[test]
fn a_killed_run_leaves_old_results_or_new_ones() {
    let kills =
        std::env::var("SUNFLECK_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(12);
    let place = Place::of("37-run-failures");
    let big = fs::read_to_string(place.path("big.ron")).unwrap();
    let scenes = [
        big.clone(),
        big.replace("\"img\": Ortho", "\"other\": Ortho")
            .replace("Constant(0.5)", "Constant(0.25)"),
    ];
    let write = |turn: usize| fs::write(place.path("big.ron"), &scenes[turn % 2]).unwrap();
    let mut times = Vec::new();
    let hashes = [0, 1].map(|turn| {
        write(turn);
        let start = Instant::now();
        place.done("run big.ron --out o");
        times.push(start.elapsed());
        fs::write(place.path("o/notes.txt"), "mine").unwrap();
        whole(&place.path("o"))
    });
    assert_ne!(hashes[0], hashes[1]);
    let longest = times[1].mul_f64(1.2);
    let (mut random, mut seen) = (0x2545_f491_4f6c_dd1d_u64, [0, 0]);
    let mut now = hashes[1].clone();
    for turn in 0..kills {
        let next = usize::from(now == hashes[0]);
        write(next);
        let mut child = place.command("run big.ron --out o").spawn().unwrap();
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        thread::sleep(longest.mul_f64((random >> 11) as f64 / (1_u64 << 53) as f64));
        child.kill().unwrap();
        child.wait().unwrap();
        let left = whole(&place.path("o"));
        assert!(left == now || left == hashes[next], "turn {turn}");
        seen[usize::from(left == hashes[next])] += 1;
        now = left;
    }
    // What killed runs have left is gone after one that ends.
    place.done("run big.ron --out o");
    whole(&place.path("o"));
    assert_eq!(place.names(""), ["big.ron", "long.ron", "mid.ron", "o"]);
    assert!(kills < 50 || seen.iter().all(|&count| count > 0), "old and new: {seen:?}");
}

#[test]
fn runs_side_by_side_leave_the_results_of_one() {
    let place = Place::of("37-run-failures");
    place.done("run big.ron --out o");
    fs::write(place.path("o/notes.txt"), "mine").unwrap();
    let children: Vec<Child> =
        (0..3).map(|_| place.command("run big.ron --out o").spawn().unwrap()).collect();
    for child in children {
        let out = child.wait_with_output().unwrap();
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    }
    whole(&place.path("o"));
    assert_eq!(place.names(""), ["big.ron", "long.ron", "mid.ron", "o"]);
}

/// *Scene*: every product that there is. *Expected*: as many values as the lengths of the axes say, and
/// tables with one column an axis and coordinate.
#[test]
fn axes_have_the_shape_of_the_values() {
    let place = Place(tempdir().unwrap());
    let scenes = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes"));
    let mut products = 0;
    for name in ["products.ron", "sensors.ron"] {
        let scene = scenes.join(name);
        place.done(&format!("run {} --quality 0.005 --out {name}", scene.display()));
        let summary = place.summary(name);
        let sensors = summary["sensors"].as_object().unwrap();
        for (sensor, product) in sensors.values().flat_map(|s| s.as_object().unwrap()) {
            let count = |list: &Value| list.as_array().unwrap().len();
            let axes = product["axes"].as_object().unwrap();
            let values: usize = axes.values().map(count).product();
            assert_eq!(values, count(&product["values"]), "{sensor}");
            assert_eq!(values, count(&product["standard_error"]), "{sensor}");
            assert_eq!(axes.len(), count(&product["shape"]), "{sensor}");
            let mut columns: Vec<&String> = axes.keys().filter(|name| *name != "band").collect();
            for (axis, others) in product["coordinates"].as_object().into_iter().flatten() {
                for (name, points) in others.as_object().unwrap() {
                    assert_eq!(count(points), count(&axes[axis]), "{sensor}: {name}");
                    columns.push(name);
                }
            }
            let files = product["files"].as_array().unwrap();
            for file in files.iter().map(|file| file.as_str().unwrap()) {
                let path = place.path(name).join(file);
                if path.extension().is_some_and(|ending| ending == "csv") {
                    let rows = table(&path);
                    for column in &columns {
                        // The last axis of some products is the columns themselves.
                        let first = axes.get(*column).and_then(|axis| axis[0].as_str());
                        let is_across =
                            first.is_some_and(|label| rows[0].iter().any(|name| name == label));
                        assert!(rows[0].contains(column) || is_across, "{file}: no {column}");
                    }
                }
            }
            products += 1;
        }
    }
    assert!(products > 20, "{products}");
}
