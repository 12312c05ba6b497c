use std::collections::BTreeMap;

use hecs::World;

use super::{Changes, Resources};
use crate::components::{InstanceCount, MaterialId, PartMaterials, SceneId, TerrainPatch};

/// Finds the materials of the ground and of placed meshes. Reads [`TerrainPatch`], [`PartMaterials`] and
/// [`InstanceCount`]; writes the resource `used_materials`, and marks it as changed only where it is.
pub(super) fn find_used_materials(world: &mut World, resources: &mut Resources) {
    let mut used: BTreeMap<MaterialId, Option<SceneId>> = BTreeMap::new();
    for (&mesh, materials, count) in world.query_mut::<(&SceneId, &PartMaterials, &InstanceCount)>()
    {
        for &material in materials.0.iter().filter(|_| count.0 > 0) {
            let first = used.entry(material).or_insert(Some(mesh));
            *first = (*first).min(Some(mesh));
        }
    }
    for patch in world.query_mut::<&TerrainPatch>() {
        for &material in &patch.materials.0 {
            used.entry(material).or_insert(None);
        }
    }
    if used != resources.used_materials {
        resources.used_materials = used;
        resources.changes |= Changes::USED_MATERIALS;
    }
}
