//! Eight `f32` lanes, chosen at run time, and a stack: the only `unsafe` code of the crate.
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

use std::mem::MaybeUninit;

use super::trace::{self, Found, Query};

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

/// What any processor can do.
#[derive(Clone, Copy)]
pub(super) struct Portable;

impl Portable {
    #[inline(always)]
    fn zip(a: Lanes, b: Lanes, f: impl Fn(f32, f32) -> f32) -> Lanes {
        Lanes(std::array::from_fn(|i| f(a.0[i], b.0[i])))
    }

    #[inline(always)]
    fn mask(a: Lanes, b: Lanes, f: impl Fn(f32, f32) -> bool) -> u32 {
        (0..8).fold(0, |mask, i| mask | u32::from(f(a.0[i], b.0[i])) << i)
    }
}

impl Isa for Portable {
    type F = Lanes;
    #[inline(always)]
    fn splat(self, value: f32) -> Lanes {
        Lanes([value; 8])
    }
    #[inline(always)]
    fn load(self, from: &Lanes) -> Lanes {
        *from
    }
    #[inline(always)]
    fn load_bits(self, from: &Words) -> Lanes {
        Lanes(from.0.map(f32::from_bits))
    }
    #[inline(always)]
    fn add(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn mul_add(self, a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        self.add(self.mul(a, b), c)
    }
    #[inline(always)]
    fn mul_sub(self, a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        self.sub(self.mul(a, b), c)
    }
    #[inline(always)]
    fn min(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: Lanes, b: Lanes) -> Lanes {
        Self::zip(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn abs(self, a: Lanes) -> Lanes {
        Lanes(a.0.map(f32::abs))
    }
    #[inline(always)]
    fn turn(self, a: Lanes, sign: Lanes) -> Lanes {
        Self::zip(a, sign, |a, s| f32::from_bits(a.to_bits() ^ (s.to_bits() & 0x8000_0000)))
    }
    #[inline(always)]
    fn pick(self, a: Lanes, b: Lanes, by: Lanes) -> Lanes {
        Lanes(std::array::from_fn(|i| if by.0[i].is_sign_negative() { b.0[i] } else { a.0[i] }))
    }
    #[inline(always)]
    fn le(self, a: Lanes, b: Lanes) -> u32 {
        Self::mask(a, b, |a, b| a <= b)
    }
    #[inline(always)]
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "NaN must pass")]
    fn not_gt(self, a: Lanes, b: Lanes) -> u32 {
        Self::mask(a, b, |a, b| !(a > b))
    }
    #[inline(always)]
    fn arrange(
        self,
        order: u32,
        enter: Lanes,
        leave: Lanes,
        child: &Words,
    ) -> (usize, Lanes, Lanes) {
        let (mut near, mut children) = (Lanes([0.0; 8]), Lanes([0.0; 8]));
        let mut count = 0;
        for place in 0..8 {
            let lane = (order >> (3 * place) & 7) as usize;
            near.0[count] = enter.0[lane];
            children.0[count] = f32::from_bits(child.0[lane]);
            count += usize::from(enter.0[lane] <= leave.0[lane]);
        }
        (count, near, children)
    }
    #[inline(always)]
    unsafe fn write(self, value: Lanes, to: *mut u32) {
        // SAFETY: the caller's.
        unsafe { to.cast::<[f32; 8]>().write_unaligned(value.0) };
    }
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
            Self::Portable => trace::trace::<Portable, false>(Portable, query),
            // SAFETY: `detect` and `available` name a level only when the processor has it.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::closest_avx2(query) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::closest_avx512(query) },
        }
    }

    /// Any primitive on one ray and the closest on another.
    #[inline]
    pub(super) fn both(
        self,
        any: &Query<'_>,
        closest: &Query<'_>,
    ) -> (Option<Found>, Option<Found>) {
        match self {
            Self::Portable => trace::trace_both(Portable, any, closest),
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::both_avx2(any, closest) },
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::both_avx512(any, closest) },
        }
    }

    /// Whether any primitive is on a ray.
    #[inline]
    pub(super) fn occluded(self, query: &Query<'_>) -> bool {
        match self {
            Self::Portable => trace::trace::<Portable, true>(Portable, query).is_some(),
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => unsafe { x86::occluded_avx2(query) },
            // SAFETY: as in `closest`.
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => unsafe { x86::occluded_avx512(query) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    #[allow(clippy::wildcard_imports, reason = "a list of intrinsics says nothing")]
    use std::arch::x86_64::*;

    use super::{Found, Isa, Lanes, Query, Words, trace};

    /// Proof that AVX2 and FMA are there: made only inside the two wrappers.
    #[derive(Clone, Copy)]
    pub(super) struct Avx2(());

    /// Proof that AVX-512 F and VL are there too: made only inside the two wrappers.
    #[derive(Clone, Copy)]
    pub(super) struct Avx512(());

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn closest_avx2(query: &Query<'_>) -> Option<Found> {
        trace::trace::<Avx2, false>(Avx2(()), query)
    }

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn occluded_avx2(query: &Query<'_>) -> bool {
        trace::trace::<Avx2, true>(Avx2(()), query).is_some()
    }

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn both_avx2(
        any: &Query<'_>,
        closest: &Query<'_>,
    ) -> (Option<Found>, Option<Found>) {
        trace::trace_both(Avx2(()), any, closest)
    }

    #[target_feature(enable = "avx512f,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn both_avx512(
        any: &Query<'_>,
        closest: &Query<'_>,
    ) -> (Option<Found>, Option<Found>) {
        trace::trace_both(Avx512(()), any, closest)
    }

    #[target_feature(enable = "avx512f,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn closest_avx512(query: &Query<'_>) -> Option<Found> {
        trace::trace::<Avx512, false>(Avx512(()), query)
    }

    #[target_feature(enable = "avx512f,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub(super) fn occluded_avx512(query: &Query<'_>) -> bool {
        trace::trace::<Avx512, true>(Avx512(()), query).is_some()
    }

    /// The methods that both instruction sets do alike.
    macro_rules! common {
        () => {
            type F = __m256;
            #[inline(always)]
            fn splat(self, value: f32) -> __m256 {
                // SAFETY: `self` proves the features, here and in every method below.
                unsafe { _mm256_set1_ps(value) }
            }
            #[inline(always)]
            fn load(self, from: &Lanes) -> __m256 {
                // SAFETY: `Lanes` is 32 bytes at a 32-byte boundary.
                unsafe { _mm256_load_ps(from.0.as_ptr()) }
            }
            #[inline(always)]
            fn load_bits(self, from: &Words) -> __m256 {
                // SAFETY: `Words` is 32 bytes at a 32-byte boundary, and any bits are an `f32`.
                unsafe { _mm256_load_ps(from.0.as_ptr().cast()) }
            }
            #[inline(always)]
            fn add(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_add_ps(a, b) }
            }
            #[inline(always)]
            fn sub(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_sub_ps(a, b) }
            }
            #[inline(always)]
            fn mul(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_mul_ps(a, b) }
            }
            #[inline(always)]
            fn div(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_div_ps(a, b) }
            }
            #[inline(always)]
            fn mul_add(self, a: __m256, b: __m256, c: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_fmadd_ps(a, b, c) }
            }
            #[inline(always)]
            fn mul_sub(self, a: __m256, b: __m256, c: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_fmsub_ps(a, b, c) }
            }
            #[inline(always)]
            fn min(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_min_ps(a, b) }
            }
            #[inline(always)]
            fn max(self, a: __m256, b: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_max_ps(a, b) }
            }
            #[inline(always)]
            fn abs(self, a: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
            }
            #[inline(always)]
            fn turn(self, a: __m256, sign: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_xor_ps(a, _mm256_and_ps(sign, _mm256_set1_ps(-0.0))) }
            }
            #[inline(always)]
            fn pick(self, a: __m256, b: __m256, by: __m256) -> __m256 {
                // SAFETY: see `splat`.
                unsafe { _mm256_blendv_ps(a, b, by) }
            }
            #[inline(always)]
            unsafe fn write(self, value: __m256, to: *mut u32) {
                // SAFETY: the caller's.
                unsafe { _mm256_storeu_ps(to.cast(), value) };
            }
            #[inline(always)]
            fn arrange(
                self,
                order: u32,
                enter: __m256,
                leave: __m256,
                child: &Words,
            ) -> (usize, __m256, __m256) {
                // SAFETY: see `splat`; `Words` is 32 bytes at a 32-byte boundary.
                unsafe {
                    let shifts = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21);
                    // Permutations heed the lowest three bits of each lane only.
                    let lanes = _mm256_srlv_epi32(_mm256_set1_epi32(order as i32), shifts);
                    let hit = self.le(
                        _mm256_permutevar8x32_ps(enter, lanes),
                        _mm256_permutevar8x32_ps(leave, lanes),
                    );
                    let lanes = Self::compress(hit, lanes);
                    let children = _mm256_load_ps(child.0.as_ptr().cast());
                    (
                        hit.count_ones() as usize,
                        _mm256_permutevar8x32_ps(enter, lanes),
                        _mm256_permutevar8x32_ps(children, lanes),
                    )
                }
            }
        };
    }

    impl Avx2 {
        /// The lanes of a mask, moved to the front.
        ///
        /// # Safety
        /// A value of this type must exist.
        #[inline(always)]
        unsafe fn compress(mask: u32, value: __m256i) -> __m256i {
            // SAFETY: the caller's value proves the features.
            unsafe {
                // Each bit of the mask becomes a byte, and picks the byte that counts its lane.
                let bytes = _pdep_u64(mask.into(), 0x0101_0101_0101_0101) * 0xFF;
                let lanes = _pext_u64(0x0706_0504_0302_0100, bytes);
                let lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(lanes as i64));
                _mm256_permutevar8x32_epi32(value, lanes)
            }
        }
    }

    impl Avx512 {
        /// The lanes of a mask, moved to the front.
        ///
        /// # Safety
        /// A value of this type must exist.
        #[inline(always)]
        unsafe fn compress(mask: u32, value: __m256i) -> __m256i {
            // SAFETY: the caller's value proves the features.
            unsafe { _mm256_maskz_compress_epi32(mask as u8, value) }
        }
    }

    impl Isa for Avx2 {
        common!();
        #[inline(always)]
        fn le(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: see `splat`.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
        }
        #[inline(always)]
        fn not_gt(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: see `splat`.
            unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_NGT_UQ>(a, b)) as u32 }
        }
    }

    impl Isa for Avx512 {
        common!();
        #[inline(always)]
        fn le(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: see `splat`.
            unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b)) }
        }
        #[inline(always)]
        fn not_gt(self, a: __m256, b: __m256) -> u32 {
            // SAFETY: see `splat`.
            unsafe { u32::from(_mm256_cmp_ps_mask::<_CMP_NGT_UQ>(a, b)) }
        }
    }
}

