use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;
use crate::transport::{Hemisphere, ReferencePlane};

/// Power that leaves through the reference plane, by cells of the hemisphere.
#[derive(Clone, Debug)]
pub struct CellCounter {
    /// The cells.
    pub hemisphere: Hemisphere,
    /// Where light leaves.
    pub plane: ReferencePlane,
}

impl Counter for CellCounter {
    fn cells(&self) -> usize {
        self.hemisphere.len()
    }

    fn count(&self, _: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Escape { ray, order: 1.., weight, .. } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            sums.add(self.hemisphere.index(ray.direction), weight, 1.0);
        }
        0
    }
}
