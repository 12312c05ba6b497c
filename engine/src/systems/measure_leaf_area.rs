use std::collections::BTreeSet;

use hecs::World;

use super::{Resources, set_component};
use crate::components::{LeafArea, Mesh, PartMaterials};
use crate::document::Material;

/// Measures the leaf area of mesh prototypes. Reads [`Mesh`], [`PartMaterials`] and `document::Material`; writes
/// [`LeafArea`].
pub(super) fn measure_leaf_area(world: &mut World, resources: &mut Resources) {
    let is_leaf = |material: usize| {
        let material = world.get::<&Material>(resources.materials[material]);
        material.is_ok_and(|material| material.is_leaf())
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
        set_component(world, entity, area.map(LeafArea));
    }
}
