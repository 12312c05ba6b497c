use hecs::World;

use super::Resources;
use crate::document::{Diagnostic, ScenePath, Terrain};
use crate::terrain::Ground;

/// Warns of a periodic ground whose opposite sides differ in height. Reads `document::Terrain` and [`Ground`].
pub(super) fn warn_seams(world: &mut World, resources: &mut Resources) {
    let Ok(ground) = world.get::<&Ground>(resources.terrain) else { return };
    let terrain = world.get::<&Terrain>(resources.terrain);
    let path = match &*terrain.expect("`spawn` gives the terrain its source") {
        Terrain::Plane(_) => return,
        Terrain::Raster(_) => ScenePath::from(["terrain", "file"]),
        Terrain::Mesh { .. } => ScenePath::from(["terrain", "mesh"]),
    };
    if !resources.is_periodic() {
        return;
    }
    let [east, north] = ground.steps_between_sides().to_array();
    if east.max(north) <= Ground::SEAM {
        return;
    }
    let message = format!(
        "the ground is repeated, but its opposite sides differ: walls of up to {east:.1} m stand \
             between east and west, of up to {north:.1} m between north and south"
    );
    let help = "they shade and are seen as ground; write `boundary: Isolated`, or take heights whose \
                    sides meet (a level plot, or one without its mean slope)";
    resources.report(Diagnostic::warning(path, message).help(help));
}
