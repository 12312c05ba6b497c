//! Eight `f32` lanes, chosen at run time, and a stack: the only folder with `unsafe` code.
//!
//! The traversal is generic over [`Isa`] and inlined into one wrapper an instruction set, which
//! alone carries `#[target_feature]`. A value of [`Avx2`] or [`Avx512`] exists only inside its
//! wrapper, and a wrapper is called only for a [`Level`] that the processor was found to have: that
//! is what makes the intrinsics below sound.
#![allow(
    unsafe_code,
    reason = "intrinsics need a processor feature that is checked at run time; the stack leaves \
              its unused part uninitialised"
)]

mod portable;
mod stack;
#[cfg(target_arch = "x86_64")]
mod x86;

use super::scene::Scene;
use super::trace::{self, Batch, Found, Query};

use portable::Portable;
pub(super) use stack::{Space, Stack};

/// Eight values, one a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Lanes(pub [f32; 8]);

/// Eight words, one a lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(super) struct Words(pub [u32; 8]);

/// Arithmetic on eight lanes. Comparisons give bit masks, lane 0 in bit 0.
///
/// Only bounds that hold with and without fused multiplication are decided with it.
pub(super) trait Isa: Copy {
    type F: Copy;
    fn splat(self, value: f32) -> Self::F;
    fn load(self, from: &Lanes) -> Self::F;
    fn load_bits(self, from: &Words) -> Self::F;
    fn add(self, a: Self::F, b: Self::F) -> Self::F;
    fn sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn div(self, a: Self::F, b: Self::F) -> Self::F;
    /// `a b + c`, rounded once or twice.
    fn mul_add(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    /// `a b - c`, rounded once or twice.
    fn mul_sub(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F;
    fn min(self, a: Self::F, b: Self::F) -> Self::F;
    fn max(self, a: Self::F, b: Self::F) -> Self::F;
    fn abs(self, a: Self::F) -> Self::F;
    /// `a` with its sign turned where `sign` is negative.
    fn turn(self, a: Self::F, sign: Self::F) -> Self::F;
    /// `b` where the sign bit of `by` is set, `a` elsewhere.
    fn pick(self, a: Self::F, b: Self::F, by: Self::F) -> Self::F;
    /// `a <= b`; false for NaN.
    fn le(self, a: Self::F, b: Self::F) -> u32;
    /// `!(a > b)`; true for NaN.
    fn not_gt(self, a: Self::F, b: Self::F) -> u32;
    /// The lanes of a node's children whose box is entered before it is left, in the order
    /// `order`: how many, where they are entered, and the children.
    fn arrange(
        self,
        order: u32,
        enter: Self::F,
        leave: Self::F,
        child: &Words,
    ) -> (usize, Self::F, Self::F);
    /// Writes all lanes, as words.
    ///
    /// # Safety
    /// There must be room for eight words.
    unsafe fn write(self, value: Self::F, to: *mut u32);
}

/// The instruction set that rays are traced with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Level {
    /// Whatever the program was compiled for.
    Portable,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512 F and VL on eight lanes: mask registers instead of vectors.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// The best that this processor has.
    pub(super) fn detect() -> Self {
        Self::available().last().copied().unwrap_or(Self::Portable)
    }

    /// All that this processor has, best last.
    pub(super) fn available() -> Vec<Self> {
        let mut levels = vec![Self::Portable];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt")
        {
            levels.push(Self::Avx2);
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                levels.push(Self::Avx512);
            }
        }
        levels
    }

    /// The closest primitive on a ray.
    #[inline]
    pub(super) fn closest(self, query: &Query<'_>) -> Option<Found> {
        match self {
            Self::Portable => trace::trace(Portable, query, false),
            // SAFETY: `detect` and `available` name a level only when the processor has it.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::closest_avx2(query) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::closest_avx512(query) },
        }
    }

    /// Answers a batch.
    #[inline]
    pub(super) fn each(self, scene: &Scene, batch: Batch<'_>) {
        match self {
            Self::Portable => trace::trace_each(Portable, scene, batch),
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::each_avx2(scene, batch) },
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::each_avx512(scene, batch) },
        }
    }

    /// Whether any primitive is on a ray.
    #[inline]
    pub(super) fn occluded(self, query: &Query<'_>) -> bool {
        match self {
            Self::Portable => trace::trace(Portable, query, true).is_some(),
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::occluded_avx2(query) },
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::occluded_avx512(query) },
        }
    }
}
