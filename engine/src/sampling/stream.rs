use super::sobol4;

/// Name of a random stream: a hash of the seed and of the path of whatever draws from it.
///
/// Streams of different paths are independent, so adding an object to a scene never changes what
/// another one draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Key(u64);

/// Finaliser of `SplitMix64`: every input bit changes every output bit with probability near 1/2.
///
/// Source: Steele, Lea and Flood (2014), "Fast splittable pseudorandom number generators", with the
/// constants of Stafford's variant 13.
const fn mix(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// 2⁶⁴ over the golden ratio, odd: consecutive multiples are spread evenly.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl Key {
    /// Root of all streams of a run.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(mix(seed.wrapping_add(GOLDEN)))
    }

    /// Stream of the entity at this path.
    #[must_use]
    pub fn path(self, path: &str) -> Self {
        path.bytes().fold(self, |key, byte| key.index(byte.into()))
    }

    /// Stream of the member of this number.
    #[must_use]
    pub const fn index(self, index: u64) -> Self {
        Self(mix(self.0 ^ mix(index.wrapping_add(GOLDEN))))
    }

    /// The stream's number at a position, uniform over all 64-bit values.
    #[must_use]
    pub const fn bits(self, position: u64) -> u64 {
        mix(self.0.wrapping_add(position.wrapping_mul(GOLDEN)))
    }

    /// The stream's number at a position, uniform in (0, 1).
    #[must_use]
    pub fn uniform(self, position: u64) -> f64 {
        ((self.bits(position) >> 12) as f64 + 0.5) * (-52_f64).exp2()
    }
}

/// Random numbers of one path, four at a time: Owen-scrambled Sobol' points for the first events,
/// a counter-based stream beyond.
#[derive(Clone, Debug)]
pub struct Sampler {
    randomisation: Key,
    index: u64,
    /// Number of draws so far.
    draw: u32,
}

/// Draws of a path that take Sobol' points: the position in the pixel, a point of the solar disc and each scattering
/// event are one draw each. Later ones depend on so many earlier ones that stratification no longer lowers their
/// variance.
const SOBOL_DRAWS: u32 = 4;

impl Sampler {
    /// Sampler of path `index` of a randomisation.
    #[must_use]
    pub const fn new(randomisation: Key, index: u64) -> Self {
        Self { randomisation, index, draw: 0 }
    }

    /// A number beside those of the next draw, uniform in (0, 1), for decisions that do not change the path.
    #[must_use]
    pub fn aside(&self) -> f64 {
        self.randomisation.index(!u64::from(self.draw)).uniform(self.index)
    }

    /// The next four numbers of the path, each uniform in (0, 1).
    pub fn next_4d(&mut self) -> [f64; 4] {
        let draw = self.draw;
        self.draw += 1;
        let stream = self.randomisation.index(draw.into());
        if draw < SOBOL_DRAWS {
            // Indices beyond 2³² start a new scrambling.
            let seed = stream.bits(self.index >> 32);
            sobol4(self.index as u32, seed)
        } else {
            let stream = stream.index(self.index);
            std::array::from_fn(|position| stream.uniform(position as u64))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Key, Sampler};

    #[test]
    fn streams_of_different_paths_are_uncorrelated() {
        let n = 20_000_u64;
        let a = Key::new(1).path("sensors.a");
        let b = Key::new(1).path("sensors.b");
        let product: f64 = (0..n).map(|i| (a.uniform(i) - 0.5) * (b.uniform(i) - 0.5)).sum();
        // Var[(u - ½)(v - ½)] = 1/144.
        let z = product / (n as f64 / 144.0).sqrt();
        assert!(z.abs() < 4.0, "z = {z}");
    }

    #[test]
    fn every_event_has_the_moments_of_the_uniform_distribution() {
        let n = 4096_u64;
        for event in 0..8 {
            let mut sums = [0.0; 4];
            for index in 0..n {
                let mut sampler = Sampler::new(Key::new(7), index);
                let mut draw = sampler.next_4d();
                for _ in 0..event {
                    draw = sampler.next_4d();
                }
                for (sum, u) in sums.iter_mut().zip(draw) {
                    assert!(u > 0.0 && u < 1.0);
                    *sum += u;
                }
            }
            for sum in sums {
                let z = (sum / n as f64 - 0.5) / (1.0 / (12.0 * n as f64)).sqrt();
                assert!(z.abs() < 4.0, "event {event}: z = {z}");
            }
        }
    }
}
