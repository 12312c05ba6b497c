use super::{Counter, Event, Recorder, WeightFactor};
use crate::components::Per;
use crate::extract::{Inventory, Stage};
use crate::transport::ReferencePlane;

/// Power that each instance absorbs below the reference plane, and each of its triangles and discs.
///
/// Cells: the instances; then the sum of all; then, of triangles, those of one instance after the
/// other.
#[derive(Clone, Debug)]
pub struct AbsorbedCounter {
    /// Plane below which absorption counts.
    pub plane: ReferencePlane,
    /// Number of instances.
    pub instances: usize,
    /// First of the triangles of each instance among all, then their number; empty if they are not
    /// counted.
    starts: Vec<usize>,
}

impl AbsorbedCounter {
    /// A counter of the instances of a stage.
    #[must_use]
    pub fn new(inventory: &Inventory, per: Per, plane: ReferencePlane) -> Self {
        let starts = if per == Per::Triangle { inventory.starts() } else { Vec::new() };
        Self { plane, instances: inventory.instances.len(), starts }
    }

    /// Returns whether triangles and discs are counted.
    #[must_use]
    pub const fn has_faces(&self) -> bool {
        !self.starts.is_empty()
    }

    /// Cell of the sum over all; those of the triangles follow.
    #[must_use]
    pub const fn total(&self) -> usize {
        self.instances
    }
}

impl Counter for AbsorbedCounter {
    fn cells(&self) -> usize {
        self.total() + 1 + self.starts.last().copied().unwrap_or(0)
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        let Event::Arrival { hit, scattered, .. } = event else { return };
        if !self.plane.is_above(hit.point) {
            return;
        }
        let instance = hit.instance as usize;
        let start = self.starts.get(instance);
        let face = start.map(|start| self.total() + 1 + start + hit.primitive as usize);
        for cell in [Some(instance), Some(self.total()), face].into_iter().flatten() {
            recorder.add(cell, WeightFactor::Complement(*scattered), 1.0);
        }
    }
}
