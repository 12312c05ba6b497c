//! `sunfleck` computes where the light of a forest goes.
//!
//! A scene is text; it becomes a document, a world of entities, a flat stage, and the stage is
//! traced. See `ARCHITECTURE.md` for the map of the modules.

pub mod accel;
pub mod assets;
pub mod components;
pub mod document;
pub mod geometry;
pub mod output;
pub mod products;
pub mod spectral;
pub mod units;
