use std::collections::BTreeSet;

use hecs::World;

use super::Resources;
use crate::components::{LeafArea, Mesh, PartMaterials};
use crate::document::Material;

/// Measures the leaf area of mesh prototypes. Reads [`Mesh`], [`PartMaterials`] and `document::Material`; writes
/// [`LeafArea`].
pub(super) fn measure_leaf_area(world: &mut World, resources: &mut Resources) {
    let is_leaf = |material: usize| {
        let material = world.get::<&Material>(resources.materials[material]);
        material.is_ok_and(|material| matches!(*material, Material::Leaf { .. }))
    };
    let leaves: BTreeSet<usize> =
        (0..resources.materials.len()).filter(|&material| is_leaf(material)).collect();
    for &entity in resources.meshes.values() {
        let area = {
            let mut loaded = world.query_one::<(&Mesh, &PartMaterials)>(entity);
            loaded.get().ok().map(|(mesh, materials)| {
                let parts = mesh.parts.iter().zip(&materials.0);
                let of_leaves =
                    parts.filter(|(_, material)| leaves.contains(&(material.0 as usize)));
                of_leaves.map(|(part, _)| mesh.part_area(part)).sum()
            })
        };
        match area {
            Some(area) => world.insert_one(entity, LeafArea(area)).expect("meshes exist"),
            // Whatever is absent already need not be removed.
            None => drop(world.remove_one::<LeafArea>(entity)),
        }
    }
}
