//! Derivatives of results with respect to parameters of a scene.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use sunfleck::output::{DerivativeTable, PointTables, Results, SweepTable};
use sunfleck::products::SweepPoint;
use sunfleck::run::{Failure, Options, SweepRun, Unwatched};
use sunfleck_tests::{Estimate, SceneText, albedo_of_sheets, product};

/// A row of `derivatives.csv`.
struct Row {
    parameter: String,
    sensor: String,
    product: String,
    band: String,
    zenith_deg: String,
    value: f64,
    derivative: Estimate,
}

impl Row {
    fn is_of(&self, parameter: &str, sensor: &str, product: &str) -> bool {
        (&*self.parameter, &*self.sensor, &*self.product) == (parameter, sensor, product)
    }
}

/// Sweeps a scene as the command does, with `quality` times its samples; returns the rows of its derivatives.
fn derivatives(scene: &SceneText, quality: f64) -> Vec<Row> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_derivatives(scene, quality, folder.path());
    let text = fs::read(folder.path().join("out/derivatives.csv")).expect("derivatives");
    let mut reader = csv::Reader::from_reader(text.as_slice());
    let header = reader.headers().expect("a header").clone();
    let row = |record: csv::StringRecord| {
        let cell = |name: &str| {
            let place = header.iter().position(|column| column == name);
            place.map_or_else(String::new, |place| record[place].to_owned())
        };
        let number = |name: &str| cell(name).parse().expect("a number");
        Row {
            parameter: cell("parameter"),
            sensor: cell("sensor"),
            product: cell("product"),
            band: cell("band"),
            zenith_deg: cell("zenith_deg"),
            value: number("value"),
            derivative: Estimate { value: number("derivative"), error: number("standard_error") },
        }
    };
    reader.records().map(|record| row(record.expect("a row"))).collect()
}

fn write_derivatives(scene: &SceneText, quality: f64, folder: &Path) {
    let (file, out) = (folder.join("test.ron"), folder.join("out"));
    fs::write(&file, scene.to_string()).expect("a file");
    let options = Options { quality, ..Options::default() };
    let mut sweep =
        SweepRun::read(&file, &options, &Unwatched).unwrap_or_else(|failure| panic!("{failure}"));
    let points = sweep.points().to_vec();
    let mut tables = PointTables::open(&out, &points).expect("tables");
    for (group, places) in sweep.groups().to_vec().into_iter().enumerate() {
        let of_group: Vec<SweepPoint> = places.iter().map(|&at| points[at].clone()).collect();
        let run = sweep.run(group, &Unwatched, |part, reports| {
            let all: Vec<usize> = (0..part.len()).collect();
            tables.write(&reports, &of_group[part], &all).expect("tables can be written");
            Ok::<_, Failure>(())
        });
        run.unwrap_or_else(|failure| panic!("{failure}"));
    }
    let derivatives = DerivativeTable::new(sweep.differences(), &points, &tables).expect("tables");
    let table = SweepTable::new(&points, &tables).expect("tables");
    let results = Results::open(&out, "sweep", &file, true).expect("a folder");
    results
        .write_sweep(&sweep.report(), &points, &table, None, derivatives.as_ref())
        .expect("files can be written");
}

/// The error of reading a sweep.
fn refusal(scene: &SceneText) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("test.ron");
    fs::write(&file, scene.to_string()).expect("a file");
    match SweepRun::read(&file, &Options::default(), &Unwatched) {
        Ok(_) => panic!("these derivatives are refused"),
        Err(failure) => failure.to_string(),
    }
}

/// The rows of a product with respect to a parameter.
fn rows<'a>(all: &'a [Row], parameter: &str, sensor: &str, product: &str) -> Vec<&'a Row> {
    let found: Vec<&Row> = all.iter().filter(|row| row.is_of(parameter, sensor, product)).collect();
    assert!(!found.is_empty(), "{parameter} {sensor} {product}");
    found
}