/// Entries that one ray may have waiting: seven a level of both trees, whose depth the builder
/// limits.
pub(super) const STACK: usize = 512;

/// What a ray has still to visit, nearest last.
///
/// The memory is the caller's, so that the length stays in a register.
pub(super) struct Stack<'a> {
    space: &'a mut Space,
    len: usize,
}

/// Memory of a [`Stack`].
pub(super) struct Space {
    refs: [MaybeUninit<u32>; STACK + 8],
    near: [MaybeUninit<u32>; STACK + 8],
}

impl Space {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let empty = [const { MaybeUninit::uninit() }; STACK + 8];
        Self { refs: empty, near: empty }
    }
}

impl<'a> Stack<'a> {
    #[inline(always)]
    pub(super) fn new(space: &'a mut Space) -> Self {
        Self { space, len: 0 }
    }

    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(super) fn push(&mut self, item: u32, near: f32) {
        self.space.refs[self.len] = MaybeUninit::new(item);
        self.space.near[self.len] = MaybeUninit::new(near.to_bits());
        self.len += 1;
    }

    /// Pushes the first `count` of eight lanes.
    #[inline(always)]
    pub(super) fn extend<I: Isa>(&mut self, isa: I, (count, near, refs): (usize, I::F, I::F)) {
        assert!(self.len <= STACK, "the builder limits the depth of trees");
        // SAFETY: there is room for eight beyond `STACK`.
        unsafe {
            isa.write(refs, self.space.refs.as_mut_ptr().add(self.len).cast());
            isa.write(near, self.space.near.as_mut_ptr().add(self.len).cast());
        }
        self.len += count.min(8);
    }

    /// The newest entry above the first `base`.
    #[inline(always)]
    pub(super) fn pop(&mut self, base: usize) -> Option<(u32, f32)> {
        if self.len <= base {
            return None;
        }
        self.len -= 1;
        // SAFETY: every entry below the old `len` was written by `push`, which checks the bound,
        // or by `extend`.
        unsafe {
            Some((
                self.space.refs.get_unchecked(self.len).assume_init(),
                f32::from_bits(self.space.near.get_unchecked(self.len).assume_init()),
            ))
        }
    }
}
