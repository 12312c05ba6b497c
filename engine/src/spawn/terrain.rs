use glam::DVec2;
use hecs::World;

use super::Spawner;
use crate::components::SceneId;
use crate::document::Terrain;
use crate::terrain::{Ground, plane};

impl Spawner<'_> {
    /// Spawns the terrain; returns what knows its heights, if nothing is wrong with it.
    pub(super) fn terrain(&self, world: &mut World) -> Option<Ground> {
        let Terrain::Plane { size_m, material, corner_m, height_m } = &self.scene.terrain;
        // An unknown material was reported with all others.
        let material = self.material_id(material)?;
        let patch = plane(DVec2::from(*corner_m), DVec2::from(*size_m), *height_m, material);
        let ground = Ground::of(&patch);
        world.spawn((SceneId(0), patch));
        Some(ground)
    }
}
