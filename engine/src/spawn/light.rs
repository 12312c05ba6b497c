use hecs::World;

use super::Spawner;
use super::spectra::Quantity;
use crate::components::{SceneId, Sky, Sun, View};
use crate::document;

impl Spawner<'_> {
    /// Spawns sun and sky.
    pub(super) fn light(&mut self, world: &mut World) {
        let scene = self.scene;
        let sun = scene.sun.as_ref().and_then(|sun| {
            let irradiance =
                self.spectrum(&sun.irradiance, Quantity::Irradiance, "sun.irradiance")?;
            // `document::check` asks for a position.
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
                // `document::check` asks for a sun and for one fraction a band.
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
        world.spawn_batch(sun.into_iter().map(|sun| (SceneId(0), sun)));
        world.spawn_batch(sky.into_iter().map(|sky| (SceneId(0), sky)));
    }
}
