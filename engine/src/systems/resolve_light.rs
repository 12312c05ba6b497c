use hecs::World;

use super::spectra::{SpectrumQuantity, resolve_spectrum};
use super::{Resources, set_component};
use crate::components::{SkyLight, SunLight, View};
use crate::document::{self, Spectrum};

/// Resolves the irradiance of sun and sky to bands. Reads `document::Sun`, `document::Sky` and the resources `spectra`
/// and `bands`; writes [`SunLight`] and [`SkyLight`].
pub(super) fn resolve_light(world: &mut World, resources: &mut Resources) {
    let (sun, sky) = light(world, resources);
    set_component(world, resources.sun, sun);
    set_component(world, resources.sky, sky);
}

/// Sun and sky of the sources that the author wrote; `None` where there is none, and after an error.
fn light(world: &World, resources: &mut Resources) -> (Option<SunLight>, Option<SkyLight>) {
    let sun = world.get::<&document::Sun>(resources.sun).ok().and_then(|sun| {
        let path = &["sun", "irradiance"].into();
        let irradiance =
            resolve_spectrum(&sun.irradiance, SpectrumQuantity::Irradiance, path, resources)?;
        note_irradiance(&sun.irradiance, &irradiance, resources);
        // `document::check` asks for a position; below the horizon the sun gives no light.
        let (zenith, azimuth) = sun.angles_deg()?;
        let view = View { zenith: zenith.to_radians(), azimuth: azimuth.to_radians() };
        let radius = 0.5 * sun.disc_deg.to_radians();
        Some(SunLight { direction: view.direction(), radius, irradiance })
    });
    let sky = world.get::<&document::Sky>(resources.sky);
    match &*sky.expect("`spawn` gives the sky its source") {
        document::Sky::None => (sun, None),
        document::Sky::Isotropic { irradiance } => {
            let at = &["sky", "irradiance"].into();
            let irradiance =
                resolve_spectrum(irradiance, SpectrumQuantity::Irradiance, at, resources);
            (sun, irradiance.map(|irradiance| SkyLight { irradiance }))
        }
        document::Sky::Fraction(fractions) => {
            // `document::check` asks for a sun and for one fraction a band; the sky is dark at night.
            let sky = sun.as_ref().map(|sun| SkyLight {
                irradiance: fractions
                    .iter()
                    .zip(&sun.irradiance)
                    .map(|(s, e)| e * s * sun.direction.z)
                    .collect(),
            });
            let sun = sun.map(|sun| SunLight {
                irradiance: fractions
                    .iter()
                    .zip(&sun.irradiance)
                    .map(|(s, e)| e * (1.0 - s))
                    .collect(),
                ..sun
            });
            (sun, sky)
        }
    }
}

/// Notes the irradiance of the sun that is taken if the scene names none.
fn note_irradiance(spectrum: &Spectrum, irradiance: &[f64], resources: &mut Resources) {
    /// Bands whose values are written.
    const MOST: usize = 8;
    if *spectrum != Spectrum::AstmG173 {
        return;
    }
    let bands = resources.bands.iter().zip(irradiance);
    let values = bands.take(MOST).map(|(band, value)| format!("{} {value:.4}", band.name));
    let more = if irradiance.len() > MOST { ", .." } else { "" };
    resources.messages.note(format!(
        "sun.irradiance is that of ASTM G173, direct and circumsolar, perpendicular to the beam: \
             {}{more} W m⁻² nm⁻¹; `irradiance: Constant(1.0)` gives absolute results per unit of \
             irradiance",
        values.collect::<Vec<_>>().join(", ")
    ));
}
