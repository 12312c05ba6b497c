use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;
use crate::transport::Hemisphere;

/// Power that leaves through the scene's rectangle at the top, by cells of the hemisphere.
#[derive(Clone, Debug)]
pub struct CellCounter(pub Hemisphere);

impl Counter for CellCounter {
    fn cells(&self) -> usize {
        self.0.len()
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Escape { ray, order: 1.., weight, .. } = event
            && stage.leaves_through_top(ray.origin, ray.direction)
        {
            sums.add(self.0.index(ray.direction), weight, 1.0);
        }
        0
    }
}
