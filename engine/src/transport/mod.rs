//! Transport systems: functions over a [`Stage`](crate::extract::Stage).
//!
//! | folder or file | subject |
//! |---|---|
//! | `reference.rs` | the algorithm as one plain loop: read it first |
//! | `paths` | paths from the sensor: backward, first order, thermal, first hit |
//! | `photons` | packets from the light, and the counters that they add to |
//! | `camera` | points of an image to rays |
//! | `films` | images and sums with their errors, and how samples are scheduled |
//! | `sensors` | the system and the film of each kind of sensor |
//! | `ray_queue.rs` | rays of many paths or packets, traced together |
//! | `roulette.rs`, `plane.rs` | Russian roulette; the plane that reflected light leaves through |
//! | `spectrum_products.rs`, `coefficients.rs` | products of spectra that many packets share; sums of them that are evaluated later |
//! | `scattering_order.rs`, `band_blocks.rs`, `state.rs` | parts of the light by order; bands that are evaluated at a time; saved numbers |
//!
//! Reflected light is computed for a total horizontal irradiance of 1 in each band (see
//! [`Light`](crate::extract::Light)), and products put the units back; emitted light is absolute.

mod band_blocks;
mod camera;
mod coefficients;
mod films;
mod paths;
mod photons;
mod plane;
mod ray_queue;
mod reference;
mod roulette;
mod scattering_order;
mod sensors;
mod spectrum_products;
mod state;
mod term_runs;

pub use camera::{
    Camera, CameraPose, FisheyeCamera, OrthographicCamera, PerspectiveCamera, footprint, view_axes,
    wanted_footprint,
};
pub use films::{
    Film, ImageOutcome, ImageTiles, Partition, PixelRows, Pixels, Randomisations, ReplicateSums,
    Schedule,
};
pub use paths::{ComponentColumns, GAP_RINGS};
pub use photons::{
    AbsorbedCounter, AlbedoCounter, Cell, CellCounter, ConeCounter, Counter, EnergyCounter,
    FluxCounter, FluxLevel, GROUND_TERMS, Hemisphere, LayerCounter, LightBeside, OrderCounter,
    PacketOptions, PhotonKind, Recorder, ViewCounter, photon_film,
};
pub use plane::ReferencePlane;
pub use ray_queue::TracedRay;
pub use roulette::RouletteThreshold;
pub use scattering_order::{ScatteringOrder, spectrum_count};
pub use sensors::{
    DirectionsFilm, DirectionsOutcome, DirectionsSettings, FirstSurfaceFilm, ImageFilm,
    LightSettings, ViewsOutcome, image_first_surface_film, path_rays,
};

/// Number of independent randomisations of sums over views and packets. Their spread gives the standard error; with
/// 32 the error of that error is 13 %. Images deal the samples of their pixels, which have two randomisations each, to
/// as many rows (`films/image_tiles.rs`).
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
