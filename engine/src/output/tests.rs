//! Every file is read back with somebody else's reader.

use std::fs;

use super::*;
use crate::products::{AxisPoints, Forecast, Georeference, ProductAxis, Rendering, SensorReport};

fn axis(name: &str, points: &[f64]) -> ProductAxis {
    ProductAxis { name: name.to_owned(), points: AxisPoints::Numbers(points.to_vec()) }
}

fn labels(name: &str, points: &[&str]) -> ProductAxis {
    let points = points.iter().map(|&point| point.to_owned()).collect();
    ProductAxis { name: name.to_owned(), points: AxisPoints::Labels(points) }
}

/// BRF of three views in two bands, one of them without data.
fn views() -> Product {
    Product {
        name: "brf".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![
            vec![axis("zenith_deg", &[-5.0, 0.0, 5.0]), axis("azimuth_deg", &[90.0, 0.0, 270.0])],
            vec![labels("band", &["red", "nir, wide"])],
        ],
        values: vec![0.1, 1.0 / 3.0, 1e-300, f64::NAN, 0.05, 0.1 + 0.2],
        standard_error: vec![0.001, 0.002, f64::NAN, f64::NAN, 1e-9, 0.0],
        image: None,
        faces: None,
    }
}

/// 3 by 2 pixels in two bands; the last pixel saw nothing.
fn image() -> Product {
    let mut values: Vec<f32> = (0_u8..12).map(|index| f32::from(index) / 16.0).collect();
    values[10..].fill(f32::NAN);
    let standard_error = values.iter().map(|value| value / 8.0).collect();
    Product {
        name: "brf".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![vec![labels("band", &["red", "nir, wide"])]],
        values: vec![0.25, 0.3125],
        standard_error: vec![0.001, 0.002],
        image: Some(Image {
            width: 3,
            height: 2,
            bands: vec!["red".to_owned(), "nir, wide".to_owned()],
            values,
            standard_error,
            coverage: vec![1.0, 1.0, 1.0, 1.0, 0.5, 0.0],
            rendering: Rendering::Quicklook,
            georeference: Some(Georeference {
                west: 679_000.5,
                north: 5_150_000.25,
                pixel_width: 0.5,
                pixel_height: 0.25,
            }),
        }),
        faces: None,
    }
}

fn sensor(name: &str, product: Product) -> SensorReport {
    SensorReport {
        name: name.to_owned(),
        products: vec![product],
        seconds: 0.1,
        rays: 1 << 40,
        samples: 64,
        ended_by: "samples 64".to_owned(),
        energy_imbalance: None,
        forecast: Forecast { seconds: 0.1, memory: 1 << 20, files: 1 << 10 },
    }
}

fn report(sensors: Vec<SensorReport>) -> Report {
    Report {
        projection: None,
        scene: "Birch\n# stand \u{df}".to_owned(),
        hash: "c0ffee".to_owned(),
        version: "0.1.0".to_owned(),
        seed: u64::MAX,
        seconds: 1.0 / 7.0,
        rays: 3,
        bands: vec!["red".to_owned(), "nir, wide".to_owned()],
        wavelengths: vec![660.0, 865.5],
        stages: vec![("z first".to_owned(), 0.5), ("a second".to_owned(), 0.25)],
        skipped: vec!["mesh \"bush\"".to_owned()],
        notes: vec!["the sun is that of ASTM G173".to_owned()],
        warnings: Vec::new(),
        sensors,
        params: vec![("sza".to_owned(), 30.0.into())],
        irradiance: vec![1.0; 2],
        sun_azimuth_deg: Some(250.0),
        origin: None,
    }
}

/// Folder with the files of one image and one list of views.
fn written() -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let report = report(vec![sensor("nadir", image()), sensor("plane", views())]);
    let paths = write(&report, &folder.path().join("deep/er")).unwrap();
    (folder, paths)
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn exactly_the_promised_files_are_written() {
    let (folder, paths) = written();
    let found = names(&folder.path().join("deep/er"));
    let expected = [
        "nadir_brf.exr",
        "nadir_brf.img",
        "nadir_brf.img.hdr",
        "nadir_brf.pixels.png",
        "nadir_brf.png",
        "nadir_brf_se.img",
        "nadir_brf_se.img.hdr",
        "plane_brf.csv",
        "plane_brf.svg",
        "summary.json",
    ];
    assert_eq!(found, expected);
    assert_eq!(paths.len(), 10);
    assert_eq!(paths[9], folder.path().join("deep/er/summary.json"));
    assert_eq!(names(folder.path()), ["deep"]);
    assert_eq!(names(&folder.path().join("deep")), ["er"]);
}

