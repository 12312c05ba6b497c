//! Document to entities that hold what the author wrote: raw components, which the
//! [`systems`](crate::systems) derive all others from.

mod files;

use hecs::{Component, Entity, World};

use crate::components::{Name, SceneId};
use crate::document::{self, Map, Material, Scene, Terrain};
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
    } = scene;
    let is_first = resources.terrain == Entity::DANGLING;
    if is_first {
        resources.terrain = world.spawn(());
        resources.sun = world.spawn(());
        resources.sky = world.spawn(());
    }
    let mut changes = if is_first { Changes::ALL } else { Changes::NONE };
    let mut note = |has_changed: bool, kind: Changes| {
        if has_changed {
            changes |= kind;
        }
    };
    note(set(&mut resources.frame, frame), Changes::FRAME);
    note(set(&mut resources.boundary, boundary), Changes::BOUNDARY);
    note(set(&mut resources.seed, &transport.seed), Changes::SEED);
    note(set(&mut resources.bands, bands), Changes::BANDS);
    note(set(&mut resources.spectra, spectra), Changes::SPECTRA);
    note(set(&mut resources.hide, hide), Changes::PATTERNS);
    note(set(&mut resources.select, select), Changes::PATTERNS);
    note(
        set(&mut resources.measures_emission, &scene.measures_emission()),
        Changes::MEASURES_EMISSION,
    );

    let old_leaves = leaves(world, &resources.materials);
    let material_changes = spawn_named(world, &mut resources.materials, materials);
    note(material_changes.any(), Changes::MATERIALS);
    note(material_changes.have_other_names, Changes::MATERIAL_NAMES);
    note(leaves(world, &resources.materials) != old_leaves, Changes::LEAVES);

    let mesh_changes = spawn_named(world, &mut resources.meshes, meshes);
    note(mesh_changes.any(), Changes::MESHES);
    let is_of_ground = |entity: &Entity| match terrain {
        Terrain::Mesh { mesh, .. } => resources.meshes.get(mesh.as_str()) == Some(entity),
        Terrain::Plane(_) | Terrain::Raster(_) => false,
    };
    note(mesh_changes.entities.iter().any(is_of_ground), Changes::TERRAIN);
    note(set_component(world, resources.terrain, Some(terrain)), Changes::TERRAIN);
    note(spawn_plantings(world, &mut resources.plantings, instances), Changes::PLANTINGS);
    note(set_component(world, resources.sun, sun.as_ref()), Changes::SUN);
    note(set_component(world, resources.sky, Some(sky)), Changes::SKY);
    note(set_component(world, resources.sky, Some(thermal_sky)), Changes::SKY);
    let sensor_changes = spawn_named::<document::Sensor>(world, &mut resources.sensors, sensors);
    note(sensor_changes.any(), Changes::SENSORS);
    changes
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
    let is_leaf = |entity: &Entity| {
        world.get::<&Material>(*entity).is_ok_and(|one| matches!(*one, Material::Leaf(_)))
    };
    materials.values().map(is_leaf).collect()
}
