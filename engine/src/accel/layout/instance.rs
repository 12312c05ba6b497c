use glam::DVec3;

/// Row of the table of instances: an instance, or a periodic copy of one.
///
/// The map is rounded to `f32` once, when the hierarchy is built, and then exact by definition: rays,
/// points, normals and boxes all follow from it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(in crate::accel) struct InstanceRecord {
    /// Linear part, in columns.
    pub object_from_world: [f32; 9],
    pub mesh: u32,
    pub translation: DVec3,
}

/// Copies of instances that cross the sides of a periodic tile; their records follow those of the instances.
#[derive(Debug, Default)]
pub(in crate::accel) struct PeriodicCopies {
    /// Number of instances.
    pub instances: u32,
    /// Instance of each copy, and number of periods from the instance to the copy.
    pub originals: Vec<(u32, [i32; 2])>,
}

impl PeriodicCopies {
    /// Number of copies.
    pub(in crate::accel) fn count(&self) -> usize {
        self.originals.len()
    }

    /// Memory of the table, bytes.
    pub(in crate::accel) fn bytes(&self) -> usize {
        size_of_val(&*self.originals)
    }

    /// Returns the instance that a record is or copies, and the number of periods from the instance to it.
    #[inline(always)]
    pub(in crate::accel) fn original(&self, record: u32) -> (u32, [i32; 2]) {
        match record.checked_sub(self.instances) {
            Some(copy) => self.originals.get(copy as usize).copied().unwrap_or((record, [0, 0])),
            None => (record, [0, 0]),
        }
    }
}
