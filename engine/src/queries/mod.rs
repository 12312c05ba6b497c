//! Questions about a scene that need no light: functions over the entities of its world.

mod cell_grid;
mod height_model;
mod leaf_area;
mod statistics;
mod stretched_area;
mod surfaces;

pub use cell_grid::{CellCount, CellGrid, HeightReference};
pub use height_model::{HeightModel, TooManyCells, height_model};
pub use leaf_area::{
    CountedSurfaces, LayerCount, LeafAreaError, LeafAreaGrid, LeafAreaRequest, leaf_area,
};
pub use statistics::{
    HeightHistogram, HeightSpan, MeshStatistics, PlantStatistics, plant_statistics,
};