#[test]
fn summary_tells_what_was_foretold_of_a_long_measurement() {
    let mut report = report(vec![sensor("plane", views())]);
    report.sensors[0].seconds = 820.5;
    report.sensors[0].forecast = Forecast { seconds: 745.25, memory: 3 << 29, files: 1 << 28 };
    let folder = tempfile::tempdir().unwrap();
    let paths = write(&report, folder.path()).unwrap();
    let text = fs::read_to_string(paths.last().unwrap()).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let plane = &json["runs"]["plane"];
    assert_eq!(plane["seconds"], 820.5, "what it took beside what was foretold");
    let foretold = serde_json::json!({
        "seconds": 745.25, "memory_bytes": 1_610_612_736, "file_bytes": 268_435_456
    });
    assert_eq!(plane["forecast"], foretold);
    let table = paths[0].metadata().unwrap().len();
    let chart = paths[1].metadata().unwrap().len();
    assert_eq!((paths.len(), plane["file_bytes"].as_u64()), (3, Some(table + chart)));
}

#[test]
fn summary_reads_back_bit_for_bit_with_keys_in_order() {
    let (_folder, paths) = written();
    let text = fs::read_to_string(&paths[9]).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let plane = &json["sensors"]["plane"];
    assert_eq!(plane.as_object().unwrap().len(), 1, "a sensor holds its products alone");
    let brf = &plane["brf"];
    for (read, value) in brf["values"].as_array().unwrap().iter().zip(views().values) {
        let same = read.as_f64().map(f64::to_bits) == Some(value.to_bits());
        assert!(same || value.is_nan() && read.is_null(), "{read} for {value}");
    }
    assert_eq!(brf["shape"], serde_json::json!([3, 2]));
    assert_eq!(brf["axes"]["zenith_deg"], serde_json::json!([-5.0, 0.0, 5.0]));
    assert_eq!(
        brf["coordinates"]["zenith_deg"]["azimuth_deg"],
        serde_json::json!([90.0, 0.0, 270.0])
    );
    assert_eq!(brf["axes"]["band"], serde_json::json!(["red", "nir, wide"]));
    assert_eq!(json["seed"].as_u64(), Some(u64::MAX));
    assert_eq!(json["seconds"].as_f64().map(f64::to_bits), Some((1.0_f64 / 7.0).to_bits()));
    assert_eq!(json["scene"], "Birch\n# stand \u{df}");
    assert_eq!(json["runs"]["plane"]["rays"], 1_u64 << 40);
    assert!(json["runs"]["plane"]["forecast"].is_null(), "it was short");
    let files = [
        "nadir_brf.exr",
        "nadir_brf.img",
        "nadir_brf.img.hdr",
        "nadir_brf_se.img",
        "nadir_brf_se.img.hdr",
        "nadir_brf.png",
        "nadir_brf.pixels.png",
        "plane_brf.csv",
        "plane_brf.svg",
        "summary.json",
    ];
    assert_eq!(json["sensors"]["nadir"]["brf"]["files"], serde_json::json!(files[..7]));
    assert_eq!(json["files"], serde_json::json!(files), "those of all products and itself");
    assert_eq!(json["params"], serde_json::json!({ "sza": 30.0 }));
    let keys = [
        "scene",
        "hash",
        "version",
        "seed",
        "seconds",
        "rays",
        "bands",
        "wavelengths_nm",
        "stages",
        "z first",
        "a second",
        "skipped",
        "notes",
        "warnings",
        "sensors",
        "nadir",
        "plane",
        "runs",
    ];
    let places = keys.map(|key| text.find(&format!("\"{key}\":")));
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}\n{text}");
}

