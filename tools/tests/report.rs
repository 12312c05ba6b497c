//! `sunfleck report` from outside.

#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test that cannot go on has failed; a skipped one says why"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// Exit code of the script where a module is missing.
const MISSING: i32 = 77;

/// Title that would run as a script, end an attribute, and turn the direction of writing.
const HOSTILE: &str = "<script>alert(1)</script> & \\\"quote' \u{202e}turned";

/// Leaves above soil, with sensors of all kinds.
fn scene(title: &str) -> String {
    let long = "x".repeat(10_000);
    format!(
        r#"Scene(
    format: 1,
    title: "{title}",
    params: {{ "sza": 40.0, "soil": 0.1, "name": "{long}" }},
    bands: [(name: "red", center_nm: 660.0), (name: "<nir>", center_nm: 865.0)],
    materials: {{
        "soil": Lambertian(reflectance: Bands(["=soil", 0.3])),
        "leaf & <b>": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45])),
    }},
    meshes: {{ "tree": Crown(
        shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 6.0,
        leaf: Square(side_m: 0.1), leaf_material: "leaf & <b>",
    ) }},
    terrain: Plane(size_m: (4.0, 4.0), material: "soil"),
    instances: [List(of: "tree", at_m: [(1.2, 2.0, 0.0)])],
    sun: (zenith_deg: "=sza", azimuth_deg: 10.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    sensors: {{
        "top \"<i>": Orthographic(size_px: (8, 8), extent_m: (4.0, 4.0), samples_per_px: 4),
        "plane": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 15.0), until: Samples(64)),
        "hemi": Photons(per_m2: 50.0, measure: [BrfCells(40), Albedo, Fapar(layer_m: 1.0)]),
    }},
    sweep: Grid({{ "sza": [20.0, 40.0, 60.0], "soil": [0.1, 0.3] }}),
)"#
    )
}

fn folder(title: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("leaves.ron"), scene(title)).unwrap();
    folder
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, line: &[&str]) -> (i32, String, String) {
    let output =
        Command::cargo_bin("sunfleck").unwrap().current_dir(folder).args(line).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn succeeds(folder: &Path, line: &[&str]) -> String {
    let (code, out, err) = outcome(folder, line);
    assert_eq!(code, 0, "{line:?}: {err}");
    out
}

fn fails(folder: &Path, line: &[&str]) -> String {
    let (code, _, err) = outcome(folder, line);
    assert_eq!(code, 1, "{line:?}: {err}");
    err.trim_end().to_owned()
}

/// The page of a run of leaves.
fn page_of_a_run(folder: &Path) -> String {
    succeeds(folder, &["run", "leaves.ron", "--out", "out"]);
    let said = succeeds(folder, &["report", "out"]);
    assert!(said.starts_with("out/report.html: "), "{said}");
    fs::read_to_string(folder.join("out/report.html")).unwrap()
}

/// *Scene*: names with marks of HTML, and one of 10 kB. *Expected*: all of them as text, no mark of theirs, and a page
/// that asks nothing of a network.
#[test]
fn names_of_the_author_are_text_and_no_part_of_the_page() {
    let folder = folder(HOSTILE);
    let page = page_of_a_run(folder.path());
    assert!(
        page.contains("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;quote' \u{fffd}turned")
    );
    assert!(page.contains("leaf &amp; &lt;b&gt;") && page.contains("&lt;nir&gt;"));
    for mark in ["<script>", "<nir>", "<b>", "<i>", "\u{202e}"] {
        assert!(!page.contains(mark), "{mark}");
    }
    assert!(!page.contains(&"x".repeat(500)));
    assert!(!page.contains("http:") && !page.contains("https:"), "no address of a network");
    assert_eq!(page.matches("<script").count(), 1);
}

/// *Expected*: a section for each subject, values with their errors, a figure for each product that has one, and links to
/// files that are there.
#[test]
fn a_run_is_told_with_figures_values_and_files() {
    let folder = folder("Leaves");
    let page = page_of_a_run(folder.path());
    let results =
        page.split("<h2>Results</h2>").nth(1).unwrap().split("</section>").next().unwrap();
    let nadir = "<td><bdi>plane</bdi></td><td><bdi>BRF: nadir</bdi></td>";
    assert_eq!(results.matches(nadir).count(), 1, "{results}");
    for id in ["results", "figures", "pictures", "energy", "scene", "values", "work", "origin"] {
        assert!(page.contains(&format!("<section id=\"{id}\">")), "{id}");
        assert!(page.contains(&format!("href=\"#{id}\"")), "{id}");
    }
    for text in [
        "plane: BRF in the principal plane",
        "hot spot",
        ">sun</text>",
        ">BRF (–)</text>",
        ">red</text>",
        "hemi: BRF in cells by view direction",
        "hemi: fAPAR by layer",
        "hemi: energy balance",
        "leaf area index 0.375",
        "sunfleck rerun . --out again",
        "sunfleck run ../leaves.ron --out again",
        "data:image/png;base64,",
        "areas are",
    ] {
        assert!(page.to_lowercase().contains(&text.to_lowercase()), "{text}");
    }
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("out/summary.json")).unwrap())
            .unwrap();
    assert!(page.contains(summary["hash"].as_str().unwrap()));
    let links: Vec<&str> =
        page.split("href=\"./").skip(1).map(|rest| rest.split('"').next().unwrap()).collect();
    assert!(links.len() >= 5, "{links:?}");
    for link in links {
        assert!(folder.path().join("out").join(link).is_file(), "{link}");
    }
}

