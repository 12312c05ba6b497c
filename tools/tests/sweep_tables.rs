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
