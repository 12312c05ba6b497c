//! Surface models that depend on both directions, in whole scenes: closed forms, energy, and systems that agree.

use std::f64::consts::PI;

use sunfleck_tests::scene_text::{LEAF_SHAPE, tree};
use sunfleck_tests::{Estimate, SceneText, product};

/// Grounds, and a leaf with a coating, in two bands and one of emission.
const MATERIALS: &str = r#"
        "rpv": Rpv(rho0: Bands([0.05, 0.1, 0.1]), k: Bands([0.95, 0.6, 0.6]), asymmetry: Bands([-0.1, -0.2, 0.0]),
            rho_c: Bands([0.05, 0.1, 0.1]), temperature: Uniform(300.0)),
        "soilspect": Soilspect(albedo: Bands([0.3, 0.7, 0.2]), roughness: Constant(0.2), b: Bands([0.0, 1.2, 0.5]),
            c: Constant(0.2), b_prime: Constant(0.1), c_prime: Constant(-0.1), temperature: Uniform(300.0)),
        "leaf": Leaf(reflectance: Bands([0.05, 0.45, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]),
            coating: Some((refractive_index: 1.5, roughness: 0.3)), temperature: Uniform(295.0)),"#;

/// Ground of a material and trees on it, under the sun.
fn scene(ground: &str, trees: &str, sensors: &str) -> SceneText {
    SceneText::default()
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10000.0)"#)
        .with("materials", MATERIALS)
        .with("meshes", tree(LEAF_SHAPE))
        .with("terrain", format!(r#"Plane(size_m: (5.0, 5.0), material: "{ground}")"#))
        .with("instances", format!(r#"List(of: "tree", at_m: [{trees}])"#))
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Bands([1.0, 1.0, 0.0])")
        .with("boundary", "Periodic")
        .with("sensors", sensors)
}

/// RPV of the scene above in its red band, with the azimuth between sun and view.
fn rpv(sun: f64, view: f64, azimuth: f64) -> f64 {
    let (rho0, k, theta, rho_c) = (0.05, 0.95, -0.1, 0.05_f64);
    let ((sin_i, cos_i), (sin_o, cos_o)) = (sun.sin_cos(), view.sin_cos());
    let cos_g = cos_i * cos_o + sin_i * sin_o * azimuth.cos();
    let (tan_i, tan_o) = (sin_i / cos_i, sin_o / cos_o);
    let distance =
        (tan_i * tan_i + tan_o * tan_o - 2.0 * tan_i * tan_o * azimuth.cos()).max(0.0).sqrt();
    let phase = (1.0 - theta * theta) / (1.0 + 2.0 * theta * cos_g + theta * theta).powf(1.5);
    rho0 * (cos_i * cos_o * (cos_i + cos_o)).powf(k - 1.0)
        * phase
        * (1.0 + (1.0 - rho_c) / (1.0 + distance))
}

/// *Scene*: bare ground of RPV under the sun. *Expected*: its BRF is the formula in every view, by every system;
/// its albedo is the integral of the formula over views.
#[test]
fn bare_rpv_ground_has_the_brf_of_its_formula() {
    let views = [(0.0, 0.0), (50.0, 10.0), (30.0, 10.0), (60.0, 190.0), (75.0, 100.0)];
    let list = "views: List([(0.0, 0.0), (50.0, 10.0), (30.0, 10.0), (60.0, 190.0), (75.0, 100.0)]), until: Samples(2000)";
    let sensors = format!(
        r#""back": Directions({list}, system: Backward), "forth": Directions({list}, system: Forward),
        "plain": Directions({list}, system: Reference), "light": Photons(per_m2: 4000.0, measure: [Albedo])"#
    );
    let report = scene("rpv", "", &sensors).measure();
    for sensor in ["back", "forth", "plain"] {
        let brf = product(&report, sensor, "brf");
        for (view, (zenith, azimuth)) in views.into_iter().enumerate() {
            let expected =
                rpv(50_f64.to_radians(), f64::to_radians(zenith), f64::to_radians(azimuth - 10.0));
            let Estimate { value, error } = Estimate::of(brf, 3 * view);
            // Nothing varies between paths; packets send virtual photons or none.
            let tolerance = 1e-4 * expected + if sensor == "forth" { 4.0 * error } else { 0.0 };
            assert!(
                (value - expected).abs() < tolerance,
                "{sensor}, {zenith}: {value} for {expected}"
            );
        }
    }
    let n = 400;
    let mut integral = 0.0;
    for i in 0..n {
        // Even steps of sin² weigh views by their cosine.
        let view = ((f64::from(i) + 0.5) / f64::from(n)).sqrt().asin();
        for j in 0..n {
            let azimuth = PI * (f64::from(j) + 0.5) / f64::from(n);
            integral += rpv(50_f64.to_radians(), view, azimuth) / f64::from(n * n);
        }
    }
    let albedo = Estimate::of(product(&report, "light", "albedo"), 0);
    let z = (albedo.value - integral) / albedo.error.hypot(2e-4 * integral);
    assert!(z.abs() < 4.0, "{albedo:?} for {integral}: z = {z:.2}");
}

/// *Scene*: glossy trees over both grounds, sun and sky, periodic and isolated. *Expected*: backward paths, packets,
/// photons as quanta and the reference integrator agree; energy closes; nothing reflects more than it receives.
#[test]
fn systems_agree_on_models_that_depend_on_directions() {
    for (ground, boundary) in [("rpv", "Periodic"), ("soilspect", "Isolated")] {
        let views = "views: List([(0.0, 0.0), (45.0, 15.0), (60.0, 190.0)]), until: Samples(40000)";
        let measures = "measure: [Albedo, BrfCones([(40.0, 100.0, 20.0)]), Fapar(layer_m: 1.0)]";
        let sensors = format!(
            r#""back": Directions({views}, system: Backward), "forth": Directions({views}, system: Forward),
            "plain": Directions({views}, system: Reference),
            "packets": Photons(per_m2: 4e3, {measures}),
            "photons": Photons(per_m2: 4e4, system: Analog, {measures})"#
        );
        let report = scene(ground, "(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)", &sensors)
            .with("sky", "Isotropic(irradiance: Bands([0.3, 0.1, 0.0]))")
            .with("boundary", boundary)
            .measure();
        let mut compared = 0;
        let mut compare = |a: (&str, &str), b: (&str, &str)| {
            let pair = (a, b);
            let (a, b) = (product(&report, a.0, a.1), product(&report, b.0, b.1));
            for index in (0..a.values.len()).filter(|index| index % 3 < 2) {
                let (a, b) = (Estimate::of(a, index), Estimate::of(b, index));
                if a.error < 0.2 * a.value && b.error < 0.2 * b.value {
                    let z = a.z_against(b);
                    assert!(
                        z.abs() < 5.0,
                        "{ground}, {pair:?}[{index}]: {a:?} and {b:?}, z = {z:.2}"
                    );
                    compared += 1;
                }
            }
        };
        compare(("back", "hdrf"), ("forth", "hdrf"));
        compare(("back", "hdrf"), ("plain", "hdrf"));
        for name in ["albedo", "brf_cones", "fapar_material", "fapar_vegetation", "ftran"] {
            let name = if name == "brf_cones" { "hdrf_cones" } else { name };
            compare(("packets", name), ("photons", name));
        }
        assert!(compared >= 30, "{ground}: {compared} values");
        for sensor in ["packets", "photons", "forth"] {
            let run = report.sensors.iter().find(|one| one.name == sensor).expect("a sensor");
            assert!(run.energy_imbalance.is_some_and(|part| part < 1e-9), "{sensor}: {run:?}");
        }
        let albedo = product(&report, "packets", "albedo");
        assert!(albedo.values[..2].iter().all(|value| *value < 1.0), "{albedo:?}");
    }
}

/// *Scene*: a wall of coated leaf over black ground, lit from the east. *Expected*: photons as quanta leave it to the
/// west in the directions that packets leave it in. The coating holds light back at grazing angles, so the cone
/// near the wall receives less than Lambert's law says.
#[test]
fn light_through_a_coated_leaf_leaves_by_its_bsdf() {
    let cones = "per_m2: 2e5, measure: [BrfCones([(15.0, 270.0, 20.0), (75.0, 270.0, 20.0)])]";
    let report = SceneText::default()
        .with("bands", r#"(name: "a", center_nm: 865.0)"#)
        .with("materials", r#"
        "black": Lambertian(reflectance: Constant(0.0)),
        "leaf": Leaf(reflectance: Constant(0.0), transmittance: Constant(0.9),
            coating: Some((refractive_index: 2.0, roughness: 0.3)))"#)
        .with("meshes", r#""wall": Faces(faces_m: [[(0.0, -2.0, 0.5), (0.0, 2.0, 0.5), (0.0, 2.0, 4.5), (0.0, -2.0, 4.5)]], material: "leaf")"#)
        .with("terrain", r#"Plane(size_m: (5.0, 5.0), material: "black")"#)
        .with("instances", r#"List(of: "wall", at_m: [(2.5, 2.5, 0.0)])"#)
        .with("sun", "zenith_deg: 60.0, azimuth_deg: 90.0, irradiance: Constant(1.0)")
        .with("sensors", format!(r#""packets": Photons({cones}), "photons": Photons(system: Analog, {cones})"#))
        .measure();
    for cone in 0..2 {
        let [packets, photons] = ["packets", "photons"]
            .map(|sensor| Estimate::of(product(&report, sensor, "brf_cones"), cone));
        assert!(packets.error < 0.03 * packets.value, "cone {cone}: {packets:?}");
        assert!(photons.error < 0.03 * photons.value, "cone {cone}: {photons:?}");
        let z = packets.z_against(photons);
        assert!(z.abs() < 4.0, "cone {cone}: {packets:?}, {photons:?}, z = {z:.2}");
    }
}

/// *Scene*: bare ground that emits into a cold sky. *Expected*: radiance `(1 - DHR(θ)) B(T)` by Kirchhoff's law, which
/// differs by direction, from paths and from packets alike.
#[test]
fn emission_follows_the_absorbed_fraction_of_each_direction() {
    let views = "views: List([(0.0, 0.0), (50.0, 100.0), (75.0, 190.0)]), measure: [Radiance], until: Samples(20000)";
    let sensors = format!(
        r#""back": Directions({views}, system: Backward), "forth": Directions({views}, system: Forward)"#
    );
    for ground in ["rpv", "soilspect"] {
        let report = scene(ground, "", &sensors).measure();
        let [back, forth] = ["back", "forth"].map(|sensor| product(&report, sensor, "radiance"));
        let tir = |view: usize| 3 * view + 2;
        for view in 0..3 {
            let (a, b) = (Estimate::of(back, tir(view)), Estimate::of(forth, tir(view)));
            let z = (a.value - b.value) / a.error.hypot(b.error).max(1e-5 * a.value);
            assert!(z.abs() < 4.0, "{ground}: {a:?} and {b:?}, z = {z:.2}");
        }
        let [nadir, oblique] = [0, 2].map(|view| back.values[tir(view)]);
        assert!((nadir - oblique).abs() > 1e-3 * nadir, "{ground}: {nadir} and {oblique}");
    }
}
