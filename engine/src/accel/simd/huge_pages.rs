//! Large vectors on huge pages.

use std::mem::MaybeUninit;

/// Minimum size of a vector on huge pages, bytes: the size of a usual second-level cache.
const MIN_BYTES: usize = 1 << 20;

/// Empty vector with memory for `capacity` elements; if it is large and the system has huge pages, it lies on them, so
/// that rays miss the translation cache less often.
pub(in crate::accel) fn with_huge_pages<T>(capacity: usize) -> Vec<T> {
    let mut vector = Vec::with_capacity(capacity);
    if size_of::<T>() * capacity >= MIN_BYTES {
        advise_huge_pages(vector.spare_capacity_mut());
    }
    vector
}

#[cfg(target_os = "linux")]
fn advise_huge_pages<T>(memory: &mut [MaybeUninit<T>]) {
    use rustix::{
        mm::{Advice, madvise},
        param::page_size,
    };
    let range = memory.as_mut_ptr_range();
    let start = range.start.addr().next_multiple_of(page_size());
    let end = range.end.addr() / page_size() * page_size();
    if start < end {
        let pages = range.start.with_addr(start).cast();
        // SAFETY: the pages belong to the vector alone, and this advice changes no content. Without huge pages it
        // fails, and nothing else happens.
        let _is_advised = unsafe { madvise(pages, end - start, Advice::LinuxHugepage) }.is_ok();
    }
}

#[cfg(not(target_os = "linux"))]
fn advise_huge_pages<T>(_: &mut [MaybeUninit<T>]) {}
