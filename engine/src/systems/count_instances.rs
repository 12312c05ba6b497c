use hecs::World;

use super::Resources;
use super::hide_and_select::needed_meshes;
use crate::components::{InstanceCount, Mesh, PrototypeId};
use crate::document::Terrain;

/// Counts the instances of each mesh prototype and notes prototypes without any. Reads [`PrototypeId`], `ShownMeshes` and
/// `document::Terrain`; writes [`InstanceCount`] of mesh prototypes.
pub(super) fn count_instances(world: &mut World, resources: &mut Resources) {
    let mut counts = vec![0_u64; resources.meshes.len()];
    for prototype in world.query_mut::<&PrototypeId>() {
        counts[prototype.0 as usize] += 1;
    }
    for (&entity, &count) in resources.meshes.values().zip(&counts) {
        world.insert_one(entity, InstanceCount(count)).expect("meshes exist");
    }
    let needed = needed_meshes(world, resources);
    let ground =
        world.get::<&Terrain>(resources.terrain).ok().and_then(|terrain| match &*terrain {
            Terrain::Mesh { mesh, .. } => resources.meshes.get_index_of(mesh.as_str()),
            Terrain::Plane(_) | Terrain::Raster(_) => None,
        });
    let is_needed = |index: usize| needed.contains(&(index as u32));
    let is_loaded = |index: usize| world.get::<&Mesh>(resources.meshes[index]).is_ok();
    let others = || (0..counts.len()).filter(|&index| ground != Some(index));
    let unneeded = others().filter(|&index| !is_needed(index));
    let unplaced =
        others().filter(|&index| is_needed(index) && counts[index] == 0 && is_loaded(index));
    for index in unneeded.chain(unplaced) {
        let (name, _) =
            resources.meshes.get_index(index).expect("`counts` has an item for each mesh");
        resources.messages.skip(format!("mesh `{name}`: nothing stands of it"));
    }
}
