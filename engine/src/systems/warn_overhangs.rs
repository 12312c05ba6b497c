use glam::Vec3;
use hecs::World;

use super::Resources;
use crate::components::TerrainPatch;
use crate::counts::{agreeing, counted};
use crate::document::{Diagnostic, Terrain};
use crate::terrain::Ground;

/// Ground that lies less below other ground is the same but for rounding, m.
const OVERHANG: f64 = 1e-3;

/// Warns of a terrain mesh with triangles under others. Reads `document::Terrain`, [`TerrainPatch`] and [`Ground`].
pub(super) fn warn_overhangs(world: &mut World, resources: &mut Resources) {
    let mut terrain = world.query_one::<(&Terrain, &TerrainPatch, &Ground)>(resources.terrain);
    let Ok((Terrain::Mesh { mesh, .. }, patch, ground)) = terrain.get() else { return };
    let mut under = (0..patch.first_cut as usize).filter_map(|index| {
        let [a, b, c] = patch.mesh.corners(index).map(Vec3::as_dvec3);
        let middle = patch.origin() + (a + b + c) / 3.0 * patch.size.extend(patch.unit);
        let is_wall = (b - a).truncate().perp_dot((c - a).truncate()) == 0.0;
        let above = ground.height(middle.truncate())? - middle.z;
        (!is_wall && above > OVERHANG.max(1e-5 * patch.unit)).then_some(middle)
    });
    let Some(first) = under.next() else { return };
    let count = 1 + under.count();
    let message = format!(
        "{} of `{mesh}` {}",
        counted(count, "triangle"),
        agreeing(count, "lies under another one", "lie under others")
    );
    let help = format!(
        "one lies at ({:.2}, {:.2}, {:.2}): what is placed there stands on the highest; of \
             overhangs that are not meant, or of closed bodies, keep the upper side alone",
        first.x, first.y, first.z
    );
    resources.report(Diagnostic::warning(["terrain", "mesh"], message).help(help));
}