#[test]
fn exr_holds_every_channel_bit_for_bit() {
    let (_folder, paths) = written();
    let read = ::exr::prelude::read_all_flat_layers_from_file(&paths[0]).unwrap();
    let layer = &read.layer_data[0];
    let channels: Vec<(String, Vec<u32>)> = layer
        .channel_data
        .list
        .iter()
        .map(|channel| {
            let bits = channel.sample_data.values_as_f32().map(f32::to_bits).collect();
            (channel.name.to_string(), bits)
        })
        .collect();
    let image = image().image.unwrap();
    let of = |values: &[f32], band: usize| -> Vec<u32> {
        values.iter().skip(band).step_by(2).map(|value| value.to_bits()).collect()
    };
    let expected = [
        ("coverage", image.coverage.iter().map(|value| value.to_bits()).collect()),
        ("nir, wide", of(&image.values, 1)),
        ("nir, wide.se", of(&image.standard_error, 1)),
        ("red", of(&image.values, 0)),
        ("red.se", of(&image.standard_error, 0)),
    ];
    assert_eq!(channels, expected.map(|(name, values)| (name.to_owned(), values)));
    let comments = layer.attributes.comments.clone().unwrap();
    let text: serde_json::Value = serde_json::from_slice(comments.bytes()).unwrap();
    let seed = u64::MAX.to_string();
    let expected = [
        ("unit", "1"),
        ("hash", "c0ffee"),
        ("seed", &seed),
        ("version", "0.1.0"),
        ("scene", "Birch # stand \u{df}"),
        ("params", "sza=30"),
    ];
    for (key, value) in expected {
        assert_eq!(text[key], value, "{key}");
    }
    // More than one attribute of our own would be written in an order that differs from run to run.
    assert!(layer.attributes.other.is_empty() && read.attributes.other.is_empty());
}

/// Value of a key in an ENVI header.
fn field<'a>(header: &'a str, key: &str) -> &'a str {
    let line = header.lines().find(|line| line.split(" = ").next() == Some(key));
    line.and_then(|line| line.split_once(" = ")).unwrap_or_else(|| panic!("no {key}")).1
}

#[test]
fn a_second_envi_raster_holds_errors_and_coverage() {
    let (_folder, paths) = written();
    let header = fs::read_to_string(&paths[4]).unwrap();
    assert_eq!(field(&header, "band names"), "{red_se, nir_ wide_se, coverage}");
    assert_eq!(field(&header, "bands"), "3");
    assert!(field(&header, "map info").contains("679000.5, 5150000.25, 0.5, 0.25"));
    assert!(!header.contains("wavelength"), "the coverage has none");
    let bytes = fs::read(&paths[3]).unwrap();
    let found: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|number| f32::from_le_bytes(number.try_into().unwrap()))
        .collect();
    let image = image().image.unwrap();
    let band = |band: usize| image.standard_error.iter().skip(band).step_by(2).copied();
    let expected: Vec<f32> = band(0)
        .chain(band(1))
        .map(|error| if error.is_nan() { -9999.0 } else { error })
        .chain(image.coverage.iter().copied())
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn no_header_stands_beside_another_file_of_its_stem() {
    let (folder, _) = written();
    let found = names(&folder.path().join("deep/er"));
    for header in found.iter().filter_map(|name| name.strip_suffix(".hdr")) {
        let stems = found.iter().filter_map(|name| name.rsplit_once('.').map(|(stem, _)| stem));
        assert!(
            !stems.into_iter().any(|stem| stem == header && !found.contains(&header.to_owned()))
        );
        assert!(found.contains(&header.to_owned()), "{header}.hdr is that of {header}");
    }
}

#[test]
fn files_of_the_same_run_are_the_same_bytes() {
    let read = || {
        let (_folder, paths) = written();
        paths.iter().map(|path| fs::read(path).unwrap()).collect::<Vec<_>>()
    };
    let first = read();
    for _ in 0..8 {
        assert!(read() == first);
    }
}

