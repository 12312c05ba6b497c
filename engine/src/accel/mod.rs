#![doc = include_str!("README.md")]
#![expect(
    clippy::inline_always,
    reason = "code that is generic over the instruction set must be inlined into the wrapper that \
              enables it"
)]

mod build;
mod layout;
mod simd;
mod traversal;

#[cfg(test)]
mod tests;

pub use build::{BuildError, InstanceInput, MeshInput};
pub use layout::{BvhMemory, Domain, TwoLevelBvh};
pub use traversal::{Departure, Hit, Ray, RayBatch};
