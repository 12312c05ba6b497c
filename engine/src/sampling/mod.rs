//! Random numbers that depend on nothing but their key: counter-based streams, Owen-scrambled
//! Sobol' points, and warps from the unit square to directions.

mod sobol;
mod stream;
mod warp;

pub use sobol::sobol4;
pub use stream::{Key, Sampler};
pub use warp::{concentric_disc, cosine_direction, cosine_hemisphere};
