//! Sums, maxima and products over lanes, in an order that suits eight-wide registers.

use std::array::from_fn;

use super::LANES;

/// Runs work on lanes with the widest SIMD registers of the processor. Functions that it inlines are compiled
/// for them. Results are the same, bit for bit.
pub(crate) fn with_simd<R>(work: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(work)
}

/// Runs work on this number of lanes, [`with_simd`] if they are more than one group.
#[inline(always)]
fn with_simd_if_many<R>(lanes: usize, work: impl Fn() -> R) -> R {
    if lanes > LANES { with_simd(work) } else { work() }
}

/// `Σ a b` of spectra of whole groups of lanes.
#[inline(always)]
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f32 {
    debug_assert!(a.len().is_multiple_of(LANES) && a.len() == b.len(), "whole groups of lanes");
    // One group needs neither a loop nor dispatch.
    if let ([a], [b]) = (a.as_chunks::<LANES>().0, b.as_chunks::<LANES>().0) {
        let products: [f32; LANES] = from_fn(|lane| a[lane] * b[lane]);
        return folded(products, |a, b| a + b);
    }
    dot_of_many(a, b)
}

#[inline(never)]
fn dot_of_many(a: &[f32], b: &[f32]) -> f32 {
    with_simd_if_many(
        a.len(),
        #[inline(always)]
        || {
            let mut sums = [0.0; LANES];
            for (a, b) in groups(a).zip(groups(b)) {
                for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
                    *sum += a * b;
                }
            }
            folded(sums, |a, b| a + b)
        },
    )
}

/// Maximum of 0 and a spectrum of whole groups of lanes.
#[inline(always)]
pub(crate) fn largest(spectrum: &[f32]) -> f32 {
    debug_assert!(spectrum.len().is_multiple_of(LANES), "whole groups of lanes");
    if let [group] = spectrum.as_chunks::<LANES>().0 {
        return largest_of([*group].into_iter());
    }
    largest_of_many(spectrum)
}

#[inline(never)]
fn largest_of_many(spectrum: &[f32]) -> f32 {
    with_simd_if_many(
        spectrum.len(),
        #[inline(always)]
        || largest_of(groups(spectrum).copied()),
    )
}

/// Maximum of 0 and the product of spectra of whole groups of lanes, all of one length.
pub(crate) fn largest_product<const N: usize>(spectra: [&[f32]; N]) -> f32 {
    let groups = spectra.map(|spectrum| spectrum.as_chunks::<LANES>().0);
    let count = groups.iter().map(|groups| groups.len()).min().unwrap_or(0);
    with_simd_if_many(
        count * LANES,
        #[inline(always)]
        || {
            largest_of((0..count).map(|group| {
                groups.iter().fold([1.0; LANES], |product, factor| {
                    let factor = &factor[group];
                    from_fn(|lane| product[lane] * factor[lane])
                })
            }))
        },
    )
}

/// `t ← t f c`, over the lanes of `f`.
#[inline(always)]
pub(crate) fn multiply(t: &mut [f32], f: &[f32], c: f32) {
    if let ([t], [f]) = (t.as_chunks_mut::<LANES>().0, f.as_chunks::<LANES>().0) {
        *t = from_fn(|lane| t[lane] * (f[lane] * c));
        return;
    }
    for (t, f) in groups_mut(t).zip(groups(f)) {
        *t = from_fn(|lane| t[lane] * (f[lane] * c));
    }
}

/// `sum ← sum + t f s c`, over the lanes of `f` and `s`.
#[inline(always)]
pub(crate) fn add_lit(sum: &mut [f32], t: &[f32], f: &[f32], s: &[f32], c: f32) {
    for ((sum, t), (f, s)) in groups_mut(sum).zip(groups(t)).zip(groups(f).zip(groups(s))) {
        *sum = from_fn(|lane| sum[lane] + t[lane] * s[lane] * f[lane] * c);
    }
}

/// `sum ← sum + t s c`, over the lanes of `s`.
#[inline(always)]
pub(crate) fn add_seen(sum: &mut [f32], t: &[f32], s: &[f32], c: f32) {
    for ((sum, t), s) in groups_mut(sum).zip(groups(t)).zip(groups(s)) {
        *sum = from_fn(|lane| sum[lane] + t[lane] * s[lane] * c);
    }
}

#[inline(always)]
fn groups(values: &[f32]) -> impl Iterator<Item = &[f32; LANES]> {
    values.as_chunks().0.iter()
}

#[inline(always)]
fn groups_mut(values: &mut [f32]) -> impl Iterator<Item = &mut [f32; LANES]> {
    values.as_chunks_mut().0.iter_mut()
}

/// Folds the lanes in pairs: a chain of three dependent steps, where one lane after the other makes seven.
#[inline(always)]
fn folded([a, b, c, d, e, f, g, h]: [f32; LANES], with: impl Fn(f32, f32) -> f32) -> f32 {
    with(with(with(a, e), with(c, g)), with(with(b, f), with(d, h)))
}

#[inline(always)]
fn largest_of(groups: impl Iterator<Item = [f32; LANES]>) -> f32 {
    let mut most = [0.0; LANES];
    for group in groups {
        for (most, value) in most.iter_mut().zip(group) {
            *most = if value > *most { value } else { *most };
        }
    }
    folded(most, |a, b| if a > b { a } else { b })
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
            assert_eq!(largest_product([&spectrum, &of(|_| 2.0), &of(|_| 0.5)]), 7.0);
        }
        assert_eq!(largest(&[-1.0; 8]), 0.0);
    }
}
