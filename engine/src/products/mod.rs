//! Products of a run: named quantities with unit, axes and standard error, made from films by pure
//! functions.

mod absorbed;
mod canopy;
mod components;
mod context;
mod denoising;
mod directions;
mod estimates;
mod from_radiance;
mod image;
mod images;
mod leaf_area;
mod of_scene;
mod photons;
mod product_size;
mod recipe;
mod reflectance;
mod replicates;
mod report;
mod sources;
mod thermal;

pub use crate::components::Channels;
pub use crate::transport::{PixelRows, Pixels};
pub use absorbed::{Faces, absorbed};
pub use canopy::{height_products, leaf_area_products};
pub use components::{direction_components, image_components};
pub use context::{BandSources, Context};
pub use directions::direction_products;
pub use from_radiance::{RadianceImage, brf_of_radiance, temperature_of_radiance};
pub use image::{Class, Georeference, Image, Rendering};
pub use images::image_products;
pub use leaf_area::{GapSums, LAI_2000_RINGS, LeafAreaIndex, lai_beer, lai_of_rings, lai_of_views};
pub use photons::{albedo, brf_cells, brf_cones, brf_views, energy, fapar, fluxes};
pub use product_size::{MeasuredLight, ProductSize, direction_sizes, image_sizes};
pub use recipe::{InputFile, Recipe};
pub use reflectance::{brf, flux_density, fraction, radiance};
pub use report::{
    AxisPoints, CentralDifference, Day, Forecast, Night, Product, ProductAxis, Report, SceneSource,
    SensorReport, SweepPoint, data_size,
};
pub use sources::{brightness_product, combine_sources};
pub use thermal::{brightness, radiance_of_sources};
