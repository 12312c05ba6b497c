//! Transport systems: which sensor can be measured by which.

use super::super::scene::{Sensor, System};
use super::Report;

/// Whether a sensor can be measured by the system that it asks for.
pub(super) fn check_system(path: &str, sensor: &Sensor, report: &mut Report<'_>) {
    let (Sensor::Orthographic { system, .. }
    | Sensor::Perspective { system, .. }
    | Sensor::Fisheye { system, .. }
    | Sensor::Directions { system, .. }
    | Sensor::Photons { system, .. }) = *sensor;
    if let Sensor::Photons { measure, .. } = sensor
        && system == System::Analog
    {
        let views = measure.iter().position(|measure| !measure.is_measured_by(system));
        if let Some(index) = views {
            let help = "measure cones, such as `BrfCones([(30.0, 90.0, 5.0)])`, or take `system: Analog` out";
            report.error(&format!("{path}.measure[{index}]"), WHOLE, help);
        }
    }
    if sensor.systems().contains(&system) {
        return;
    }
    let (message, help) = match (sensor, system) {
        (Sensor::Photons { .. }, _) => (
            "photons come from the sources of light",
            "write `system: Forward` or `system: Analog`",
        ),
        (Sensor::Perspective { .. } | Sensor::Fisheye { .. }, System::Forward) => (
            "photon packets never meet the one point that this camera looks from",
            "take `system: Forward` out; only orthographic images can be drawn forward",
        ),
        _ => (WHOLE, "take `system: Analog` out; it is for `Photons`"),
    };
    report.error(&format!("{path}.system"), message, help);
}

const WHOLE: &str =
    "a photon that is followed as a whole never leaves in the very direction of a view";
