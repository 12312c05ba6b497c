use std::collections::BTreeSet;

use hecs::World;

use super::{Changes, Resources};
use crate::components::{InstanceCount, MaterialId, PartMaterials, TerrainPatch};

/// Finds the materials of the ground and of placed meshes. Reads [`TerrainPatch`], [`PartMaterials`] and
/// [`InstanceCount`]; writes the resource `used_materials`, and marks it as changed only where it is.
pub(super) fn find_used_materials(world: &mut World, resources: &mut Resources) {
    let mut used: BTreeSet<MaterialId> = BTreeSet::new();
    for (materials, count) in world.query_mut::<(&PartMaterials, &InstanceCount)>() {
        if count.0 > 0 {
            used.extend(&materials.0);
        }
    }
    for patch in world.query_mut::<&TerrainPatch>() {
        used.extend(&patch.materials.0);
    }
    if used != resources.used_materials {
        resources.used_materials = used;
        resources.changes |= Changes::USED_MATERIALS;
    }
}
