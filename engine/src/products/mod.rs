//! What a run reports: named quantities with unit, axes and standard error, made from films by pure
//! functions.

mod context;
mod directions;
mod images;
mod photons;
mod reflectance;
mod report;

pub use context::Context;
pub use directions::of_directions;
pub use images::of_image;
pub use photons::{albedo, brf_cells, brf_views, energy, fapar, fluxes};
pub use reflectance::{brf, flux_density, fraction, radiance};
pub use report::{Axis, AxisPoints, Georeference, Image, Product, Report, SensorReport};
