//! Emitted light followed forwards, against the backward system and closed forms.

use std::f64::consts::PI;

use sunfleck::products::{AxisPoints, Report};
use sunfleck::spectral::planck;
use sunfleck_tests::scene_text::tree;
use sunfleck_tests::{Estimate, SceneText, product};

/// Trees with transmitting leaves on warm soil, each with a sunlit and a shaded temperature, under
/// sun, sky and thermal sky; a band of reflected, one of emitted and one of both kinds of light.
fn trees(boundary: &str) -> Report {
    let views = "List([(0.0, 0.0), (40.0, 100.0), (60.0, 190.0)])";
    SceneText::two_trees()
        .with("bands", r#"
        (name: "nir", center_nm: 865.0),
        (name: "mir", center_nm: 4000.0, source: Both),
        (name: "tir", center_nm: 10500.0)"#)
        .with("materials", r#"
        "soil": Lambertian(reflectance: Bands([0.3, 0.2, 0.06]), temperature: SunlitShaded(sunlit_k: 325.0, shaded_k: 295.0)),
        "leaf": Leaf(
            reflectance: Bands([0.5, 0.1, 0.03]), back_reflectance: Some(Bands([0.4, 0.3, 0.2])),
            transmittance: Bands([0.4, 0.1, 0.25]), temperature: MeanDelta(mean_k: 300.0, delta_k: 8.0),
        )"#)
        .with("meshes", tree("Disc(radius_m: 0.08)"))
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Bands([1.0, 0.01, 0.0002])")
        .with("sky", "Fraction([0.3, 0.1, 0.0])")
        .with("thermal_sky", "BlackBody(250.0)")
        .with("boundary", boundary)
        .with("sensors", format!(r#"
        "back": Directions(system: Backward, views: {views}, until: Samples(40000), measure: [Radiance]),
        "forth": Directions(views: {views}, until: Samples(20000), measure: [Radiance], system: Forward),
        "image": Orthographic(size_px: (4, 4), extent_m: (4.0, 4.0), samples_per_px: 1024, measure: [Radiance, BrightnessTemperature]),
        "film": Orthographic(size_px: (4, 4), extent_m: (4.0, 4.0), samples_per_px: 1024, measure: [Radiance, BrightnessTemperature], system: Forward),
        "photons": Photons(per_m2: 6000.0, measure: [
            Exitance, RadianceCells(40), RadianceViews({views}), BrightnessTemperature,
            RadianceCones([(0.0, 0.0, 8.0), (40.0, 100.0, 8.0), (60.0, 190.0, 8.0)]),
            Fluxes(pixel_m: 1.0), Albedo,
        ])"#))
        .measure()
}

/// *Expected*: the radiance towards each view is the same backwards, forwards and in cones, in every
/// band; cells sum to the exitance, which the flux map has too; brightness temperatures go with it; and
/// what surfaces and the sky emit is absorbed, leaves, or is played for, to 1e-9.
#[test]
fn photons_carry_the_radiance_that_paths_find() {
    for boundary in ["Periodic", "Isolated"] {
        let report = trees(boundary);
        let back = product(&report, "back", "radiance");
        for (sensor, name, bend) in [
            ("forth", "radiance", 0.0),
            ("photons", "radiance_views", 0.0),
            // Over a cone of 8° the radiance bends by less than this.
            ("photons", "radiance_cones", 0.01),
        ] {
            let other = product(&report, sensor, name);
            assert_eq!(other.unit, "W m-2 sr-1 nm-1");
            for index in 0..9 {
                let (one, other) = (Estimate::of(back, index), Estimate::of(other, index));
                assert!(one.error < 0.01 * one.value, "{boundary}, {index}: {one:?}");
                let allowed = 4.0 * one.error.hypot(other.error) + bend * one.value;
                assert!(
                    (one.value - other.value).abs() < allowed,
                    "{boundary}, {sensor} {name} {index}: {one:?} {other:?}"
                );
            }
        }
        for name in ["radiance", "brightness_temperature"] {
            let (image, film) = (product(&report, "image", name), product(&report, "film", name));
            for index in 0..image.values.len() {
                let (one, other) = (Estimate::of(image, index), Estimate::of(film, index));
                let z = one.z_against(other);
                assert!(z.abs() < 4.0, "{boundary}, {name} {index}: {one:?} {other:?}");
            }
        }
        let exitance = product(&report, "photons", "exitance");
        let up = product(&report, "photons", "upwelling_top");
        let cells = product(&report, "photons", "radiance_cells");
        let AxisPoints::Numbers(weights) = &cells.dimensions[0][2].points else {
            panic!("weights are numbers")
        };
        for band in 0..3 {
            let whole = exitance.values[band];
            let sum: f64 =
                weights.iter().zip(cells.values.chunks_exact(3)).map(|(w, l)| w * l[band]).sum();
            assert!((sum / whole - 1.0).abs() < 1e-9, "{boundary}: {sum} {whole}");
            // The map at the top of an isolated scene leaves out what rises beyond its rectangle there.
            assert!(up.values[band] <= whole * (1.0 + 1e-9), "{boundary}: {up:?}");
            if boundary == "Periodic" {
                assert!((up.values[band] / whole - 1.0).abs() < 1e-9, "{boundary}: {up:?}");
            }
        }
        let energy = product(&report, "photons", "emitted_energy");
        for band in 0..3 {
            let terms: Vec<f64> = energy.values.iter().skip(band).step_by(3).copied().collect();
            let balance = terms[0] - terms[1..].iter().sum::<f64>();
            assert!(balance.abs() <= 1e-9 * terms[0], "{boundary}, {band}: {terms:?}");
            // Nothing is emitted in a band of sunlight alone.
            assert_eq!(band > 0, terms[0] > 0.0, "{boundary}, {band}: {terms:?}");
        }
        // Two bands hold emission: 4 and 10.5 µm.
        let (kelvin, radiance) = (
            product(&report, "photons", "brightness_temperature_views"),
            product(&report, "photons", "radiance_views"),
        );
        for view in 0..3 {
            let found = planck(10_500.0, kelvin.values[2 * view + 1]);
            assert!((found / radiance.values[3 * view + 2] - 1.0).abs() < 1e-9);
        }
        assert_eq!(kelvin.values.len(), 6);
    }
}

/// A rectangle of emissivity 0.9 at 300 K.
fn plane(rectangle: &str) -> SceneText {
    SceneText::bare(0.0, rectangle).with("bands", r#"(name: "tir", center_nm: 10000.0)"#).with(
        "materials",
        r#""soil": Lambertian(reflectance: Constant(0.1), temperature: Uniform(300.0))"#,
    )
}

/// *Scene*: a plane of emissivity 0.9 at 300 K, alone, under a thermal sky. *Expected*: exitance
/// `ε π B + ρ π B_sky`, the same radiance in every cell, and a downwelling flux of `π B_sky`.
#[test]
fn a_plane_emits_after_lamberts_law() {
    for boundary in ["Periodic", "Isolated"] {
        let report = plane("size_m: (5.0, 3.0), corner_m: (-1.0, 2.0), height_m: 7.0")
            .with("thermal_sky", "BlackBody(260.0)")
            .with("boundary", boundary)
            .with("sensors", r#""photons": Photons(per_m2: 4000.0, measure: [Exitance, RadianceCells(24), Fluxes(pixel_m: 1.0)])"#)
            .measure();
        let sky = planck(10_000.0, 260.0);
        let radiance = 0.9 * planck(10_000.0, 300.0) + 0.1 * sky;
        let near = |name: &str, truth: f64| {
            let one = Estimate::of(product(&report, "photons", name), 0);
            // Every line meets the plane once: little is left to chance.
            let allowed = 4.0 * one.error + 1e-6 * truth;
            assert!((one.value - truth).abs() < allowed, "{boundary}, {name}: {one:?} {truth}");
            assert!(one.error < 1e-5 * truth, "{boundary}, {name}: {one:?} {truth}");
        };
        near("exitance", PI * radiance);
        near("downwelling_terrain", PI * sky);
        near("downwelling_top", PI * sky);
        near("upwelling_terrain", PI * radiance);
        let cells = product(&report, "photons", "radiance_cells");
        for index in 0..24 {
            let one = Estimate::of(cells, index);
            // 24 cells with 31 degrees of freedom each: one in 1000 such runs has |t| > 4.8.
            assert!(one.z(radiance).abs() < 4.8, "{boundary}, {index}: {one:?} {radiance}");
        }
    }
}

/// A brightness temperature needs a band that emits, and a radiance beside it.
#[test]
fn a_brightness_temperature_of_photons_needs_a_radiance() {
    let photons = |measure: &str| {
        format!(r#""photons": Photons(measure: [{measure}, BrightnessTemperature])"#)
    };
    let emitting = plane("size_m: (5.0, 3.0)").with("sensors", photons("Exitance"));
    let problems = emitting.read().render();
    assert!(problems.contains("RadianceViews(List([(0.0, 0.0)]))"), "{problems}");
    let reflecting = emitting
        .with("bands", r#"(name: "tir", center_nm: 660.0)"#)
        .with("sensors", photons("RadianceCells(20)"));
    let problems = reflecting.read().render();
    assert!(problems.contains("source: Emission"), "{problems}");
}
