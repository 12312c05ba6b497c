//! Trees from a canopy height model: their tops, their crowns, and which mesh fits each.

mod crowns;
mod fit;
#[cfg(test)]
mod tests;
mod tops;

pub use crowns::{Crown, crowns};
pub use fit::{Model, fit};
pub use tops::Window;
