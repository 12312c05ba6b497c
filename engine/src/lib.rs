//! `sunfleck` computes where the light of a forest goes.
//!
//! A scene is text; it becomes a document, a world of entities, a flat stage, and the stage is
//! traced. `ARCHITECTURE.md` beside this crate is the map of its modules.

pub mod accel;
pub mod assets;
pub mod components;
pub mod document;
pub mod extract;
mod files;
pub mod film;
pub mod geometry;
mod memory;
pub mod output;
pub mod placement;
pub mod products;
pub mod run;
pub mod sampling;
pub mod scattering;
pub mod spawn;
pub mod spectral;
pub mod systems;
pub mod terrain;
pub mod transport;
pub mod units;
