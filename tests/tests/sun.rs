//! The sun: its spectrum over a band, its disc, its place.

use std::f64::consts::PI;

use sunfleck_tests::scene_text::{BAND, LEAF_SHAPE};
use sunfleck_tests::{Estimate, SceneText, product, shared};

/// *Scene*: a plane under the ASTM G173 direct spectrum, bands from 0 to 2000 nm wide, with edges on
/// and between the table's points. *Expected*: the irradiance is the mean of the polyline over the
/// band, here by 40 000 midpoints, to the error of that sum.
#[test]
fn irradiance_is_the_exact_mean_of_the_solar_spectrum_over_the_band() {
    let Some(shared) = shared() else { return };
    let table = std::fs::read_to_string(shared.join("data/solar/ASTMG173.csv")).expect("a table");
    let table = table.split_once('\n').expect("a title line").1;
    let points: Vec<(f64, f64)> = table
        .lines()
        .skip(1)
        .map(|line| {
            let number = |column: usize| {
                line.split(',').nth(column).expect("a column").trim().parse().expect("a number")
            };
            (number(0), number(3))
        })
        .collect();
    let at = |nm: f64| {
        let next = points.partition_point(|point| point.0 < nm).clamp(1, points.len() - 1);
        let ((x0, y0), (x1, y1)) = (points[next - 1], points[next]);
        y0 + (y1 - y0) * (nm - x0) / (x1 - x0)
    };
    let bands = [
        (550.0, 0.0),
        (600.25, 0.1),
        (600.0, 2.0),
        (600.0, 10.0),
        (900.3, 2.0),
        (1600.0, 1.0),
        (2200.0, 2.0),
        (865.0, 20.7),
        (1500.0, 2000.0),
    ];
    let list: Vec<String> = bands
        .iter()
        .enumerate()
        .map(|(i, (center, width))| {
            format!(r#"(name: "b{i}", center_nm: {center:?}, width_nm: {width:?})"#)
        })
        .collect();
    let report = SceneText::bare(0.2, "size_m: (10.0, 10.0)")
        .with("bands", list.join(", "))
        .with("sun", r#"zenith_deg: 60.0, irradiance: Table(file: "sun.csv", wavelength: "wavelength", wavelength_unit: Nanometres, value: "direct")"#)
        .with_file("sun.csv", table)
        .with("boundary", "Periodic")
        .with("sensors", r#""photons": Photons(per_m2: 10.0, measure: [Fluxes(pixel_m: 10.0)])"#)
        .measure();
    let found = product(&report, "photons", "downwelling_top");
    for (index, (center, width)) in bands.into_iter().enumerate() {
        let n = 40_000;
        let mean = (0..n)
            .map(|i| at(center + width * ((f64::from(i) + 0.5) / f64::from(n) - 0.5)))
            .sum::<f64>()
            / f64::from(n);
        let irradiance = found.values[index] / 60_f64.to_radians().cos();
        // Packets carry f32, good to 6e-8; midpoints of 0.05 nm miss kinks by less than 1e-6.
        assert!(
            (irradiance / mean - 1.0).abs() < 2e-6,
            "{center} nm, {width} nm: {irradiance}, expected {mean}"
        );
    }
}

/// *Scene*: a Lambertian plane under a sun of 6° across. *Expected*: its irradiance is that of the
/// parallel beam exactly, in both systems and in every sample.
#[test]
fn a_disc_gives_the_horizontal_the_same_irradiance() {
    for boundary in ["Periodic", "Isolated"] {
        let report = SceneText::bare(0.4, "size_m: (10.0, 7.0)")
            .with("sun", "zenith_deg: 80.0, azimuth_deg: 130.0, disc_deg: 6.0, irradiance: Constant(1.0)")
            .with("boundary", boundary)
            .with("sensors", r#"
        "back": Directions(system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 30.0), until: Samples(256)),
        "photons": Photons(per_m2: 100.0, measure: [Albedo, Fluxes(pixel_m: 10.0)])"#)
            .measure();
        let exact = |name: &str, value: f64, expected: f64| {
            assert!((value / expected - 1.0).abs() < 1e-5, "{boundary}, {name}: {value}");
        };
        for value in &product(&report, "back", "brf").values {
            exact("brf", *value, 0.4);
        }
        exact("albedo", product(&report, "photons", "albedo").values[0], 0.4);
        let down = product(&report, "photons", "downwelling_terrain").values[0];
        exact("downwelling", down, 80_f64.to_radians().cos());
    }
}

/// *Scene*: black ground under the edge of a black sheet 4 m above it; a sun of 4° overhead.
/// *Expected*: across the penumbra the irradiance is the part of a disc on one side of a chord,
/// `1/2 + (t √(1 - t²) + asin t) / π` at `t = x / (h tan α)`, averaged over each pixel.
#[test]
fn a_disc_casts_the_penumbra_of_an_edge() {
    let sheet = "g sheet\nv -3 -3 4\nv 2.5 -3 4\nv 2.5 8 4\nv -3 8 4\nf 1 2 3 4\n";
    let report = SceneText::default()
        .with("bands", BAND)
        .with("materials", r#""black": Lambertian(reflectance: Constant(0.0))"#)
        .with_obj("sheet", "black", sheet)
        .with("terrain", r#"Plane(size_m: (5.0, 5.0), material: "black")"#)
        .with("instances", r#"List(of: "sheet", at_m: [(0.0, 0.0, 0.0)])"#)
        .with("sun", "zenith_deg: 0.0, disc_deg: 4.0, irradiance: Constant(1.0)")
        .with("boundary", "Isolated")
        .with("sensors", r#""photons": Photons(per_m2: 40000.0, measure: [Fluxes(pixel_m: 0.05)])"#)
        .measure();
    let image = product(&report, "photons", "downwelling_terrain").image.as_ref().expect("a map");
    assert_eq!((image.width, image.height), (100, 100));
    let values = image.load().expect("pixels can be read").values;
    // A point of the disc at sin θ shifts the shadow by h tan θ: to 1e-3 of the width the same.
    let width = 4.0 * 2_f64.to_radians().tan();
    let lit = |x: f64| {
        let t = ((x - 2.5) / width).clamp(-1.0, 1.0);
        0.5 + (t * (1.0 - t * t).sqrt() + t.asin()) / PI
    };
    let mut inside = 0;
    for column in 0..image.width {
        let rows = (0..image.height).map(|row| f64::from(values[row * 100 + column]));
        let rows: Vec<f64> = rows.collect();
        let mean = rows.iter().sum::<f64>() / 100.0;
        let variance = rows.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 99.0;
        let error = (variance / 100.0).sqrt();
        let expected = (0..100).map(|i| lit((column as f64 + (f64::from(i) + 0.5) / 100.0) * 0.05));
        let expected = expected.sum::<f64>() / 100.0;
        // 100 columns: one in 100 such runs has |z| > 4. Dark columns are dark exactly.
        let allowed = 4.0 * error + 1e-3 * f64::from(expected > 0.0 && expected < 1.0) + 1e-6;
        assert!((mean - expected).abs() < allowed, "column {column}: {mean}, not {expected}");
        inside += usize::from(expected > 0.01 && expected < 0.99);
    }
    assert!(inside >= 4, "the penumbra is wider than a pixel");
}

/// *Scene*: trees under a large sun and a sky. *Expected*: forward and backward paths agree, and
/// energy closes.
#[test]
fn both_systems_see_the_same_disc() {
    for boundary in ["Periodic", "Isolated"] {
        let report = SceneText::bare(0.3, "size_m: (5.0, 5.0)")
            .with("bands", r#"(name: "a", center_nm: 865.0)"#)
            .with_leaf(0.4, 0.3)
            .with_two_trees(LEAF_SHAPE)
            .with("sun", "zenith_deg: 60.0, azimuth_deg: 10.0, disc_deg: 8.0, irradiance: Constant(1.0)")
            .with("sky", "Fraction([0.2])")
            .with("boundary", boundary)
            .with("sensors", r#"
        "back": Directions(system: Backward, views: List([(0.0, 0.0), (55.0, 10.0), (60.0, 10.0), (60.0, 190.0)]), until: Samples(30000)),
        "forth": Directions(views: List([(0.0, 0.0), (55.0, 10.0), (60.0, 10.0), (60.0, 190.0)]), until: Samples(60000), system: Forward),
        "photons": Photons(per_m2: 1000.0, measure: [Albedo])"#)
            .measure();
        let (back, forth) = (product(&report, "back", "hdrf"), product(&report, "forth", "hdrf"));
        for view in 0..4 {
            let z = Estimate::of(back, view).z_against(Estimate::of(forth, view));
            assert!(z.abs() < 4.0, "{boundary}, view {view}: z = {z:.2}");
        }
        let energy = &product(&report, "photons", "energy").values;
        let balance = energy[0] - energy[1..].iter().sum::<f64>();
        assert!(balance.abs() < 1e-9 * energy[0], "{boundary}: {balance}");
    }
}

/// *Scene*: the sun by place and time. *Expected*: the same bits as by the angles of NREL's worked
/// example to their digits.
#[test]
fn a_sun_by_place_and_time_lights_as_one_by_angles() {
    let albedo = |sun: &str| {
        let report = SceneText::bare(0.3, "size_m: (5.0, 5.0)")
            .with("bands", r#"(name: "a", center_nm: 865.0)"#)
            .with("sun", sun)
            .with("sensors", r#"
        "photons": Photons(per_m2: 10.0, measure: [Fluxes(pixel_m: 5.0)]),
        "plane": Directions(system: Backward, views: PrincipalPlane(max_deg: 10.0, step_deg: 10.0), until: Samples(32))"#)
            .measure();
        let sunfleck::products::AxisPoints::Numbers(azimuths) =
            product(&report, "plane", "brf").dimensions[0][1].points.clone()
        else {
            panic!("azimuths are numbers")
        };
        (product(&report, "photons", "downwelling_top").values[0], azimuths[2])
    };
    let angles = albedo("zenith_deg: 50.11162, azimuth_deg: 194.34024");
    let spa = albedo(
        "position: Spa(date: (2003, 10, 17), time: (12, 30, 30), utc_offset_h: -7, \
         latitude_deg: 39.742476, longitude_deg: -105.1786, altitude_m: 1830.14, \
         pressure_hpa: 820, temperature_c: 11, delta_t_s: 67)",
    );
    assert!((angles.0 - spa.0).abs() < 1e-6, "{angles:?} {spa:?}");
    assert!((angles.1 - spa.1).abs() < 1e-5, "{angles:?} {spa:?}");
}
