//! The energy balance of photon packets.

use super::finding::Finding;
use super::measured::{forest, measure, product};

/// Maximum error of the balance by rounding of f64, relative to the incident energy.
const BALANCE: f64 = 1e-9;

/// Zenith angle of the sun, degrees.
const ZENITH_DEG: f64 = 55.0;

/// *Scene*: the small forest under sun and sky, periodic and isolated, with a cruel roulette.
/// *Expected*: in each band incident = the sum of all other terms; what layers and instances
/// absorb sums to what is absorbed; the albedo is what is reflected.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for boundary in ["Periodic", "Isolated"] {
        let keys = forest(
            (0.0, 0.0),
            &format!(
                r#"sun: (zenith_deg: {ZENITH_DEG:?}, azimuth_deg: 10.0, irradiance: Constant(1.0)), sky: Fraction([0.3, 0.1]),
            transport: (roulette: (after_order: 1, kill: 0.5)),
            sensors: {{ "photons": Photons(
                per_m2: 4000.0, measure: [Albedo, Fapar(layer_m: 0.7), Absorbed(per: Instance)],
            ) }},"#
            ),
        );
        let keys = keys.replace("boundary: Periodic", &format!("boundary: {boundary}"));
        let report = measure(&keys)?;
        let of = |name: &str| Ok::<_, anyhow::Error>(&product(&report, "photons", name)?.values);
        let (energy, albedo, layers) = (of("energy")?, of("albedo")?, of("fapar")?);
        let instances = of("absorbed_by_instance")?;
        let bands = albedo.len();
        for (band, name) in ["red", "near infrared"].iter().enumerate() {
            let term = |index: usize| energy[index * bands + band];
            // Incident, reflected, beside, missed, lost, roulette, then what each material absorbs.
            let terms = energy.len() / bands;
            let told: f64 = (1..terms).map(term).sum();
            let absorbed: f64 = (6..terms).map(term).sum();
            let sum = |values: &[f64]| values.iter().skip(band).step_by(bands).sum::<f64>();
            let (in_layers, by_instances) = (sum(layers), sum(instances));
            // Instances absorb watts: sun and sky together have cos 55° on each of 20 m².
            let power = 20.0 * ZENITH_DEG.to_radians().cos();
            let mut finding = |quantity: &str, expected, measured| {
                let quantity = format!("{quantity}, {}, {name}", boundary.to_lowercase());
                findings.push(Finding::within(quantity, expected, measured, BALANCE));
            };
            finding("all terms but incident", term(0), told);
            finding("absorbed in layers", absorbed, in_layers);
            finding("absorbed by instances, W nm⁻¹", absorbed * power, by_instances);
            finding("albedo", term(1), albedo[band]);
        }
    }
    Ok(findings)
}
