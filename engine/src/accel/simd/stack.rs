//! Stack of nodes and leaves that a ray has still to visit.

use std::mem::MaybeUninit;

use super::{HitChildren, Isa};

/// Maximum number of entries of one ray: seven per level of both hierarchies, whose depth the build limits.
const STACK: usize = 512;

/// Nodes and leaves that a ray has still to visit, with the distances of their boxes, nearest last.
///
/// The memory is borrowed, so that the length stays in a register.
pub(in crate::accel) struct Stack<'a> {
    memory: &'a mut StackMemory,
    len: usize,
}

/// Memory of a [`Stack`].
pub(in crate::accel) struct StackMemory {
    refs: [MaybeUninit<u32>; STACK + 8],
    near: [MaybeUninit<u32>; STACK + 8],
}

impl StackMemory {
    #[inline(always)]
    pub(in crate::accel) fn new() -> Self {
        let empty = [const { MaybeUninit::uninit() }; STACK + 8];
        Self { refs: empty, near: empty }
    }
}

impl<'a> Stack<'a> {
    #[inline(always)]
    pub(in crate::accel) fn new(memory: &'a mut StackMemory) -> Self {
        Self { memory, len: 0 }
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
        self.memory.refs[self.len] = MaybeUninit::new(item);
        self.memory.near[self.len] = MaybeUninit::new(near.to_bits());
        self.len += 1;
    }

    /// Returns the newest entry, whichever hierarchy it belongs to.
    #[inline(always)]
    pub(in crate::accel) fn newest(&self) -> Option<u32> {
        let newest = self.len.checked_sub(1)?;
        // SAFETY: see `pop`.
        Some(unsafe { self.memory.refs.get_unchecked(newest).assume_init() })
    }

    /// Pushes the children that a ray hits.
    #[inline(always)]
    pub(in crate::accel) fn extend<I: Isa>(
        &mut self,
        isa: I,
        HitChildren { count, near, children }: HitChildren<I::F>,
    ) {
        assert!(self.len <= STACK, "the build limits the depth of hierarchies");
        // SAFETY: there is room for eight beyond `STACK`.
        unsafe {
            isa.write(children, self.memory.refs.as_mut_ptr().add(self.len).cast());
            isa.write(near, self.memory.near.as_mut_ptr().add(self.len).cast());
        }
        self.len += count.min(8);
    }

    /// Removes and returns the newest entry above the first `base`.
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
                self.memory.refs.get_unchecked(self.len).assume_init(),
                f32::from_bits(self.memory.near.get_unchecked(self.len).assume_init()),
            ))
        }
    }
}
