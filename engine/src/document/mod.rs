//! The scene language: what a scene file may say, reading it with places, and writing it.

#[macro_use]
mod schema;
mod scene;

pub use scene::*;
