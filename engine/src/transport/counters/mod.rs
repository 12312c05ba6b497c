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

use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::Sampler;

pub use absorbed::AbsorbedCounter;
pub use albedo::AlbedoCounter;
pub use cells::CellCounter;
pub use cones::ConeCounter;
pub use energy::EnergyCounter;
pub use fluxes::{FluxCounter, FluxLevel};
pub use layers::{GROUND_TERMS, LayerCounter};
pub use views::ViewCounter;

/// An event in a packet's life. Weights, shape `[lanes]`, are in units of the power that falls on
/// the scene's rectangle over the number of packets; of emitted light, in W m⁻² nm⁻¹ times the area
/// of the rectangle over the number of lines.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// It starts.
    Start {
        /// From where and in which direction.
        ray: &'a Ray,
        /// Its weight.
        weight: &'a [f32],
    },
    /// A surface emits it.
    Emission {
        /// From where.
        hit: &'a Hit,
        /// In which direction.
        ray: &'a Ray,
        /// Its weight: over all lines, directions follow Lambert's law.
        weight: &'a [f32],
        /// Where it draws from, for counters that play for rays with a number aside.
        sampler: &'a Sampler,
    },
    /// It flies.
    Flight {
        /// From where and in which direction.
        ray: &'a Ray,
        /// How far, m.
        distance: f64,
        /// Its weight.
        weight: &'a [f32],
    },
    /// It arrives at a surface.
    Arrival {
        /// Where.
        hit: &'a Hit,
        /// Unit vector to where it comes from.
        wo: DVec3,
        /// How many surfaces it has left before.
        order: u32,
        /// Whether any of them was the ground.
        met_ground: bool,
        /// Whether scattering here counts no more.
        is_last: bool,
        /// Its weight.
        weight: &'a [f32],
        /// Share of it that is scattered, and the part of that which stays on the side that it
        /// arrives at: of a packet expected values, of a photon all or nothing.
        scattered: &'a [f32],
        /// See above.
        reflected: &'a [f32],
        /// Where it draws from, for counters that play for rays with a number aside.
        sampler: &'a Sampler,
    },
    /// It goes on after being scattered, or does not.
    Roulette {
        /// The weight that is scattered, whatever direction or roulette were drawn.
        expected: &'a [f32],
        /// The weight that goes on.
        kept: &'a [f32],
    },
    /// It ends where an isolated ground is cut out of the earth.
    Buried {
        /// Its weight.
        weight: &'a [f32],
    },
    /// It leaves the scene.
    Escape {
        /// Its last flight.
        ray: &'a Ray,
        /// How many surfaces it has left: as often as it was scattered, or once more if a surface
        /// emitted it.
        order: u32,
        /// Whether any of them was the ground.
        met_ground: bool,
        /// Its weight.
        weight: &'a [f32],
    },
}

/// A product of photon tracing: cells of sums, filled from the events of all packets.
pub trait Counter: Sync {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Counts an event; returns the number of rays that this took.
    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64;
}
