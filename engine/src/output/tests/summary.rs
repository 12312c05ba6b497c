//! `summary.json`.

use super::*;

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

/// *Expected*: as many values as the axes have points, in the file as in the report.
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

fn sorted(mut numbers: Vec<usize>) -> Vec<usize> {
    numbers.sort_unstable();
    numbers
}
