//! Classes of surfaces that leaf area is counted by.

use std::collections::BTreeMap;

use hecs::World;

use super::{CountedSurfaces, LeafAreaError, LeafAreaRequest};
use crate::components::{MaterialId, Mesh, Name, PartMaterials, SceneId};
use crate::document::Material;

/// Classes that areas are counted by.
pub(super) struct Classes {
    pub(super) names: Vec<String>,
    pub(super) is_leaf: Vec<bool>,
    by_material: BTreeMap<MaterialId, usize>,
}

impl Classes {
    pub(super) fn new(
        world: &World,
        request: &LeafAreaRequest,
        meshes: &[(&SceneId, &Mesh, &PartMaterials)],
    ) -> Result<Self, LeafAreaError> {
        let has_surfaces = |mesh: &Mesh, part: usize| {
            let part = &mesh.parts[part];
            !part.triangles.is_empty() || !part.discs.is_empty()
        };
        let mut used: Vec<MaterialId> = meshes
            .iter()
            .flat_map(|(_, mesh, materials)| {
                let parts = materials.0.iter().enumerate();
                parts.filter(|(part, _)| has_surfaces(mesh, *part)).map(|(_, material)| *material)
            })
            .collect();
        used.sort_unstable();
        used.dedup();
        let mut query = world.query::<(&SceneId, &Name, &Material)>();
        let mut all: Vec<(MaterialId, &Name, bool)> = query
            .iter()
            .map(|(id, name, material)| (MaterialId(id.0), name, material.is_leaf()))
            .filter(|(id, _, is_leaf)| {
                used.contains(id) && (*is_leaf || request.surfaces == CountedSurfaces::All)
            })
            .collect();
        if all.is_empty() {
            return Err(if used.is_empty() {
                LeafAreaError::NoInstances
            } else {
                LeafAreaError::NoLeaves
            });
        }
        all.sort_unstable_by_key(|material| material.0);
        let mut classes =
            Self { names: Vec::new(), is_leaf: Vec::new(), by_material: BTreeMap::new() };
        for (id, name, is_leaf) in all {
            let class = if request.by_material {
                name.0.clone()
            } else {
                if is_leaf { "leaf" } else { "other" }.to_owned()
            };
            let known = classes.names.iter().position(|known| *known == class);
            let index = known.unwrap_or_else(|| {
                classes.names.push(class);
                classes.is_leaf.push(is_leaf);
                classes.names.len() - 1
            });
            classes.by_material.insert(id, index);
        }
        Ok(classes)
    }

    pub(super) fn of_material(&self, material: MaterialId) -> Option<usize> {
        self.by_material.get(&material).copied()
    }
}
