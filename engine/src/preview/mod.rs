//! Pictures of a scene before anything is measured.

mod map;
mod palette;

pub use map::{MAP_SIZE, SceneMap, map_svg};
