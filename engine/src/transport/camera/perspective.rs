use glam::{DVec2, UVec2};

use super::pose::CameraPose;
use crate::accel::Ray;
use crate::components;
use crate::extract::Stage;

/// A perspective camera: equal steps on the film are equal steps of the tangent.
#[derive(Clone, Debug, PartialEq)]
pub struct PerspectiveCamera {
    /// Columns and rows.
    pub size: UVec2,
    /// True if it sees the sky.
    pub sees_sky: bool,
    pose: CameraPose,
    /// Tangents of half the fields of view.
    reach: DVec2,
}

impl PerspectiveCamera {
    /// The camera in a scene.
    #[must_use]
    pub fn new(camera: &components::PerspectiveOptics, size: UVec2, stage: &Stage) -> Self {
        let half = 0.5 * camera.field;
        Self {
            size,
            sees_sky: camera.sees_sky,
            pose: CameraPose::new(&camera.placement, |at| stage.ground_at(at)),
            reach: DVec2::new(half.x.tan(), half.y.tan()),
        }
    }

    /// The ray through film coordinates, from `(0, 0)` top left to `(1, 1)` bottom right.
    #[must_use]
    pub fn ray(&self, at: DVec2) -> Ray {
        let CameraPose { eye, right, down, ahead } = self.pose;
        let tangent = (2.0 * at - 1.0) * self.reach;
        let through = ahead + right * tangent.x + down * tangent.y;
        Ray { origin: eye, direction: through / through.length(), from: None }
    }
}