/// *Expected*: what repeats the results of other spectra is the command that made them, on the results of the run.
#[test]
fn other_spectra_are_repeated_from_the_run_whose_paths_they_share() {
    let folder = folder("Leaves");
    succeeds(folder.path(), &["run", "leaves.ron", "--keep-coefficients", "--out", "out"]);
    succeeds(folder.path(), &["respectrum", "out", "--set", "soil=0.2", "--out", "other"]);
    succeeds(folder.path(), &["report", "other"]);
    let page = fs::read_to_string(folder.path().join("other/report.html")).unwrap();
    assert!(page.contains("sunfleck respectrum RESULTS --set soil=0.2 --out again"));
    assert!(!page.contains("sunfleck rerun"));
}

/// *Expected*: the next run replaces results and takes the report with it, and leaves a page that is somebody else's.
#[test]
fn a_report_goes_with_its_results_and_other_pages_stay() {
    let folder = folder("Leaves");
    page_of_a_run(folder.path());
    let report = folder.path().join("out/report.html");
    succeeds(folder.path(), &["run", "leaves.ron", "--out", "out", "--sensor", "plane"]);
    assert!(!report.exists(), "the old report tells of results that are gone");
    fs::write(&report, "<html>my notes</html>").unwrap();
    succeeds(folder.path(), &["run", "leaves.ron", "--out", "out", "--sensor", "plane"]);
    assert_eq!(fs::read_to_string(&report).unwrap(), "<html>my notes</html>");
    let error = fails(folder.path(), &["report", "out"]);
    assert_eq!(
        error,
        "error: out/report.html is no report of sunfleck, and is not replaced: move it, or name another file with --out"
    );
    succeeds(folder.path(), &["report", "out", "--out", "pages/a.html"]);
    let page = fs::read_to_string(folder.path().join("pages/a.html")).unwrap();
    assert!(
        page.contains("href=\"./../out/plane_brf.csv\""),
        "links lead from the page to the results"
    );
    succeeds(folder.path(), &["report", "out", "--out", "pages/a.html"]);
    assert_eq!(
        fs::read_dir(folder.path().join("pages")).unwrap().count(),
        1,
        "nothing is left beside it"
    );
}

#[test]
fn a_scene_that_has_changed_or_gone_is_not_taken_for_that_of_the_results() {
    let folder = folder("Leaves");
    page_of_a_run(folder.path());
    let file = folder.path().join("leaves.ron");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("leaf_area_m2: 6.0", "leaf_area_m2: 3.0")).unwrap();
    succeeds(folder.path(), &["report", "out"]);
    let page = || fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(page().contains("The scene file has changed since the run"));
    assert!(!page().contains("hot spot"), "where the sun is now says nothing of these results");
    fs::remove_file(file).unwrap();
    succeeds(folder.path(), &["report", "out"]);
    assert!(page().contains("is not where it was") && page().contains("BRF in the plane"));
}

