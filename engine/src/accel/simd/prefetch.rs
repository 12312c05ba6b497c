//! Memory that is asked for before it is read.

/// Number of cache lines of a planar block, the largest that a ray reads in one step.
#[cfg(target_arch = "x86_64")]
const LINES: usize = 6;

/// Asks the processor to fetch the [`LINES`] cache lines from an address on. It may be any address.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(in crate::accel) fn prefetch(address: *const u8) {
    use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

    for line in 0..LINES {
        // SAFETY: all processors of this kind have the instruction, which reads nothing and never faults.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64 * line).cast()) };
    }
}

#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub(in crate::accel) fn prefetch(_: *const u8) {}
