//! What a ray has still to visit.

use std::mem::MaybeUninit;

use super::Isa;

/// Entries that one ray may have waiting: seven a level of both trees, whose depth the builder
/// limits.
pub(in crate::accel) const STACK: usize = 512;

/// What a ray has still to visit, nearest last.
///
/// The memory is the caller's, so that the length stays in a register.
pub(in crate::accel) struct Stack<'a> {
    space: &'a mut Space,
    len: usize,
}

/// Memory of a [`Stack`].
pub(in crate::accel) struct Space {
    refs: [MaybeUninit<u32>; STACK + 8],
    near: [MaybeUninit<u32>; STACK + 8],
}

impl Space {
    #[inline(always)]
    pub(in crate::accel) fn new() -> Self {
        let empty = [const { MaybeUninit::uninit() }; STACK + 8];
        Self { refs: empty, near: empty }
    }
}

impl<'a> Stack<'a> {
    #[inline(always)]
    pub(in crate::accel) fn new(space: &'a mut Space) -> Self {
        Self { space, len: 0 }
    }

    #[inline(always)]
    pub(in crate::accel) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(in crate::accel) fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    pub(in crate::accel) fn push(&mut self, item: u32, near: f32) {
        self.space.refs[self.len] = MaybeUninit::new(item);
        self.space.near[self.len] = MaybeUninit::new(near.to_bits());
        self.len += 1;
    }

    /// Pushes the first `count` of eight lanes.
    #[inline(always)]
    pub(in crate::accel) fn extend<I: Isa>(
        &mut self,
        isa: I,
        (count, near, refs): (usize, I::F, I::F),
    ) {
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
    pub(in crate::accel) fn pop(&mut self, base: usize) -> Option<(u32, f32)> {
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
