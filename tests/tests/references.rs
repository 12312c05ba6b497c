//! Turbid layers of leaves against tables by adding and doubling (`../shared/reference`): all fluxes
//! under sun and isotropic sky, and the BRF and its orders in three planes, away from the hot spot.
//!
//! A layer of discs of 1 cm that is 40 m high is turbid: by Kuusk's kernel the tail of its hot spot
//! raises single scattering 5° off by 0.3 %, 20° off by less than 0.1 %. Its leaves are drawn anew 32
//! times; the spread between these is the error, that of the leaves' places included, so that z
//! follows Student's t with 31 degrees of freedom: 4.66 of its errors are as rare as 4 of the normal
//! distribution's.
//!
//! `SUNFLECK_FULL=1 cargo test --release -p sunfleck-tests --test references -- --nocapture` compares
//! every row at a relative standard error of 0.2 % and prints the table (`SUNFLECK_FULL=0.004` at 0.4 %, in a
//! quarter of the time), which takes hours: `SUNFLECK_CASES=HOM03,R4P1D_LAI2.5` takes only the cases whose
//! names begin so. Without it, every 12th direction of six layers of 20 m at 2 %.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use sunfleck::run::Options;
use sunfleck::statistics::Spread;
use sunfleck_tests::{measure, product, shared};

/// Standard errors that a value may be off: two-sided significance 6e-5 of Student's t.
const MOST: f64 = 4.66;

/// Layers drawn.
const LAYERS: u32 = 32;

/// Below this, a value of which no layer saw anything is not compared, such as that of soil seen at a slant through
/// five layers of leaves: 32 times nothing has no spread to tell an error from.
const RARE: f64 = 4e-5;

/// Standard error of the tables, half of the 1.1e-5 by which their energy is off at most.
const TABLE_ERROR: f64 = 5e-6;

/// Degrees about the sun that the hot spot takes.
const HOT_SPOT_DEG: f64 = 5.0;

/// The golden angle off the tile's sides: along them the ways of light down and up would meet the same
/// leaves again and again, period by period.
const SUN_AZIMUTH_DEG: f64 = 137.508;

fn is_full() -> bool {
    std::env::var_os("SUNFLECK_FULL").is_some()
}

/// Relative standard error to aim for.
fn relative_error() -> f64 {
    let written = std::env::var("SUNFLECK_FULL").ok();
    let full = written.map(|text| text.parse().ok().filter(|error| *error < 0.1).unwrap_or(0.002));
    full.unwrap_or(0.02)
}

/// A row of the table of fluxes, and those of its BRF.
struct Case {
    name: String,
    leaf: (f64, f64),
    soil: f64,
    /// Albedo, absorbed by leaves, transmitted in all and uncollided; under the sun and under the sky.
    sun: Vec<f64>,
    sky: Vec<f64>,
    views: Vec<View>,
}

/// A direction, and BRF there: in all, collided once by leaves, by the soil alone, and more often.
#[derive(Clone)]
struct View {
    zenith: f64,
    relative_azimuth: f64,
    brf: Vec<f64>,
}

/// Cases of the same leaves and sun: kind of leaf angles, LAI and zenith angle, as they are written.
type Groups = BTreeMap<(String, String, String), Vec<Case>>;

fn rows(path: &Path) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(path).expect("a table");
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn numbers(cells: &[String]) -> Vec<f64> {
    cells.iter().map(|cell| cell.parse().expect("a number")).collect()
}

/// Cosine of the angle between two directions.
fn cosine(zenith: f64, other: f64, azimuth: f64) -> f64 {
    let (a, b) = (zenith.to_radians(), other.to_radians());
    a.cos() * b.cos() + a.sin() * b.sin() * azimuth.to_radians().cos()
}

/// Whether a case is asked for.
fn is_wanted(name: &str) -> bool {
    match std::env::var("SUNFLECK_CASES") {
        Ok(wanted) if is_full() => wanted.split(',').any(|start| name.starts_with(start)),
        _ => true,
    }
}

