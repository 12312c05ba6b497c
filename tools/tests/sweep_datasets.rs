//! Data sets of sweeps, read by xarray against `sweep.csv`.
//!
//! Needs a Python with `numpy`, `xarray`, `zarr` and `netCDF4`: `python3`, or the one that `SUNFLECK_PYTHON` names. Without
//! it the comparison is skipped, and says so.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stderr, reason = "a skipped test says why")]

use std::fs;
use std::path::Path;
use std::process::Command;

/// A scene with a sun that may stand below the horizon.
fn scene(sweep: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    params: {{ "hour": 12.0, "rho": 0.2, "name_of_soil": "a" }},
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.5, width_nm: 20.0)],
    spectra: {{ "a": Constant("=rho"), "b": Bands([0.1, 0.3]) }},
    materials: {{ "soil": Lambertian(reflectance: Named("=name_of_soil")) }},
    terrain: Plane(size_m: (30.0, 20.0), material: "soil"),
    sun: (
        position: Spa(date: (2026, 6, 21), time: ("=hour", 0.0, 0.0), latitude_deg: 52.5, longitude_deg: 0.0),
        irradiance: Bands([1.5, 0.8]),
    ),
    sensors: {{
        "top": Orthographic(size_px: (6, 4), extent_m: (30.0, 20.0), samples_per_px: 4, measure: [Brf]),
        "plane": Directions(views: List([(0.0, 0.0), (30.0, 90.0)]), until: Samples(1000), measure: [Brf]),
        "f": Photons(per_m2: 5.0, measure: [Albedo]),
    }},
    sweep: {sweep},
    output: [Zarr, NetCdf],
)"#
    )
}

/// *Expected*: values and errors of the table bit for bit, at their parameters; NaN without light.
#[test]
fn data_sets_of_a_sweep_hold_its_table() {
    let sweeps = [
        (r#"Grid({ "hour": [2.0, 10.0, 12.0], "rho": [0.1, 0.4] })"#, "hour,rho", "hour,rho"),
        (
            r#"Grid({ "name_of_soil": ["a", "b"], "rho": [0.1, 0.4] })"#,
            "name_of_soil,rho",
            "name_of_soil,rho",
        ),
        (r#"Zip({ "hour": [8.0, 11.0, 15.0], "rho": [0.1, 0.1, 0.3] })"#, "hour,rho", "point"),
    ];
    for (sweep, parameters, dimensions) in sweeps {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.ron"), scene(sweep)).unwrap();
        let run = Command::new(env!("CARGO_BIN_EXE_sunfleck"))
            .args(["sweep", "a.ron", "--out", "out"])
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let script = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/readers/sweeps.py"));
        let python = std::env::var_os("SUNFLECK_PYTHON").unwrap_or_else(|| "python3".into());
        let mut command = Command::new(python);
        command.arg(script).arg(folder.path().join("out")).args([parameters, dimensions]);
        let Ok(read) = command.output() else {
            eprintln!("skipped: there is no Python");
            return;
        };
        let [said, wrong] = [&read.stdout, &read.stderr].map(|text| String::from_utf8_lossy(text));
        if read.status.code() == Some(77) {
            eprintln!("skipped: {said}");
            return;
        }
        assert!(read.status.success(), "{sweep}: {said}{wrong}");
    }
}
