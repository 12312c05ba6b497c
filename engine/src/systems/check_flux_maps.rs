use hecs::World;

use super::Resources;
use crate::components::TerrainPatch;
use crate::document::{ScenePath, Sensor, Terrain, check_maps};

/// Refuses maps of fluxes with too many pixels over ground whose extent a file decides. Reads `document::Terrain`,
/// [`TerrainPatch`] and `document::Sensor`.
pub(super) fn check_flux_maps(world: &mut World, resources: &mut Resources) {
    let Ok(patch) = world.get::<&TerrainPatch>(resources.terrain) else { return };
    let is_plane = world
        .get::<&Terrain>(resources.terrain)
        .is_ok_and(|terrain| matches!(*terrain, Terrain::Plane(_)));
    if is_plane {
        return;
    }
    for (name, &entity) in &resources.sensors {
        let sensor = world.get::<&Sensor>(entity).expect("`spawn` gives sensors their source");
        let Sensor::Photons(photons) = &*sensor else { continue };
        for (index, measure) in photons.measure.iter().enumerate() {
            let path = ScenePath::from("sensors").name(name).key("measure").index(index);
            let bands = resources.bands.len();
            if let Some(problem) = check_maps(&path, measure, bands, patch.size.into()) {
                resources.messages.report(problem);
            }
        }
    }
}
