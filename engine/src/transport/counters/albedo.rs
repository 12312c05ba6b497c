use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;
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

    fn count(&self, _: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Escape { ray, order: 1.., weight, .. } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            sums.add(0, weight, 1.0);
        }
        0
    }
}
