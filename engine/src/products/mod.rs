//! What a run reports: named quantities with unit, axes and standard error, made from films by pure
//! functions.

mod absorbed;
mod components;
mod context;
mod directions;
mod extent;
mod images;
mod leaf_area;
mod photons;
mod reflectance;
mod report;
mod sources;
mod thermal;

pub use crate::components::Channels;
pub use absorbed::{Faces, absorbed};
pub use components::{components_of_directions, components_of_image};
pub use context::{BandSources, Context};
pub use directions::of_directions;
pub use extent::{Extent, extents_of_directions, extents_of_image};
pub use images::of_image;
pub use leaf_area::{GapSums, LAI_2000_RINGS, LeafAreaIndex, lai_beer, lai_of_rings, lai_of_views};
pub use photons::{albedo, brf_cells, brf_cones, brf_views, energy, fapar, fluxes};
pub use reflectance::{brf, flux_density, fraction, radiance};
pub use report::{
    Axis, AxisPoints, Class, Day, Forecast, Georeference, Image, Night, Origin, Point, Product,
    Rendering, Report, SensorReport, data_size,
};
pub use sources::{brightness_of, of_sources};
pub use thermal::{brightness, radiance_of_sources};
