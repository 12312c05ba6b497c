//! Partition of a measurement among several runs.

/// One of several disjoint parts of a measurement: those of its units (randomisations, or tiles of an image)
/// whose number modulo `count` is `index`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    /// Its number, from 0.
    pub index: u32,
    /// Number of partitions.
    pub count: u32,
}

impl Partition {
    /// The whole measurement.
    pub const ALL: Self = Self { index: 0, count: 1 };

    /// Returns whether a unit belongs to it.
    #[must_use]
    pub const fn owns(self, unit: usize) -> bool {
        unit % self.count as usize == self.index as usize
    }
}
