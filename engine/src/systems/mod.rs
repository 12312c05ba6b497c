//! A world that computes: systems derive components from what the author wrote.
//!
//! The [`World`](hecs::World) holds entities: mesh prototypes, materials, plantings, instances, the terrain, the sun, the
//! sky and sensors; [`components`](crate::components) lists what each has. [`Resources`] holds what belongs to no entity:
//! settings of the scene, entities by name, and messages.
//!
//! [`spawn`](crate::spawn::spawn) writes raw components and settings and returns which kinds have changed.
//! [`run_schedule`] then runs the systems of the `schedule` in order, each only if a kind that it reads has changed; the
//! kinds that it writes count as changed from then on. So a changed sun or leaf spectrum leaves meshes, ground and
//! instances as they are.
//!
//! A system is a function `fn(&mut World, &mut Resources)` in a file of its own. Its documentation says which components
//! it reads and writes. Three rules hold:
//!
//! - A system removes what it wrote before, where it does not write it anew: nothing derived from older data remains.
//! - A system goes on after an error, and later systems do without what it could not write, so that all errors of a scene
//!   are reported at once.
//! - Results do not depend on the order of a query: whatever needs an order sorts by [`SceneId`](crate::components::SceneId).

mod changes;
mod coordinate_advice;
mod georeference;
mod messages;
mod resources;
mod schedule;

mod check_absorption_memory;
mod check_flux_maps;
mod check_positions;
mod check_tiles_crossed;
mod count_instances;
mod find_used_materials;
mod hide_and_select;
mod load_meshes;
mod map_reflectance;
mod measure_bounds;
mod measure_extents;
mod measure_leaf_area;
mod plant;
mod resolve_bands;
mod resolve_crs;
mod resolve_light;
mod resolve_optics;
mod resolve_sensors;
mod resolve_sky_emission;
mod resolve_temperatures;
mod resolve_weights;
mod spectra;
mod triangulate_terrain;
mod visible_optics;
mod warn_dark_bands;
mod warn_flat_raster;
mod warn_floating_instances;
mod warn_image_footprints;
mod warn_implausible_plants;
mod warn_mesh_sizes;
mod warn_overhangs;
mod warn_seams;
mod warn_sensor_heights;

pub use changes::Changes;
pub(crate) use coordinate_advice::place_of_instance;
pub use georeference::{CoordinateSystem, MapFrame, MapTransform};
pub use messages::Messages;
pub use resolve_bands::BandResponses;
pub use resources::Resources;
pub use schedule::{ScheduleRun, run_schedule};
pub use visible_optics::{VISIBLE_NM, visible_optics};

/// Sets or removes a component of an entity.
fn set_component<T: hecs::Component>(
    world: &mut hecs::World,
    entity: hecs::Entity,
    value: Option<T>,
) {
    match value {
        Some(value) => world.insert_one(entity, value).expect("entities of a scene exist"),
        // Whatever is absent already need not be removed.
        None => drop(world.remove_one::<T>(entity)),
    }
}
