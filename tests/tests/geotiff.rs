//! `GeoTIFF` of a run, read by GDAL (rasterio) and tifffile, against the ENVI rasters beside them.
//!
//! Needs a Python with `numpy`, `rasterio` and `tifffile`: `python3`, or the one that `SUNFLECK_PYTHON` names. Without it
//! the comparison is skipped, and says so.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use sunfleck::document::{FileFormat, ReadOptions};
use sunfleck::output;
use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, run_file};
use sunfleck_tests::readers::{ScriptOutcome, run_reader};

/// An image of 300 by 151 pixels that shows ground and its surroundings, and rasters of flux.
fn scene(output: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    title: "Plot & <two> plates",
    frame: (origin_m: (400000.0, 5600000.0, 0.0), crs: "EPSG:32633"),
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.5)],
    materials: {{
        "soil": Lambertian(reflectance: Bands([0.2, 0.4])),
        "plate": Lambertian(reflectance: Bands([0.05, 0.3])),
    }},
    meshes: {{
        "m": Faces(faces_m: [[(-3.0, -3.0, 5.0), (3.0, -3.0, 5.0), (3.0, 3.0, 5.0), (-3.0, 3.0, 5.0)]], material: "plate"),
    }},
    terrain: Plane(size_m: (100.0, 50.0), material: "soil"),
    instances: [List(of: "m", at_m: [(30.0, 20.0, 0.0), (80.0, 40.0, 0.0)])],
    sun: (zenith_deg: 30.0, azimuth_deg: 120.0),
    sensors: {{
        "top": Orthographic(size_px: (300, 151), extent_m: (105.0, 52.85), samples_per_px: 2, measure: [Brf, FourComponents]),
        "f": Photons(per_m2: 20.0, measure: [Fluxes(pixel_m: 0.5, heights_m: [1.0])]),
    }},
    {output}
)"#
    )
}

/// Report of a scene whose key `output` is this, and of formats in its place.
fn report(folder: &Path, output: &str, formats: Option<Vec<FileFormat>>) -> Report {
    let file = folder.join("plot.ron");
    fs::write(&file, scene(output)).expect("a file");
    let document = ReadOptions { output: formats, ..ReadOptions::default() };
    let options = Options { document, ..Options::default() };
    run_file(&file, &options, &Unwatched).unwrap_or_else(|failure| panic!("{failure}"))
}

/// *Expected*: GDAL and tifffile read the values of the ENVI rasters bit for bit, and the place, system, names and
/// wavelengths of the scene; overviews are means.
#[test]
fn other_programs_read_what_was_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = report(folder.path(), "output: [GeoTiff, Envi],", None);
    let out = folder.path().join("out");
    let files = output::write(&report, &out).expect("files");
    let rasters: Vec<_> = files
        .iter()
        .filter_map(|file| file.file_name()?.to_str()?.strip_suffix("_se.tif"))
        .filter(|stem| !stem.contains("component"))
        .collect();
    assert!(rasters.len() >= 2 && rasters.contains(&"top_brf"), "{files:?}");
    for stem in rasters {
        let arguments = [out.as_os_str(), stem.as_ref(), "32633".as_ref(), "red,nir".as_ref()];
        if let ScriptOutcome::Skipped(why) = run_reader("geotiff.py", &arguments) {
            eprintln!("skipped: {why}");
            return;
        }
    }
}

/// *Expected*: files of the formats that are asked for and no others, by the scene or in its place; all in the summary,
/// and the same hash, as the numbers are the same.
#[test]
fn formats_decide_the_files_and_not_the_hash() {
    let folder = tempfile::tempdir().expect("a folder");
    let endings = |report: &Report, name: &str| -> BTreeSet<String> {
        let out = folder.path().join(name);
        let files = output::write(report, &out).expect("files");
        let summary = fs::read_to_string(out.join("summary.json")).expect("a summary");
        let names = files.iter().map(|file| file.file_name().and_then(|name| name.to_str()));
        let names: Vec<&str> = names.map(|name| name.expect("a name")).collect();
        for name in names.iter().filter(|name| **name != "summary.json") {
            assert!(summary.matches(&format!("\"{name}\"")).count() == 2, "{name}");
        }
        let images = names.into_iter().filter_map(|name| name.strip_prefix("top_brf"));
        images.map(str::to_owned).collect()
    };
    let set = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<BTreeSet<_>>();
    let default = report(folder.path(), "", None);
    let (envi, png) = ([".img", ".img.hdr", "_se.img", "_se.img.hdr"], [".png", ".pixels.png"]);
    assert_eq!(endings(&default, "a"), set(&[&envi[..], &png, &[".exr"]].concat()));
    let named = report(folder.path(), "output: [GeoTiff],", None);
    assert_eq!(endings(&named, "b"), set(&[".tif", "_se.tif"]));
    let pictures = [FileFormat::Png, FileFormat::GeoTiff];
    let replaced = report(folder.path(), "output: [Exr],", Some(pictures.to_vec()));
    assert_eq!(endings(&replaced, "c"), set(&[&png[..], &[".tif", "_se.tif"]].concat()));
    let none = report(folder.path(), "output: [],", None);
    assert_eq!(endings(&none, "d"), set(&[]));
    let exr = report(folder.path(), "output: [Exr],", None);
    assert_eq!(endings(&exr, "e"), set(&[".exr"]));
    for other in [&named, &replaced, &none] {
        assert_eq!(other.hash, default.hash);
    }
    let pixels = |name: &str| {
        let png = fs::read(folder.path().join(name).join("top_brf.png")).expect("a PNG");
        // Texts before the pixels name the formats.
        let start = png.windows(4).position(|name| name == b"IDAT").expect("pixels");
        png[start..].to_vec()
    };
    assert_eq!(pixels("a"), pixels("c"), "pictures are the same without ENVI");
}
