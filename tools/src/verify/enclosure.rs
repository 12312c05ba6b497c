//! A closed box of one temperature.

use anyhow::Context as _;
use sunfleck::spectral::planck;

use super::finding::Finding;
use super::measured::{THERMAL, THERMAL_NM, measure, product, value};

/// *Scene*: six walls at 300 K with emissivities from 0.05 to 0.95, and in them a leaf of 300 K and a camera that
/// looks all around. *Expected*: Planck's radiance of 300 K in each band, on average and in each pixel.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let material = |name: &str, rho: &str| {
        format!("\"{name}\": Lambertian(reflectance: Bands([{rho}]), temperature: Uniform(300.0)),")
    };
    // Two walls across each axis.
    let walls = |name: &str, corners: [[f64; 3]; 4], axis: usize| {
        let face = |at: f64| {
            let corners = corners.map(|mut corner| {
                corner[axis] = at;
                let [x, y, z] = corner;
                format!("({x:?}, {y:?}, {z:?})")
            });
            format!("[{}]", corners.join(", "))
        };
        format!("\"{name}\": Faces(faces_m: [{}, {}], material: \"{name}\"),", face(0.0), face(1.0))
    };
    let report = measure(&format!(
        r#"{THERMAL}
        materials: {{
            "cold": Lambertian(reflectance: Constant(0.0), temperature: Uniform(0.0)),
            "leaf": Leaf(
                reflectance: Constant(0.3), transmittance: Constant(0.2), temperature: Uniform(300.0),
            ),
            {}{}{}
        }},
        meshes: {{
            {}{}{}
            "leaf": Faces(
                faces_m: [[(0.2, 0.5, 0.3), (0.7, 0.6, 0.2), (0.5, 0.8, 0.6)]], material: "leaf",
            ),
        }},
        terrain: Plane(size_m: (1.0, 1.0), material: "cold"),
        instances: [
            List(of: "x", at_m: [(0.0, 0.0, 0.5)]), List(of: "y", at_m: [(0.0, 0.0, 0.5)]),
            List(of: "z", at_m: [(0.0, 0.0, 0.5)]), List(of: "leaf", at_m: [(0.0, 0.0, 0.5)]),
        ],
        sensors: {{ "all": Fisheye(
            size_px: (8, 8), position_m: (0.3, 0.4, 0.8), fov_deg: 340.0, samples_per_px: 4096,
            measure: [Radiance, BrightnessTemperature],
        ) }},"#,
        material("x", "0.05, 0.9, 0.8"),
        material("y", "0.5, 0.1, 0.8"),
        material("z", "0.95, 0.3, 0.8"),
        walls("x", [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]], 0),
        walls("y", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 0.0, 1.0]], 1),
        walls("z", [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]], 2),
    ))?;
    let mut findings = Vec::new();
    for (band, nm) in THERMAL_NM.into_iter().enumerate() {
        let radiance = value(&report, "all", "radiance", band)?;
        let quantity = format!("mean radiance at {} µm, W m⁻² sr⁻¹ µm⁻¹", nm / 1000.0);
        let truth = 1000.0 * planck(nm, 300.0);
        findings.push(Finding::estimate(quantity, truth, radiance.scaled(1000.0), 0.002));
    }
    let temperature = product(&report, "all", "brightness_temperature")?;
    let image = temperature.image.as_ref().context("no image of temperatures")?;
    let pixels = image.load()?;
    let seen = pixels.values.iter().copied().filter(|kelvin| !kelvin.is_nan());
    let worst = seen.max_by(|a, b| (a - 300.0).abs().total_cmp(&(b - 300.0).abs()));
    let worst = worst.context("no pixel sees anything")?;
    let quantity = "brightness temperature of the worst pixel, K";
    findings.push(Finding::within(quantity, 300.0, worst.into(), 3e-3));
    Ok(findings)
}
