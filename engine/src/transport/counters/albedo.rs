use super::{Counter, Event, Share, Tally};
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// Albedo: power that leaves through the reference plane over the power that falls on it (LESS manual
/// eq. 6). One cell.
#[derive(Clone, Debug)]
pub struct AlbedoCounter {
    /// Where light leaves.
    pub plane: ReferencePlane,
}

impl Counter for AlbedoCounter {
    fn cells(&self) -> usize {
        1
    }

    fn count<'a>(&self, _: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64 {
        if let Event::Escape { ray, order: 1.., .. } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            tally.add(0, Share::Whole, 1.0);
        }
        0
    }
}
