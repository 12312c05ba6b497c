use hecs::World;

use super::check_absorption_memory::check_absorption_memory;
use super::check_flux_maps::check_flux_maps;
use super::check_positions::check_positions;
use super::check_tiles_crossed::check_tiles_crossed;
use super::count_instances::count_instances;
use super::find_used_materials::find_used_materials;
use super::hide_and_select::{check_patterns, hide_and_select};
use super::load_meshes::load_meshes;
use super::map_reflectance::map_reflectance;
use super::measure_bounds::measure_bounds;
use super::measure_extents::measure_extents;
use super::measure_leaf_area::measure_leaf_area;
use super::plant::plant;
use super::resolve_bands::resolve_bands;
use super::resolve_crs::resolve_crs;
use super::resolve_light::resolve_light;
use super::resolve_optics::resolve_optics;
use super::resolve_sensors::resolve_sensors;
use super::resolve_sky_emission::resolve_sky_emission;
use super::resolve_temperatures::resolve_temperatures;
use super::resolve_weights::resolve_weights;
use super::triangulate_terrain::triangulate_terrain;
use super::warn_dark_bands::warn_dark_bands;
use super::warn_flat_raster::warn_flat_raster;
use super::warn_floating_instances::warn_floating_instances;
use super::warn_image_footprints::warn_image_footprints;
use super::warn_implausible_plants::warn_implausible_plants;
use super::warn_mesh_sizes::warn_mesh_sizes;
use super::warn_overhangs::warn_overhangs;
use super::warn_seams::warn_seams;
use super::warn_sensor_heights::warn_sensor_heights;
use super::{Changes, Resources};

/// A system with the kinds whose change makes it run, and the kinds that it marks as changed.
struct ScheduledSystem {
    name: &'static str,
    run: fn(&mut World, &mut Resources),
    reads: Changes,
    writes: Changes,
}

/// One line per system: `name: kinds that make it run => kinds that it marks as changed`.
///
/// Kinds that follow from another are left out on both sides: [`MeshBounds`](crate::components::MeshBounds) change
/// with `LOADED_MESHES`, so that a system that reads them names those and stands below `measure_bounds`. All components
/// that a system reads and writes are in its own documentation.
macro_rules! schedule {
    ($($name:ident: $($reads:ident)|+ $(=> $($writes:ident)|+)?;)+) => {
        &[$(ScheduledSystem {
            name: stringify!($name),
            run: $name,
            reads: Changes::NONE$(.or(Changes::$reads))+,
            writes: Changes::NONE$($(.or(Changes::$writes))+)?,
        }),+]
    };
}

/// All systems in the order in which they run. Messages are shown in this order.
///
/// `hide_and_select`, `find_used_materials` and `resolve_weights` mark what they write themselves, and only if it differs.
const SCHEDULE: &[ScheduledSystem] = schedule! {
    // Ground.
    resolve_crs: FRAME => CRS;
    triangulate_terrain: TERRAIN | FRAME | CRS | BOUNDARY | MATERIAL_NAMES => GROUND;
    warn_overhangs: GROUND;
    warn_flat_raster: GROUND;
    warn_seams: GROUND;

    // Meshes and instances.
    hide_and_select: PLANTINGS | PATTERNS | MESHES;
    load_meshes: MESHES | SHOWN_MESHES | MATERIAL_NAMES => LOADED_MESHES;
    measure_bounds: LOADED_MESHES;
    measure_leaf_area: LOADED_MESHES | LEAVES => LEAF_AREA;
    plant: PLANTINGS | SHOWN_MESHES | LOADED_MESHES | GROUND | SEED => INSTANCES;
    check_patterns: PLANTINGS | PATTERNS;
    count_instances: INSTANCES | LOADED_MESHES | TERRAIN;
    warn_floating_instances: INSTANCES | GROUND;
    check_positions: INSTANCES | GROUND;
    warn_mesh_sizes: INSTANCES | MESHES;
    warn_implausible_plants: INSTANCES | LEAF_AREA | GROUND;
    measure_extents: INSTANCES | GROUND => EXTENTS;

    // Sensors and light on the ground.
    check_flux_maps: SENSORS | BANDS | GROUND;
    warn_image_footprints: SENSORS | GROUND;
    warn_sensor_heights: SENSORS | GROUND | INSTANCES;
    check_tiles_crossed: SENSORS | SUN | EXTENTS;

    // Spectra.
    resolve_bands: BANDS => RESPONSES;
    resolve_weights: RESPONSES | SUN | SPECTRA;
    find_used_materials: INSTANCES | LOADED_MESHES | GROUND;
    resolve_optics: MATERIALS | SPECTRA | RESPONSES | USED_MATERIALS;
    map_reflectance: MATERIALS | SPECTRA | RESPONSES | USED_MATERIALS | GROUND;
    resolve_temperatures: MATERIALS | RESPONSES | USED_MATERIALS | MEASURES_EMISSION;
    resolve_light: SUN | SKY | SPECTRA | RESPONSES => LIGHT;
    warn_dark_bands: LIGHT | SENSORS;
    resolve_sky_emission: SKY | SPECTRA | RESPONSES | MEASURES_EMISSION;
    resolve_sensors: SENSORS | SUN | GROUND | BANDS;
    check_absorption_memory: SENSORS | INSTANCES | GROUND | BANDS;
};

/// Result of a run of the schedule.
#[derive(Clone, Debug)]
pub struct ScheduleRun {
    /// Names of the systems that ran, in order.
    pub ran: Vec<&'static str>,
    /// Kinds that have changed, those that the systems wrote included.
    pub changes: Changes,
}

/// Runs the systems that depend on what has changed. Errors and warnings are in the messages of the resources.
pub fn run_schedule(world: &mut World, resources: &mut Resources, changes: Changes) -> ScheduleRun {
    resources.changes = changes;
    let mut ran = Vec::new();
    for (place, system) in SCHEDULE.iter().enumerate() {
        if resources.changes.intersects(system.reads) {
            resources.messages.begin(place);
            (system.run)(world, resources);
            resources.changes |= system.writes;
            ran.push(system.name);
        }
    }
    ScheduleRun { ran, changes: resources.changes }
}
