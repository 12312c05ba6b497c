//! Planes, slopes, plates and what they exchange.

use std::f64::consts::PI;

use sunfleck::spectral::planck;

use super::finding::Finding;
use super::measured::{RED_AND_NIR, THERMAL, measure, value};

pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    Ok([plane()?, slope()?, shadow()?, view_factors()?].concat())
}

/// *Scene*: a Lambertian plane under the sun. *Expected*: BRF and albedo are its reflectance ρ, from the
/// view, from the sun and in an image, in every sample.
fn plane() -> anyhow::Result<Vec<Finding>> {
    let rho = 0.127;
    let report = measure(&format!(
        r#"{RED_AND_NIR}
        materials: {{ "soil": Lambertian(reflectance: Bands([{rho:?}, 0.7])) }},
        terrain: Plane(size_m: (10.0, 7.3), corner_m: (-3.1, 2.0), height_m: 12.7, material: "soil"),
        sun: (zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(1.0)),
        sensors: {{
            "back": Directions(system: Backward, views: List([(70.0, 30.0)]), until: Samples(2048)),
            "forth": Directions(views: List([(70.0, 30.0)]), until: Samples(2048), system: Forward),
            "image": Orthographic(size_px: (8, 8), extent_m: (5.0, 5.0), samples_per_px: 16),
            "photons": Photons(per_m2: 500.0, measure: [Albedo]),
        }},"#
    ))?;
    let mut findings = Vec::new();
    for (sensor, name) in
        [("back", "brf"), ("forth", "brf"), ("image", "brf"), ("photons", "albedo")]
    {
        let found = value(&report, sensor, name, 0)?;
        let quantity = format!("plane: {name} ({sensor})");
        // Weights are f32.
        findings.push(Finding::within(quantity, rho, found.value, 1e-6));
    }
    Ok(findings)
}

/// *Scene*: a small panel of slope β and aspect φ high above black ground, under the sun, then under
/// an isotropic sky. *Expected*: `L = ρ E cos i / (π cos θ)` of a horizontal irradiance E, with
/// `cos i = cos θ cos β + sin θ sin β cos(φ_sun - φ)`; and `L = ρ E (1 + cos β) / 2π`.
fn slope() -> anyhow::Result<Vec<Finding>> {
    let (rho, theta, beta, turned) =
        (0.5, 40_f64.to_radians(), 35_f64.to_radians(), 70_f64.to_radians());
    // Faces north: from its southern, upper edge it goes down to the northern one.
    let (sin, cos) = beta.sin_cos();
    let corner = |x: f64, down: f64| format!("({x:?}, {:?}, {:?})", down * cos, -down * sin);
    let corners =
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)].join(", ");
    let radiance = |light: &str| {
        let report = measure(&format!(
            r#"{RED_AND_NIR}
            materials: {{
                "black": Lambertian(reflectance: Constant(0.0)),
                "grey": Lambertian(reflectance: Constant({rho:?})),
            }},
            meshes: {{ "panel": Faces(faces_m: [[{corners}]], material: "grey") }},
            terrain: Plane(size_m: (100.0, 100.0), corner_m: (-50.0, -50.0), material: "black"),
            instances: [List(of: "panel", at_m: [(0.0, 0.0, 2.0)])],
            {light}
            sensors: {{ "nadir": Orthographic(
                size_px: (1, 1), extent_m: (0.2, 0.2), center_m: (0.0, 0.0), samples_per_px: 65536,
                measure: [Radiance],
            ) }},"#
        ))?;
        value(&report, "nadir", "radiance", 0)
    };
    // Of the sun's own irradiance of 1 across the beam.
    let share = theta.cos() * cos + theta.sin() * sin * turned.cos();
    let sun = radiance("sun: (zenith_deg: 40.0, azimuth_deg: 70.0, irradiance: Constant(1.0)),")?;
    let sky = radiance("sky: Isotropic(irradiance: Constant(1.0)),")?;
    let of_sky = rho * 0.5 * (1.0 + cos) / PI;
    Ok(vec![
        // Normals are f32.
        Finding::within("slope: radiance under the sun", rho * share / PI, sun.value, 2e-5),
        Finding::estimate("slope: radiance under the sky", of_sky, sky, 0.002),
    ])
}

