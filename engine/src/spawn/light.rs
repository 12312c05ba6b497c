use hecs::World;

use super::Spawner;
use super::spectra::Quantity;
use crate::components::{SceneId, Sky, Sun, View};
use crate::document::{self, Diagnostic, ImageMeasure, PhotonMeasure, Sensor, Spectrum};

impl Spawner<'_> {
    /// Spawns sun and sky.
    pub(super) fn light(&mut self, world: &mut World) {
        let scene = self.scene;
        let sun = scene.sun.as_ref().and_then(|sun| {
            let irradiance =
                self.spectrum(&sun.irradiance, Quantity::Irradiance, "sun.irradiance")?;
            self.note_irradiance(&sun.irradiance, &irradiance);
            // `document::check` asks for a position; below the horizon the sun gives no light.
            let (zenith, azimuth) = sun.angles_deg()?;
            let view = View { zenith: zenith.to_radians(), azimuth: azimuth.to_radians() };
            let radius = 0.5 * sun.disc_deg.to_radians();
            Some(Sun { direction: view.direction(), radius, irradiance })
        });
        let (sun, sky) = match &scene.sky {
            document::Sky::None => (sun, None),
            document::Sky::Isotropic { irradiance } => {
                let at = "sky.irradiance";
                let irradiance = self.spectrum(irradiance, Quantity::Irradiance, at);
                (sun, irradiance.map(|irradiance| Sky { irradiance }))
            }
            document::Sky::Fraction(fractions) => {
                // `document::check` asks for a sun and for one fraction a band; the sky is dark at night.
                let sky = sun.as_ref().map(|sun| Sky {
                    irradiance: fractions
                        .iter()
                        .zip(&sun.irradiance)
                        .map(|(s, e)| e * s * sun.direction.z)
                        .collect(),
                });
                let sun = sun.map(|sun| Sun {
                    irradiance: fractions
                        .iter()
                        .zip(&sun.irradiance)
                        .map(|(s, e)| e * (1.0 - s))
                        .collect(),
                    ..sun
                });
                (sun, sky)
            }
        };
        self.doubt_dark_bands(sun.as_ref(), sky.as_ref());
        world.spawn_batch(sun.into_iter().map(|sun| (SceneId(0), sun)));
        world.spawn_batch(sky.into_iter().map(|sky| (SceneId(0), sky)));
    }

    /// Warns of bands without light where reflectance is measured: nothing has a reflectance there.
    fn doubt_dark_bands(&mut self, sun: Option<&Sun>, sky: Option<&Sky>) {
        let lights = [sun.map(|sun| &sun.irradiance), sky.map(|sky| &sky.irradiance)];
        let is_dark = |band: usize| lights.iter().flatten().all(|light| light[band] <= 0.0);
        // Reflectance is measured in bands of emission as well.
        let asks = self.scene.sensors.values().any(asks_for_reflectance);
        let bands = self.scene.bands.iter().enumerate();
        let dark: Vec<String> = bands
            .filter(|&(index, band)| (band.reflects() || asks) && is_dark(index))
            .map(|(_, band)| format!("`{}`", band.name))
            .collect();
        // Scenes without any light measure gaps and emission, or were refused.
        if dark.is_empty() || lights.iter().all(Option::is_none) {
            return;
        }
        let path = if sun.is_some() { "sun.irradiance" } else { "sky.irradiance" };
        let message = format!(
            "no light falls on the scene in {} {}: radiance is 0 there, and reflectance factors, albedo and \
             absorbed fractions have no value",
            if dark.len() == 1 { "band" } else { "bands" },
            dark.join(", ")
        );
        let help = "write an irradiance above 0, or take the bands out";
        self.problems.push(Diagnostic::warning(path, message).help(help));
    }

    /// Says which irradiance of the sun is taken where the scene need not have named one.
    fn note_irradiance(&mut self, spectrum: &Spectrum, irradiance: &[f64]) {
        /// Bands whose values are told.
        const MOST: usize = 8;
        if *spectrum != Spectrum::AstmG173 {
            return;
        }
        let bands = self.scene.bands.iter().zip(irradiance);
        let values = bands.take(MOST).map(|(band, value)| format!("{} {value:.4}", band.name));
        let more = if irradiance.len() > MOST { ", .." } else { "" };
        self.notes.push(format!(
            "sun.irradiance is that of ASTM G173, direct and circumsolar, perpendicular to the beam: \
             {}{more} W m⁻² nm⁻¹; `irradiance: Constant(1.0)` gives absolute results per unit of \
             irradiance",
            values.collect::<Vec<_>>().join(", ")
        ));
    }
}

/// Returns whether a sensor reports what is relative to the light of sun and sky.
fn asks_for_reflectance(sensor: &Sensor) -> bool {
    let of_image = |one: &ImageMeasure| matches!(one, ImageMeasure::Brf | ImageMeasure::Orders);
    let of_photons = |one: &PhotonMeasure| {
        !one.is_absolute()
            && !matches!(one, PhotonMeasure::Orders | PhotonMeasure::BrightnessTemperature)
    };
    match sensor {
        Sensor::Photons { measure, .. } => measure.iter().any(of_photons),
        other => other.image_measures().into_iter().flatten().any(of_image),
    }
}
