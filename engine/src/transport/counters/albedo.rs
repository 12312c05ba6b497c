use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;

/// Albedo: power that leaves through the scene's rectangle at the top over the power that falls on
/// it (LESS manual eq. 6). One cell.
#[derive(Clone, Copy, Debug)]
pub struct AlbedoCounter;

impl Counter for AlbedoCounter {
    fn cells(&self) -> usize {
        1
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Escape { ray, order: 1.., weight, .. } = event
            && stage.leaves_through_top(ray.origin, ray.direction)
        {
            sums.add(0, weight, 1.0);
        }
        0
    }
}
