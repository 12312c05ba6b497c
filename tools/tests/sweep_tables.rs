//! Sweeps of many points on the same paths: one file of tables, found again point by point.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::tempdir;

/// Bare soil under the sun at many reflectances, and at two of them by the sun's zenith angle too.
fn soil(sweep: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    params: {{ "rho": 0.3, "sza": 0.0 }},
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: {{ "soil": Lambertian(reflectance: Constant("=rho")) }},
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (zenith_deg: "=sza", azimuth_deg: 90.0, irradiance: Bands([1.5, 0.8])),
    boundary: Periodic,
    sensors: {{ "p": Photons(per_m2: 5.0, measure: [Albedo, Exitance]) }},
    sweep: {sweep},
)"#
    )
}

fn sweep(folder: &Path) -> String {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(["sweep", "soil.ron", "--out", "o"]).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn reflectances(count: u32) -> String {
    let values: Vec<f64> = (0..count).map(|i| f64::from(i) / 200.0).collect();
    format!("{values:?}")
}

/// Names in a folder, in order.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// *Scene*: a Lambertian soil at 70 reflectances. *Expected*: one file of tables; the albedo of each point is its
/// reflectance; a sweep that goes on finds all points in that file, and those of a file that was cut are run again to the
/// same table.
#[test]
fn many_points_share_a_file_and_are_found_again() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("soil.ron"), soil(&format!("Grid({{ \"rho\": {} }})", reflectances(70))))
        .unwrap();
    assert_eq!(sweep(folder), "o/sweep.csv: 70 points run, 0 kept; geometry built once\n");
    let points = folder.join("o/points");
    assert_eq!(names(&points), ["70_from_rho=0"]);
    assert_eq!(names(&points.join("70_from_rho=0")), ["points.csv"]);
    let first = fs::read_to_string(folder.join("o/sweep.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(first.as_bytes());
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(header[..4], ["rho", "sensor", "product", "unit"]);
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    let albedo: Vec<&csv::StringRecord> = rows.iter().filter(|row| &row[2] == "albedo").collect();
    assert_eq!(albedo.len(), 2 * 70);
    for row in albedo {
        let [rho, value] = [0, header.len() - 2].map(|at| row[at].parse::<f64>().unwrap());
        assert!((rho - value).abs() < 1e-6, "{row:?}");
    }

    assert_eq!(sweep(folder), "o/sweep.csv: 0 points run, 70 kept; geometry built 0 times\n");
    assert_eq!(fs::read_to_string(folder.join("o/sweep.csv")).unwrap(), first);
    let tables = points.join("70_from_rho=0/points.csv");
    let text = fs::read_to_string(&tables).unwrap();
    let half = text.match_indices("# key: ").nth(30).unwrap().0;
    fs::write(&tables, &text[..half]).unwrap();
    assert_eq!(sweep(folder), "o/sweep.csv: 40 points run, 30 kept; geometry built once\n");
    assert_eq!(names(&points), ["40_from_rho=0.15", "70_from_rho=0"]);
    assert_eq!(fs::read_to_string(folder.join("o/sweep.csv")).unwrap(), first);
}

/// Points with other columns than most: one without light, at night, has a note.
#[test]
fn tables_with_different_columns_are_united() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let scene = soil(&format!("Grid({{ \"hour\": [0.0, 12.0], \"rho\": {} }})", reflectances(65)))
        .replace("\"sza\": 0.0", "\"hour\": 12.0")
        .replace(
            "zenith_deg: \"=sza\", azimuth_deg: 90.0",
            "position: Spa(date: (2026, 6, 21), time: (\"=hour\", 0.0, 0.0), latitude_deg: 50.0, longitude_deg: 0.0)",
        );
    fs::write(folder.join("soil.ron"), scene).unwrap();
    let printed = sweep(folder);
    assert_eq!(
        printed,
        "o/sweep.csv: 65 points run, 65 without light, 0 kept; geometry built once\n"
    );
    assert_eq!(names(&folder.join("o/points")).len(), 66);
    let mut reader = csv::Reader::from_path(folder.join("o/sweep.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|column| column == name).unwrap();
    let (product, note) = (at("product"), at("note"));
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.iter().filter(|row| row[product].is_empty()).count(), 65);
    for row in rows {
        assert_eq!(row[product].is_empty(), row[note].contains("below the horizon"), "{row:?}");
    }
}

/// *Scene*: a Lambertian soil. *Expected*: derivatives beside the table of the points, which has a row for each value; a sweep
/// that goes on finds the points and writes the same derivatives; and points of a `Grid` in the same folder, which keep no
/// values of randomisations, are run again.
#[test]
fn derivatives_are_written_from_points_that_are_found_again() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let write = |sweep: &str| fs::write(folder.join("soil.ron"), soil(sweep)).unwrap();
    write("Zip({ \"rho\": [0.3, 0.29, 0.31] })");
    sweep(folder);
    write("Derivatives({ \"rho\": 0.01 })");
    let [run, kept] = [
        "3 points run, 0 kept; geometry built once",
        "0 points run, 3 kept; geometry built 0 times",
    ]
    .map(|points| format!("o/sweep.csv: {points}\no/derivatives.csv: 18 derivatives\n"));
    assert_eq!(sweep(folder), run);
    let first = fs::read_to_string(folder.join("o/derivatives.csv")).unwrap();
    assert_eq!(sweep(folder), kept);
    assert_eq!(fs::read_to_string(folder.join("o/derivatives.csv")).unwrap(), first);
    let table = fs::read_to_string(folder.join("o/sweep.csv")).unwrap();
    assert_eq!(
        table.lines().next().unwrap(),
        "rho,sensor,product,unit,term,band,value,standard_error"
    );
    assert!(table.lines().all(|line| line.split(',').count() == 8), "{table}");
    let albedo = first.lines().find(|line| line.contains("albedo")).unwrap();
    let cells: Vec<&str> = albedo.split(',').collect();
    assert_eq!(cells[..8], ["rho", "0.3", "0.01", "p", "albedo", "1", "", "red"]);
    let derivative: f64 = cells[9].parse().unwrap();
    assert!((derivative - 1.0).abs() < 1e-5, "{albedo}");
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("o/summary.json")).unwrap()).unwrap();
    let expected = serde_json::json!({
        "parameters": [{ "parameter": "rho", "at": 0.3, "step": 0.01 }], "rows": 18, "left_out": [],
    });
    assert_eq!(summary["derivatives"], expected);
}
