//! Scenes whose answer is known exactly.

use sunfleck::transport::EnergyCounter;
use sunfleck_tests::scene_text::BANDS;
use sunfleck_tests::{Estimate, SceneText, albedo_of_sheets, product};

/// *Scene*: a Lambertian plane, isolated or periodic, under sun and sky.
/// *Expected*: BRF, albedo and HDRF equal the reflectance, exactly in expectation; backward paths
/// see nothing else than ρ, so there without any spread up to the rounding of f32.
#[test]
fn a_lambertian_plane_has_a_brf_equal_to_its_reflectance_in_every_direction() {
    for boundary in ["Isolated", "Periodic"] {
        for sky in ["None", "Fraction([0.25, 0.5])"] {
            let report = SceneText::bare(0.0, "size_m: (10.0, 7.3), corner_m: (-3.1, 2.0), height_m: 12.7")
                .with("bands", BANDS)
                .with("materials", r#""soil": Lambertian(reflectance: Bands([0.127, 0.7]))"#)
                .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0)")
                .with("sky", sky)
                .with("boundary", boundary)
                .with("sensors", r#"
        "back": Directions(system: Backward, views: CrossPlane(max_deg: 80.0, step_deg: 20.0), until: Samples(2048)),
        "forth": Directions(views: PrincipalPlane(max_deg: 80.0, step_deg: 20.0), until: Samples(2048), system: Forward),
        "image": Orthographic(size_px: (8, 8), extent_m: (5.0, 5.0), samples_per_px: 16, measure: [Radiance, Brf]),
        "once": Directions(views: CrossPlane(max_deg: 80.0, step_deg: 20.0), until: Samples(2048), system: FirstOrder, measure: [Orders]),
        "photons": Photons(per_m2: 500.0, measure: [Albedo, BrfCells(30), Fapar(layer_m: 1.0), Fluxes(pixel_m: 1.0)]),
        "analog": Photons(per_m2: 5000.0, measure: [Albedo, BrfCells(30), Fluxes(pixel_m: 1.0)], system: Analog)"#)
                .measure();
            let factor = if sky == "None" { "brf" } else { "hdrf" };
            let rho = [0.127_f64, 0.7];
            let sun = 40_f64.to_radians().cos();
            let ground = format!("{factor}_uc");
            for (sensor, name) in
                [("back", factor), ("forth", factor), ("image", factor), ("once", &ground)]
            {
                let product = product(&report, sensor, name);
                for (index, value) in product.values.iter().enumerate() {
                    let deviation = value / rho[index % 2] - 1.0;
                    let error = product.standard_error[index] / rho[index % 2];
                    // A sky leaves the random choice between it and the sun.
                    let allowed = if sky == "None" { 1e-6 } else { 4.0 * error + 1e-6 };
                    assert!(
                        deviation.abs() < allowed,
                        "{boundary}, {sky}, {sensor}[{index}]: {value} +- {error}"
                    );
                }
            }
            for (index, &rho) in rho.iter().enumerate() {
                for photons in ["photons", "analog"] {
                    let albedo = Estimate::of(product(&report, photons, "albedo"), index);
                    // Without a sky every packet carries the same.
                    let allowed = 4.0 * albedo.error + 1e-6;
                    assert!((albedo.value - rho).abs() < allowed, "{boundary}, {sky}: {albedo:?}");
                    let up = Estimate::of(product(&report, photons, "upwelling_terrain"), index);
                    assert!((up.value - rho * sun).abs() < 4.0 * up.error + 1e-6, "{up:?}");
                }
                // L = ρ E / π with E the horizontal irradiance.
                let radiance = product(&report, "image", "radiance").values[index];
                let expected = rho * sun / std::f64::consts::PI;
                assert!((radiance / expected - 1.0).abs() < 0.02, "{radiance} {expected}");
                let down = Estimate::of(product(&report, "photons", "downwelling_terrain"), index);
                assert!((down.value - sun).abs() < 4.0 * down.error + 1e-6, "{down:?}");
                let top = Estimate::of(product(&report, "photons", "downwelling_top"), index);
                assert!((top.value - sun).abs() < 4.0 * top.error + 1e-6, "{top:?}");
                let up = Estimate::of(product(&report, "photons", "upwelling_top"), index);
                assert!((up.value - rho * sun).abs() < 4.0 * up.error + 1e-6, "{up:?}");
            }
            for photons in ["photons", "analog"] {
                let cells = product(&report, photons, &format!("{factor}_cells"));
                // 480 cells in all: with 31 degrees of freedom one in 500 such runs has |t| > 5.5.
                for (index, value) in cells.values.iter().enumerate() {
                    let z = Estimate::of(cells, index).z(rho[index % 2]);
                    assert!(
                        z.abs() < 5.5,
                        "{boundary}, {sky}: {photons} cell {index}: {value}, z = {z}"
                    );
                }
            }
        }
    }
}

/// A periodic box of leaves with ρ + τ = 1 over soil of reflectance 1.
fn furnace(leaf: &str, roulette: &str, sensor: &str) -> SceneText {
    SceneText::bare(1.0, "size_m: (4.0, 4.0)")
        .with("bands", BANDS)
        .with_more("materials", format!(r#""leaf": Leaf({leaf})"#))
        .with(
            "meshes",
            r#""cloud": Crown(
        shape: Box(size_m: (4.0, 4.0, 1.0)), base_m: 0.1, leaf_area_m2: 32.0,
        leaf: Disc(radius_m: 0.05), leaf_material: "leaf",
    )"#,
        )
        .with("instances", r#"List(of: "cloud", at_m: [(2.0, 2.0, 0.0)])"#)
        .with("boundary", "Periodic")
        .with("transport", format!("roulette: (after_order: 5, kill: {roulette})"))
        .with("sensors", format!(r#""sensor": {sensor}"#))
}

/// *Scene*: the furnace under the sun. *Expected*: albedo 1. With bands alike and no constant
/// roulette a packet keeps its weight until it leaves, so that there is next to no noise; bands that
/// differ and the roulette of the manual bring noise, and no bias.
#[test]
fn a_white_furnace_has_albedo_1() {
    let sun = "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)";
    let alike = "reflectance: Constant(0.6), transmittance: Constant(0.4)";
    let unlike = "reflectance: Bands([0.5, 0.6]), transmittance: Bands([0.5, 0.4])";
    for (leaf, roulette, system, most) in [
        (alike, "0.0", "Forward", 1e-4),
        (unlike, "0.05", "Forward", 2e-3),
        // Nothing is absorbed: each photon leaves whole, and the bands share their number.
        (unlike, "0.05", "Analog", 5e-3),
    ] {
        let photons = format!("Photons(per_m2: 10000.0, measure: [Albedo], system: {system})");
        let report = furnace(leaf, roulette, &photons).with("sun", sun).measure();
        for band in 0..2 {
            let albedo = Estimate::of(product(&report, "sensor", "albedo"), band);
            assert!(albedo.error < most, "{albedo:?}");
            // Weights are f32: after hundreds of orders they are 1 to some 1e-6.
            assert!((albedo.value - 1.0).abs() < 4.0 * albedo.error + 1e-5, "{albedo:?}");
        }
    }
}

/// *Scene*: the furnace under an isotropic sky. *Expected*: an HDRF of 1 in every direction.
#[test]
fn a_white_furnace_under_an_isotropic_sky_looks_like_the_sky() {
    let leaf = "reflectance: Bands([0.5, 0.6]), transmittance: Bands([0.5, 0.4])";
    let views = "Directions(system: Backward, views: List([(0.0, 0.0), (30.0, 90.0), (70.0, 200.0)]), until: RelError(0.002))";
    let report =
        furnace(leaf, "0.05", views).with("sky", "Isotropic(irradiance: Constant(1.0))").measure();
    let views = product(&report, "sensor", "hdrf");
    for index in 0..views.values.len() {
        let one = Estimate::of(views, index);
        assert!((one.value - 1.0).abs() < 4.0 * one.error, "{index}: {one:?}");
    }
}

/// *Scene*: N horizontal sheets of leaf (r, t) over soil s, wider than the tile.
/// *Expected*: albedo by adding layers: R₁₂ = R₁ + T₁² R₂ / (1 - R₁ R₂).
#[test]
fn leaf_sheets_add_up_as_layers_do() {
    let optics = (0.45, 0.45, 0.2);
    let report = SceneText::sheets(&[optics], &[1.0, 2.0]).with("sensors", r#"
        "photons": Photons(per_m2: 10000.0, measure: [Albedo]),
        "views": Directions(system: Backward, views: List([(20.0, 90.0), (60.0, 200.0)]), until: RelError(0.001))"#).measure();
    // Lambertian layers: what they send out is diffuse whatever came in.
    let both = albedo_of_sheets(optics, 2);
    let albedo = Estimate::of(product(&report, "photons", "albedo"), 0);
    assert!(albedo.z(both).abs() < 4.0 && albedo.error < 1e-3 * both, "{albedo:?} for {both}");
    for view in 0..2 {
        let brf = Estimate::of(product(&report, "views", "brf"), view);
        assert!(brf.z(both).abs() < 4.0, "{brf:?} for {both}");
    }
}

/// *Scene*: a heterogeneous periodic scene under sun and sky.
/// *Expected*: in every band incident = reflected + absorbed + lost + roulette, to 1e-9, and cells
/// sum to the albedo.
#[test]
fn energy_closes_and_cells_sum_to_the_albedo() {
    for boundary in ["Periodic", "Isolated"] {
        let sensors = r#""photons": Photons(per_m2: 4000.0, measure: [Albedo, BrfCells(40), Fapar(layer_m: 0.7)])"#;
        let report = SceneText::trees_in_daylight(boundary).with("sensors", sensors).measure();
        let energy = product(&report, "photons", "energy");
        let bands = 2;
        for band in 0..bands {
            let term = |index: usize| energy.values[index * bands + band];
            let terms = energy.values.len() / bands;
            let balance = term(0) - (1..terms).map(term).sum::<f64>();
            assert!(balance.abs() < 1e-9 * term(0), "{boundary}, band {band}: {balance}");
            let albedo = product(&report, "photons", "albedo").values[band];
            assert!((albedo - term(1)).abs() < 1e-12, "albedo is what is reflected");
            let cells = product(&report, "photons", "hdrf_cells");
            let sunfleck::products::AxisPoints::Numbers(weights) = &cells.dimensions[0][2].points
            else {
                panic!("weights are numbers")
            };
            let sum: f64 = weights
                .iter()
                .enumerate()
                .map(|(cell, weight)| cells.values[cell * bands + band] * weight)
                .sum();
            assert!(
                (sum / std::f64::consts::PI / albedo - 1.0).abs() < 1e-9,
                "cells sum to albedo"
            );
            let fapar = product(&report, "photons", "fapar");
            let absorbed: f64 = fapar.values.iter().skip(band).step_by(bands).sum();
            let expected: f64 = (EnergyCounter::ABSORBED..terms).map(term).sum();
            assert!((absorbed - expected).abs() < 1e-9, "layers sum to what is absorbed");
        }
    }
}
