use super::{Counter, Event, Recorder, Visited, WeightFactor};
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// Albedo: power that leaves through the reference plane over the power that falls on it (LESS manual
/// eq. 6). One cell.
#[derive(Clone, Debug)]
pub struct AlbedoCounter {
    /// Plane through which light leaves.
    pub plane: ReferencePlane,
}

impl Counter for AlbedoCounter {
    fn cells(&self) -> usize {
        1
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        if let Event::Escape { ray, visited: Visited { order: 1.., .. } } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            recorder.add(0, WeightFactor::One, 1.0);
        }
    }
}