#[test]
fn envi_header_describes_the_pixels() {
    let (_folder, paths) = written();
    let header = fs::read_to_string(&paths[2]).unwrap();
    assert!(header.starts_with("ENVI\n"));
    let field = |key: &str| field(&header, key);
    let count = |key: &str| field(key).parse::<usize>().unwrap();
    let (samples, lines, bands) = (count("samples"), count("lines"), count("bands"));
    let bytes = fs::read(&paths[1]).unwrap();
    assert_eq!((samples, lines, bands), (3, 2, 2));
    assert_eq!((field("data type"), field("interleave"), field("byte order")), ("4", "bsq", "0"));
    assert_eq!(bytes.len(), samples * lines * bands * 4 + count("header offset"));
    let list = |key: &str| -> Vec<String> {
        let inner = field(key).trim_start_matches('{').trim_end_matches('}');
        inner.split(',').map(|item| item.trim().to_owned()).collect()
    };
    assert_eq!(list("band names"), ["red", "nir_ wide"], "no comma within a name");
    assert_eq!(list("wavelength"), ["660", "865.5"]);
    let place = list("map info");
    assert_eq!(place[1..7], ["1", "1", "679000.5", "5150000.25", "0.5", "0.25"]);
    assert_eq!(place[0], "Arbitrary");
    let no_data: f32 = field("data ignore value").parse().unwrap();
    let image = image().image.unwrap();
    for band in 0..bands {
        for pixel in 0..samples * lines {
            let at = 4 * (band * samples * lines + pixel);
            let read = f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
            let value = image.values[pixel * bands + band];
            let expected = if value.is_nan() { no_data } else { value };
            assert_eq!(read.to_bits(), expected.to_bits(), "band {band}, pixel {pixel}");
        }
    }
}

#[test]
fn quicklook_is_a_png_with_transparency_and_provenance() {
    let (_folder, paths) = written();
    let file = io::BufReader::new(fs::File::open(&paths[6]).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (3, 2));
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgba, png::BitDepth::Eight));
    let opacity: Vec<u8> = pixels.iter().skip(3).step_by(4).copied().collect();
    assert_eq!(opacity, [255, 255, 255, 255, 128, 0]);
    assert_eq!(pixels[..3], [0; 3], "darkest pixel");
    assert_eq!(pixels[16..19], [255; 3], "brightest pixel");
    let texts: Vec<_> = reader.info().utf8_text.iter().map(|text| text.keyword.as_str()).collect();
    assert!(texts.contains(&"hash") && texts.contains(&"seed"), "{texts:?}");
}

#[test]
fn csv_reads_back_bit_for_bit() {
    let (_folder, paths) = written();
    let text = fs::read_to_string(&paths[7]).unwrap();
    for line in
        ["# scene: Birch # stand \u{df}\n", "# params: sza=30\n", "# hash: c0ffee\n", "# unit: 1\n"]
    {
        assert!(text.contains(line), "{line:?} in\n{text}");
    }
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(&paths[7]).unwrap();
    let header: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let expected = [
        "zenith_deg",
        "azimuth_deg",
        "signed_zenith_deg",
        "red",
        "red_se",
        "nir, wide",
        "nir, wide_se",
    ];
    assert_eq!(header, expected);
    let rows: Vec<Vec<f64>> = reader
        .records()
        .map(|row| row.unwrap().iter().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let views = views();
    let (values, errors) = (&views.values, &views.standard_error);
    let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(rows.len(), 3);
    for (index, (zenith, azimuth)) in
        [(-5.0, 90.0), (0.0, 0.0), (5.0, 270.0)].into_iter().enumerate()
    {
        let at = 2 * index;
        // The sun's azimuth is 250°: -5 at 90° is 5 on the sun's side.
        let signed = [5.0, 0.0, 5.0][index];
        let row = [zenith, azimuth, signed, values[at], errors[at], values[at + 1], errors[at + 1]];
        assert_eq!(bits(&rows[index]), bits(&row));
    }
}

#[test]
fn csv_of_several_dimensions_counts_the_last_fastest() {
    let folder = tempfile::tempdir().unwrap();
    let product = Product {
        name: "fapar".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![
            vec![labels("material", &["leaf", "bark"])],
            vec![axis("height_m", &[0.5, 1.5])],
            vec![labels("band", &["red"])],
        ],
        values: vec![0.1, 0.2, 0.3, 0.4],
        standard_error: vec![0.01; 4],
        image: None,
        faces: None,
    };
    write(&report(vec![sensor("flux", product)]), folder.path()).unwrap();
    let text = fs::read_to_string(folder.path().join("flux_fapar.csv")).unwrap();
    let rows: Vec<_> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let expected = [
        "material,height_m,red,red_se",
        "leaf,0.5,0.1,0.01",
        "leaf,1.5,0.2,0.01",
        "bark,0.5,0.3,0.01",
        "bark,1.5,0.4,0.01",
    ];
    assert_eq!(rows, expected);
}

#[test]
fn hostile_names_stay_inside_the_folder_and_apart() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("out");
    let hostile = ["../x", "a/b", "a b", "A b", "CON", "summary.json", "", "/etc/x", "\u{0}", ".."];
    let sensors = hostile.map(|name| sensor(name, views())).into();
    let paths = write(&report(sensors), &folder).unwrap();
    assert_eq!(names(root.path()), ["out"]);
    let found = names(&folder);
    // A table and a chart each, and the summary.
    assert_eq!(found.len(), 2 * hostile.len() + 1, "{found:?}");
    for path in &paths {
        assert_eq!(path.parent(), Some(folder.as_path()));
        assert!(path.is_file());
    }
    let mut distinct: Vec<_> = found.iter().map(|name| name.to_lowercase()).collect();
    distinct.dedup();
    assert_eq!(distinct.len(), found.len(), "{found:?}");
    assert!(found.iter().all(|name| !name.starts_with('.') && !name.starts_with("CON.")));
    let text = fs::read_to_string(folder.join("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["sensors"].as_object().unwrap().len(), hostile.len());
    let files = serde_json::json!(["A_b_brf_3.csv", "A_b_brf_3.svg"]);
    assert_eq!(json["sensors"]["A b"]["brf"]["files"], files);
}

#[test]
fn a_folder_that_cannot_be_is_an_error_with_its_path_and_cause() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "mine").unwrap();
    let report = report(vec![sensor("plane", views())]);
    assert!(matches!(probe(&file), Err(OutputError::NotAFolder { .. })));
    assert!(matches!(probe(&file.join("below")), Err(OutputError::Folder { .. })));
    probe(&root.path().join("new/er")).unwrap();
    let error = write(&report, &file).unwrap_err();
    let expected = format!("{} is a file: name a folder for the output", file.display());
    assert_eq!(error.to_string(), expected);
    let error = write(&report, &file.join("below")).unwrap_err();
    assert!(matches!(&error, OutputError::Folder { path, .. } if path == &file.join("below")));
    assert!(std::error::Error::source(&error).is_some());
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert_eq!(names(root.path()), ["file"]);
}

