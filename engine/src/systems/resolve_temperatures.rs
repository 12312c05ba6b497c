use hecs::World;

use super::{Resources, set_component};
use crate::components::{BlackBody, MaterialId};
use crate::document::{Band, Diagnostic, Material, ScenePath};
use crate::spectral::{BandResponse, planck_mean};

/// Resolves the temperatures of used materials to radiance if a sensor measures emission. Reads `document::Material` and
/// the resources `bands` and `used_materials`; writes [`BlackBody`].
pub(super) fn resolve_temperatures(world: &mut World, resources: &mut Resources) {
    for (index, (name, &entity)) in resources.materials.iter().enumerate() {
        let is_used = resources.used_materials.contains_key(&MaterialId(index as u32));
        let body = if is_used && resources.measures_emission {
            let material = world.get::<&Material>(entity);
            let material = material.expect("`spawn` gives materials their source");
            black_body(&material, resources)
                .map_err(|message| {
                    let path = ScenePath::from("materials").name(name);
                    resources.messages.report(Diagnostic::error(path, message).help(
                        "write `temperature: Uniform(300.0)`, or in the band `source: Sunlight` for what \
                         is reflected alone",
                    ));
                })
                .ok()
        } else {
            None
        };
        set_component(world, entity, body);
    }
}

/// Radiance of a black body with the temperature of a material; a message if it has no temperature.
fn black_body(material: &Material, resources: &Resources) -> Result<BlackBody, String> {
    let Some(temperature) = material.temperature() else {
        let emitting = resources.bands.iter().filter(|band| band.emits());
        let names: Vec<String> = emitting.map(|band| format!("`{}`", band.name)).collect();
        return Err(format!(
            "a sensor measures what this material emits in band {}, and it has no temperature",
            names.join(", ")
        ));
    };
    let (sunlit, shaded) = temperature.sunlit_and_shaded();
    Ok(BlackBody {
        sunlit: black_body_radiance(resources, sunlit),
        shaded: black_body_radiance(resources, shaded),
    })
}

/// Mean radiance of a black body in each band that holds emission, W m⁻² sr⁻¹ nm⁻¹; 0 in other bands. Shape `[bands]`.
pub(super) fn black_body_radiance(resources: &Resources, kelvin: f64) -> Vec<f64> {
    let bands = resources.bands.iter().zip(resources.responses.all());
    let mean = |(band, response): (&Band, &BandResponse)| {
        if band.emits() { planck_mean(response, kelvin) } else { 0.0 }
    };
    bands.map(mean).collect()
}