#[test]
fn what_is_no_folder_of_results_is_one_clear_error() {
    let folder = folder("Leaves");
    page_of_a_run(folder.path());
    let at = folder.path();
    let error = |name: &str| fails(at, &["report", name]);
    assert_eq!(
        error("none"),
        "error: none does not exist: name the folder of the results, such as out/birch_stand"
    );
    assert_eq!(
        error("leaves.ron"),
        "error: leaves.ron is a file: name the folder of the results, such as out/birch_stand"
    );
    assert_eq!(
        error("."),
        "error: . holds no results of `run`, `sweep` or `compare`: it has no summary.json; did you mean ./out?"
    );
    let summary = at.join("out/summary.json");
    let whole = fs::read_to_string(&summary).unwrap();
    for (text, cause) in [
        (whole[..whole.len() / 2].to_owned(), "EOF while parsing"),
        ("{\"name\": \"somebody else's\"}".to_owned(), "missing field `scene`"),
        (String::new(), "EOF while parsing"),
        (format!("{{\"deep\": {}", "[".repeat(100_000)), "EOF while parsing a list"),
        (
            whole.replacen("\"values\": [", "\"values\": [1.0, ", 1),
            "values or errors, and other numbers of points",
        ),
    ] {
        fs::write(&summary, text).unwrap();
        let error = error("out");
        assert!(
            error.starts_with("error: out/summary.json is damaged") && error.contains(cause),
            "{error}"
        );
    }
    fs::write(&summary, whole).unwrap();
    assert!(
        fails(at, &["report", "out", "--out", "out"])
            .contains("out is a folder: name a file for the report")
    );
    assert!(
        fails(at, &["report", "out", "out", "--out", "a.html"]).contains("--out names one file")
    );
    // A picture that is gone, or is none, is told where it would be.
    let pictures: Vec<PathBuf> = fs::read_dir(at.join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with("_brf.png"))
        .collect();
    fs::write(&pictures[0], "no picture").unwrap();
    succeeds(at, &["report", "out"]);
    assert!(fs::read_to_string(at.join("out/report.html")).unwrap().contains("is no PNG"));
    fs::remove_file(&pictures[0]).unwrap();
    succeeds(at, &["report", "out"]);
    let page = fs::read_to_string(at.join("out/report.html")).unwrap();
    assert!(page.contains("is missing") && page.contains("No picture"));
}

/// *Expected*: values against the parameter with a line for each value of the other one, at the points of `sweep.csv`.
#[test]
fn a_sweep_is_drawn_against_its_parameters() {
    let folder = folder("Leaves");
    succeeds(folder.path(), &["sweep", "leaves.ron", "--out", "s"]);
    succeeds(folder.path(), &["report", "s"]);
    let page = fs::read_to_string(folder.path().join("s/report.html")).unwrap();
    // Red and near infrared differ too much in size for one axis; the sun of each line has a mark in its colour.
    for text in [
        "hemi: albedo",
        "sza = 20",
        "soil = 0.1",
        "soil = 0.3",
        "href=\"./sweep.csv\"",
        ">sza: sun zenith (°)</text>",
        ">albedo (–)</text>",
        ">BRF (–)</text>",
        "Panels have axes of their own",
        ">view zenith (°): − forward, + backward scattering</text>",
        "<g class=\"c0\"><path class=\"mark\"",
        "<g class=\"c2\"><path class=\"mark\"",
        ">sun</text>",
    ] {
        assert!(page.contains(text), "{text}");
    }
    fs::remove_file(folder.path().join("s/sweep.csv")).unwrap();
    assert!(fails(folder.path(), &["report", "s"]).contains("s/sweep.csv is missing"));
}

#[test]
fn systems_are_drawn_side_by_side() {
    let folder = folder("Leaves");
    let line = [
        "compare",
        "leaves.ron",
        "--systems",
        "backward,forward",
        "--sensor",
        "plane",
        "--out",
        "c",
    ];
    succeeds(folder.path(), &line);
    succeeds(folder.path(), &["report", "c"]);
    let page = fs::read_to_string(folder.path().join("c/report.html")).unwrap();
    for text in
        ["backward", "forward", "difference (standard errors)", "href=\"./compare_summary.csv\""]
    {
        assert!(page.contains(text), "{text}");
    }
}

