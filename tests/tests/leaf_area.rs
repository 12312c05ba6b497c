//! Standard errors of leaf area indices are right: estimates lie about the truth as their errors say.
//!
//! Each of many sensors, which differ in nothing but their name and so in their random numbers, measures
//! the same leaf area indices in a sparse, a usual and a dense canopy. z = (estimate - truth) / error of a
//! right error has a standard deviation of 1.

use std::fmt::Write as _;

use sunfleck_tests::{Estimate, SceneText, product};

/// Sensors of each kind in each canopy.
const SENSORS: usize = 500;
/// One-sided leaf area of each of three trees on 64 m², m²: gap fractions about 0.97, 0.6 and 0.3.
const LEAF_AREAS: [f64; 3] = [1.5, 25.0, 90.0];
/// Randomisations, and half-samples, from which each error is found: z has Student's distribution.
const FREEDOM: f64 = 31.0;
/// What errors may be wrong by beyond the noise of the test: the logarithm is no straight line.
const CURVATURE: f64 = 0.03;

const FISHEYE: &str = "Fisheye(size_px: (24, 24), position_m: (4.0, 4.0, 0.2), samples_per_px: N, measure: [GapFraction])";
const DOWN: &str = "Fisheye(size_px: (24, 24), position_m: (4.0, 4.0, 8.0), look: Down, samples_per_px: N, measure: [GapFraction])";
const DIRECTIONS: &str = "Directions(views: List([(7.0, 0.0), (7.0, 120.0), (23.0, 0.0), (23.0, 120.0), (38.0, 0.0), (53.0, 120.0), (53.0, 200.0), (68.0, 20.0)]), until: Samples(N), measure: [GapFraction])";

/// A sensor with the standard number of samples, and with enough of them for a truth.
fn texts(sensor: &str, samples: u32) -> [String; 2] {
    [samples, 256 * samples].map(|samples| sensor.replace('N', &samples.to_string()))
}

/// z of the indices `names` of all sensors in one canopy, by index.
fn deviations(leaf_area: f64, [sensor, truth]: &[String; 2], names: &[&str]) -> Vec<Vec<f64>> {
    let mut sensors = format!("\"truth\": {truth},\n");
    for number in 0..SENSORS {
        writeln!(sensors, "\"{number}\": {sensor},").expect("memory");
    }
    let report = SceneText::bare(0.15, "size_m: (8.0, 8.0)")
        .with("bands", r#"(name: "red", center_nm: 660.0)"#)
        .with_leaf(0.06, 0.03)
        .with(
            "meshes",
            format!(
                r#""tree": Crown(
        shape: Ellipsoid(diameter_m: 3.0, height_m: 4.0), base_m: 1.0, leaf_area_m2: {leaf_area},
        leaf: Disc(radius_m: 0.1), leaf_material: "leaf",
    )"#
            ),
        )
        .with(
            "instances",
            r#"List(of: "tree", at_m: [(2.0, 3.0, 0.0), (5.5, 6.0, 0.0), (6.0, 2.0, 0.0)])"#,
        )
        .with("sun", "zenith_deg: 35.0")
        .with("boundary", "Periodic")
        .with("sensors", sensors)
        .measure();
    let of_name = |name: &&str| {
        let truth = Estimate::of(product(&report, "truth", name), 0);
        let of_sensor = |number: usize| {
            Estimate::of(product(&report, &number.to_string(), name), 0).z_against(truth)
        };
        (0..SENSORS).map(of_sensor).collect()
    };
    names.iter().map(of_name).collect()
}

/// *Scene*: 500 sensors of one kind in each of three canopies. *Expected*: the standard deviation of z over
/// all of them is that of Student's t with 31 degrees of freedom, within four of its own standard errors.
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn assert_calibrated(sensor: &str, samples: u32, names: &[&str]) {
    let texts = texts(sensor, samples);
    let mut all = vec![Vec::new(); names.len()];
    for leaf_area in LEAF_AREAS {
        for (all, z) in all.iter_mut().zip(deviations(leaf_area, &texts, names)) {
            let n = z.len() as f64;
            let spread = (z.iter().map(|z| z * z).sum::<f64>() / n).sqrt();
            println!("{leaf_area} m², spread of z {spread:.3}");
            all.extend(z);
        }
    }
    let expected = (FREEDOM / (FREEDOM - 2.0)).sqrt();
    for (name, z) in names.iter().zip(all) {
        let n = z.len() as f64;
        let mean = z.iter().sum::<f64>() / n;
        let spread = (z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let found = format!("{name}: {n} values, mean {mean:.3}, standard deviation {spread:.3}");
        println!("{found}");
        // Chi-square with n degrees of freedom; the kurtosis of t adds 6 / (ν - 4) / 4 of it.
        let noise = 4.0 * ((1.0 + 1.5 / (FREEDOM - 4.0)) / (2.0 * n)).sqrt();
        assert!((spread / expected - 1.0).abs() < noise + CURVATURE, "{found}");
    }
}

#[test]
fn errors_of_a_fisheye_that_looks_up_are_right() {
    assert_calibrated(FISHEYE, 8, &["lai_beer", "lai_miller", "lai_2000"]);
}

#[test]
fn errors_of_a_fisheye_that_looks_down_are_right() {
    assert_calibrated(DOWN, 7, &["lai_beer", "lai_miller", "lai_2000"]);
}

#[test]
fn errors_of_directions_are_right() {
    assert_calibrated(DIRECTIONS, 2048, &["lai_miller", "lai_2000"]);
}
