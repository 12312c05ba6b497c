use hecs::World;

use super::spectra::{Quantity, reads_file, resolve_spectrum};
use super::{Resources, set_component};
use crate::components::{EnergyGain, LambertianOptics, MaterialId, SurfaceOptics};
use crate::document::{Diagnostic, Material, Spectrum};

/// Resolves the spectra of used materials to bands, and checks the others as far as that takes no file. Reads
/// `document::Material` and the resources `spectra`, `bands` and `used_materials`; writes [`SurfaceOptics`].
pub(super) fn resolve_optics(world: &mut World, resources: &mut Resources) {
    let materials: Vec<_> =
        resources.materials.iter().map(|(name, &entity)| (name.clone(), entity)).collect();
    for (index, (name, entity)) in materials.into_iter().enumerate() {
        let path = format!("materials.{name}");
        let is_used = resources.used_materials.contains(&MaterialId(index as u32));
        if !is_used {
            resources.messages.skip(format!("material `{name}`: nothing wears it"));
        }
        let optics = {
            let material = world.get::<&Material>(entity);
            let material = material.expect("`spawn` gives materials their source");
            let reads_file =
                material.spectra().any(|(_, spectrum)| reads_file(spectrum, resources));
            if is_used || !reads_file { optics(&material, &path, resources) } else { None }
        };
        set_component(world, entity, optics.filter(|_| is_used));
    }
}

/// Optics of a material; `None` after an error.
fn optics(material: &Material, path: &str, resources: &mut Resources) -> Option<SurfaceOptics> {
    let at = |key: &str| format!("{path}.{key}");
    let reflectance = material.reflectance();
    let front = resolve_spectrum(reflectance, Quantity::Reflectance, &at("reflectance"), resources);
    let back = match material.back_reflectance() {
        Some(back) => {
            resolve_spectrum(back, Quantity::Reflectance, &at("back_reflectance"), resources)
        }
        None => front.clone(),
    };
    let opaque = Spectrum::Constant(0.0);
    let transmittance = material.transmittance().unwrap_or(&opaque);
    let through =
        resolve_spectrum(transmittance, Quantity::Transmittance, &at("transmittance"), resources);
    match LambertianOptics::new(&front?, &back?, &through?) {
        Ok(optics) => Some(SurfaceOptics::BiLambertian(optics)),
        Err(EnergyGain { band, reflectance, transmittance }) => {
            let band = &resources.bands[band].name;
            // As many digits as tell the sum from 1, without the rounding of the sum itself.
            let sum = format!("{:.12}", reflectance + transmittance);
            let sum = sum.trim_end_matches('0').trim_end_matches('.');
            resources.messages.report(
                Diagnostic::error(
                    path,
                    format!(
                        "in band `{band}` reflectance {reflectance} and transmittance \
                             {transmittance} sum to {sum}: a surface cannot send out more light \
                             than it receives"
                    ),
                )
                .help("lower one of them so that they sum to at most 1"),
            );
            None
        }
    }
}
