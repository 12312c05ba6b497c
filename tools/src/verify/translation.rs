//! The same scene elsewhere.

use sunfleck::products::Report;

use super::finding::Finding;
use super::measured::{bits, differing, forest, measure, value};

/// Translation, m.
const FAR: f64 = 1e6;

/// *Scene*: the small forest here, with its frame anchored 1000 km away, and moved by 1000 km in its frame.
/// *Expected*: the anchor changes no bit; 1000 km from the origin coordinates are rounded to 10⁻¹⁰ m, so
/// paths are the same but for a few, and so are the results within a tenth of their errors.
pub(super) fn run() -> anyhow::Result<Vec<Finding>> {
    let sensors = r#"sun: (zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)), sky: Fraction([0.3, 0.1]),
        sensors: {
            "image": Orthographic(size_px: (24, 20), cover: WholeScene, zenith_deg: 20.0, samples_per_px: 32),
            "views": Directions(system: Backward, views: List([(0.0, 0.0), (40.0, 110.0)]), until: Samples(16384)),
            "photons": Photons(per_m2: 4000.0, measure: [Albedo, Fapar(layer_m: 1.0)]),
        },"#;
    let here = measure(&forest((0.0, 0.0), sensors))?;
    let anchor = format!("frame: (origin_m: ({FAR:?}, {:?}, 300.0)), {sensors}", 5.0 * FAR);
    let anchored = measure(&forest((0.0, 0.0), &anchor))?;
    let there = measure(&forest((FAR, -FAR), sensors))?;
    let mut findings = vec![Finding::exact(
        "anchored elsewhere: numbers that differ",
        0.0,
        differing(&bits(&here)?, &bits(&anchored)?),
    )];
    for (sensor, name, index, what) in [
        ("image", "hdrf", 0, "image, red"),
        ("image", "hdrf", 1, "image, near infrared"),
        ("views", "hdrf", 0, "HDRF at nadir, red"),
        ("views", "hdrf", 3, "HDRF at 40°, near infrared"),
        ("photons", "albedo", 1, "albedo, near infrared"),
        ("photons", "fapar_vegetation", 0, "fAPAR, red"),
    ] {
        let of = |report: &Report| value(report, sensor, name, index);
        let (one, other) = (of(&here)?, of(&there)?);
        let quantity = format!("moved in its frame: {what}");
        let limit = 0.1 * one.error / one.value;
        findings.push(Finding::within(quantity, one.value, other.value, limit));
    }
    Ok(findings)
}
