use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use super::Spawner;
use super::instances::needed_meshes;
use crate::assets::{self, AssetError, CrownSpec, Import, Loaded};
use crate::components::{MaterialId, Mesh, Name, PartMaterials, Placement};
use crate::document::{self, Diagnostic, Scene, Terrain};

/// A mesh with the materials of its parts.
pub(super) struct Prototype {
    pub(super) name: Name,
    pub(super) mesh: Mesh,
    pub(super) materials: PartMaterials,
}

impl Spawner<'_> {
    /// The meshes that instances may place, by their place in the document; each is read once.
    pub(super) fn meshes(&mut self) -> BTreeMap<u32, Prototype> {
        let scene = self.scene;
        let used = needed_meshes(scene);
        let mut wanted = Vec::new();
        for (index, (name, mesh)) in scene.meshes.iter().enumerate() {
            if used.contains(name.as_str()) {
                self.note_file(mesh);
                wanted.push((index as u32, name, mesh));
            } else if !is_ground(scene, name) {
                self.skipped.push(nothing_of(name));
            }
        }
        let folder = self.folder;
        let loaded: Vec<_> = wanted.par_iter().map(|(.., mesh)| load(mesh, folder)).collect();
        let mut prototypes = BTreeMap::new();
        for ((id, name, mesh), loaded) in wanted.into_iter().zip(loaded) {
            let path = format!("meshes.{name}");
            match loaded {
                Ok(Loaded { value, warnings }) => {
                    let warnings = warnings.into_iter().map(|w| Diagnostic::warning(&path, w));
                    self.problems.extend(warnings);
                    let materials = PartMaterials(self.part_materials(mesh, &value, &path));
                    let name = Name(name.clone());
                    prototypes.insert(id, Prototype { name, mesh: value, materials });
                }
                Err(error) => {
                    let key = match mesh {
                        document::Mesh::Faces { .. } => ".faces_m",
                        document::Mesh::Crown { .. } => "",
                        _ => ".file",
                    };
                    let problem = Diagnostic::error(format!("{path}{key}"), error.to_string());
                    self.problems.push(problem);
                }
            }
        }
        prototypes
    }

    /// The meshes of which anything stands.
    pub(super) fn keep_placed(
        &mut self,
        mut meshes: BTreeMap<u32, Prototype>,
        placements: &[Placement],
    ) -> BTreeMap<u32, Prototype> {
        let placed: BTreeSet<u32> = placements.iter().map(|p| p.prototype.0).collect();
        meshes.retain(|id, prototype| {
            let is_placed = placed.contains(id);
            if !is_placed && !is_ground(self.scene, &prototype.name.0) {
                self.skipped.push(nothing_of(&prototype.name.0));
            }
            is_placed
        });
        meshes
    }

    pub(super) fn note_file(&mut self, mesh: &document::Mesh) {
        match mesh {
            document::Mesh::Obj { file, .. }
            | document::Mesh::Gltf { file, .. }
            | document::Mesh::Discs { file, .. } => {
                self.file(file);
            }
            document::Mesh::Faces { .. } | document::Mesh::Crown { .. } => {}
        }
    }

    pub(super) fn crown_materials(
        &mut self,
        leaf: &str,
        wood: Option<&str>,
        loaded: &Mesh,
        path: &str,
    ) -> Vec<MaterialId> {
        let leaf = self.known_material(leaf, &format!("{path}.leaf_material"));
        let wood =
            wood.and_then(|name| self.known_material(name, &format!("{path}.wood_material")));
        let of = |part: &str| if part == "leaf" { leaf } else { wood };
        // `document::check` asks for a wood material wherever there is wood.
        loaded.parts.iter().map(|part| of(&part.name).unwrap_or(MaterialId(0))).collect()
    }
}

fn is_ground(scene: &Scene, mesh: &str) -> bool {
    matches!(&scene.terrain, Terrain::Mesh { mesh: ground, .. } if ground == mesh)
}

fn nothing_of(mesh: &str) -> String {
    format!("mesh `{mesh}`: nothing stands of it")
}

pub(super) fn load(
    mesh: &document::Mesh,
    folder: &std::path::Path,
) -> Result<Loaded<Mesh>, AssetError> {
    match mesh {
        document::Mesh::Obj { file, up, unit_m, origin, parts_by, .. } => assets::read_obj(
            &folder.join(file),
            &Import { up: up.clone(), unit_m: *unit_m, origin: origin.clone() },
            parts_by,
        ),
        document::Mesh::Gltf { file, up, unit_m, origin, .. } => assets::read_gltf(
            &folder.join(file),
            &Import { up: up.clone(), unit_m: *unit_m, origin: origin.clone() },
        ),
        document::Mesh::Discs { file, .. } => assets::read_discs(&folder.join(file)),
        document::Mesh::Faces { faces_m, .. } => assets::mesh_of_faces(faces_m),
        document::Mesh::Crown { .. } => {
            let spec = CrownSpec::from_document(mesh).expect("a crown is a crown");
            let value = assets::grow_crown(&spec)?;
            Ok(Loaded { value, warnings: Vec::new() })
        }
    }
}
