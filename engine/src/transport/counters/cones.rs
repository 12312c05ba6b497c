use std::f64::consts::PI;

use super::{Counter, Event};
use crate::components::Cone;
use crate::extract::Stage;
use crate::film::Sums;

/// Power that leaves through the scene's rectangle at the top within cones of directions, one cell
/// each.
#[derive(Clone, Debug)]
pub struct ConeCounter {
    /// The cones.
    pub cones: Vec<Cone>,
    /// Unit vector along each axis, and the cosine of the half angle.
    axes: Vec<(glam::DVec3, f64)>,
}

impl ConeCounter {
    /// Of these cones.
    #[must_use]
    pub fn new(cones: Vec<Cone>) -> Self {
        let axes =
            cones.iter().map(|cone| (cone.axis.direction(), cone.half_angle.cos())).collect();
        Self { cones, axes }
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

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        if let Event::Escape { ray, order: 1.., weight, .. } = event
            && stage.leaves_through_top(ray.origin, ray.direction)
        {
            for (cell, (axis, cos)) in self.axes.iter().enumerate() {
                if axis.dot(ray.direction) >= *cos {
                    sums.add(cell, weight, 1.0);
                }
            }
        }
        0
    }
}
