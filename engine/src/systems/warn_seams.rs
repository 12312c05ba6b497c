use glam::DVec2;
use hecs::World;

use super::Resources;
use crate::document::{Diagnostic, ScenePath, Terrain};
use crate::terrain::Ground;

/// Steps along a seam that are lower may be meant, m.
const SEAM: f64 = 1.0;

/// Places along a side of the ground where both sides are compared.
const PLACES: usize = 512;

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
    let step = |axis: usize| {
        let (corner, size) = (ground.corner(), ground.size());
        (0..=PLACES)
            .filter_map(|place| {
                let along = place as f64 / PLACES as f64;
                let at = |side: f64| {
                    let mut at = DVec2::splat(along);
                    at[axis] = side;
                    ground.height(corner + at * size)
                };
                Some((at(1.0)? - at(0.0)?).abs())
            })
            .fold(0.0, f64::max)
    };
    let (east, north) = (step(0), step(1));
    if east.max(north) <= SEAM {
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
