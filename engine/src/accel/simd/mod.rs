//! Vectors of eight `f32` lanes, dispatch over instruction sets, a stack, prefetching and memory on huge pages: the only
//! folder with `unsafe` code.
//!
//! A [`Kernel`] is generic over [`Isa`] and inlined into one wrapper per instruction set, which
//! alone carries `#[target_feature]`. A value of `Avx2` or `Avx512` exists only inside its
//! wrapper, and a wrapper is called only for a [`SimdLevel`] that the processor was found to have.
//! Therefore the intrinsics in this folder are sound.
#![allow(
    unsafe_code,
    reason = "intrinsics need a processor feature that is checked at run time; the stack leaves \
              its unused part uninitialised"
)]

mod huge_pages;
mod portable;
mod prefetch;
mod stack;
#[cfg(target_arch = "x86_64")]
mod x86;

pub(super) use huge_pages::with_huge_pages;
use portable::Portable;
pub(super) use prefetch::prefetch;
pub(super) use stack::{Stack, StackMemory};

/// Eight values, one per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(32))]
pub(super) struct Lanes(pub [f32; 8]);

/// Eight words, one per lane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(32))]
pub(super) struct Words(pub [u32; 8]);

/// Arithmetic on eight lanes. Comparisons return bit masks, lane 0 in bit 0.
///
/// It decides only by bounds that hold with and without fused multiplication.
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
    /// `a`, negated where `sign` is negative.
    fn xor_sign(self, a: Self::F, sign: Self::F) -> Self::F;
    /// `b` where the sign bit of `by` is set, `a` elsewhere.
    fn select(self, a: Self::F, b: Self::F, by: Self::F) -> Self::F;
    /// `a <= b`; false for NaN.
    fn le(self, a: Self::F, b: Self::F) -> u32;
    /// `!(a > b)`; true for NaN.
    fn not_gt(self, a: Self::F, b: Self::F) -> u32;
    /// Children of a node whose boxes are entered before they are left, moved to the front in the order `order`.
    fn compress_hits(
        self,
        order: u32,
        enter: Self::F,
        leave: Self::F,
        child: &Words,
    ) -> HitChildren<Self::F>;
    /// Writes all lanes, as words.
    ///
    /// # Safety
    /// There must be room for eight words.
    unsafe fn write(self, value: Self::F, to: *mut u32);
}

/// Children of a node that a ray hits; lanes beyond `count` are not defined.
#[derive(Clone, Copy)]
pub(super) struct HitChildren<F> {
    pub count: usize,
    /// Distances at which their boxes are entered.
    pub near: F,
    /// References, as bits.
    pub children: F,
}

/// Work that is compiled once per instruction set.
///
/// Implementations of `run` must be `#[inline(always)]`, and so must everything that they call with an [`Isa`].
pub(super) trait Kernel {
    type Output;
    fn run<I: Isa>(self, isa: I) -> Self::Output;
}

/// Instruction set that rays are traced with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SimdLevel {
    /// Instructions that the program was compiled for.
    Portable,
    /// AVX2 and FMA.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512 F and VL on eight lanes: mask registers instead of vectors.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl SimdLevel {
    /// Best level that this processor has.
    pub(super) fn detect() -> Self {
        Self::available().last().copied().unwrap_or(Self::Portable)
    }

    /// All levels that this processor has, best last.
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

    /// Runs a kernel with this instruction set.
    #[inline]
    pub(super) fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            Self::Portable => kernel.run(Portable),
            // SAFETY: `detect` and `available` name a level only when the processor has it.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::run_avx2(kernel) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::run_avx512(kernel) },
        }
    }
}
