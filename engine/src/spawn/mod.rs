//! Document to entities that hold what the author wrote: raw components, which the
//! [`systems`](crate::systems) derive all others from.

mod files;

use hecs::{Component, Entity, World};

use crate::components::{Name, SceneId};
use crate::document::{self, Map, Material, Prototype, Scene, Terrain};
use crate::systems::{Changes, Resources};

pub use files::missing_files;

/// Sets the raw components and the settings of a world to those of a scene; returns which kinds have changed.
///
/// Entities stay as long as their kind has the same names in the same order.
pub fn spawn(scene: &Scene, world: &mut World, resources: &mut Resources) -> Changes {
    let Scene {
        format: _,
        title: _,
        params: _,
        include: _,
        frame,
        bands,
        spectra,
        materials,
        meshes,
        terrain,
        instances,
        hide,
        select,
        sun,
        sky,
        thermal_sky,
        boundary,
        sensors,
        transport,
        variants: _,
        sweep: _,
        output: _,
    } = scene;
    let is_first = resources.terrain == Entity::DANGLING;
    if is_first {
        resources.terrain = world.spawn(());
        resources.sun = world.spawn(());
        resources.sky = world.spawn(());
    }
    let mut changes = Changes::ALL.only_if(is_first);
    let measures_emission = scene.measures_emission();
    changes |= Changes::FRAME.only_if(set(&mut resources.frame, frame));
    changes |= Changes::BOUNDARY.only_if(set(&mut resources.boundary, boundary));
    changes |= Changes::SEED.only_if(set(&mut resources.seed, &transport.seed));
    changes |= Changes::BANDS.only_if(set(&mut resources.bands, bands));
    changes |= Changes::SPECTRA.only_if(set(&mut resources.spectra, spectra));
    changes |= Changes::PATTERNS.only_if(set(&mut resources.hide, hide));
    changes |= Changes::PATTERNS.only_if(set(&mut resources.select, select));
    changes |= Changes::MEASURES_EMISSION
        .only_if(set(&mut resources.measures_emission, &measures_emission));
    changes |= spawn_materials(world, resources, materials);
    changes |= spawn_prototypes(world, resources, meshes, terrain);
    changes |= Changes::TERRAIN.only_if(set_component(world, resources.terrain, Some(terrain)));
    changes |=
        Changes::PLANTINGS.only_if(spawn_plantings(world, &mut resources.plantings, instances));
    changes |= Changes::SUN.only_if(set_component(world, resources.sun, sun.as_ref()));
    changes |= Changes::SKY.only_if(set_component(world, resources.sky, Some(sky)));
    changes |= Changes::SKY.only_if(set_component(world, resources.sky, Some(thermal_sky)));
    let sensor_changes = spawn_named::<document::Sensor>(world, &mut resources.sensors, sensors);
    changes |= Changes::SENSORS.only_if(sensor_changes.any());
    changes
}

/// Sets the materials; returns which kinds have changed.
fn spawn_materials(
    world: &mut World,
    resources: &mut Resources,
    materials: &Map<Material>,
) -> Changes {
    let old_leaves = leaves(world, &resources.materials);
    let changed = spawn_named(world, &mut resources.materials, materials);
    Changes::MATERIALS.only_if(changed.any())
        | Changes::MATERIAL_NAMES.only_if(changed.have_other_names)
        | Changes::LEAVES.only_if(leaves(world, &resources.materials) != old_leaves)
}

/// Sets the mesh prototypes, one of which may be the terrain; returns which kinds have changed.
fn spawn_prototypes(
    world: &mut World,
    resources: &mut Resources,
    meshes: &Map<Prototype>,
    terrain: &Terrain,
) -> Changes {
    let changed = spawn_named(world, &mut resources.meshes, meshes);
    let is_of_ground = |entity: &Entity| match terrain {
        Terrain::Mesh { mesh, .. } => resources.meshes.get(mesh.as_str()) == Some(entity),
        Terrain::Plane(_) | Terrain::Raster(_) => false,
    };
    Changes::MESHES.only_if(changed.any())
        | Changes::TERRAIN.only_if(changed.entities.iter().any(is_of_ground))
}

/// Sets a value; returns whether it has changed.
fn set<T: Clone + PartialEq>(old: &mut T, new: &T) -> bool {
    let has_changed = old != new;
    if has_changed {
        old.clone_from(new);
    }
    has_changed
}

/// Sets or removes a component of an entity; returns whether it has changed.
fn set_component<T>(world: &mut World, entity: Entity, new: Option<&T>) -> bool
where
    T: Component + Clone + PartialEq,
{
    let is_same = match (world.get::<&T>(entity), new) {
        (Ok(old), Some(new)) => *old == *new,
        (Err(_absent), None) => true,
        _ => false,
    };
    if is_same {
        return false;
    }
    match new {
        Some(new) => world.insert_one(entity, new.clone()).expect("`spawn` despawns no singleton"),
        None => drop(world.remove_one::<T>(entity)),
    }
    true
}

/// Changes of the entities of one kind.
struct NamedChanges {
    /// True if names or their order differ, so that all entities are new.
    have_other_names: bool,
    /// Entities that are new or have another value.
    entities: Vec<Entity>,
}

impl NamedChanges {
    fn any(&self) -> bool {
        self.have_other_names || !self.entities.is_empty()
    }
}

/// Makes the entities of one kind those of a map of the document.
fn spawn_named<T>(world: &mut World, entities: &mut Map<Entity>, values: &Map<T>) -> NamedChanges
where
    T: Component + Clone + PartialEq,
{
    if entities.keys().eq(values.keys()) {
        let pairs = entities.values().zip(values.values());
        let changed = pairs.filter(|(entity, value)| set_component(world, **entity, Some(*value)));
        let entities = changed.map(|(&entity, _)| entity).collect();
        return NamedChanges { have_other_names: false, entities };
    }
    for (_, entity) in entities.drain(..) {
        world.despawn(entity).expect("entities by name exist");
    }
    for (index, (name, value)) in values.iter().enumerate() {
        let entity = world.spawn((SceneId(index as u32), Name(name.clone()), value.clone()));
        entities.insert(name.clone(), entity);
    }
    NamedChanges { have_other_names: true, entities: entities.values().copied().collect() }
}

/// Makes the plantings those of the document; returns whether any has changed.
fn spawn_plantings(
    world: &mut World,
    plantings: &mut Vec<Entity>,
    instances: &[document::Instances],
) -> bool {
    let mut has_changed = plantings.len() != instances.len();
    for unwanted in plantings.drain(instances.len().min(plantings.len())..) {
        world.despawn(unwanted).expect("plantings exist");
    }
    for (index, instances) in instances.iter().enumerate() {
        if let Some(&planting) = plantings.get(index) {
            has_changed |= set_component(world, planting, Some(instances));
        } else {
            plantings.push(world.spawn((SceneId(index as u32), instances.clone())));
        }
    }
    has_changed
}

/// Returns whether each material is a leaf.
fn leaves(world: &World, materials: &Map<Entity>) -> Vec<bool> {
    let is_leaf =
        |entity: &Entity| world.get::<&Material>(*entity).is_ok_and(|material| material.is_leaf());
    materials.values().map(is_leaf).collect()
}
