//! Pictures of a scene before anything is measured.

mod boxes;
mod map;
mod palette;
mod view;

pub use boxes::replace_by_boxes;
pub use map::{MAP_SIZE, SceneMap, map_svg};
pub use view::{SceneView, VIEW_SAMPLES, VIEW_SIZE, ViewSettings};