/// A folder of results that was not made by a run: `bands` bands, and as many rows.
fn large(folder: &Path, bands: usize, rows: usize) {
    let names: Vec<String> = (0..bands).map(|band| format!("b{band}")).collect();
    let waves: Vec<f64> = (0..bands).map(|band| 400.0 + band as f64).collect();
    let heights: Vec<f64> = (0..rows).map(|row| row as f64).collect();
    let tops: Vec<f64> = heights.iter().map(|height| height + 1.0).collect();
    let values: Vec<f64> = (0..rows * bands).map(|at| (at % 97) as f64).collect();
    let spectrum: Vec<f64> = (0..bands).map(|band| band as f64).collect();
    let summary = serde_json::json!({
        "scene": "large", "command": "run", "scene_file": null, "params": {}, "variant": null, "set": {}, "quality": 1.0,
        "hash": "0", "version": "0.1.0", "seed": 1, "files": [], "seconds": 1.0, "rays": 1, "bands": names,
        "wavelengths_nm": waves, "stages": {}, "skipped": [], "notes": [], "runs": {},
        "warnings": vec!["again and again"; 5000],
        "sensors": { "p": {
            "fapar": {
                "unit": "1", "axes": "AXES", "coordinates": { "bottom_m": { "top_m": tops } },
                "values": values, "standard_error": values, "files": ["p_fapar.csv"],
            },
            "albedo": { "unit": "1", "axes": { "band": names }, "values": spectrum, "standard_error": spectrum, "files": [] },
        } },
    });
    // Maps of `serde_json` are sorted; axes are not.
    let axes = serde_json::json!([heights, names]);
    let axes = format!("{{ \"bottom_m\": {}, \"band\": {} }}", axes[0], axes[1]);
    fs::write(folder.join("summary.json"), summary.to_string().replace("\"AXES\"", &axes)).unwrap();
}

/// *Expected*: 500 bands, 10⁵ rows and 1000 points of a sweep each give a page of less than 2 MB that says what it leaves out.
#[test]
fn pages_of_large_results_stay_small() {
    let folder = tempdir().unwrap();
    for (bands, rows) in [(500, 200), (2, 100_000)] {
        large(folder.path(), bands, rows);
        succeeds(folder.path(), &["report", "."]);
        let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
        assert!(page.len() < 2_000_000, "{} bytes", page.len());
        let caption = format!("80 of {rows} rows");
        assert!(page.contains("p_fapar.csv") && page.contains(&caption), "no {caption}");
        assert!(page.contains("4960 more are in summary.json"));
    }
    let head = fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let head: serde_json::Value = serde_json::from_str(&head).unwrap();
    let mut sweep = head.as_object().unwrap().clone();
    sweep.remove("sensors");
    sweep.insert("command".to_owned(), "sweep".into());
    fs::write(folder.path().join("summary.json"), serde_json::Value::Object(sweep).to_string())
        .unwrap();
    let mut table = "lai,sensor,product,unit,zenith_deg,azimuth_deg,signed_zenith_deg,band,value,standard_error\n".to_owned();
    for point in 0..1000 {
        for view in 0..31 {
            writeln!(table, "{point},p,brf,1,{view},0,{view},red,0.1,0.01").unwrap();
        }
        writeln!(table, "{point},q,albedo,1,,,,red,0.1,0.01").unwrap();
    }
    fs::write(folder.path().join("sweep.csv"), table).unwrap();
    succeeds(folder.path(), &["report", "."]);
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    assert!(
        page.len() < 2_000_000 && page.contains("6 of 1000 values of the parameter are drawn"),
        "{} bytes",
        page.len()
    );
}

/// *Expected*: reports of a run, a sweep and a comparison in a browser, by `tests/readers/report.py`.
///
/// Needs a Python with `playwright` and `html5lib`, `python3` or the one that `SUNFLECK_PYTHON` names, and Chromium.
#[test]
fn a_browser_shows_each_report_as_it_should() {
    let folder = folder(HOSTILE);
    page_of_a_run(folder.path());
    succeeds(folder.path(), &["sweep", "leaves.ron", "--out", "s"]);
    succeeds(folder.path(), &["compare", "leaves.ron", "--out", "c"]);
    succeeds(folder.path(), &["report", "s", "c"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/readers/report.py");
    let python = std::env::var_os("SUNFLECK_PYTHON").unwrap_or_else(|| "python3".into());
    let mut command = std::process::Command::new(python);
    command
        .arg(script)
        .args(["out", "s", "c"].map(|name| folder.path().join(name).join("report.html")));
    let Ok(run) = command.output() else {
        eprintln!("skipped: there is no Python");
        return;
    };
    let [said, wrong] = [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text));
    if run.status.code() == Some(MISSING) {
        eprintln!("skipped: {said}");
        return;
    }
    assert!(run.status.success(), "{said}{wrong}");
}
