use super::{Counter, Event, Share, Tally};
use crate::extract::Stage;
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

    fn count<'a>(&self, _: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64 {
        if let Event::Escape { ray, order: 1.., .. } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            tally.add(self.hemisphere.index(ray.direction), Share::Whole, 1.0);
        }
        0
    }
}
