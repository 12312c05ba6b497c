//! A homogeneous layer of leaves that are small beside it: a turbid medium.

use super::finding::Finding;
use super::measured::{Estimate, measure, value};

/// Leaf area index, and (ρ, τ) of the leaves, and the reflectance of the soil: RAMI's `HOM03_TUR_UNI`.
const LAI: f64 = 3.0;
const LEAF: (f64, f64) = (0.4957, 0.4409);
const SOIL: f64 = 0.159;

/// Height of the layer, radius of its leaves, and side of the square that repeats, m.
const HEIGHT: f64 = 2.0;
const RADIUS: f64 = 0.01;
const SIDE: f64 = 1.25;

/// Layers of other leaves, all of the same kind.
const REPEATS: u32 = 24;

/// Relative error of a flux by the finite size of leaves: they hide each other's shadow near the hot spot, whose
/// width is their size over the height of the layer.
const OF_LEAF_SIZE: f64 = 0.003;

/// Views (zenith, azimuth), degrees, away from the hot spot: those of the BRF on the far side of the
/// sun at azimuth 0, then those of gap fractions.
const BRF_VIEWS: [(f64, f64); 2] = [(21.0, 180.0), (61.0, 180.0)];
const GAP_VIEWS: [(f64, f64); 3] = [(0.0, 0.0), (30.0, 90.0), (60.0, 250.0)];

/// Values of the turbid layer in the near infrared under the sun at 20°: albedo, absorbed by leaves,
/// flux at the soil, uncollided flux at the soil, and the BRF of [`BRF_VIEWS`].
///
/// Source: solved apart from this program by adding and doubling of layers, which closes energy to 1e-5
/// and is reciprocal to 1e-9; the uncollided flux is `exp(-LAI / (2 cos 20°))`.
const ALBEDO: f64 = 0.413_188;
const ABSORBED: f64 = 0.161_854;
const AT_SOIL: f64 = 0.505_301;
const UNCOLLIDED: f64 = 0.202_651;
const BRF: [f64; 2] = [0.374_047, 0.412_363];

/// *Scene*: such layers, each of other leaves; the spread among them is the error, which so holds how leaves
/// happen to lie. *Expected*: gap fractions `exp(-G LAI / cos θ)` with G = 1/2 as normals are even on the sphere;
/// fluxes and BRF of the turbid medium.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let names = ["albedo", "absorbed by leaves", "flux at the soil", "the same uncollided"];
    let mut quantities: Vec<(String, f64, f64)> = names
        .iter()
        .zip([ALBEDO, ABSORBED, AT_SOIL, UNCOLLIDED])
        .map(|(name, expected)| ((*name).to_owned(), expected, OF_LEAF_SIZE))
        .collect();
    quantities.extend(
        BRF_VIEWS.iter().zip(BRF).map(|(view, brf)| {
            (format!("BRF at {}°, away from the sun", view.0), brf, OF_LEAF_SIZE)
        }),
    );
    quantities.extend(GAP_VIEWS.iter().map(|view| {
        let gap = (-0.5 * LAI / view.0.to_radians().cos()).exp();
        (format!("gap fraction at {}°", view.0), gap, 0.0)
    }));
    let mut values = vec![Vec::new(); quantities.len()];
    for seed in 1..=REPEATS {
        for (values, value) in values.iter_mut().zip(layer(seed)?) {
            values.push(value);
        }
    }
    let findings = quantities.into_iter().zip(&values);
    Ok(findings
        .map(|((quantity, expected, share), values)| {
            let found = Estimate::from_repeats(values);
            let finding = Finding::estimate(quantity, expected, found, 0.02);
            if share > 0.0 { finding.with_tolerance(share) } else { finding }
        })
        .collect())
}

/// Measurements of one layer, in the order of the quantities.
fn layer(seed: u32) -> anyhow::Result<Vec<f64>> {
    let views = |views: &[(f64, f64)]| {
        let views: Vec<_> = views.iter().map(|(z, a)| format!("({z:?}, {a:?})")).collect();
        format!("List([{}])", views.join(", "))
    };
    let ((rho, tau), area, middle) = (LEAF, LAI * SIDE * SIDE, 0.5 * SIDE);
    let report = measure(&format!(
        r#"bands: [(name: "nir", center_nm: 865.0)],
        materials: {{
            "soil": Lambertian(reflectance: Constant({SOIL:?})),
            "leaf": Leaf(reflectance: Constant({rho:?}), transmittance: Constant({tau:?})),
        }},
        meshes: {{ "layer": Crown(
            shape: Box(size_m: ({SIDE:?}, {SIDE:?}, {:?})), base_m: {RADIUS:?}, leaf_area_m2: {area:?},
            leaf_angle: Spherical, leaf: Disc(radius_m: {RADIUS:?}), leaf_material: "leaf", seed: {seed},
        ) }},
        terrain: Plane(size_m: ({SIDE:?}, {SIDE:?}), material: "soil"),
        instances: [List(of: "layer", at_m: [({middle:?}, {middle:?}, 0.0)])],
        sun: (zenith_deg: 20.0, irradiance: Constant(1.0)),
        boundary: Periodic,
        transport: (seed: {seed}),
        sensors: {{
            "photons": Photons(per_m2: 10000.0, measure: [Albedo, Fapar(layer_m: {HEIGHT:?})]),
            "brf": Directions(system: Backward, views: {}, until: Samples(8192)),
            "gaps": Directions(system: Backward, views: {}, until: Samples(16384), measure: [GapFraction]),
        }},"#,
        HEIGHT - RADIUS,
        views(&BRF_VIEWS),
        views(&GAP_VIEWS),
    ))?;
    let mut values = vec![
        value(&report, "photons", "albedo", 0)?.value,
        value(&report, "photons", "fapar_vegetation", 0)?.value,
        value(&report, "photons", "ftran", 0)?.value,
        value(&report, "photons", "ftran", 1)?.value,
    ];
    for view in 0..BRF_VIEWS.len() {
        values.push(value(&report, "brf", "brf", view)?.value);
    }
    for view in 0..GAP_VIEWS.len() {
        values.push(value(&report, "gaps", "gap_fraction", view)?.value);
    }
    Ok(values)
}
