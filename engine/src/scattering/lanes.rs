//! Sums and maxima over lanes, in an order that a processor can take eight at a time.

use super::LANES;

/// `Σ a b` of spectra of whole groups of lanes.
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f32 {
    debug_assert!(a.len().is_multiple_of(LANES) && a.len() == b.len(), "whole groups of lanes");
    let mut sums = [0.0; LANES];
    for (a, b) in a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum()
}

/// The largest of a spectrum of whole groups of lanes, and 0.
pub(crate) fn largest(spectrum: &[f32]) -> f32 {
    debug_assert!(spectrum.len().is_multiple_of(LANES), "whole groups of lanes");
    largest_of(spectrum.as_chunks::<LANES>().0.iter().copied())
}

/// The largest of `a b` of spectra of whole groups of lanes, and 0.
pub(crate) fn largest_product(a: &[f32], b: &[f32]) -> f32 {
    let pairs = a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0);
    largest_of(pairs.map(|(a, b)| std::array::from_fn(|lane| a[lane] * b[lane])))
}

fn largest_of(groups: impl Iterator<Item = [f32; LANES]>) -> f32 {
    let mut most = [0.0; LANES];
    for group in groups {
        for (most, value) in most.iter_mut().zip(group) {
            *most = if value > *most { value } else { *most };
        }
    }
    most.into_iter().fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "small whole numbers are exact")]
    fn all_lanes_count() {
        let of = |f: fn(f32) -> f32| -> Vec<f32> { (0..24_u8).map(|i| f(i.into())).collect() };
        assert_eq!(dot(&of(|i| i), &of(|_| 2.0)), 2.0 * (23.0 * 24.0 / 2.0));
        for peak in 0..24 {
            let mut spectrum = of(|i| 0.5 - i);
            spectrum[peak] = 7.0;
            assert_eq!(largest(&spectrum), 7.0);
            assert_eq!(largest_product(&spectrum, &of(|_| 2.0)), 14.0);
        }
        assert_eq!(largest(&[-1.0; 8]), 0.0);
    }
}
