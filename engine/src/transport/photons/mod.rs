//! Photon packets: their source, flight, weights, and the counters that they add to.

mod analog;
mod counters;
mod hemisphere;
mod light_beside;
mod order_counter;
mod packet;
mod packet_film;
mod record;
mod source;
mod tally;
mod thermal_emission;

pub use counters::{
    AbsorbedCounter, AlbedoCounter, CellCounter, ConeCounter, Counter, EnergyCounter, FluxCounter,
    FluxLevel, GROUND_TERMS, LayerCounter, ViewCounter,
};
pub use hemisphere::{Cell, Hemisphere};
pub use light_beside::LightBeside;
pub use order_counter::OrderCounter;
pub use packet_film::{PacketOptions, photon_film};
pub use record::Recorder;

use super::RouletteThreshold;

/// Representation of light that starts at its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotonKind {
    /// Packets with power in every band, which lose a part of it wherever they are scattered, with Russian
    /// roulette.
    Packet(RouletteThreshold),
    /// Photons of one band, which are absorbed or scattered as a whole.
    Photon,
}