/// *Scene*: a black square plate of side 1 above Lambertian ground of side 2, periodic; the sun in the
/// east so low that its shadow is moved by 0.4. *Expected*: of the ground 3/4 is lit; from above, the plate
/// hides 1/4 and the shadow beside it 0.4/4 more, so that BRF = ρ (1 - 1.4/4); no light comes back to the ground.
fn shadow() -> anyhow::Result<Vec<Finding>> {
    let (rho, height, moved) = (0.3, 0.8, 0.4_f64);
    let zenith = (moved / height).atan().to_degrees();
    let report = measure(&format!(
        r#"{RED_AND_NIR}
        materials: {{
            "black": Lambertian(reflectance: Constant(0.0)),
            "soil": Lambertian(reflectance: Constant({rho:?})),
        }},
        meshes: {{ "plate": Faces(
            faces_m: [[(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]],
            material: "black",
        ) }},
        terrain: Plane(size_m: (2.0, 2.0), material: "soil"),
        instances: [List(of: "plate", at_m: [(0.2, 0.7, {height:?})])],
        sun: (zenith_deg: {zenith:?}, azimuth_deg: 90.0, irradiance: Constant(1.0)),
        boundary: Periodic,
        sensors: {{
            "nadir": Directions(
                system: Backward, views: List([(0.0, 0.0)]), until: Samples(131072), measure: [Brf, FourComponents],
            ),
            "photons": Photons(per_m2: 32768.0, measure: [Fapar(layer_m: 1.0)]),
        }},"#
    ))?;
    let lit = 1.0 - 0.25 * (1.0 + moved);
    let brf = value(&report, "nadir", "brf", 0)?;
    let sunlit = value(&report, "nadir", "four_components", 0)?;
    let shaded = value(&report, "nadir", "four_components", 2)?;
    let ground = value(&report, "photons", "ftran", 0)?;
    Ok(vec![
        Finding::estimate("shadow of a plate: BRF at nadir", rho * lit, brf, 0.005),
        Finding::estimate("shadow of a plate: sunlit ground seen", lit, sunlit, 0.005),
        Finding::estimate("shadow of a plate: shaded ground seen", 0.25 * moved, shaded, 0.02),
        Finding::estimate("shadow of a plate: light on the ground", 0.75, ground, 0.005),
    ])
}

/// *Scene*: a hot black square and beside it a cold one that sends all it receives from the one side out of
/// the other, as a Lambertian surface. *Expected*: that one's radiance is the view factor times the black body's.
///
/// Source of the factors: J. R. Howell, "A catalog of radiation configuration factors", C-11 (unit
/// squares at a distance of 1) and C-14 (unit squares at a right angle, with a common edge).
fn view_factors() -> anyhow::Result<Vec<Finding>> {
    let level = "(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)";
    let wall = "(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 1.0), (0.0, 0.0, 1.0)";
    let mut findings = Vec::new();
    for (name, hot, factor) in [
        ("parallel squares at a distance of 1", level, 0.199_824_9),
        ("squares at a right angle", wall, 0.200_043_8),
    ] {
        let report = measure(&format!(
            r#"{THERMAL}
            materials: {{
                "cold": Lambertian(reflectance: Constant(0.0), temperature: Uniform(0.0)),
                "hot": Lambertian(reflectance: Constant(0.0), temperature: Uniform(300.0)),
                "glass": Leaf(
                    reflectance: Constant(0.0), transmittance: Constant(1.0), temperature: Uniform(0.0),
                ),
            }},
            meshes: {{
                "hot": Faces(faces_m: [[{hot}]], material: "hot"),
                "glass": Faces(faces_m: [[{level}]], material: "glass"),
            }},
            terrain: Plane(size_m: (1.0, 1.0), material: "cold"),
            instances: [
                List(of: "hot", at_m: [(0.0, 0.0, 0.1)]), List(of: "glass", at_m: [(0.0, 0.0, 1.1)]),
            ],
            sensors: {{ "nadir": Directions(
                system: Backward, views: List([(0.0, 0.0)]), until: Samples(262144), measure: [Radiance],
            ) }},"#
        ))?;
        let found = value(&report, "nadir", "radiance", 0)?.scaled(1.0 / planck(10_000.0, 300.0));
        findings.push(Finding::estimate(format!("view factor, {name}"), factor, found, 0.005));
    }
    Ok(findings)
}