#[cfg(unix)]
#[test]
#[allow(clippy::print_stderr, reason = "a test that cannot be made says so")]
fn a_folder_without_permission_stays_as_it_was() {
    use std::os::unix::fs::PermissionsExt as _;
    let root = tempfile::tempdir().unwrap();
    fs::set_permissions(root.path(), fs::Permissions::from_mode(0o500)).unwrap();
    if fs::write(root.path().join("probe"), "").is_ok() {
        eprintln!("skipped: this user may write everywhere");
        return;
    }
    let report = report(vec![sensor("plane", views())]);
    assert!(matches!(write(&report, root.path()), Err(OutputError::Write { .. })));
    assert!(matches!(write(&report, &root.path().join("new")), Err(OutputError::Folder { .. })));
    assert!(names(root.path()).is_empty());
}

#[test]
fn a_write_that_fails_leaves_no_file_and_an_older_report_whole() {
    let root = tempfile::tempdir().unwrap();
    let good = report(vec![sensor("plane", views())]);
    write(&good, root.path()).unwrap();
    let before = fs::read(root.path().join("summary.json")).unwrap();
    fs::create_dir(root.path().join("late_brf.csv")).unwrap();
    let mut other = views();
    other.values[0] = 0.9;
    let blocked = report(vec![sensor("plane", other), sensor("late", views())]);
    let error = write(&blocked, root.path()).unwrap_err();
    assert!(
        matches!(&error, OutputError::Taken { path } if path.ends_with("late_brf.csv")),
        "{error}"
    );
    assert_eq!(
        names(root.path()),
        ["late_brf.csv", "plane_brf.csv", "plane_brf.svg", "summary.json"]
    );
    assert_eq!(fs::read(root.path().join("summary.json")).unwrap(), before);
    let csv = fs::read_to_string(root.path().join("plane_brf.csv")).unwrap();
    assert!(!csv.contains("0.9"), "{csv}");
}

#[test]
fn a_product_that_contradicts_its_axes_is_an_error_before_any_file() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("out");
    let mut short = views();
    short.values.pop();
    let error = write(&report(vec![sensor("plane", short)]), &folder).unwrap_err();
    assert_eq!(error.to_string(), "plane.brf has 5 values, but its axes say 6");
    let mut empty = image();
    empty.image.as_mut().unwrap().width = 0;
    assert!(write(&report(vec![sensor("nadir", empty)]), &folder).is_err());
    assert!(names(root.path()).is_empty());
}

