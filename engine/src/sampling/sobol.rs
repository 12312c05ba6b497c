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
    let mut point = [0_u32; 3];
    let mut rest = shuffled;
    while rest != 0 {
        let bit = rest.trailing_zeros() as usize;
        for (coordinate, direction) in point.iter_mut().zip(&DIRECTIONS) {
            *coordinate ^= direction[bit];
        }
        rest &= rest - 1;
    }
    // The first coordinate is the reversed index, so its reversal is the index itself.
    let reversed =
        [shuffled, point[0].reverse_bits(), point[1].reverse_bits(), point[2].reverse_bits()];
    let mut dimension = 0_u32;
    reversed.map(|x| {
        dimension += 1;
        let key = (seed >> 32) as u32;
        let own = (key ^ dimension.wrapping_mul(0x9e37_79b9)).wrapping_mul(0x85eb_ca6b);
        let scrambled = scramble_reversed(x, own ^ (own >> 15)).reverse_bits();
        (f64::from(scrambled) + 0.5) * (-32_f64).exp2()
    })
}

#[cfg(test)]
mod tests {
    use super::sobol4;

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