fn groups(folder: &Path) -> Groups {
    let mut views: BTreeMap<String, Vec<View>> = BTreeMap::new();
    for row in rows(&folder.join("turbid_brf.csv")) {
        let [sun, zenith, relative_azimuth] = [1, 2, 3].map(|at| row[at].parse().expect("degrees"));
        if cosine(sun, zenith, relative_azimuth) < HOT_SPOT_DEG.to_radians().cos() {
            let view = View { zenith, relative_azimuth, brf: numbers(&row[4..8]) };
            views.entry(row[0].clone()).or_default().push(view);
        }
    }
    let mut groups = Groups::new();
    for row in rows(&folder.join("turbid_flux.csv")).iter().filter(|row| is_wanted(&row[0])) {
        let optics = numbers(&row[3..6]);
        let all = views.remove(&row[0]).unwrap_or_default();
        let step = if is_full() { 1 } else { 12 };
        let case = Case {
            name: row[0].clone(),
            leaf: (optics[0], optics[1]),
            soil: optics[2],
            sun: numbers(&row[8..12]),
            sky: numbers(&row[12..16]),
            views: all.into_iter().step_by(step).collect(),
        };
        groups.entry((row[1].clone(), row[2].clone(), row[6].clone())).or_default().push(case);
    }
    if !is_full() {
        let quick = [
            ("spherical", "3.0", "20"),
            ("planophile", "3.0", "50"),
            ("planophile", "1.0", "30"),
            ("spherical", "2.0", "0"),
            ("spherical", "0.5", "60"),
            ("spherical", "1.5", "83"),
        ];
        groups.retain(|(lad, lai, sun), _| {
            quick.contains(&(lad.as_str(), lai.as_str(), sun.as_str()))
        });
        assert_eq!(groups.len(), quick.len());
    }
    groups
}

