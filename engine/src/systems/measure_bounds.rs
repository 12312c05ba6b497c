use std::collections::BTreeMap;

use hecs::World;

use super::{Resources, set_component};
use crate::components::{InstanceCount, Mesh, MeshBounds, Name, SceneId};

/// Measures the boxes around meshes. Reads [`Mesh`]; writes [`MeshBounds`] of meshes that hold any primitive.
pub(super) fn measure_bounds(world: &mut World, resources: &mut Resources) {
    for &entity in resources.meshes.values() {
        let bounds = world.get::<&Mesh>(entity).ok().and_then(|mesh| mesh.bounds());
        let bounds = bounds.map(|(low, high)| MeshBounds { low, high });
        set_component(world, entity, bounds);
    }
}

/// A mesh of which instances are placed.
#[derive(Clone, Debug)]
pub(super) struct MeshSummary {
    pub(super) name: String,
    /// Box around it; `None` if it is empty.
    pub(super) bounds: Option<MeshBounds>,
    /// Number of triangles and discs.
    pub(super) primitives: usize,
}

/// Meshes of which instances are placed, by their id.
pub(super) fn placed_meshes(world: &World) -> BTreeMap<u32, MeshSummary> {
    let mut query = world.query::<(&SceneId, &Name, &Mesh, Option<&MeshBounds>, &InstanceCount)>();
    let placed = query.iter().filter(|(.., count)| count.0 > 0);
    let view = |(id, name, mesh, bounds, _): (
        &SceneId,
        &Name,
        &Mesh,
        Option<&MeshBounds>,
        &InstanceCount,
    )| {
        let primitives = mesh.triangles.len() + mesh.discs.len();
        (id.0, MeshSummary { name: name.0.clone(), bounds: bounds.copied(), primitives })
    };
    placed.map(view).collect()
}
