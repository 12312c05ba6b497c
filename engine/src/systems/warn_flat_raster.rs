use hecs::World;

use super::Resources;
use crate::components::TerrainPatch;
use crate::document::{Diagnostic, Terrain, TerrainRaster};

/// Warns of a raster of heights that are all 0: a mask, or a map without heights. Reads `document::Terrain` and
/// [`TerrainPatch`].
pub(super) fn warn_flat_raster(world: &mut World, resources: &mut Resources) {
    let mut terrain = world.query_one::<(&Terrain, &TerrainPatch)>(resources.terrain);
    let Ok((Terrain::Raster(TerrainRaster { file, .. }), patch)) = terrain.get() else { return };
    let origin = resources.frame.origin_m.2;
    if [patch.lowest(), patch.highest()].iter().all(|height| height + origin == 0.0) {
        let message = format!("all heights in `{file}` are 0");
        let help =
            "is it a raster of elevations? flat ground is `Plane(size_m: (..), material: ..)`";
        resources.report(Diagnostic::warning(["terrain", "file"], message).help(help));
    }
}
