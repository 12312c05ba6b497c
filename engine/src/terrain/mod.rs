//! The ground: from rasters and meshes to triangles, and its height and slope at any place.

mod cells;
mod cover;
mod grid;
mod ground;
mod mesh;
mod plane;
mod raster;
mod relief;
mod surface;
mod tin;

pub use cells::Cells;
pub use ground::Ground;
pub use mesh::mesh;
pub use plane::plane;
pub use raster::raster;
pub use relief::{GroundPlane, Relief};
pub use surface::Parts;

#[cfg(test)]
#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "what was measured, and what skipped"
)]
mod tests;
