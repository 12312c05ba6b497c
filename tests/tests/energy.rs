//! Every run of photon packets accounts for all of its energy, and says so.

use sunfleck::transport::EnergyCounter;
use sunfleck_tests::scene_text::LEAF;
use sunfleck_tests::{SceneText, product};

/// *Scene*: trees under sun, sky and both, periodic and isolated, with the roulette of the manual, a
/// cruel one and a limit of orders; photons with and without a virtual plane, directions and images
/// traced forward. *Expected*: incident = reflected + beside + missed + lost + absorbed +
/// roulette to 1e-9 of the incident in every band, and the same number in the report; nothing of the kind where no packets
/// are traced.
#[test]
fn incident_energy_is_reflected_lost_absorbed_or_taken_by_roulette() {
    let trees = SceneText::two_trees()
        .with("materials", format!(r#""soil": Lambertian(reflectance: Bands([0.1, 0.9])), {LEAF}"#))
        .with("terrain", r#"Plane(size_m: (5.0, 4.0), material: "soil")"#)
        .with("instances", r#"List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 3.9, 0.0)])"#)
        .with("sensors", r#"
        "all": Photons(per_m2: 300.0),
        "plane": Photons(per_m2: 300.0, virtual_plane: (center_m: (2.0, 2.0), size_m: (1.0, 2.0), height_m: 2.0)),
        "whole": Photons(per_m2: 300.0, system: Analog),
        "forth": Directions(views: List([(20.0, 0.0)]), until: Samples(3000), system: Forward),
        "film": Orthographic(size_px: (2, 2), extent_m: (3.0, 3.0), samples_per_px: 500, system: Forward),
        "back": Directions(system: Backward, views: List([(20.0, 0.0)]), until: Samples(64))"#);
    let sun = "zenith_deg: 60.0, azimuth_deg: 30.0, disc_deg: 0.5, irradiance: Constant(1.0)";
    let lights = [
        trees.clone().with("sun", sun),
        trees.clone().with("sun", sun).with("sky", "Fraction([0.5, 0.2])"),
        trees.with("sky", "Isotropic(irradiance: Bands([1.0, 0.3]))"),
    ];
    let rules = [
        "roulette: (after_order: 5, kill: 0.05)",
        "roulette: (after_order: 1, kill: 0.6)",
        "max_order: 2",
    ];
    for boundary in ["Periodic", "Isolated"] {
        for (light, scene) in lights.iter().enumerate() {
            for rules in rules {
                let report =
                    scene.clone().with("boundary", boundary).with("transport", rules).measure();
                let is_expected = |warning: &String| warning.starts_with("boundary: ");
                assert!(report.warnings.iter().all(is_expected), "{:?}", report.warnings);
                let case = format!("{boundary}, light {light}, {rules}");
                for sensor in &report.sensors {
                    match sensor.energy_imbalance {
                        None => assert_eq!(sensor.name, "back"),
                        Some(off) => assert!(off < 1e-9, "{case}, {}: {off:e}", sensor.name),
                    }
                }
                for sensor in ["all", "plane"] {
                    let energy = product(&report, sensor, "energy");
                    for band in 0..2 {
                        let terms: Vec<f64> =
                            energy.values[band..].iter().step_by(2).copied().collect();
                        let others: f64 = terms[1..].iter().sum();
                        assert!((terms[0] / others - 1.0).abs() < 1e-9, "{case}: {terms:?}");
                        let absorbed = &terms[EnergyCounter::ABSORBED..];
                        assert!(
                            terms[1] > 0.0 && absorbed.iter().all(|one| *one > 0.0),
                            "{terms:?}"
                        );
                    }
                }
                // What is reflected is what leaves through the plane.
                let albedo = product(&report, "plane", "albedo");
                let energy = product(&report, "plane", "energy");
                for band in 0..2 {
                    let reflected = energy.values[2 + band] * 20.0 / 2.0;
                    assert!((albedo.values[band] / reflected - 1.0).abs() < 1e-12);
                }
            }
        }
    }
}
