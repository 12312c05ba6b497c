//! The ground and the plants on it, as entities of a world hold them.

use hecs::World;

use super::GroundHeights;
use crate::components::{Instance, InstanceCount, Mesh, PartMaterials, SceneId, TerrainPatch};
use crate::terrain::Ground;

/// A mesh prototype with its id and materials.
pub(in crate::queries) type PlantedMesh<'a> = (&'a SceneId, &'a Mesh, &'a PartMaterials);

/// Ground of a world, mesh prototypes that are placed, and their instances.
pub(in crate::queries) struct PlantedGround<'a> {
    pub(in crate::queries) patch: &'a TerrainPatch,
    pub(in crate::queries) ground: GroundHeights<'a>,
    pub(in crate::queries) meshes: Vec<PlantedMesh<'a>>,
    /// Instances in document order.
    pub(in crate::queries) instances: Vec<Instance>,
}

impl PlantedGround<'_> {
    /// Answer to a question about a world.
    ///
    /// # Panics
    /// If the world has no terrain.
    pub(in crate::queries) fn of_world<R>(
        world: &World,
        is_periodic: bool,
        ask: impl FnOnce(PlantedGround<'_>) -> R,
    ) -> R {
        let mut terrains = world.query::<(&TerrainPatch, &Ground)>();
        let (patch, ground) = terrains.iter().next().expect("a world has a terrain");
        let mut query = world.query::<(&SceneId, &Mesh, &PartMaterials, &InstanceCount)>();
        let placed = query.iter().filter(|(.., count)| count.0 > 0);
        let meshes = placed.map(|(id, mesh, materials, _)| (id, mesh, materials)).collect();
        ask(PlantedGround {
            patch,
            ground: GroundHeights::new(patch, ground, is_periodic),
            meshes,
            instances: Instance::in_order(world),
        })
    }
}
