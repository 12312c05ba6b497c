//! Transport systems: functions over a [`Stage`](crate::extract::Stage).
//!
//! | folder or file | subject |
//! |---|---|
//! | `reference.rs` | the algorithm as one plain loop: read it first |
//! | `paths` | paths from the sensor: backward, first order, thermal, first hit |
//! | `photons` | packets from the light, and the counters that they add to |
//! | `camera` | points of an image to rays |
//! | `films` | images and sums with their errors, and how samples are scheduled |
//! | `roulette.rs`, `plane.rs` | Russian roulette; the plane that reflected light leaves through |
//!
//! Reflected light is computed for a total horizontal irradiance of 1 in each band (see
//! [`Light`](crate::extract::Light)), and products put the units back; emitted light is absolute.

mod camera;
mod films;
mod paths;
mod photons;
mod plane;
mod reference;
mod roulette;

pub use camera::{
    Camera, FisheyeCamera, OrthographicCamera, PerspectiveCamera, footprint, wanted_footprint,
};
pub use films::{
    ComponentsFilm, DirectionsFilm, DirectionsOutcome, DirectionsSettings, Film, ImageFilm,
    ImageOutcome, ImageTiles, LightSettings, Partition, ReplicateSums, Schedule, ViewsOutcome,
    image_components_film, path_rays,
};
pub use paths::{COMPONENT_COLUMNS, GAP_COLUMN, GAP_RINGS, TracedRay};
pub use photons::{
    AbsorbedCounter, AlbedoCounter, Cell, CellCounter, ConeCounter, Counter, EnergyCounter,
    FluxCounter, FluxLevel, GROUND_TERMS, Hemisphere, LayerCounter, LightBeside, OrderCounter,
    PacketOptions, PhotonKind, ScatteringOrder, Tally, ViewCounter, photon_film, spectra,
};
pub use plane::ReferencePlane;
pub use roulette::RouletteThreshold;

/// Number of independent randomisations of every measurement that has the samples for them. Their spread
/// gives the standard error; with 32 the error of that error is 13 %.
pub const RANDOMISATIONS: u32 = 32;

/// Origin of light, and the unit of its radiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightSource {
    /// Light of sun and sky that is reflected, `L / E`, sr⁻¹.
    Reflected,
    /// Light that surfaces and the sky emit, and its reflections, W m⁻² sr⁻¹ nm⁻¹.
    Emitted,
}

/// Receives the part of a measurement that is done, 0 to 1.
pub type ProgressFn<'a> = &'a (dyn Fn(f64) + Sync);