/// All that one layer measures of a group, in the order of [`expected`].
fn measured(
    (lad, lai, sun): &(String, String, String),
    cases: &[Case],
    layer: u32,
    error: f64,
) -> Vec<f64> {
    let (side, height) = if is_full() { (3.0, 40.0) } else { (1.0, 20.0) };
    let list = |of: &dyn Fn(&Case) -> f64| cases.iter().map(of).collect::<Vec<_>>();
    let angle = match lad.as_str() {
        "spherical" => "Spherical",
        "planophile" => "Planophile",
        other => panic!("{other} is no distribution of leaf angles in the table"),
    };
    let mut bands = String::new();
    for index in 0..cases.len() {
        write!(bands, r#"(name: "b{index}", center_nm: 865.0), "#).expect("memory");
    }
    // As many as give this error if one has a relative deviation of 1.
    let samples = (error.powi(-2) / f64::from(LAYERS)).ceil();
    let photons = format!(
        "Photons(per_m2: {}, measure: [Albedo, Fapar(layer_m: 200.0)])",
        samples / (side * side)
    );
    let views = &cases[0].views;
    let mut sensors = format!(r#""photons": {photons},"#);
    if !views.is_empty() {
        let views: Vec<_> = views
            .iter()
            .map(|view| (view.zenith, SUN_AZIMUTH_DEG + view.relative_azimuth))
            .collect();
        // A packet, which serves all views, tells each about as much as a path of its own.
        let system = if is_full() { "Forward" } else { "Backward" };
        write!(
            sensors,
            r#""views": Directions(system: {system}, views: List({views:?}), until: Samples({samples}), measure: [Brf, Orders])"#
        )
        .expect("memory");
    }
    let run = |light: &str, sensors: &str| {
        let text = format!(
            r#"Scene(
    format: 1,
    bands: [{bands}],
    materials: {{
        "soil": Lambertian(reflectance: Bands({:?})),
        "leaf": Leaf(reflectance: Bands({:?}), transmittance: Bands({:?})),
    }},
    meshes: {{ "layer": Crown(
        shape: Box(size_m: ({side:?}, {side:?}, {height:?})), base_m: 0.01, leaf_area_m2: {:?},
        leaf_angle: {angle}, leaf: Disc(radius_m: 0.01), leaf_material: "leaf", seed: {layer},
    ) }},
    terrain: Plane(size_m: ({side:?}, {side:?}), material: "soil"),
    instances: [List(of: "layer", at_m: [({:?}, {:?}, 0.0)])],
    {light}
    boundary: Periodic,
    sensors: {{ {sensors} }},
    transport: (seed: {layer}),
)"#,
            list(&|case| case.soil),
            list(&|case| case.leaf.0),
            list(&|case| case.leaf.1),
            lai.parse::<f64>().expect("a leaf area index") * side * side,
            side / 2.0,
            side / 2.0,
        );
        measure(&text, Path::new("."), &Options::default())
    };
    let under_sun = run(
        &format!(
            "sun: (zenith_deg: {sun}, azimuth_deg: {SUN_AZIMUTH_DEG}, irradiance: Constant(1.0)),"
        ),
        &sensors,
    );
    let under_sky =
        run("sky: Isotropic(irradiance: Constant(1.0)),", &format!(r#""photons": {photons}"#));
    let mut all = Vec::new();
    for report in [&under_sun, &under_sky] {
        // The first two terms of transmission: in all, and uncollided.
        for (name, term) in [("albedo", 0), ("fapar_vegetation", 0), ("ftran", 0), ("ftran", 1)] {
            let product = product(report, "photons", name);
            all.extend_from_slice(&product.values[term * cases.len()..(term + 1) * cases.len()]);
        }
    }
    if !views.is_empty() {
        for name in ["brf", "brf_co_sgl", "brf_uc", "brf_mlt"] {
            all.extend_from_slice(&product(&under_sun, "views", name).values);
        }
    }
    all
}

/// What the tables say, and of what: fluxes by light, quantity and case; BRF by order, view and case.
fn expected(cases: &[Case]) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    for light in ["sun", "sky"] {
        for (at, name) in ["albedo", "absorbed", "transmitted", "uncollided"].iter().enumerate() {
            all.extend(cases.iter().map(|case| {
                let values = if light == "sun" { &case.sun } else { &case.sky };
                (format!("{},{name} {light}", case.name), values[at])
            }));
        }
    }
    for (at, name) in ["brf", "brf_co_sgl", "brf_uc", "brf_mlt"].iter().enumerate() {
        for view in 0..cases[0].views.len() {
            all.extend(cases.iter().map(|case| {
                let View { zenith, relative_azimuth, brf } = &case.views[view];
                (format!("{},{name} {zenith} {relative_azimuth}", case.name), brf[at])
            }));
        }
    }
    all
}

/// *Scene*: layers of leaf area indices of 0.5 to 5, spherical and planophile, RAMI's and RAMI4PILPS's
/// optics. *Expected*: the tables' fluxes and BRF.
#[test]
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn layers_of_small_leaves_have_the_fluxes_and_the_brf_of_a_turbid_medium() {
    let Some(shared) = shared() else { return };
    let (mut squares, mut unseen) = ((0, 0.0), 0);
    let mut wrong = Vec::new();
    println!("case,quantity,expected,measured,error,z");
    for (group, cases) in &groups(&shared.join("reference")) {
        let layers: Vec<Vec<f64>> =
            (1..=LAYERS).map(|layer| measured(group, cases, layer, relative_error())).collect();
        let expected = expected(cases);
        let spread = Spread::from_rows(expected.len(), layers.iter().map(Vec::as_slice));
        let errors = spread.standard_error();
        for (((what, expected), found), error) in expected.iter().zip(spread.mean()).zip(errors) {
            if *expected < RARE && *found == 0.0 {
                unseen += 1;
                continue;
            }
            let z = (found - expected) / error.hypot(TABLE_ERROR);
            let row = format!("{what},{expected},{found:.6},{error:.6},{z:.2}");
            println!("{row}");
            squares = (squares.0 + 1, squares.1 + z * z);
            if z.abs() > MOST {
                wrong.push(row);
            }
        }
    }
    let (count, sum) = squares;
    let rms = (sum / f64::from(count)).sqrt();
    println!("{count} values, root mean square of z {rms:.3}; {unseen} too rare to be seen");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
