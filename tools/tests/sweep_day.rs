//! Sweeps over the hours of a day: nights have rows without data, days have sums.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use sunfleck::document::{Spa, Spectrum, Sun, SunPosition};
use tempfile::{TempDir, tempdir};

/// Bare soil of 100 m² under the sun of a summer's or a winter's day.
const SOIL: &str = r#"Scene(
    format: 1,
    params: { "hour": 12.0, "rho": 0.3, "month": 6, "latitude": 52.5 },
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0)],
    materials: { "soil": Lambertian(reflectance: Constant("=rho")) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
    sun: (
        position: Spa(
            date: (2026, "=month", 21), time: ("=hour", 0.0, 0.0), latitude_deg: "=latitude", longitude_deg: 0.0,
        ),
        irradiance: Bands([1.5, 0.8]),
    ),
    boundary: Periodic,
    sensors: { "p": Photons(per_m2: 20.0, measure: [Albedo, Fapar, Absorbed, Fluxes(pixel_m: 10.0), Exitance]) },
    variants: { "winter": { "month": 12 } },
    sweep: Grid({ "hour": [HOURS] }),
)"#;

/// Irradiance perpendicular to the beam in the band `red`, W m⁻² nm⁻¹.
const RED: f64 = 1.5;

const EVERY_3_H: &str = "0.0, 3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0";

fn folder_with(scene: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("soil.ron"), scene).unwrap();
    folder
}

/// Exit code, stdout and stderr.
fn outcome(folder: &Path, arguments: &str) -> (i32, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.current_dir(folder).args(arguments.split(' ')).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// A sweep that must succeed; returns what it prints.
fn swept(folder: &Path, more: &str) -> (String, String) {
    let (code, stdout, stderr) = outcome(folder, &format!("sweep soil.ron --out o{more}"));
    assert_eq!(code, 0, "{stderr}");
    (stdout, stderr)
}

type Row = BTreeMap<String, String>;

fn table(folder: &Path, name: &str) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(folder.join("o").join(name)).unwrap();
    let header = reader.headers().unwrap().clone();
    let row = |row: csv::StringRecord| {
        header.iter().map(str::to_owned).zip(row.iter().map(str::to_owned)).collect()
    };
    reader.records().map(|one| row(one.unwrap())).collect()
}

