//! Sun and view swapped.

use super::finding::Finding;
use super::measured::{forest, measure, value};

/// Pairs of directions (zenith, azimuth), degrees.
const PAIRS: [[(f64, f64); 2]; 2] = [[(0.0, 0.0), (50.0, 200.0)], [(30.0, 40.0), (65.0, 250.0)]];

/// *Scene*: trunks, transmitting leaves of two kinds and a leaning wall, periodic. *Expected*: the mean
/// BRF with the sun at a and the view at b is that with the sun at b and the view at a: in each pair,
/// one is traced from the view and the other from the sun.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for [a, b] in PAIRS {
        let brf = |sun: (f64, f64), view: (f64, f64), sensor: &str| {
            let light = format!(
                "sun: (zenith_deg: {:?}, azimuth_deg: {:?}, irradiance: Constant(1.0)),",
                sun.0, sun.1
            );
            let view = format!("[({:?}, {:?})]", view.0, view.1);
            let sensor = sensor.replace("VIEW", &view);
            measure(&forest((0.0, 0.0), &format!("{light} sensors: {{ \"one\": {sensor} }},")))
        };
        let one =
            brf(a, b, "Directions(system: Backward, views: List(VIEW), until: Samples(524288))")?;
        let other = brf(b, a, "Photons(per_m2: 64000.0, measure: [BrfViews(List(VIEW))])")?;
        for (band, name) in ["red", "near infrared"].iter().enumerate() {
            let one = value(&one, "one", "brf", band)?;
            let other = value(&other, "one", "brf_views", band)?;
            let quantity = format!("BRF {}° ↔ {}°, {name}, ratio", a.0, b.0);
            findings.push(Finding::estimate(quantity, 1.0, one.over(other), 0.0025));
        }
    }
    Ok(findings)
}
