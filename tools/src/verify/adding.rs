//! Horizontal leaf sheets, whose exchange is that of layers.

use super::finding::Finding;
use super::measured::{measure, value};

/// (ρ, τ) of the upper and the lower sheet, and the reflectance of the soil.
const UPPER: (f64, f64) = (0.45, 0.4);
const LOWER: (f64, f64) = (0.25, 0.6);
const SOIL: f64 = 0.3;

/// *Scene*: a sheet over bare soil, another one, both over the same soil, each as wide as the tile.
/// *Expected*: what Lambertian layers send out is diffuse whatever comes in, so R₁₂ = R₁ + T₁² R₂ / (1 - R₁ R₂)
/// for any view, and what each absorbs follows from the fluxes between them.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let over = |(r, t): (f64, f64), below: f64| r + t * t * below / (1.0 - r * below);
    let one = over(LOWER, SOIL);
    let both = over(UPPER, one);
    let mut findings = Vec::new();
    for (name, places, expected) in [
        ("lower sheet", "\"lower\"", one),
        ("upper sheet", "\"upper\"", over(UPPER, SOIL)),
        ("both sheets", "\"lower\", \"upper\"", both),
    ] {
        let report = scene(places)?;
        let albedo = value(&report, "photons", "albedo", 0)?;
        findings.push(Finding::estimate(format!("{name}: albedo"), expected, albedo, 0.002));
        let brf = value(&report, "view", "brf", 0)?;
        findings.push(Finding::estimate(format!("{name}: BRF"), expected, brf, 0.002));
        if name == "both sheets" {
            // Fluxes down behind each sheet, for 1 that comes in.
            let between = UPPER.1 / (1.0 - UPPER.0 * one);
            let ground = between * LOWER.1 / (1.0 - LOWER.0 * SOIL);
            let down = value(&report, "photons", "ftran", 0)?;
            findings.push(Finding::estimate("both sheets: flux at the soil", ground, down, 0.002));
            let absorbed = [
                ("soil", (1.0 - SOIL) * ground),
                ("lower", (1.0 - LOWER.0 - LOWER.1) * (between + SOIL * ground)),
                ("upper", (1.0 - UPPER.0 - UPPER.1) * (1.0 + one * between)),
            ];
            for (index, (material, expected)) in absorbed.into_iter().enumerate() {
                let fapar = value(&report, "photons", "fapar_material", index)?;
                let quantity = format!("both sheets: absorbed by {material}");
                findings.push(Finding::estimate(quantity, expected, fapar, 0.002));
            }
        }
    }
    Ok(findings)
}

fn scene(sheets: &str) -> anyhow::Result<sunfleck::products::Report> {
    let leaf = |(r, t): (f64, f64)| {
        format!("Leaf(reflectance: Constant({r:?}), transmittance: Constant({t:?}))")
    };
    let sheet = |height: f64, material: &str| {
        let corners = [(-1.0, -1.0), (5.0, -1.0), (5.0, 5.0), (-1.0, 5.0)];
        let corners: Vec<_> =
            corners.iter().map(|(x, y)| format!("({x:?}, {y:?}, {height:?})")).collect();
        format!("Faces(faces_m: [[{}]], material: \"{material}\")", corners.join(", "))
    };
    let places: Vec<_> = sheets
        .split(", ")
        .map(|name| format!("List(of: {name}, at_m: [(0.0, 0.0, 0.0)])"))
        .collect();
    measure(&format!(
        r#"bands: [(name: "a", center_nm: 660.0)],
        materials: {{
            "soil": Lambertian(reflectance: Constant({SOIL:?})), "lower": {}, "upper": {},
        }},
        meshes: {{ "lower": {}, "upper": {} }},
        terrain: Plane(size_m: (4.0, 4.0), material: "soil"),
        instances: [{}],
        sun: (zenith_deg: 35.0, azimuth_deg: 10.0, irradiance: Constant(1.0)),
        boundary: Periodic,
        sensors: {{
            "photons": Photons(per_m2: 30000.0, measure: [Albedo, Fapar(layer_m: 2.0)]),
            "view": Directions(system: Backward, views: List([(60.0, 200.0)]), until: Samples(131072)),
        }},"#,
        leaf(LOWER),
        leaf(UPPER),
        sheet(1.0, "lower"),
        sheet(1.5, "upper"),
        places.join(", ")
    ))
}
