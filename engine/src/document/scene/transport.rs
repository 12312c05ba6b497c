//! How light is traced.

use std::borrow::Cow;

use super::super::decode::{Decode, Fields, Reader, example_of_keys};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;

record! {
    /// How light is traced.
    pub struct Transport ("`transport`") {
        /// Another number is another, independent estimate.
        seed: u64 = 1,
        /// How weak paths end.
        roulette: Roulette = Roulette::default(),
        /// Count light that was scattered once, and no more.
        first_order_only: bool = false,
        /// Count light that was scattered so often at most.
        max_order: Option<u32> = None,
    }
}

impl Transport {
    /// How often light may be scattered that counts.
    #[must_use]
    pub fn most_orders(&self) -> u32 {
        if self.first_order_only { 1 } else { self.max_order.unwrap_or(u32::MAX) }
    }
}

impl Default for Transport {
    fn default() -> Self {
        Self { seed: 1, roulette: Roulette::default(), first_order_only: false, max_order: None }
    }
}

record! {
    /// Russian roulette: from some order on a path ends with some probability; those that survive
    /// carry its power on. Where that would give them more than they started with, fewer end.
    pub struct Roulette ("the roulette") {
        /// Orders of scattering before it starts.
        after_order: u32 = 5,
        /// Probability to end, below 1.
        kill: f64 = 0.05,
    }
}

impl Default for Roulette {
    fn default() -> Self {
        Self { after_order: 5, kill: 0.05 }
    }
}
