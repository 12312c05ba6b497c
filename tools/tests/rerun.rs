//! `rerun`: a run once more, from any of its files.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::{TempDir, tempdir};

/// A scene with an included file, a parameter, a variant and a table, whose sensors write every format.
const SCENE: &str = r#"Scene(
    format: 1,
    title: "Plot <1>; {a}, \"b\"",
    params: { "sza": 30.0, "soil": 0.2 },
    include: { "other": "parts/other.ron" },
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.5)],
    materials: {
        "soil": Lambertian(reflectance: Constant("=soil / 2")),
        "plate": Lambertian(reflectance: Named("other.plate")),
    },
    meshes: {
        "m": Faces(faces_m: [[(-3.0, -3.0, 5.0), (3.0, -3.0, 5.0), (3.0, 3.0, 5.0), (-3.0, 3.0, 5.0)]], material: "plate"),
    },
    terrain: Plane(size_m: (30.0, 20.0), material: "soil"),
    instances: [Table(file: "stems.csv", of: "m")],
    sun: (zenith_deg: "=sza", azimuth_deg: 120.0),
    sensors: {
        "top": Orthographic(size_px: (30, 20), extent_m: (30.0, 20.0), samples_per_px: 4, measure: [Brf, FourComponents]),
        "plane": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), until: Samples(2000), measure: [Brf]),
        "f": Photons(per_m2: 20.0, measure: [Albedo, Absorbed(per: Triangle)]),
    },
    output: [Exr, Envi, GeoTiff, Png, Zarr, NetCdf],
    variants: { "dark": { "soil": 0.1 } },
)"#;

/// A folder `scenes` with the scene.
struct Project(TempDir);

impl Project {
    fn new() -> Self {
        let project = Self(tempdir().unwrap());
        fs::create_dir_all(project.path("scenes/parts")).unwrap();
        fs::write(project.path("scenes/plot.ron"), SCENE).unwrap();
        let other = r#"Library(spectra: { "plate": Table(file: "plate.csv") })"#;
        fs::write(project.path("scenes/parts/other.ron"), other).unwrap();
        let plate = "wavelength_nm,reflectance\n400,0.05\n1000,0.3\n";
        fs::write(project.path("scenes/parts/plate.csv"), plate).unwrap();
        fs::write(project.path("scenes/stems.csv"), "x_m,y_m\n8,10\n20,7\n").unwrap();
        project
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
        command.args(arguments).current_dir(self.0.path()).output().unwrap()
    }

    /// Runs, which must succeed; returns what it prints and what it warns of.
    fn done(&self, arguments: &[&str]) -> [String; 2] {
        let out = self.command(arguments);
        let texts = [out.stdout, out.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(out.status.success(), "{arguments:?}: {texts:?}");
        texts
    }

    fn refused(&self, arguments: &[&str]) -> String {
        let out = self.command(arguments);
        assert_eq!(out.status.code(), Some(1), "{arguments:?}");
        String::from_utf8(out.stderr).unwrap()
    }
}

/// All files below a folder but the summary, which holds times.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with("summary.json") {
                let name = path.strip_prefix(folder).unwrap().to_owned();
                all.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    all
}

/// *Expected*: from a file of each format, all files come again bit for bit, though the scene, its include and its
/// parameters have changed since, with any number of threads.
#[test]
fn a_file_of_any_format_repeats_its_run_bit_for_bit() {
    let project = Project::new();
    let run =
        ["run", "scenes/plot.ron", "--set", "sza=40", "--variant", "dark", "--quality", "0.3"];
    project.done(
        &[&run[..], &["--sensor", "top", "--sensor", "plane", "--sensor", "f", "--out", "out/a"]]
            .concat(),
    );
    fs::write(project.path("scenes/plot.ron"), "gone").unwrap();
    fs::remove_file(project.path("scenes/parts/other.ron")).unwrap();
    let first = contents(&project.path("out/a"));
    let files = [
        "summary.json",
        "top_brf.exr",
        "top_brf.img",
        "top_brf_se.img.hdr",
        "top_brf.tif",
        "top_brf.png",
        "top_brf.pixels.png",
        "top.zarr",
        "top.nc",
        "plane_brf.csv",
        "plane_brf.svg",
        "f_albedo.csv",
        "f_absorbed_by_triangle.ply",
    ];
    for (number, name) in files.into_iter().enumerate() {
        let (file, threads) = (format!("out/a/{name}"), (number % 3 + 1).to_string());
        let [said, warned] = project.done(&["rerun", &file, "--threads", &threads]);
        assert!(said.starts_with(&format!("repeats the run of {file} (sunfleck ")), "{said}");
        assert!(said.contains("none of its 2 input files has changed since"), "{said}");
        assert!(!warned.contains("differ"), "{warned}");
        let again = contents(&project.path("out/a_rerun"));
        assert_eq!(again.keys().collect::<Vec<_>>(), first.keys().collect::<Vec<_>>(), "{name}");
        for (path, bytes) in &first {
            assert!(again[path] == *bytes, "{} from {name}", path.display());
        }
    }
    let summaries = ["a", "a_rerun"].map(|name| {
        let text = fs::read_to_string(project.path(&format!("out/{name}/summary.json"))).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    });
    for key in
        ["scene", "scene_file", "params", "variant", "set", "quality", "hash", "recipe", "sensors"]
    {
        assert_eq!(summaries[0][key], summaries[1][key], "{key}");
    }
}

#[test]
fn changed_and_missing_input_files_are_named_before_the_run() {
    let project = Project::new();
    project.done(&["run", "scenes/plot.ron", "--sensor", "plane", "--out", "out/a"]);
    fs::write(project.path("scenes/stems.csv"), "x_m,y_m\n8,10\n").unwrap();
    let [said, warned] = project.done(&["rerun", "out/a/plane_brf.csv", "--out", "elsewhere/b"]);
    assert!(said.contains("1 of its 2 input files changed since"), "{said}");
    assert!(warned.contains("stems.csv has changed since"), "{warned}");
    fs::remove_file(project.path("scenes/parts/plate.csv")).unwrap();
    let refused = project.refused(&["rerun", "out/a/plane_brf.csv", "--out", "c"]);
    assert!(refused.contains("plate.csv cannot be read"), "{refused}");
    fs::rename(project.path("scenes"), project.path("moved")).unwrap();
    let refused = project.refused(&["rerun", "out/a/plane_brf.csv", "--out", "c"]);
    assert!(
        refused.contains("which is not there: name that folder with `--folder DIR`"),
        "{refused}"
    );
    fs::write(
        project.path("moved/parts/plate.csv"),
        "wavelength_nm,reflectance\n400,0.05\n1000,0.3\n",
    )
    .unwrap();
    let [said, _] = project.done(&["rerun", "out/a", "--out", "c", "--folder", "moved"]);
    assert!(said.contains("1 of its 2 input files changed since"), "{said}");
    let refused = project.refused(&["rerun", "moved/stems.csv"]);
    assert!(refused.contains("is none of the files that sunfleck writes"), "{refused}");
}
