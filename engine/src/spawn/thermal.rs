use hecs::World;

use super::Spawner;
use super::spectra::Quantity;
use crate::components::{BlackBody, Emission, SceneId};
use crate::document::{Band, Diagnostic, Material, ThermalSky};
use crate::spectral::{BandWindow, planck_mean};

impl Spawner<'_> {
    /// Spawns what the sky emits and which bands hold emission, if a sensor measures it.
    pub(super) fn emission(&mut self, world: &mut World) {
        let scene = self.scene;
        if !scene.measures_emission() {
            return;
        }
        let sky = match &scene.thermal_sky {
            ThermalSky::None => {
                self.note_cold_sky();
                Some(vec![0.0; scene.bands.len()])
            }
            ThermalSky::BlackBody(kelvin) => Some(black(&scene.bands, *kelvin)),
            ThermalSky::Radiance(radiance) => {
                self.spectrum(radiance, Quantity::Irradiance, "thermal_sky")
            }
        };
        if let Some(sky) = sky {
            let bands = scene.bands.iter().map(Band::emits).collect();
            world.spawn((SceneId(0), Emission { bands, sky }));
        }
    }

    /// Says that the sky emits nothing, which lowers brightness temperatures.
    fn note_cold_sky(&mut self) {
        let bands = self.scene.bands.iter().filter(|band| band.emits());
        let names: Vec<String> = bands.map(|band| format!("`{}`", band.name)).collect();
        if !names.is_empty() {
            self.notes.push(format!(
                "no `thermal_sky` is given: the sky emits nothing in {} {}, as if it were at 0 K, and surfaces \
                 reflect none of it; a clear sky is about `thermal_sky: BlackBody(250.0)`",
                if names.len() == 1 { "band" } else { "bands" },
                names.join(", ")
            ));
        }
    }

    /// Radiance of a black body as warm as a material that is worn, if a sensor measures emission.
    pub(super) fn black_body(&mut self, material: &Material, path: &str) -> Option<BlackBody> {
        let scene = self.scene;
        if !scene.measures_emission() {
            return None;
        }
        let Some(temperature) = material.temperature() else {
            let bands: Vec<String> = scene
                .bands
                .iter()
                .filter(|band| band.emits())
                .map(|band| format!("`{}`", band.name))
                .collect();
            let message = format!(
                "a sensor measures what this material emits in band {}, and it has no temperature",
                bands.join(", ")
            );
            self.problems.push(Diagnostic::error(path, message).help(
                "write `temperature: Uniform(300.0)`, or in the band `source: Sunlight` for what \
                 is reflected alone",
            ));
            return None;
        };
        let (sunlit, shaded) = temperature.sunlit_and_shaded();
        Some(BlackBody { sunlit: black(&scene.bands, sunlit), shaded: black(&scene.bands, shaded) })
    }
}

/// Mean radiance of a black body in each band that holds emission, 0 in others.
fn black(bands: &[Band], kelvin: f64) -> Vec<f64> {
    bands
        .iter()
        .map(|band| {
            let window = BandWindow { center: band.center_nm, width: band.width_nm };
            if band.emits() { planck_mean(window, kelvin) } else { 0.0 }
        })
        .collect()
}
