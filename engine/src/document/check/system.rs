//! Transport systems: which sensor can be measured by which.

use super::super::scene::{ImageMeasure, Photons, Scene, Sensor, System};
use super::Report;

/// Checks that the transport system of a sensor can measure its quantities.
pub(super) fn check_system(path: &str, sensor: &Sensor, scene: &Scene, report: &mut Report<'_>) {
    let Some(system) = sensor.system() else { return };
    if let Sensor::Photons(Photons { measure, .. }) = sensor
        && system == System::Analog
    {
        let views = measure.iter().position(|measure| !measure.is_measured_by(system));
        if let Some(index) = views {
            let help = "measure cones, such as `BrfCones([(30.0, 90.0, 5.0)])`, or take `system: Analog` out";
            report.error(&format!("{path}.measure[{index}]"), WHOLE, help);
        }
    }
    if let Some(measures) = sensor.image_measures()
        && system == System::FirstOrder
    {
        let other = measures.iter().position(|one| !one.is_measured_by(system, scene));
        if let Some(index) = other {
            let measure = &measures[index];
            let is_light = matches!(measure, ImageMeasure::Brf | ImageMeasure::Radiance);
            let (message, help) = if is_light && scene.transport.most_orders() > 1 {
                let message = format!(
                    "`{measure:?}` is of light of all orders, and `FirstOrder` measures what was scattered once"
                );
                (
                    message,
                    "write `measure: [Orders]` for `brf_uc` and `brf_co_sgl`, or `transport: (first_order_only: true)`",
                )
            } else {
                let message = format!("`{measure:?}` is not of light that was scattered once");
                (message, "measure `Orders`, or take `system: FirstOrder` out")
            };
            report.error(&format!("{path}.measure[{index}]"), message, help);
        }
    }
    if let Some(measures) = sensor.image_measures()
        && system == System::Reference
    {
        let first_hit = [ImageMeasure::FourComponents, ImageMeasure::GapFraction];
        let other = measures
            .iter()
            .position(|one| !one.is_measured_by(system, scene) && !first_hit.contains(one));
        if let Some(index) = other {
            let measure = &measures[index];
            let message = format!("`Reference` does not measure `{measure:?}` in this scene");
            let help =
                "measure `Brf`, or `Radiance` without emission, or take `system: Reference` out";
            report.error(&format!("{path}.measure[{index}]"), message, help);
        }
    }
    if sensor.systems().contains(&system) {
        return;
    }
    let (message, help) = match (sensor, system) {
        (Sensor::Photons(_), _) => (
            "photons come from the sources of light",
            "write `system: Forward` or `system: Analog`",
        ),
        (Sensor::Perspective(_) | Sensor::Fisheye(_), System::Forward) => (
            "photon packets never meet the one point that this camera looks from",
            "take `system: Forward` out; only orthographic images can be drawn forward",
        ),
        _ => (WHOLE, "take `system: Analog` out; it is for `Photons`"),
    };
    report.error(&format!("{path}.system"), message, help);
}

const WHOLE: &str =
    "a photon that is followed as a whole never leaves in the very direction of a view";
