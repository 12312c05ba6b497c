//! The ground: from rasters and meshes to triangles, and its height and slope at any place.

mod ground;
mod plane;

pub use ground::Ground;
pub use plane::plane;
