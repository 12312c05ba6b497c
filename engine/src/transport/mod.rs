//! Transport systems: functions over a [`Stage`](crate::extract::Stage), one file each.
//!
//! Everything is computed for a total horizontal irradiance of 1 in each band (see
//! [`Light`](crate::extract::Light)); products put the units back.

mod backward;
mod blocks;
mod camera;
mod components;
mod counters;
mod directions;
mod emission;
mod forward;
mod hemisphere;
mod image;
mod parts;
mod roulette;
mod thermal;
mod walk;

pub use backward::{Path, Traced};
pub use camera::{Camera, Fisheye, Perspective, Projection, footprint};
pub use components::{
    COMPONENT_COLUMNS, GAP_COLUMN, measure_directions_components, measure_image_components,
};
pub use counters::{
    AlbedoCounter, CellCounter, ConeCounter, Counter, EnergyCounter, FluxCounter, FluxLevel,
    GROUND_TERMS, LayerCounter, ViewCounter,
};
pub use directions::{DirectionsOutcome, ViewsOutcome, measure_directions};
pub use forward::{PhotonOutcome, trace_photons};
pub use hemisphere::{Cell, Hemisphere};
pub use image::{ImageOutcome, measure_image, measure_image_forward, path_rays};
pub use parts::{Part, PartCounter, spectra};
pub use thermal::{measure_directions_thermal, measure_image_thermal};
use walk::Walk;

/// Independent randomisations of every measurement that has the samples for them. Their spread
/// gives the standard error; with 32 the error of that error is 13 %.
pub const RANDOMISATIONS: u32 = 32;

/// Watches a measurement: receives the part that is done, 0 to 1.
pub type Watch<'a> = &'a (dyn Fn(f64) + Sync);
