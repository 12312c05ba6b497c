//! Owen-scrambled Sobol' points in four dimensions.
//!
//! Sets of four dimensions with independently shuffled indices serve any number of events: each
//! set is as even as Sobol' points are, and the shuffle makes them independent of each other.
//! Source: Burley (2020), "Practical hash-based Owen scrambling", JCGT 9(4); direction numbers of
//! Joe and Kuo (2008), new-joe-kuo-6.21201; hash constants of Vegdahl (2021), "Building a better LK
//! hash". (`sobol_burley` has the same construction, but only 2¹⁶ points and f32.)

/// Direction numbers of dimensions 1 to 3 (dimension 0 is the bit-reversed index), with the most
/// significant bit first: entry `i` belongs to bit `i` of the index.
const DIRECTIONS: [[u32; 32]; 3] =
    [directions(1, 0, [1, 0, 0]), directions(2, 1, [1, 3, 0]), directions(3, 1, [1, 3, 1])];

/// Recurrence of Bratley and Fox (1988) for a primitive polynomial of `degree` with inner
/// coefficients `a` and initial numbers `m`.
const fn directions(degree: usize, a: u32, m: [u32; 3]) -> [u32; 32] {
    let mut v = [0_u32; 32];
    let mut i = 0;
    while i < 32 {
        if i < degree {
            v[i] = m[i] << (31 - i);
        } else {
            v[i] = v[i - degree] ^ (v[i - degree] >> degree);
            let mut k = 1;
            while k < degree {
                if (a >> (degree - 1 - k)) & 1 == 1 {
                    v[i] ^= v[i - k];
                }
                k += 1;
            }
        }
        i += 1;
    }
    v
}

/// Contribution of each half byte of an index to the four coordinates, bit-reversed: entry `[i][value]` belongs to
/// bits `4i` to `4i + 3`. A loop over the bits that are set would end where no processor foresees it.
const PARTS: [[[u32; 4]; 16]; 8] = {
    let mut parts = [[[0; 4]; 16]; 8];
    let mut bit = 0;
    while bit < 32 {
        let own = [
            1 << bit,
            DIRECTIONS[0][bit].reverse_bits(),
            DIRECTIONS[1][bit].reverse_bits(),
            DIRECTIONS[2][bit].reverse_bits(),
        ];
        let mut value = 0;
        while value < 16 {
            if value >> (bit % 4) & 1 == 1 {
                let mut axis = 0;
                while axis < 4 {
                    parts[bit / 4][value][axis] ^= own[axis];
                    axis += 1;
                }
            }
            value += 1;
        }
        bit += 1;
    }
    parts
};

/// Nested uniform scramble of a bit-reversed number: each bit flips depending on the more
/// significant ones, which are the less significant ones here.
const fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

/// Point `index` of the scrambled sequence of this seed; each coordinate in (0, 1).
#[must_use]
pub fn sobol4(index: u32, seed: u64) -> [f64; 4] {
    let shuffled = scramble_reversed(index.reverse_bits(), seed as u32).reverse_bits();
    let mut reversed = [0_u32; 4];
    for (place, parts) in PARTS.iter().enumerate() {
        let part = parts[(shuffled >> (4 * place) & 15) as usize];
        reversed = std::array::from_fn(|axis| reversed[axis] ^ part[axis]);
    }
    let key = (seed >> 32) as u32;
    let scrambled = std::array::from_fn(|axis| {
        let own = (key ^ KEYS[axis]).wrapping_mul(0x85eb_ca6b);
        scramble_reversed(reversed[axis], own ^ (own >> 15))
    });
    flipped(scrambled).map(|x| (f64::from(x) + 0.5) * (-32_f64).exp2())
}

/// Multiples of 2³² over the golden ratio, which set the scramblings of the four dimensions apart.
const KEYS: [u32; 4] = [0x9e37_79b9, 0x3c6e_f372, 0xdaa6_6d2b, 0x78dd_e6e4];

/// Each with its bits in reverse, all four at once.
fn flipped(x: [u32; 4]) -> [u32; 4] {
    let swap = |x: [u32; 4], by: u32, mask: u32| x.map(|x| (x >> by & mask) | (x & mask) << by);
    let nibbles = swap(swap(x, 1, 0x5555_5555), 2, 0x3333_3333);
    swap(nibbles, 4, 0x0f0f_0f0f).map(u32::swap_bytes)
}

#[cfg(test)]
mod tests {
    use super::{DIRECTIONS, PARTS, flipped, sobol4};

    /// The coordinates of a point are the sums of the direction numbers of the bits of its index.
    #[test]
    fn half_bytes_add_what_their_bits_add() {
        for index in (0..32)
            .map(|bit| 1_u32 << bit)
            .chain((0..1000).map(|i| 0x9e37_79b1_u32.wrapping_mul(i)))
        {
            let bits = (0..32).filter(|bit| index >> bit & 1 == 1);
            let expected = bits.fold([0_u32; 4], |sum, bit| {
                let [y, z, w] = DIRECTIONS.map(|directions| directions[bit]);
                let own = [1 << (31 - bit), y, z, w];
                std::array::from_fn(|axis| sum[axis] ^ own[axis])
            });
            let parts = (0..8).map(|place| PARTS[place][(index >> (4 * place) & 15) as usize]);
            let sum = parts
                .fold([0_u32; 4], |sum, part| std::array::from_fn(|axis| sum[axis] ^ part[axis]));
            assert_eq!(flipped(sum), expected, "{index:#x}");
        }
    }

    /// Any 2^(a+b) consecutive points of dimensions 0 and 1 put one point into each box of
    /// 2^a x 2^b: the (0, 2)-sequence property, which scrambling keeps.
    #[test]
    fn the_first_two_dimensions_stratify_every_elementary_box() {
        for seed in [0, 1, 0x1234_5678_9abc_def0] {
            for (a, b) in [(0, 6), (3, 3), (6, 0), (2, 4)] {
                let mut seen = [false; 64];
                for index in 64..128 {
                    let [x, y, ..] = sobol4(index, seed);
                    let (i, j) =
                        ((x * f64::from(1 << a)) as usize, (y * f64::from(1 << b)) as usize);
                    assert!(!std::mem::replace(&mut seen[(i << b) + j], true), "box hit twice");
                }
            }
        }
    }

    /// Every single dimension is stratified into as many strata as there are points.
    #[test]
    fn every_dimension_alone_is_stratified() {
        for dimension in 0..4 {
            let mut seen = [false; 256];
            for index in 0..256 {
                let stratum = (sobol4(index, 99)[dimension] * 256.0) as usize;
                assert!(!std::mem::replace(&mut seen[stratum], true));
            }
        }
    }

    /// Points of different seeds are independent: the mean over seeds of a product of centred
    /// coordinates vanishes.
    #[test]
    fn seeds_are_independent() {
        let n = 4096_u32;
        let sum: f64 = (0..n)
            .map(|seed| {
                let key = u64::from(seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let next = u64::from(seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                (sobol4(5, key)[1] - 0.5) * (sobol4(5, next)[1] - 0.5)
            })
            .sum();
        let z = sum / (f64::from(n) / 144.0).sqrt();
        assert!(z.abs() < 4.0, "z = {z}");
    }
}
