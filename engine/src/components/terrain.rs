use glam::DVec2;

use super::MaterialId;

/// The ground: a horizontal rectangle. It is also the tile of a periodic scene and the reference
/// area on which irradiance is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainPatch {
    /// South-west corner, m, local frame.
    pub corner: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
    /// Height, m, local frame.
    pub height: f64,
    /// Material of the ground.
    pub material: MaterialId,
}
