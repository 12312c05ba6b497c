//! Transport systems: functions over a [`Stage`](crate::extract::Stage), one file each.
//!
//! What is reflected is computed for a total horizontal irradiance of 1 in each band (see
//! [`Light`](crate::extract::Light)), and products put the units back; what is emitted is absolute.

mod analog;
mod backward;
mod beside;
mod blocks;
mod camera;
mod components;
mod counters;
mod coverage;
mod directions;
mod emission;
mod first_order;
mod forward;
mod glow;
mod growth;
mod hemisphere;
mod history;
mod image;
mod parts;
mod plane;
mod roulette;
mod rows;
mod share;
mod tally;
mod thermal;
mod tile;
mod tiles;
mod walk;
mod weights;

use backward::Path;
pub use beside::LightBeside;
pub use camera::{Camera, Fisheye, Perspective, Projection, footprint, wanted_footprint};
pub use components::{
    COMPONENT_COLUMNS, ComponentsFilm, GAP_COLUMN, GAP_RINGS, image_components_film,
};
pub use counters::{
    AbsorbedCounter, AlbedoCounter, CellCounter, ConeCounter, Counter, EnergyCounter, FluxCounter,
    FluxLevel, GROUND_TERMS, LayerCounter, ViewCounter,
};
pub use directions::{DirectionsFilm, DirectionsOutcome, ViewsOutcome};
use first_order::FirstOrder;
pub use forward::photon_film;
pub use growth::{Film, Schedule};
pub use hemisphere::{Cell, Hemisphere};
pub use image::{ImageFilm, ImageOutcome, path_rays};
pub use parts::{Part, PartCounter, spectra};
pub use plane::ReferencePlane;
pub use roulette::Roulette;
pub use rows::Rows;
pub use share::Share;
pub use tally::Tally;
use thermal::ThermalPath;
pub use tiles::Tiles;
pub use walk::Traced;

/// Independent randomisations of every measurement that has the samples for them. Their spread
/// gives the standard error; with 32 the error of that error is 13 %.
pub const RANDOMISATIONS: u32 = 32;

/// Where light comes from, and the unit that radiance is found in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Reflected of sun and sky, `L / E`, sr⁻¹.
    Reflected,
    /// Emitted by surfaces and the sky, and reflected of that, W m⁻² sr⁻¹ nm⁻¹.
    Emitted,
}

/// What light is followed as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grain {
    /// Packets with power in every band, which lose a part of it wherever they are scattered, and are
    /// played for when little is left.
    Packet(Roulette),
    /// Photons of one band, which are absorbed or scattered as a whole.
    Photon,
}

/// Watches a measurement: receives the part that is done, 0 to 1.
pub type Watch<'a> = &'a (dyn Fn(f64) + Sync);
