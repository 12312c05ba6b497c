mod part_materials;

use std::path::Path;

use hecs::World;
use rayon::prelude::*;

use super::Resources;
use super::hide_and_select::needed_meshes;
use crate::assets::{self, AssetError, Import, Loaded};
use crate::components::{Mesh, PartMaterials};
use crate::document::{self, Diagnostic, Gltf, MeshFile, Obj, Ply, ScenePath};

pub(super) use part_materials::part_materials;

/// Loads the meshes that plantings show, all at once. Reads `document::Prototype` and `ShownMeshes`; writes [`Mesh`] and
/// [`PartMaterials`] of mesh prototypes.
pub(super) fn load_meshes(world: &mut World, resources: &mut Resources) {
    let needed = needed_meshes(world, resources);
    let mut wanted = Vec::new();
    for (index, (name, &entity)) in resources.meshes.iter().enumerate() {
        // Whatever is absent already need not be removed.
        drop(world.remove::<(Mesh, PartMaterials)>(entity));
        if needed.contains(&(index as u32)) {
            let source = world.get::<&document::Prototype>(entity);
            let source = source.expect("`spawn` gives each mesh prototype its source");
            wanted.push((name.clone(), entity, (*source).clone()));
        }
    }
    for (.., source) in &wanted {
        note_file(source, resources);
    }
    let folder = &resources.folder;
    let loaded: Vec<_> = wanted.par_iter().map(|(.., source)| load(source, folder)).collect();
    for ((name, entity, source), loaded) in wanted.into_iter().zip(loaded) {
        let path = ScenePath::from("meshes").name(name);
        match loaded {
            Ok(Loaded { value, warnings }) => {
                for warning in warnings {
                    resources.report(Diagnostic::warning(&path, warning));
                }
                let materials = part_materials(&source, &value, &path, resources);
                world.insert(entity, (value, PartMaterials(materials))).expect("meshes exist");
            }
            Err(error) => {
                let path = match source {
                    document::Prototype::Faces { .. } => path.key("faces_m"),
                    document::Prototype::Crown(_) => path,
                    _ => path.key("file"),
                };
                resources.report(Diagnostic::error(path, error.to_string()));
            }
        }
    }
}

/// Notes the file of a mesh as read.
pub(super) fn note_file(mesh: &document::Prototype, resources: &mut Resources) {
    match mesh {
        document::Prototype::Obj(Obj { file, .. })
        | document::Prototype::Gltf(Gltf { file, .. })
        | document::Prototype::Ply(Ply { file, .. })
        | document::Prototype::Discs { file, .. } => {
            resources.file(file);
        }
        document::Prototype::Faces { .. } | document::Prototype::Crown(_) => {}
    }
}

fn import(mesh: &MeshFile<'_>) -> Import {
    Import { up: mesh.up.clone(), unit_m: mesh.unit_m, origin: mesh.origin.clone() }
}

/// Loads or generates a mesh.
pub(super) fn load(mesh: &document::Prototype, folder: &Path) -> Result<Loaded<Mesh>, AssetError> {
    match mesh {
        document::Prototype::Obj(obj) => {
            let import = import(&obj.mesh_file());
            assets::read_obj(&folder.join(&obj.file), &import, &obj.parts_by)
        }
        document::Prototype::Gltf(gltf) => {
            assets::read_gltf(&folder.join(&gltf.file), &import(&gltf.mesh_file()))
        }
        document::Prototype::Ply(Ply { file, up, unit_m, origin, .. }) => {
            let import = Import { up: up.clone(), unit_m: *unit_m, origin: origin.clone() };
            assets::read_ply(&folder.join(file), &import)
        }
        document::Prototype::Discs { file, .. } => assets::read_discs(&folder.join(file)),
        document::Prototype::Faces { faces_m, .. } => assets::mesh_of_faces(faces_m),
        document::Prototype::Crown(crown) => {
            let value = assets::grow_crown(crown)?;
            Ok(Loaded { value, warnings: Vec::new() })
        }
    }
}
