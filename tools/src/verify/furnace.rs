//! A periodic box of leaves with ρ + τ = 1 over soil of reflectance 1.

use super::finding::Finding;
use super::measured::{RED_AND_NIR, measure, value};

/// *Expected*: under an isotropic sky the second law leaves nothing to be seen: an HDRF of 1 in every
/// direction and the sky's flux at the ground; under the sun, albedo 1. Bands differ in how they share
/// reflectance and transmittance, so paths do not just keep their weight.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let scene = |light: &str, sensors: &str| {
        measure(&format!(
            r#"{RED_AND_NIR}
            materials: {{
                "soil": Lambertian(reflectance: Constant(1.0)),
                "leaf": Leaf(reflectance: Bands([0.5, 0.6]), transmittance: Bands([0.5, 0.4])),
            }},
            meshes: {{ "cloud": Crown(
                shape: Box(size_m: (2.0, 2.0, 1.0)), base_m: 0.1, leaf_area_m2: 8.0,
                leaf: Disc(radius_m: 0.05), leaf_material: "leaf",
            ) }},
            terrain: Plane(size_m: (2.0, 2.0), material: "soil"),
            instances: [List(of: "cloud", at_m: [(1.0, 1.0, 0.0)])],
            {light}
            boundary: Periodic,
            sensors: {{ {sensors} }},"#
        ))
    };
    let mut findings = Vec::new();
    let report = scene(
        "sky: Isotropic(irradiance: Constant(1.0)),",
        r#""views": Directions(system: Backward, views: List([(0.0, 0.0), (30.0, 90.0), (70.0, 200.0)]), until: Samples(16384)),
        "photons": Photons(per_m2: 8000.0, measure: [Albedo, Fapar(layer_m: 2.0)]),"#,
    )?;
    let views = ["nadir", "30°", "70°"];
    for (index, view) in views.iter().enumerate() {
        for (band, name) in ["even leaves", "uneven leaves"].iter().enumerate() {
            let hdrf = value(&report, "views", "hdrf", 2 * index + band)?;
            findings.push(Finding::estimate(format!("HDRF, {view}, {name}"), 1.0, hdrf, 0.01));
        }
    }
    // First of the terms of `ftran` is the total.
    let down = value(&report, "photons", "ftran", 0)?;
    findings.push(Finding::estimate("flux at the ground under the sky", 1.0, down, 0.01));
    let sun = "sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),";
    let report = scene(sun, r#""photons": Photons(per_m2: 16000.0, measure: [Albedo]),"#)?;
    for (band, name) in ["even leaves", "uneven leaves"].iter().enumerate() {
        let albedo = value(&report, "photons", "albedo", band)?;
        findings.push(Finding::estimate(
            format!("albedo under the sun, {name}"),
            1.0,
            albedo,
            0.005,
        ));
    }
    Ok(findings)
}
