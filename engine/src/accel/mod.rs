#![doc = include_str!("README.md")]
#![expect(
    clippy::inline_always,
    reason = "code that is generic over the instruction set must be inlined into the wrapper that \
              enables it"
)]

mod binary;
mod collapse;
mod error;
mod exact;
mod instance;
mod mesh;
mod planar;
mod ray;
mod scene;
mod simd;
mod tile;
mod trace;
mod tree;
mod types;

#[cfg(test)]
mod tests;

pub use error::BuildError;
pub use scene::Scene;
pub use trace::Batch;
pub use types::{Boundary, Departure, Domain, Hit, InstanceInput, Memory, MeshInput, Ray};
