//! Zarr stores and `NetCDF` files of a run, read by xarray, netCDF4, scipy and GDAL, against the files beside them.
//!
//! Needs a Python with `numpy`, `xarray`, `zarr`, `netCDF4`, `scipy` and `rasterio`: `python3`, or the one that
//! `SUNFLECK_PYTHON` names. Without it the comparison is skipped, and says so.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::fs;
use std::path::{Path, PathBuf};

use sunfleck::output;
use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, run_file};
use sunfleck_tests::readers::{ScriptOutcome, run_reader};

/// Images on the ground and of a perspective, directions, and packets, in two reflected bands and a thermal one.
fn scene(frame: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    title: "Plot & <two> plates, “ö”",
    frame: ({frame}),
    bands: [
        (name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.5, width_nm: 20.0),
        (name: "tir", center_nm: 10000.0, width_nm: 1000.0),
    ],
    materials: {{
        "soil": Lambertian(reflectance: Bands([0.2, 0.4, 0.05]), temperature: SunlitShaded(sunlit_k: 310.0, shaded_k: 300.0)),
        "plate": Lambertian(reflectance: Bands([0.05, 0.3, 0.02]), temperature: SunlitShaded(sunlit_k: 305.0, shaded_k: 295.0)),
    }},
    meshes: {{
        "m": Faces(faces_m: [[(-3.0, -3.0, 5.0), (3.0, -3.0, 5.0), (3.0, 3.0, 5.0), (-3.0, 3.0, 5.0)]], material: "plate"),
    }},
    terrain: Plane(size_m: (100.0, 50.0), material: "soil"),
    instances: [List(of: "m", at_m: [(30.0, 20.0, 0.0), (80.0, 40.0, 0.0)])],
    sun: (zenith_deg: 30.0, azimuth_deg: 120.0, irradiance: Bands([1.5, 0.9, 0.0])),
    sensors: {{
        "top view": Orthographic(size_px: (520, 516), extent_m: (105.0, 52.85), samples_per_px: 2, measure: [Brf, BrightnessTemperature]),
        "eye": Perspective(size_px: (40, 30), position_m: (50.0, 0.0, 60.0), target_m: (50.0, 25.0, 0.0), fov_deg: (50.0, 40.0), samples_per_px: 4, measure: [Radiance, FourComponents]),
        "plane": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 15.0), until: Samples(2000), measure: [Brf, BrightnessTemperature]),
        "f": Photons(per_m2: 20.0, measure: [BrfCells(50), Albedo, Fapar(layer_m: 1.0), Fluxes(pixel_m: 0.5, heights_m: [1.0])]),
    }},
    output: [Zarr, NetCdf, Envi],
)"#
    )
}

fn report(folder: &Path, text: &str) -> Report {
    let file = folder.join("plot.ron");
    fs::write(&file, text).expect("a file");
    run_file(&file, &Options::default(), &Unwatched).unwrap_or_else(|failure| panic!("{failure}"))
}

/// *Expected*: xarray reads both formats with all engines, GDAL their images; values are those of ENVI rasters and of
/// tables bit for bit, coordinates those of the axes, systems those of the scene, of UTM and others.
#[test]
fn other_programs_read_what_was_written() {
    let systems = [
        ("origin_m: (400000.0, 5600000.0, 0.0), crs: \"EPSG:32633\"", "32633"),
        ("origin_m: (4321000.0, 3210000.0, 0.0), crs: \"EPSG:3035\"", "3035"),
        ("origin_m: (10.0, 20.0, 0.0)", "0"),
    ];
    for (frame, epsg) in systems {
        let folder = tempfile::tempdir().expect("a folder");
        let out = folder.path().join("out");
        // One image of several chunks is enough.
        let size = if epsg == "32633" { "(520, 516)" } else { "(21, 13)" };
        let text = scene(frame).replace("(520, 516)", size);
        output::write(&report(folder.path(), &text), &out).expect("files");
        let outcome = run_reader("datasets.py", &[out.as_os_str(), epsg.as_ref()]);
        if let ScriptOutcome::Skipped(why) = outcome {
            eprintln!("skipped: {why}");
            return;
        }
    }
}

/// *Expected*: an older store is gone with its chunks, whether the new run has one or not, and nothing is left beside the
/// results; files that are no results stay; the summary names the stores.
#[test]
fn a_store_takes_the_place_of_an_older_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let small = scene("").replace("(520, 516)", "(20, 20)");
    let files_of = |store: &str| -> Vec<PathBuf> {
        let mut all: Vec<_> = walk(&out.join(store));
        all.sort();
        all
    };
    output::write(&report(folder.path(), &scene("")), &out).expect("files");
    let large = files_of("top_view.zarr");
    fs::write(out.join("notes.txt"), "mine").expect("a note");
    output::write(&report(folder.path(), &small), &out).expect("files");
    let chunks = files_of("top_view.zarr");
    assert!(chunks.len() < large.len(), "{} and {}", chunks.len(), large.len());
    let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
    for name in ["top_view.zarr", "top_view.nc", "f.zarr"] {
        assert!(summary.contains(&format!("\"{name}\"")), "{name}");
    }
    let without = small.replace("[Zarr, NetCdf, Envi]", "[Envi]");
    output::write(&report(folder.path(), &without), &out).expect("files");
    let names: Vec<_> = fs::read_dir(&out)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
        .collect();
    let has = |ending: &str| names.iter().any(|name| name.ends_with(ending));
    assert!(!has(".zarr") && !has(".nc") && has("notes.txt"), "{names:?}");
    let beside = fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(beside, 2, "the scene and its results");
}

/// All files in a folder and in those in it.
fn walk(folder: &Path) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] }).collect()
}
