//! Warnings about light of isolated scenes that takes another way than through the footprint.

use hecs::World;

use super::sensors::{self, SensorEntity};
use crate::components::ResolvedSensor;
use crate::extract::Stage;
use crate::terrain::Ground;
use crate::transport::LightBeside;

/// Fraction of the light beside the footprint above which a warning says so.
const NOTABLE: f64 = 0.01;

/// Warnings for sensors that measure per area of the ground's rectangle, from a pilot run: those of each scene whose bands
/// the stage holds, all with the same number of bands.
pub(super) fn warnings(world: &World, stage: &Stage, scenes: usize) -> Vec<Vec<String>> {
    let refers_to_ground = |one: &SensorEntity| match &one.sensor {
        ResolvedSensor::Image(_) => false,
        ResolvedSensor::Directions(directions) => directions.plane.is_none(),
        ResolvedSensor::Photons(photons) => photons.plane.is_none(),
    };
    let none = || vec![Vec::new(); scenes];
    if !sensors::in_order(world).iter().any(refers_to_ground) {
        return none();
    }
    let Some(light) = LightBeside::from_pilot_run(stage) else { return none() };
    let remedy = remedy(world);
    let bands = stage.bands / scenes;
    let largest = |fractions: &[f64], scene: usize| {
        fractions[scene * bands..(scene + 1) * bands].iter().copied().fold(0.0, f64::max)
    };
    (0..scenes)
        .map(|scene| {
            let (incoming, outgoing) =
                (largest(&light.incoming, scene), largest(&light.outgoing, scene));
            of_scene(incoming, outgoing, &remedy)
        })
        .collect()
}

/// Warnings about the largest fractions in the bands of one scene.
fn of_scene(incoming: f64, outgoing: f64, remedy: &str) -> Vec<String> {
    let mut warnings = Vec::new();
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

/// Text about what to write instead: a ground is repeated only if its opposite sides meet.
fn remedy(world: &World) -> String {
    let mut grounds = world.query::<&Ground>();
    let step = grounds.iter().map(|ground| ground.steps_between_sides().max_element());
    match step.fold(0.0, f64::max) {
        step if step > Ground::SEAM => format!(
            "take a larger terrain than the area that is measured, or read the BRF of an `Orthographic` camera over its middle (scenes/ISOLATED.md): `boundary: Periodic` would put walls of up to {step:.1} m between opposite sides of the ground"
        ),
        _ => "a larger terrain or `boundary: Periodic` avoids it (scenes/ISOLATED.md)".to_owned(),
    }
}

fn percent(fraction: f64) -> String {
    format!("{:.*} %", usize::from(fraction < 0.1), 100.0 * fraction)
}
