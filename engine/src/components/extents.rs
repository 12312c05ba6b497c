use glam::{DVec2, Vec3};

use crate::document::ScenePath;

/// Box around a loaded mesh, m, object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshBounds {
    /// Lowest corner, m.
    pub low: Vec3,
    /// Highest corner, m.
    pub high: Vec3,
}

/// One-sided area of all primitives of a mesh that have a leaf material, m².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeafArea(pub f64);

/// Number of instances of a mesh prototype.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstanceCount(pub u64);

/// Extents of all geometry, and the memory that the ray engine will take.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneExtents {
    /// Height of the lowest point, m, local frame.
    pub low: f64,
    /// Height of the highest point, m, local frame.
    pub high: f64,
    /// Extent of the tile of a periodic scene, m.
    pub tile: Option<DVec2>,
    /// Number of triangles and discs of all meshes.
    pub primitives: u64,
    /// Number of instances, and of their images in a periodic tile.
    pub records: u64,
    /// Path in the document of the mesh with most primitives.
    pub largest_mesh: ScenePath,
    /// Path in the document of the instances with most records.
    pub most_records: ScenePath,
}
