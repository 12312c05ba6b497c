use super::{Counter, Event, Recorder, Visited, WeightFactor};
use crate::extract::Stage;
use crate::transport::{Hemisphere, ReferencePlane};

/// Power that leaves through the reference plane, by cells of the hemisphere.
#[derive(Clone, Debug)]
pub struct CellCounter {
    /// The cells.
    pub hemisphere: Hemisphere,
    /// Plane through which light leaves.
    pub plane: ReferencePlane,
}

impl Counter for CellCounter {
    fn cells(&self) -> usize {
        self.hemisphere.len()
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        if let Event::Escape { ray, visited: Visited { order: 1.., .. } } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            recorder.add(self.hemisphere.index(ray.direction), WeightFactor::One, 1.0);
        }
    }
}