fn summary(folder: &Path) -> serde_json::Value {
    let text = fs::read_to_string(folder.join("o/summary.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Rows of a product in the band `red` for which `chosen` holds.
fn rows(table: &[Row], product: &str, chosen: impl Fn(&Row) -> bool) -> Vec<Row> {
    let is_one = |row: &&Row| row["product"] == product && row["band"] == "red" && chosen(row);
    table.iter().filter(is_one).cloned().collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap()
}

/// Cosine of the sun's zenith angle at an hour; 0 below the horizon.
fn cosine(month: u32, latitude_deg: f64, hour: f64) -> f64 {
    let sun = Sun {
        zenith_deg: None,
        azimuth_deg: 0.0,
        position: Some(SunPosition::Spa(Spa {
            date: (2026, month, 21),
            time: (hour, 0.0, 0.0),
            utc_offset_h: 0.0,
            latitude_deg,
            longitude_deg: 0.0,
            altitude_m: 0.0,
            pressure_hpa: 1013.25,
            temperature_c: 15.0,
            delta_t_s: None,
        })),
        disc_deg: 0.0,
        irradiance: Spectrum::Constant(1.0),
    };
    sun.angles_deg().map_or(0.0, |(zenith, _)| zenith.to_radians().cos())
}

/// Integral of a function of the hour by the midpoint rule in steps of 36 s.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = ((to - from) * 100.0).round() as usize;
    let step = (to - from) / steps as f64;
    (0..steps).map(|at| f(from + (at as f64 + 0.5) * step) * step).sum()
}

/// The trapezoidal rule, from sunrise to sunset where the sun crosses the horizon between two hours.
fn trapezoids(f: impl Fn(f64) -> f64, hours: &[f64]) -> f64 {
    let rises = |from: f64, to: f64| {
        // The first of many steps by day, coming from the night.
        let at = |step: u32| from + (to - from) * f64::from(step) / 100_000.0;
        (0..=100_000).map(at).find(|&hour| f(hour) > 0.0).unwrap()
    };
    let area = |pair: &[f64]| match (f(pair[0]), f(pair[1])) {
        (0.0, 0.0) => 0.0,
        (0.0, late) => 0.5 * late * (pair[1] - rises(pair[0], pair[1])),
        (early, 0.0) => 0.5 * early * (rises(pair[1], pair[0]) - pair[0]),
        (early, late) => 0.5 * (early + late) * (pair[1] - pair[0]),
    };
    hours.windows(2).map(area).sum()
}

fn hours(from: u32, to: u32) -> String {
    (from..=to).map(|hour| format!("{hour}.0")).collect::<Vec<_>>().join(", ")
}

#[test]
fn a_night_hour_is_a_row_without_data_and_no_end() {
    let folder = folder_with(&SOIL.replace("HOURS", EVERY_3_H));
    let (stdout, stderr) = swept(folder.path(), "");
    assert!(stdout.contains("5 points run, 3 without light, 0 kept"), "{stdout}");
    assert_eq!(stderr.matches("nothing is traced: the sun is").count(), 3, "{stderr}");
    assert!(stderr.contains("at hour=21: nothing is traced"), "{stderr}");
    let all = table(folder.path(), "sweep.csv");
    for (hour, is_night) in [("0.0", true), ("3.0", true), ("6.0", false), ("21.0", true)] {
        let of_hour: Vec<&Row> = all.iter().filter(|row| row["hour"] == hour).collect();
        assert_eq!(of_hour.len() == 1, is_night, "{hour}");
        for row in of_hour {
            assert_eq!(row["value"].is_empty() && row["product"].is_empty(), is_night, "{row:?}");
            assert_eq!(row["note"].contains("below the horizon"), is_night, "{row:?}");
        }
    }
    let summary = summary(folder.path());
    assert_eq!(summary["no_data"].as_object().unwrap().len(), 3, "{summary}");
    let text = fs::read_to_string(folder.path().join("o/points/hour=0/summary.json")).unwrap();
    assert!(text.contains("below the horizon"), "{text}");
    // It goes on where it stopped, across such rows.
    let first = fs::read_to_string(folder.path().join("o/sweep.csv")).unwrap();
    for point in ["hour=3", "hour=12"] {
        fs::remove_file(folder.path().join(format!("o/points/{point}/point.csv"))).unwrap();
    }
    let (stdout, _) = swept(folder.path(), "");
    assert!(stdout.contains("1 point run, 1 without light, 6 kept"), "{stdout}");
    let (stdout, stderr) = swept(folder.path(), "");
    assert!(stdout.contains("0 points run, 8 kept"), "{stdout}");
    assert_eq!(stderr, "");
    assert_eq!(fs::read_to_string(folder.path().join("o/sweep.csv")).unwrap(), first);
    // One such scene alone is an error, as before, and so is any other error in the dark.
    for command in ["run", "check"] {
        let (code, _, stderr) = outcome(folder.path(), &format!("{command} soil.ron --set hour=0"));
        assert_eq!(code, 1, "{stderr}");
        assert!(stderr.contains("below the horizon then"), "{stderr}");
    }
    // A disc that the horizon cuts is no light either: sunset is at 20:24.
    let disc = SOIL.replace("irradiance: Bands", "disc_deg: 0.5, irradiance: Bands");
    let folder = folder_with(&disc.replace("HOURS", "20.3, 20.38, 20.6"));
    let (stdout, stderr) = swept(folder.path(), "");
    assert!(stdout.contains("1 point run, 2 without light"), "{stdout}");
    assert!(stderr.contains("at hour=20.38: nothing is traced: the horizon cuts"), "{stderr}");
    let wrong = SOIL.replace("HOURS", "0.0, 3.0").replace("size_m: (10.0", "size_m: (-10.0");
    let folder = folder_with(&wrong);
    let (code, _, stderr) = outcome(folder.path(), "sweep soil.ron");
    assert_eq!(code, 1);
    assert!(stderr.contains("terrain.size_m"), "{stderr}");
}

#[test]
fn other_light_is_traced_without_the_sun() {
    let sky = "boundary: Periodic, sky: Isotropic(irradiance: Constant(0.2)),";
    let folder = folder_with(&SOIL.replace("HOURS", EVERY_3_H).replace("boundary: Periodic,", sky));
    let (stdout, stderr) = swept(folder.path(), "");
    assert!(stdout.contains("8 points run, 0 kept"), "{stdout}");
    assert_eq!(stderr.matches("the scene is traced without it").count(), 3, "{stderr}");
    let all = table(folder.path(), "sweep.csv");
    let night = rows(&all, "downwelling_top", |row| row["hour"] == "3.0");
    assert!((number(&night[0], "value") - 0.2).abs() < 1e-9, "{night:?}");
    let night = rows(&all, "albedo", |row| row["hour"] == "3.0");
    assert!((number(&night[0], "value") - 0.3).abs() < 1e-3, "{night:?}");
    // Nights add what their sky gives, and lie in the trapezoidal rule like all others.
    let daily = table(folder.path(), "daily.csv");
    let day = rows(&daily, "downwelling_top", |_| true);
    let values: Vec<f64> =
        rows(&all, "downwelling_top", |_| true).iter().map(|row| number(row, "value")).collect();
    let expected: f64 = values.windows(2).map(|pair| 1.5 * (pair[0] + pair[1])).sum::<f64>();
    assert!((number(&day[0], "value") / (expected * 3.6e-3) - 1.0).abs() < 1e-9, "{day:?}");
    for command in ["run", "check"] {
        let (code, _, stderr) = outcome(folder.path(), &format!("{command} soil.ron --set hour=0"));
        assert_eq!(code, 0, "{stderr}");
        assert!(stderr.contains("the scene is traced without it"), "{stderr}");
    }
}

/// *Scene*: soil of 300 K in a thermal and a visible band, by day and by night. *Expected*: the same
/// emission; no reflectance where nothing shines.
#[test]
fn a_thermal_scene_is_measured_at_night() {
    let scene = SOIL
        .replace("(name: \"nir\", center_nm: 865.0)", "(name: \"tir\", center_nm: 10500.0)")
        .replace("Constant(\"=rho\")", "Constant(\"=rho\"), temperature: Uniform(300.0)")
        .replace("boundary: Periodic,", "boundary: Periodic, sky: Fraction([0.2, 0.0]),")
        .replace("HOURS", "0.0, 12.0");
    let views = "Directions(views: PrincipalPlane(max_deg: 30.0, step_deg: 30.0), measure: [Radiance, Brf], until: Samples(64))";
    let scene = scene.replace("sensors: {", &format!("sensors: {{ \"d\": {views},"));
    let folder = folder_with(&scene);
    let (stdout, stderr) = swept(folder.path(), "");
    assert!(stdout.contains("2 points run"), "{stdout}");
    assert!(stderr.contains("at hour=0: the sun is"), "{stderr}");
    let all = table(folder.path(), "sweep.csv");
    let of = |product: &str, band: &str, hour: &str| -> Vec<String> {
        let is_one =
            |row: &&Row| row["product"] == product && row["band"] == band && row["hour"] == hour;
        all.iter().filter(is_one).map(|row| row["value"].clone()).collect()
    };
    assert_eq!(of("radiance", "tir", "0.0").len(), 3);
    assert_eq!(of("radiance", "tir", "0.0"), of("radiance", "tir", "12.0"));
    assert_eq!(of("exitance", "tir", "0.0"), of("exitance", "tir", "12.0"));
    assert_eq!(of("radiance", "red", "0.0"), ["0.0"; 3]);
    assert_eq!(of("albedo", "red", "0.0"), ["NaN"]);
    // A mean with the incident light leaves the night out.
    let day = rows(&table(folder.path(), "daily.csv"), "albedo", |_| true);
    assert!((number(&day[0], "value") - 0.3).abs() < 1e-3, "{day:?}");
}

/// *Expected*: all rows of a polar night are without data; a polar day is the trapezoidal rule over all
/// its hours, the whole day's integral to within that rule.
#[test]
fn polar_nights_and_polar_days() {
    let scene = SOIL.replace("HOURS", &hours(0, 24)).replace("52.5", "80.0");
    let folder = folder_with(&scene);
    let (stdout, _) = swept(folder.path(), " --variant winter");
    assert!(stdout.contains("0 points run, 25 without light, 0 kept"), "{stdout}");
    let all = table(folder.path(), "sweep.csv");
    assert_eq!(all.len(), 25);
    assert!(all.iter().all(|row| row["value"].is_empty() && row["note"].contains("horizon")));
    assert!(!folder.path().join("o/daily.csv").exists());
    let (stdout, _) = swept(folder.path(), " --variant winter");
    assert!(stdout.contains("0 points run, 25 kept"), "{stdout}");
    let (stdout, stderr) = swept(folder.path(), " --force");
    assert!(stdout.contains("25 points run, 0 kept"), "{stdout}");
    assert_eq!(stderr, "");
    let day = rows(&table(folder.path(), "daily.csv"), "downwelling_top", |_| true);
    assert_eq!(day.len(), 1);
    assert_eq!([day[0]["from_h"].as_str(), &day[0]["to_h"]], ["0.0", "24.0"]);
    let expected = 3.6e-3 * RED * integral(|hour| cosine(6, 80.0, hour), 0.0, 24.0);
    let found = number(&day[0], "value") / expected;
    assert!((found - 1.0).abs() < 1e-4, "{found}: a full period by an even rule");
}

/// *Scene*: bare Lambertian soil. *Expected*: it absorbs `(1 - ρ) E cos θ(t)`, whose integral is made here
/// in steps of 36 s. With points every hour the trapezoidal rule is 0.6 to 1.4 % below it, every quarter of
/// an hour less than 0.1 %.
#[test]
fn a_daily_sum_is_the_integral_of_the_closed_form() {
    let winter = " --variant winter";
    for (month, variant, each_hour) in
        [(6, "", &[(1, 0.016)][..]), (12, winter, &[(1, 0.016), (4, 0.0012)])]
    {
        for &(steps, tolerance) in each_hour {
            let hours: Vec<f64> =
                (0..=24 * steps).map(|step| f64::from(step) / f64::from(steps)).collect();
            let by_hand = trapezoids(|hour| cosine(month, 52.5, hour), &hours) * RED * 3.6e-3;
            let times: Vec<String> = hours.iter().map(|hour| format!("{hour:?}")).collect();
            let folder = folder_with(&SOIL.replace("HOURS", &times.join(", ")));
            swept(folder.path(), variant);
            let daily = table(folder.path(), "daily.csv");
            let light = integral(|hour| cosine(month, 52.5, hour), 0.0, 24.0) * RED * 3.6e-3;
            for (product, unit, expected) in [
                ("downwelling_top", "MJ m-2 nm-1", light),
                ("exitance", "MJ m-2 nm-1", 0.3 * light),
                ("absorbed_by_instance", "MJ nm-1", 0.7 * light * 100.0),
            ] {
                let rows = rows(&daily, product, |_| true);
                assert_eq!((rows.len(), rows[0]["unit"].as_str()), (1, unit), "{product}");
                let found = number(&rows[0], "value") / expected;
                assert!((found - 1.0).abs() < tolerance, "{product}, {steps} an hour: {found}");
                assert!(found < 1.0, "the cosine is concave by day: {found}");
            }
            let found = number(&rows(&daily, "downwelling_top", |_| true)[0], "value") / by_hand;
            assert!((found - 1.0).abs() < 1e-6, "{found}");
        }
    }
}

/// *Scene*: soil whose albedo rises over the day. *Expected*: means of it are weighted with the incident
/// light, and errors are the weighted mean of the errors.
#[test]
fn shares_are_means_weighted_with_the_incident_light() {
    let rising = "Constant(\"=rho + 0.02 * hour\")";
    let scene = SOIL.replace("Constant(\"=rho\")", rising).replace("HOURS", &hours(0, 24));
    let folder = folder_with(&scene);
    swept(folder.path(), "");
    let all = table(folder.path(), "sweep.csv");
    let daily = table(folder.path(), "daily.csv");
    let light =
        |f: &dyn Fn(f64) -> f64| integral(|hour| f(hour) * cosine(6, 52.5, hour), 0.0, 24.0);
    let expected = light(&|hour| 0.3 + 0.02 * hour) / light(&|_| 1.0);
    let found = rows(&daily, "albedo", |_| true);
    assert_eq!((found.len(), found[0]["unit"].as_str()), (1, "1"));
    assert!((number(&found[0], "value") - expected).abs() < 2e-3, "{found:?}: {expected}");
    let ground = rows(&daily, "fapar_material", |_| true);
    assert!((number(&ground[0], "value") + number(&found[0], "value") - 1.0).abs() < 1e-6);
    let errors: Vec<f64> =
        rows(&all, "albedo", |_| true).iter().map(|row| number(row, "standard_error")).collect();
    let error = number(&found[0], "standard_error");
    assert!(errors.iter().any(|one| *one >= error) && errors.iter().any(|one| *one <= error));
    // The balance of packets and the like has no sum.
    assert!(rows(&daily, "energy", |_| true).is_empty());
}

#[test]
fn each_value_of_other_parameters_has_its_own_day() {
    let grid = "\"hour\": [6.0, 12.0, 18.0], \"rho\": [0.1, 0.4]";
    let folder = folder_with(&SOIL.replace("\"hour\": [HOURS]", grid));
    swept(folder.path(), "");
    let daily = table(folder.path(), "daily.csv");
    let days = rows(&daily, "exitance", |_| true);
    let of = |rho: &str| days.iter().find(|row| row["rho"] == rho).unwrap().clone();
    assert_eq!(days.len(), 2);
    assert!(!daily[0].contains_key("hour"));
    let [low, high] = [number(&of("0.1"), "value"), number(&of("0.4"), "value")];
    assert!((high / low - 4.0).abs() < 0.02, "{low} {high}");
    assert_eq!([days[0]["from_h"].as_str(), &days[0]["to_h"]], ["6.0", "18.0"]);
    let json = summary(folder.path());
    let entries = json["daily"].as_array().unwrap();
    assert_eq!(entries.len(), daily.len());
    assert_eq!(entries[0]["params"]["rho"], 0.1);
    // Months are other days; neither dates, nor reflectances, nor one hour alone have sums.
    let months = SOIL.replace("\"hour\": [HOURS]", "\"month\": [6, 7], \"hour\": [11.0, 12.0]");
    let folder = folder_with(&months);
    swept(folder.path(), "");
    assert_eq!(rows(&table(folder.path(), "daily.csv"), "albedo", |_| true).len(), 2);
    swept(folder.path(), " --set hour=12 --force");
    assert!(!folder.path().join("o/daily.csv").exists(), "it was of another sweep");
    for grid in ["\"month\": [6, 7]", "\"rho\": [0.1, 0.2]", "\"hour\": [12.0, 12.0]"] {
        let folder = folder_with(&SOIL.replace("\"hour\": [HOURS]", grid));
        swept(folder.path(), "");
        assert!(!folder.path().join("o/daily.csv").exists(), "{grid}");
        assert!(summary(folder.path()).get("daily").is_none());
    }
}