#[test]
fn table_is_aligned_and_condensed() {
    let count = 31_u8;
    let mut long = views();
    let zenith: Vec<f64> = (0..count).map(|view| f64::from(view) * 5.0 - 75.0).collect();
    long.dimensions[0] = vec![axis("zenith_deg", &zenith)];
    long.values = (0..2 * count).map(|index| 0.1 + f64::from(index) / 1000.0).collect();
    long.standard_error = vec![0.001; 2 * usize::from(count)];
    let text = table(&report(vec![sensor("nadir", image()), sensor("plane", long)]));
    let expected = "\
sensor  product  at                band        value  standard error
nadir   brf      mean of 3 x 2 px  red        0.2500  ± 0.0010
                                   nir, wide  0.3125  ± 0.0020
plane   brf      zenith -75°       red        0.1000  ± 0.0010
                                   nir, wide  0.1010  ± 0.0010
                 zenith -35°       red        0.1160  ± 0.0010
                                   nir, wide  0.1170  ± 0.0010
                 zenith 0°         red        0.1300  ± 0.0010
                                   nir, wide  0.1310  ± 0.0010
                 zenith 40°        red        0.1460  ± 0.0010
                                   nir, wide  0.1470  ± 0.0010
                 zenith 75°        red        0.1600  ± 0.0010
                                   nir, wide  0.1610  ± 0.0010
                 (26 more)
";
    assert_eq!(text, expected, "got\n{text}");
}

/// What spreadsheets take for formulas, in every place where a scene's author has the word.
#[test]
fn no_cell_is_a_formula() {
    let folder = tempfile::tempdir().unwrap();
    let evil = ["=1+1", "+cmd", "-2+3", "@sum", "\ttab", "-5.5", "#1"];
    let product = Product {
        name: "fapar".to_owned(),
        unit: "1".to_owned(),
        dimensions: vec![vec![labels("material", &evil)], vec![labels("band", &["=red", "a"])]],
        values: vec![0.0; 14],
        standard_error: vec![-0.5; 14],
        image: None,
        faces: None,
    };
    let mut report = report(vec![sensor("=flux", product)]);
    report.scene = "=1, =2; +3\t@4, e-5".to_owned();
    let paths = write(&report, folder.path()).unwrap();
    let text = fs::read_to_string(&paths[0]).unwrap();
    assert!(text.contains("# scene: '=1, '=2; '+3 @4, e-5\n# params"), "{text}");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(&paths[0]).unwrap();
    let header = reader.headers().unwrap().clone();
    assert_eq!(Vec::from_iter(&header), ["material", "'=red", "'=red_se", "a", "a_se"]);
    let first: Vec<String> = reader.records().map(|row| row.unwrap()[0].to_owned()).collect();
    assert_eq!(first, ["'=1+1", "'+cmd", "'-2+3", "'@sum", "'\ttab", "-5.5", "#1"]);
    assert!(text.contains("-0.5"), "numbers stay as they are");
}

fn sorted(mut numbers: Vec<usize>) -> Vec<usize> {
    numbers.sort_unstable();
    numbers
}

/// As many values as the lengths of the axes say, in the file as in the report.
#[test]
fn the_summary_has_one_axis_a_dimension() {
    let (_folder, paths) = written();
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(paths.last().unwrap()).unwrap()).unwrap();
    let mut count = 0;
    for product in
        json["sensors"].as_object().unwrap().values().flat_map(|s| s.as_object().unwrap().values())
    {
        let axes = product["axes"].as_object().unwrap();
        let lengths: Vec<usize> =
            axes.values().map(|axis| axis.as_array().unwrap().len()).collect();
        let shape: Vec<usize> = serde_json::from_value(product["shape"].clone()).unwrap();
        // The reader sorts the axes by name.
        assert_eq!(sorted(shape), sorted(lengths.clone()));
        let values = product["values"].as_array().unwrap().len();
        assert_eq!(lengths.iter().product::<usize>(), values);
        for (axis, others) in product["coordinates"].as_object().into_iter().flatten() {
            for (name, points) in others.as_object().unwrap() {
                let points = points.as_array().unwrap().len();
                assert_eq!(points, axes[axis].as_array().unwrap().len(), "{name}");
            }
        }
        count += 1;
    }
    assert_eq!(count, 2);
}
