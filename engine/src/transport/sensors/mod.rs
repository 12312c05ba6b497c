//! Measurements of each kind of sensor: the transport system that it takes, and the film that holds its samples.

mod coverage;
mod directions;
mod first_surface;
mod image;

pub use directions::{
    DirectionsFilm, DirectionsOutcome, DirectionsSettings, LightSettings, ViewsOutcome,
};
pub use first_surface::{FirstSurfaceFilm, image_first_surface_film};
pub use image::{ImageFilm, path_rays};
