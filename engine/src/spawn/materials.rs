use std::collections::BTreeSet;

use hecs::World;

use super::Spawner;
use super::spectra::Quantity;
use crate::components::{EnergyGain, MaterialId, Name, SceneId, SurfaceOptics};
use crate::document::{Diagnostic, Material, Spectrum, unknown_name};

impl Spawner<'_> {
    /// Id of a material by its name.
    pub(super) fn material_id(&self, name: &str) -> Option<MaterialId> {
        self.scene.materials.get_index_of(name).map(|index| MaterialId(index as u32))
    }

    /// Id of a material, or a note that there is none of this name.
    pub(super) fn known_material(&mut self, name: &str, path: &str) -> Option<MaterialId> {
        let id = self.material_id(name);
        if id.is_none() {
            let known = self.scene.materials.keys().map(String::as_str);
            self.problems.push(unknown_name(path, "material", name, known));
        }
        id
    }

    /// Spawns the materials that the terrain and the parts of used meshes wear (`used`). Others are
    /// looked at as far as that takes no file: what is wrong with them should not wait until they are
    /// used.
    pub(super) fn materials(&mut self, used: &BTreeSet<MaterialId>, world: &mut World) {
        let scene = self.scene;
        for (index, (name, material)) in scene.materials.iter().enumerate() {
            let path = format!("materials.{name}");
            if used.contains(&MaterialId(index as u32)) {
                let id = SceneId(index as u32);
                let optics = self.optics(material, &path);
                let warmth = self.black_body(material, &path);
                if let Some(optics) = optics {
                    let entity = world.spawn((id, Name(name.clone()), optics));
                    if let Some(warmth) = warmth {
                        world.insert_one(entity, warmth).expect("it was just spawned");
                    }
                }
                continue;
            }
            self.skipped.push(format!("material `{name}`: nothing wears it"));
            if !spectra_of(material).into_iter().any(|spectrum| self.reads_file(spectrum)) {
                self.optics(material, &path);
            }
        }
    }

    fn optics(&mut self, material: &Material, path: &str) -> Option<SurfaceOptics> {
        let (reflectance, back, transmittance) = match material {
            Material::Lambertian { reflectance, back_reflectance, .. } => {
                (reflectance, back_reflectance, &Spectrum::Constant(0.0))
            }
            Material::Leaf { reflectance, transmittance, back_reflectance, .. } => {
                (reflectance, back_reflectance, transmittance)
            }
        };
        let at = |key: &str| format!("{path}.{key}");
        let front = self.spectrum(reflectance, Quantity::Reflectance, &at("reflectance"));
        let back = match back {
            Some(back) => self.spectrum(back, Quantity::Reflectance, &at("back_reflectance")),
            None => front.clone(),
        };
        let through = self.spectrum(transmittance, Quantity::Transmittance, &at("transmittance"));
        match SurfaceOptics::new(&front?, &back?, &through?) {
            Ok(optics) => Some(optics),
            Err(EnergyGain { band, reflectance, transmittance }) => {
                let band = &self.scene.bands[band].name;
                // As many digits as tell the sum from 1, without the rounding of the sum itself.
                let sum = format!("{:.12}", reflectance + transmittance);
                let sum = sum.trim_end_matches('0').trim_end_matches('.');
                self.problems.push(
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
}

/// All spectra of a material.
fn spectra_of(material: &Material) -> Vec<&Spectrum> {
    match material {
        Material::Lambertian { reflectance, back_reflectance, .. } => {
            std::iter::once(reflectance).chain(back_reflectance).collect()
        }
        Material::Leaf { reflectance, transmittance, back_reflectance, .. } => {
            [reflectance, transmittance].into_iter().chain(back_reflectance).collect()
        }
    }
}
