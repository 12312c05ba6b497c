//! What photon packets are counted for, one file a product.

mod absorbed;
mod albedo;
mod cells;
mod cones;
mod energy;
mod fluxes;
mod layers;
mod stakes;
mod views;

use glam::DVec3;

use super::tally::{Share, Tally};
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::sampling::Sampler;
use crate::scattering::Spectrum;

pub use absorbed::AbsorbedCounter;
pub use albedo::AlbedoCounter;
pub use cells::CellCounter;
pub use cones::ConeCounter;
pub use energy::EnergyCounter;
pub use fluxes::{FluxCounter, FluxLevel};
pub use layers::{GROUND_TERMS, LayerCounter};
pub use views::ViewCounter;

/// An event in a packet's life. Its weight is what the [`Tally`] holds: in units of the power that falls on
/// the scene's rectangle over the number of packets; of emitted light, in W m⁻² nm⁻¹ times the area of the
/// rectangle over the number of lines.
#[derive(Clone, Copy, Debug)]
pub enum Event<'e, 'a> {
    /// It starts.
    Start {
        /// From where and in which direction.
        ray: &'e Ray,
    },
    /// A surface emits it. Over all lines, directions follow Lambert's law.
    Emission {
        /// From where.
        hit: &'e Hit,
        /// In which direction.
        ray: &'e Ray,
        /// Outline of its weight: the product of those of all that it was multiplied with.
        outline: &'e [f32],
        /// Where it draws from, for counters that play for rays with a number aside.
        sampler: &'e Sampler,
    },
    /// It flies.
    Flight {
        /// From where and in which direction.
        ray: &'e Ray,
        /// How far, m.
        distance: f64,
    },
    /// It arrives at a surface.
    Arrival {
        /// Where.
        hit: &'e Hit,
        /// Unit vector to where it comes from.
        wo: DVec3,
        /// How many surfaces it has left before.
        order: u32,
        /// Whether any of them was the ground.
        met_ground: bool,
        /// Whether scattering here counts no more.
        is_last: bool,
        /// Outline of its weight: the product of those of all that it was multiplied with.
        outline: &'e [f32],
        /// Share of it that is scattered, and the part of that which stays on the side that it
        /// arrives at: of a packet expected values, of a photon all or nothing.
        scattered: &'a Spectrum,
        /// See above.
        reflected: &'a Spectrum,
        /// Where it draws from, for counters that play for rays with a number aside.
        sampler: &'e Sampler,
    },
    /// It goes on from a surface, with a direction and the luck of roulette in its weight.
    Departure,
    /// It ends where an isolated ground is cut out of the earth.
    Buried,
    /// It leaves the scene.
    Escape {
        /// Its last flight.
        ray: &'e Ray,
        /// How many surfaces it has left: as often as it was scattered, or once more if a surface
        /// emitted it.
        order: u32,
        /// Whether any of them was the ground.
        met_ground: bool,
    },
}

/// A product of photon tracing: cells of sums, to which the events of all packets add.
pub trait Counter: Sync {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Does once, before any packet is traced, what counting needs.
    fn prepare(&self, _: &Stage) {}

    /// Counts an event; returns the number of rays that this took.
    fn count<'a>(&self, stage: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64;
}
