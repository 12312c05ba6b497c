//! Warnings about light of isolated scenes that takes another way than through the footprint.

use super::sensors::SensorEntity;
use crate::components::ResolvedSensor;
use crate::extract::Stage;
use crate::transport::LightBeside;

/// Fraction of the light beside the footprint above which a warning says so.
const NOTABLE: f64 = 0.01;

/// Warnings for sensors that measure per area of the ground's rectangle, from a pilot run.
pub(super) fn warnings(sensors: &[SensorEntity], stage: &Stage) -> Vec<String> {
    let refers_to_ground = |sensor: &ResolvedSensor| match sensor {
        ResolvedSensor::Image(_) => false,
        ResolvedSensor::Directions(directions) => directions.plane.is_none(),
        ResolvedSensor::Photons(photons) => photons.plane.is_none(),
    };
    if !sensors.iter().any(|one| refers_to_ground(&one.sensor)) {
        return Vec::new();
    }
    let Some(LightBeside { incoming, outgoing }) = LightBeside::from_pilot_run(stage) else {
        return Vec::new();
    };
    let mut warnings = Vec::new();
    let remedy = "a larger terrain or `boundary: Periodic` avoids it (scenes/ISOLATED.md)";
    if outgoing > NOTABLE {
        warnings.push(format!(
            "boundary: {} of the light that the scene scatters upwards leaves on lines beside the rectangle of its ground, from what stands high above it or over its edge: directions, albedo and cells do not count it (`beside` in `energy`); {remedy}",
            percent(outgoing)
        ));
    }
    if incoming > NOTABLE {
        warnings.push(format!(
            "boundary: {} of the light that the scene intercepts arrives on lines beside the rectangle of its ground: what is reflected and absorbed per m\u{b2} of ground includes it, and can exceed the irradiance there; {remedy}",
            percent(incoming)
        ));
    }
    warnings
}

fn percent(fraction: f64) -> String {
    format!("{:.*} %", usize::from(fraction < 0.1), 100.0 * fraction)
}
