//! Random numbers of one leaf, from nothing but the crown's seed, their purpose and the leaf's
//! place: leaves can be made in any order, and a change to one kind of number moves no other.

/// Purpose of random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    Position = 1,
    Normal = 2,
    Turn = 3,
    Clump = 4,
}

/// A sequence of random numbers.
pub(super) struct Stream(u64);

/// 2^64 over the golden ratio, odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Stream {
    pub(super) fn new(seed: u64, purpose: Purpose, index: u64) -> Self {
        let key = mix(seed.wrapping_add(STEP)) ^ purpose as u64;
        Self(mix(mix(key.wrapping_add(STEP)) ^ index))
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(STEP);
        (mix(self.0) >> 11) as f64 * (0.5 * f64::EPSILON)
    }
}

/// The finaliser of `SplitMix64`.
///
/// Source: Steele, Lea & Flood (2014), OOPSLA, 453–472.
fn mix(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}
