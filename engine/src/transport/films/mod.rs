//! Films: images and sums of views and packets, with their errors; rounds of samples, partitions and blocks.

mod blocks;
mod components;
mod coverage;
mod directions;
mod film;
mod image;
mod image_tiles;
mod partition;
mod replicate_sums;
mod tile;

pub use components::{ComponentsFilm, image_components_film};
pub use directions::{
    DirectionsFilm, DirectionsOutcome, DirectionsSettings, LightSettings, ViewsOutcome,
};
pub use film::{Film, Schedule};
pub use image::{ImageFilm, ImageOutcome, path_rays};
pub use image_tiles::ImageTiles;
pub use partition::Partition;
pub use replicate_sums::ReplicateSums;
pub(super) use replicate_sums::SampleTracer;
