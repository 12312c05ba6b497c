//! AVX2 and AVX-512 on eight lanes, and the functions that are compiled for them.

#[allow(clippy::wildcard_imports, reason = "a list of intrinsics says nothing")]
use std::arch::x86_64::*;

use super::{HitChildren, Isa, Kernel, Lanes, Words};

/// Proof that the processor has AVX2 and FMA: constructed only inside its wrapper.
#[derive(Clone, Copy)]
pub(super) struct Avx2(());

/// Proof that the processor has AVX-512 F and VL too: constructed only inside its wrapper.
#[derive(Clone, Copy)]
pub(super) struct Avx512(());

#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn run_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(Avx2(()))
}

#[target_feature(enable = "avx512f,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub(super) fn run_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run(Avx512(()))
}

/// Methods that are the same for both instruction sets.
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
        fn xor_sign(self, a: __m256, sign: __m256) -> __m256 {
            // SAFETY: see `splat`.
            unsafe { _mm256_xor_ps(a, _mm256_and_ps(sign, _mm256_set1_ps(-0.0))) }
        }
        #[inline(always)]
        fn select(self, a: __m256, b: __m256, by: __m256) -> __m256 {
            // SAFETY: see `splat`.
            unsafe { _mm256_blendv_ps(a, b, by) }
        }
        #[inline(always)]
        unsafe fn write(self, value: __m256, to: *mut u32) {
            // SAFETY: the caller's.
            unsafe { _mm256_storeu_ps(to.cast(), value) };
        }
        #[inline(always)]
        fn compress_hits(
            self,
            order: u32,
            enter: __m256,
            leave: __m256,
            child: &Words,
        ) -> HitChildren<__m256> {
            // SAFETY: see `splat`; `Words` is 32 bytes at a 32-byte boundary.
            unsafe {
                let shifts = _mm256_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21);
                // Permutations use only the lowest three bits of each lane.
                let lanes = _mm256_srlv_epi32(_mm256_set1_epi32(order as i32), shifts);
                let hit = self.le(
                    _mm256_permutevar8x32_ps(enter, lanes),
                    _mm256_permutevar8x32_ps(leave, lanes),
                );
                let lanes = Self::compress(hit, lanes);
                let children = _mm256_load_ps(child.0.as_ptr().cast());
                HitChildren {
                    count: hit.count_ones() as usize,
                    near: _mm256_permutevar8x32_ps(enter, lanes),
                    children: _mm256_permutevar8x32_ps(children, lanes),
                }
            }
        }
    };
}

impl Avx2 {
    /// Lanes of a mask, moved to the front.
    ///
    /// # Safety
    /// A value of this type must exist.
    #[inline(always)]
    unsafe fn compress(mask: u32, value: __m256i) -> __m256i {
        // SAFETY: the caller's value proves the features.
        unsafe {
            // Each bit of the mask becomes a byte, and selects the byte that holds the number of its lane.
            let bytes = _pdep_u64(mask.into(), 0x0101_0101_0101_0101) * 0xFF;
            let lanes = _pext_u64(0x0706_0504_0302_0100, bytes);
            let lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(lanes as i64));
            _mm256_permutevar8x32_epi32(value, lanes)
        }
    }
}

impl Avx512 {
    /// Lanes of a mask, moved to the front.
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