/// *Scene*: level Lambertian ground of the reflectance `ρ` under the irradiance `e cos θ`, of which the sky gives the share `f`,
/// and black ground that emits. *Expected*, within 4.5 standard errors and the rounding of f32: with respect to `ρ`, 1 of
/// reflectance factors and albedo; with respect to `e`, 0 of them and `ρ cos θ / π` of the radiance; with respect to `f`, 0
/// of all; with respect to the sun's zenith angle, `-π/180 tan θ` times the downwelling flux; of
/// a black body's brightness temperature with respect to its temperature, 1.
#[test]
fn bare_ground_has_the_derivatives_of_its_closed_forms() {
    let scene = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("params", r#""rho": 0.3, "e": 1.5, "f": 0.2, "sza": 40.0, "k": 300.0"#)
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "tir", center_nm: 10500.0)"#)
        .with("materials", r#""soil": Lambertian(reflectance: Bands(["=rho", 0.0]), temperature: Uniform("=k"))"#)
        .with("sun", r#"zenith_deg: "=sza", irradiance: Bands(["=e", 0.0])"#)
        .with("sky", r#"Fraction(["=f", 0.0])"#)
        .with("boundary", "Periodic")
        .with("sensors", r#"
            "image": Orthographic(size_px: (3, 2), extent_m: (3.0, 2.0), samples_per_px: 8, measure: [Brf, Radiance, BrightnessTemperature]),
            "forward": Orthographic(size_px: (3, 2), extent_m: (3.0, 2.0), samples_per_px: 50, system: Forward, measure: [Brf]),
            "views": Directions(views: List([(0.0, 0.0), (40.0, 90.0)]), until: Samples(2000), measure: [Brf, Radiance, BrightnessTemperature]),
            "paths": Directions(views: List([(40.0, 90.0)]), until: Samples(2000), system: Backward, measure: [Brf, Radiance]),
            "photons": Photons(per_m2: 2000.0, measure: [Albedo, Fluxes(pixel_m: 2.0), BrfCones([(0.0, 0.0, 40.0)])])"#)
        .with("sweep", r#"Derivatives(["rho", "e", "f", "sza", "k"])"#);
    let all = derivatives(&scene, 1.0);
    let down = 1.5 * 40_f64.to_radians().cos();
    let l = 0.3 * down / PI;
    let by_angle = -40_f64.to_radians().tan() * 1_f64.to_radians();
    // The difference over 0.4°, in place of the derivative.
    let by_angle = by_angle * 0.4_f64.to_radians().sin() / 0.4_f64.to_radians();
    let factors = ["image", "forward", "views", "paths"].map(|sensor| (sensor, "hdrf"));
    let factors = factors.into_iter().chain([("photons", "albedo"), ("photons", "hdrf_cones")]);
    let radiances = ["image", "views", "paths"].map(|sensor| (sensor, "radiance"));
    let mut expected = Vec::new();
    for (sensor, name) in factors {
        expected.extend([
            ("rho", sensor, name, 1.0),
            ("e", sensor, name, 0.0),
            ("f", sensor, name, 0.0),
        ]);
    }
    for (sensor, name) in radiances {
        expected.extend([
            ("rho", sensor, name, down / PI),
            ("e", sensor, name, l / 1.5),
            ("f", sensor, name, 0.0),
            ("sza", sensor, name, l * by_angle),
        ]);
    }
    expected.push(("sza", "photons", "downwelling_terrain", down * by_angle));
    expected.push(("rho", "photons", "upwelling_terrain", down));
    for (parameter, sensor, name, truth) in expected {
        for row in rows(&all, parameter, sensor, name).iter().filter(|row| row.band == "red") {
            let Estimate { value, error } = row.derivative;
            let near = 4.5 * error + 3e-5;
            assert!(
                (value - truth).abs() < near,
                "{parameter} {sensor} {name}: {value} {error} {truth}"
            );
            // Packets hit few pixels of the small image, and those of sun and sky others.
            let is_precise =
                parameter == "f" || sensor == "forward" || error <= 0.02 * truth.abs() + 1e-9;
            assert!(is_precise, "{parameter} {sensor} {name}: {error}");
        }
    }
    for sensor in ["image", "views"] {
        for row in rows(&all, "k", sensor, "brightness_temperature") {
            assert!((row.derivative.value - 1.0).abs() < 1e-4, "{:?}", row.derivative);
        }
    }
}

/// *Scene*: two sheets of leaf over soil. *Expected*: the derivatives of the albedo with respect to reflectance and transmittance of
/// the leaf and reflectance of the soil by adding layers, within 4.5 standard errors; and these are at most 2 % of the derivative.
#[test]
fn sheets_have_the_derivatives_of_adding_layers() {
    let own = [0.3, 0.4, 0.2];
    let scene = SceneText::sheets(&[(0.0, 0.0, 0.0)], &[1.0, 2.0])
        .with("params", r#""r": 0.3, "t": 0.4, "s": 0.2"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=s")), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant("=t"))"#)
        .with("sensors", r#""p": Photons(per_m2: 2000.0, measure: [Albedo])"#)
        .with("sweep", r#"Derivatives(["r", "t", "s"])"#);
    let all = derivatives(&scene, 1.0);
    for (place, parameter) in ["r", "t", "s"].into_iter().enumerate() {
        let at = |sign: f64| {
            let mut optics = own;
            optics[place] *= 1.0 + 0.01 * sign;
            let [r, t, s] = optics;
            albedo_of_sheets((r, t, s), 2)
        };
        let truth = (at(1.0) - at(-1.0)) / (0.02 * own[place]);
        let [row] = rows(&all, parameter, "p", "albedo")[..] else { panic!("one band") };
        assert!(row.derivative.z(truth).abs() < 4.5, "{parameter}: {:?} {truth}", row.derivative);
        assert!(row.derivative.error < 0.02 * truth, "{parameter}: {:?}", row.derivative);
    }
}

/// *Scene*: trees with black leaves over soil of the reflectance `ρ`, whose radiance is linear in it. *Expected*: the derivative is
/// the value over `ρ`, path by path: the same for its standard error, of all sensors.
#[test]
fn what_is_linear_in_a_parameter_has_its_value_over_it_as_derivative() {
    let scene = SceneText::trees_in_daylight("Periodic")
        .with("params", r#""rho": 0.2"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=rho")), "leaf": Leaf(reflectance: Constant(0.0), transmittance: Constant(0.0))"#)
        .with("sensors", SENSORS)
        .with("sweep", r#"Derivatives({ "rho": 0.05 })"#);
    let own = scene.clone().with("params", r#""rho": 0.2"#).measure();
    let all = derivatives(&scene, 1.0);
    let mut count = 0;
    for (sensor, name) in LIGHT {
        let own = product(&own, sensor, name);
        for (index, row) in rows(&all, "rho", sensor, name).into_iter().enumerate() {
            let near = |a: f64, b: f64, limit: f64| (a - b).abs() <= limit * b.abs();
            assert!(near(row.derivative.value, row.value / 0.2, 1e-5), "{sensor} {name}");
            // Points that share paths have other representative bands than one alone.
            assert!(near(row.value, own.values[index], 0.05), "{sensor} {name}");
            // The error of the error of an image, by half-samples and by pixels, is 13 %.
            let limit = if sensor == "image" { 0.5 } else { 0.2 };
            let error = own.standard_error[index] / 0.2;
            assert!(
                near(row.derivative.error, error, limit),
                "{sensor}: {:?} {error}",
                row.derivative
            );
            count += 1;
        }
    }
    assert_eq!(count, 2 * (1 + 1 + 3 + 1 + 1));
}

/// Sensors of the trees, and products of theirs.
const SENSORS: &str = r#"
    "photons": Photons(per_m2: 40.0, measure: [Albedo, Fluxes(pixel_m: 1.0)]),
    "views": Directions(views: List([(0.0, 0.0), (30.0, 60.0), (50.0, 200.0)]), until: Samples(1000)),
    "paths": Directions(views: List([(30.0, 60.0)]), until: Samples(8000)),
    "image": Orthographic(size_px: (16, 16), extent_m: (5.0, 5.0), samples_per_px: 32)"#;
const LIGHT: [(&str, &str); 5] = [
    ("photons", "albedo"),
    ("photons", "upwelling_top"),
    ("views", "hdrf"),
    ("paths", "hdrf"),
    ("image", "hdrf"),
];

/// *Scene*: trees at sensors of all kinds. Parameters of optics, on the same paths; of the sun, whose points share the paths of
/// some sensors; and of a place, whose points are runs of their own with the same random numbers. *Expected*: over 40
/// seeds, deviations from the derivatives of a long run in standard errors whose mean square is at most that of Student's t with 31
/// degrees of freedom, 31/29, as far as 40 numbers tell, and 0.85 to 1.4 over all (measured: 1.11; 300 seeds of the image alone
/// with 32 samples per pixel: 1.05, 1.25 and 0.99 of `r`, `t` and `f`).
#[test]
fn standard_errors_of_derivatives_are_right() {
    const SEEDS: u32 = 40;
    let scene = |seed: u32| {
        SceneText::trees_in_daylight("Periodic")
            .with("params", r#""r": 0.4, "t": 0.3, "f": 0.3, "sza": 40.0, "x": 3.0"#)
            .with("bands", r#"(name: "nir", center_nm: 865.0)"#)
            .with("materials", r#""soil": Lambertian(reflectance: Constant(0.2)), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant("=t"))"#)
            .with("instances", r#"List(of: "tree", at_m: [(0.2, 2.0, 0.0), ("=x", 4.9, 0.0)])"#)
            .with("sun", r#"zenith_deg: "=sza", azimuth_deg: 10.0, irradiance: Constant(1.0)"#)
            .with("sky", r#"Fraction(["=f"])"#)
            .with("sensors", SENSORS)
            .with("transport", format!("seed: {seed}"))
            .with("sweep", r#"Derivatives({ "r": 0.01, "t": 0.01, "f": 0.01, "sza": 2.0, "x": 0.2 })"#)
    };
    let long = derivatives(&scene(1000), 50.0);
    let runs: Vec<Vec<Row>> = (0..SEEDS).map(|seed| derivatives(&scene(seed), 1.0)).collect();
    let mut means = Vec::new();
    for parameter in ["r", "t", "f", "sza", "x"] {
        for (sensor, name) in LIGHT {
            let truth = rows(&long, parameter, sensor, name);
            let mut squares = Vec::new();
            for run in &runs {
                for (row, truth) in rows(run, parameter, sensor, name).into_iter().zip(&truth) {
                    assert_eq!(row.zenith_deg, truth.zenith_deg);
                    squares.push(row.derivative.z_against(truth.derivative).powi(2));
                }
            }
            let mean = squares.iter().sum::<f64>() / squares.len() as f64;
            // Views share their packets: three count as one.
            let limit = 31.0 / 29.0 * (1.0 + 4.5 * (2.0 / f64::from(SEEDS)).sqrt());
            assert!(mean < limit, "{parameter} {sensor} {name}: {mean}");
            means.push(mean);
        }
    }
    let mean = means.iter().sum::<f64>() / means.len() as f64;
    assert!((0.85..1.4).contains(&mean), "{mean}: {means:?}");
}

/// *Scene*: the trees on the same paths. *Expected*: the standard error of a derivative with respect to the leaf's reflectance is
/// less than a twentieth of that of a difference between independent runs.
#[test]
fn a_derivative_has_far_less_noise_than_independent_points() {
    let scene = SceneText::trees_in_daylight("Periodic")
        .with("params", r#""r": 0.5"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant(0.2)), "leaf": Leaf(reflectance: Constant("=r"), transmittance: Constant(0.3))"#)
        .with("sensors", SENSORS)
        .with("sweep", r#"Derivatives(["r"])"#);
    let all = derivatives(&scene, 1.0);
    let own = scene.measure();
    for (sensor, name) in [("photons", "albedo"), ("views", "hdrf"), ("image", "hdrf")] {
        let independent = product(&own, sensor, name).standard_error[0] * 2_f64.sqrt() / 0.01;
        let error = rows(&all, "r", sensor, name)[0].derivative.error;
        assert!(error < 0.05 * independent, "{sensor}: {error} {independent}");
    }
}

/// *Expected*: gap fractions and components have no derivatives, and take none from the products beside them; a denoised image,
/// whose mean is that of the plain one, has its derivative.
#[test]
fn what_is_not_made_of_light_has_no_derivatives() {
    let scene = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("params", r#""rho": 0.3"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=rho"))"#)
        .with("sun", "zenith_deg: 30.0, irradiance: Constant(2.0)")
        .with("boundary", "Periodic")
        .with("sensors", r#""i": Orthographic(size_px: (8, 8), extent_m: (4.0, 4.0), samples_per_px: 4, measure: [Brf, GapFraction, Radiance, FourComponents], denoised: true)"#)
        .with("sweep", r#"Derivatives(["rho"])"#);
    let found: Vec<(String, f64)> = derivatives(&scene, 1.0)
        .into_iter()
        .map(|row| (row.product, row.derivative.value))
        .collect();
    let names: Vec<&str> = found.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["brf", "brf_denoised", "radiance", "radiance_denoised"]);
    let radiance = 2.0 * 30_f64.to_radians().cos() / PI;
    for ((name, value), truth) in found.iter().zip([1.0, 1.0, radiance, radiance]) {
        assert!((value - truth).abs() < 1e-5, "{name}: {value}");
    }
}

/// *Expected*: a parameter that follows from another by a formula follows it, so that a derivative is that of the scene as a
/// function of one parameter.
#[test]
fn parameters_follow_each_other_by_their_formulas() {
    let scene = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("params", r#""a": 0.1, "b": "=2*a""#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=a + b"))"#)
        .with("sun", "zenith_deg: 0.0, irradiance: Constant(1.0)")
        .with("boundary", "Periodic")
        .with("sensors", r#""p": Photons(per_m2: 50.0, measure: [Albedo])"#)
        .with("sweep", r#"Derivatives(["a", "b"])"#);
    let all = derivatives(&scene, 1.0);
    for (parameter, truth) in [("a", 3.0), ("b", 1.0)] {
        let value = rows(&all, parameter, "p", "albedo")[0].derivative.value;
        assert!((value - truth).abs() < 1e-4, "{parameter}: {value}");
    }
}

/// *Expected*: derivatives at the value that is set in place of the scene's own.
#[test]
fn derivatives_are_taken_at_values_that_are_set() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("test.ron");
    let scene = SceneText::bare(0.0, "size_m: (4.0, 4.0)")
        .with("params", r#""rho": 0.3"#)
        .with("materials", r#""soil": Lambertian(reflectance: Constant("=rho"))"#)
        .with("sun", "zenith_deg: 0.0, irradiance: Constant(1.0)")
        .with("sensors", r#""p": Photons(per_m2: 50.0, measure: [Albedo])"#)
        .with("sweep", r#"Derivatives(["rho"])"#);
    fs::write(&file, scene.to_string()).expect("a file");
    let mut options = Options::default();
    options.document.set.push(("rho".to_owned(), 0.5.into()));
    let sweep =
        SweepRun::read(&file, &options, &Unwatched).unwrap_or_else(|failure| panic!("{failure}"));
    let names: Vec<String> = sweep.points().iter().map(SweepPoint::name).collect();
    assert_eq!(names, ["rho=0.5", "rho=0.495", "rho=0.505"]);
    let [difference] = sweep.differences() else { panic!("one parameter") };
    assert_eq!((difference.at, difference.sides, difference.points), (0.5, [0.495, 0.505], [1, 2]));
    assert_eq!(sweep.groups(), [[0, 1, 2]]);
}

/// *Expected*: parameters that change whole numbers, names or nothing are refused, with the place of what they change.
#[test]
fn what_is_no_real_number_has_no_derivative() {
    let scene = SceneText::bare(0.2, "size_m: (4.0, 4.0)")
        .with("params", r#""n": 20.0"#)
        .with("sun", "zenith_deg: 0.0, irradiance: Constant(1.0)")
        .with("boundary", "Periodic");
    let refused = |cells: &str| {
        let sensors = format!(r#""p": Photons(per_m2: 50.0, measure: [BrfCells("{cells}")])"#);
        let sweep = r#"Derivatives({ "n": 1.5 })"#;
        refusal(&scene.clone().with("sensors", sensors).with("sweep", sweep))
    };
    let texts = ["=n", "=round(n)", "=10*round(n/100)+10"].map(refused);
    let texts = texts.map(|text| without_folder(&text));
    insta::assert_snapshot!(texts.join("\n"));
}

/// A text without the folder of the scene.
fn without_folder(text: &str) -> String {
    let line = |line: &str| match line.split_once("--> ") {
        Some((start, place)) => format!("{start}--> {}", place.rsplit('/').next().unwrap_or(place)),
        None => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}
