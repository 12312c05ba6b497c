//! Options of the light transport.

record! {
    /// Options of the light transport.
    pub struct Transport ("`transport`") {
        /// Another number is another, independent estimate.
        seed: u64 = 1,
        /// Russian roulette of weak paths.
        roulette: Roulette = Roulette::default(),
        /// Count light that was scattered once, and no more.
        first_order_only: bool = false,
        /// Count light that was scattered so often at most.
        max_order: Option<u32> = None,
    }
}

impl Transport {
    /// Maximum number of scattering events of light that counts.
    #[must_use]
    pub fn most_orders(&self) -> u32 {
        if self.first_order_only { 1 } else { self.max_order.unwrap_or(u32::MAX) }
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
