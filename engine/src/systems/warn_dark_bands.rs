use hecs::World;

use super::Resources;
use crate::components::{SkyLight, SunLight};
use crate::counts::noun_of;
use crate::document::{Diagnostic, ImageMeasure, PhotonMeasure, Sensor};

/// Warns of bands without light in which a sensor measures reflectance. Reads [`SunLight`], [`SkyLight`] and `document::Sensor`.
pub(super) fn warn_dark_bands(world: &mut World, resources: &mut Resources) {
    let sun = world.get::<&SunLight>(resources.sun).ok();
    let sky = world.get::<&SkyLight>(resources.sky).ok();
    let lights = [sun.as_ref().map(|sun| &sun.irradiance), sky.as_ref().map(|sky| &sky.irradiance)];
    let is_dark = |band: usize| lights.iter().flatten().all(|light| light[band] <= 0.0);
    // Reflectance is measured in bands of emission as well.
    let asks = resources.sensors.values().any(|&sensor| {
        world.get::<&Sensor>(sensor).is_ok_and(|sensor| asks_for_reflectance(&sensor))
    });
    let bands = resources.bands.iter().enumerate();
    let dark: Vec<String> = bands
        .filter(|&(index, band)| (band.reflects() || asks) && is_dark(index))
        .map(|(_, band)| format!("`{}`", band.name))
        .collect();
    // Scenes without any light measure gaps and emission, or were refused.
    if dark.is_empty() || lights.iter().all(Option::is_none) {
        return;
    }
    let path = [if sun.is_some() { "sun" } else { "sky" }, "irradiance"];
    let message = format!(
        "no light falls on the scene in {} {}: radiance is 0 there, and reflectance factors, albedo and \
             absorbed fractions have no value",
        noun_of(dark.len(), "band"),
        dark.join(", ")
    );
    let help = "write an irradiance above 0, or take the bands out";
    resources.messages.report(Diagnostic::warning(path, message).help(help));
}

/// Returns whether a sensor reports what is relative to the light of sun and sky.
fn asks_for_reflectance(sensor: &Sensor) -> bool {
    let of_image = |one: &ImageMeasure| matches!(one, ImageMeasure::Brf | ImageMeasure::Orders);
    let of_photons = |one: &PhotonMeasure| {
        !one.is_absolute()
            && !matches!(one, PhotonMeasure::Orders | PhotonMeasure::BrightnessTemperature)
    };
    sensor.any_measure(of_image, of_photons)
}
