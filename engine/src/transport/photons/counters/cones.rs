use std::f64::consts::PI;

use super::{Counter, Event, Recorder, Visited, WeightFactor};
use crate::components::Cone;
use crate::extract::Stage;
use crate::transport::ReferencePlane;

/// Power that leaves through the reference plane within cones of directions, one cell each.
#[derive(Clone, Debug)]
pub struct ConeCounter {
    /// The cones.
    pub cones: Vec<Cone>,
    /// Plane through which light leaves.
    pub plane: ReferencePlane,
    /// Unit vector along each axis, and the cosine of the half angle.
    axes: Vec<(glam::DVec3, f64)>,
}

impl ConeCounter {
    /// A counter of these cones.
    #[must_use]
    pub fn new(cones: Vec<Cone>, plane: ReferencePlane) -> Self {
        let axes =
            cones.iter().map(|cone| (cone.axis.direction(), cone.half_angle.cos())).collect();
        Self { cones, plane, axes }
    }

    /// `∫ cos θ dω` over a cone, sr: exact where it lies above the horizon.
    #[must_use]
    pub fn projected_solid_angle(cone: &Cone) -> f64 {
        PI * cone.half_angle.sin().powi(2) * cone.axis.zenith.cos()
    }
}

impl Counter for ConeCounter {
    fn cells(&self) -> usize {
        self.axes.len()
    }

    fn count(&self, _: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        if let Event::Escape { ray, visited: Visited { order: 1.., .. } } = event
            && self.plane.is_left_by(ray.origin, ray.direction)
        {
            for (cell, (axis, cos)) in self.axes.iter().enumerate() {
                if axis.dot(ray.direction) >= *cos {
                    recorder.add(cell, WeightFactor::One, 1.0);
                }
            }
        }
    }
}
