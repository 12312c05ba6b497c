//! Counters of photon packets, one file a product.

mod absorbed;
mod albedo;
mod cells;
mod cones;
mod energy;
mod fluxes;
mod layers;
mod views;
mod virtual_photon_roulette;

use super::record::Recorder;
use super::tally::WeightFactor;
use crate::accel::{Hit, Ray};
use crate::extract::Stage;
use crate::sampling::Sampler;
use crate::scattering::{Interaction, Lobe};

pub use absorbed::AbsorbedCounter;
pub use albedo::AlbedoCounter;
pub use cells::CellCounter;
pub use cones::ConeCounter;
pub use energy::EnergyCounter;
pub use fluxes::{FluxCounter, FluxLevel};
pub use layers::{GROUND_TERMS, LayerCounter};
pub use views::ViewCounter;

/// Surfaces that a packet has left so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Visited {
    /// Number of them: scattering events, and one more if a surface emitted the packet.
    pub order: u32,
    /// True if one of them was the ground.
    pub has_met_ground: bool,
}

impl Visited {
    /// Adds a surface.
    pub(super) const fn leave(&mut self, is_ground: bool) {
        self.order += 1;
        self.has_met_ground |= is_ground;
    }
}

/// An event in the life of a packet, whose weight the [`Recorder`] knows: in units of the power that falls on
/// the scene's rectangle over the number of packets; for emitted light, in W m⁻² nm⁻¹ times the area of the
/// rectangle over the number of lines.
#[derive(Clone, Copy, Debug)]
pub enum Event<'e> {
    /// A packet of sun or sky starts.
    Start {
        /// Origin and direction.
        ray: &'e Ray,
    },
    /// A surface emits a packet. The packet's weight is that of a black body: the surface emits `emitted` of
    /// it. Over all lines, directions follow Lambert's law.
    Emission {
        /// Point of emission.
        hit: &'e Hit,
        /// Origin and direction.
        ray: &'e Ray,
        /// Fraction of the weight that is emitted along the ray.
        emitted: Lobe,
        /// Factor that the emitted fractions in all directions share.
        scale: f32,
        /// Band of a photon, which carries all that is emitted in it.
        band: Option<usize>,
        /// Emitted weight in the representative bands.
        throughput: &'e [f32],
        /// Random numbers of the packet, for counters that draw one of their own.
        sampler: &'e Sampler,
    },
    /// A packet flies.
    Flight {
        /// Origin and direction.
        ray: &'e Ray,
        /// Length of the flight, m.
        distance: f64,
    },
    /// A packet arrives at a surface.
    Arrival {
        /// Point of arrival.
        hit: &'e Hit,
        /// The surface, seen from the packet's origin.
        surface: Interaction<'e>,
        /// Surfaces that it has left before.
        visited: Visited,
        /// True if scattering here does not count.
        is_last: bool,
        /// Weight in the representative bands.
        throughput: &'e [f32],
        /// Fraction of the weight that is scattered: an expected value for a packet, 0 or 1 for a photon.
        scattered: Lobe,
        /// Fraction of the weight that is scattered to the side of arrival: an expected value for a packet, 0
        /// or 1 for a photon.
        reflected: Lobe,
        /// Random numbers of the packet, for counters that draw one of their own.
        sampler: &'e Sampler,
    },
    /// A packet leaves a surface, with the weight of its direction and of Russian roulette.
    Departure,
    /// A packet ends at a face along which an isolated ground is cut out of the earth.
    Buried,
    /// A packet leaves the scene.
    Escape {
        /// Its last flight.
        ray: &'e Ray,
        /// Surfaces that it has left.
        visited: Visited,
    },
}

/// A product of photon tracing: cells of sums that the events of all packets add to.
pub trait Counter: Sync {
    /// Number of cells.
    fn cells(&self) -> usize;

    /// Prepares for counting, once, before any packet is traced.
    fn prepare(&self, _: &Stage) {}

    /// Counts an event. Contributions that depend on a shadow ray are recorded with it, before it is traced.
    fn count(&self, stage: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>);
}
