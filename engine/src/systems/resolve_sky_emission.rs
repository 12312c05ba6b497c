use hecs::World;

use super::resolve_temperatures::black_body_radiance;
use super::spectra::{SpectrumQuantity, resolve_spectrum};
use super::{Resources, set_component};
use crate::components::Emission;
use crate::counts::noun_of;
use crate::document::{Band, ThermalSky};

/// Resolves the emission of the sky if a sensor measures emission. Reads `document::ThermalSky` and the resources
/// `spectra` and `bands`; writes [`Emission`] of the sky.
pub(super) fn resolve_sky_emission(world: &mut World, resources: &mut Resources) {
    let radiance = resources.measures_emission.then(|| radiance(world, resources)).flatten();
    let bands = resources.bands.iter().map(Band::emits).collect();
    let emission = radiance.map(|sky| Emission { bands, sky });
    set_component(world, resources.sky, emission);
}

fn radiance(world: &World, resources: &mut Resources) -> Option<Vec<f64>> {
    let sky = world.get::<&ThermalSky>(resources.sky);
    match &*sky.expect("`spawn` gives the sky its source") {
        ThermalSky::None => {
            note_cold_sky(resources);
            Some(vec![0.0; resources.bands.len()])
        }
        ThermalSky::BlackBody(kelvin) => Some(black_body_radiance(resources, *kelvin)),
        ThermalSky::Radiance(radiance) => resolve_spectrum(
            radiance,
            SpectrumQuantity::Irradiance,
            &"thermal_sky".into(),
            resources,
        ),
    }
}

/// Notes that the sky emits nothing, which lowers brightness temperatures.
fn note_cold_sky(resources: &mut Resources) {
    let bands = resources.bands.iter().filter(|band| band.emits());
    let names: Vec<String> = bands.map(|band| format!("`{}`", band.name)).collect();
    if !names.is_empty() {
        resources.messages.note(format!(
            "no `thermal_sky` is given: the sky emits nothing in {} {}, as if it were at 0 K, and surfaces \
             reflect none of it; a clear sky is about `thermal_sky: BlackBody(250.0)`",
            noun_of(names.len(), "band"),
            names.join(", ")
        ));
    }
}
