use glam::{DVec2, DVec3};

use crate::components::{CameraPlacement, LookAt};

/// A camera's position and axes: right and down in the image, and ahead; unit vectors,
/// perpendicular to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// Position, m.
    pub eye: DVec3,
    /// To the right in the image.
    pub right: DVec3,
    /// Downwards in the image.
    pub down: DVec3,
    /// Through the middle of the image.
    pub ahead: DVec3,
}

impl CameraPose {
    /// The pose in a scene whose ground has the height `ground_at` of a horizontal position: heights of camera and target
    /// may be above the ground below them.
    #[must_use]
    pub fn new(placement: &CameraPlacement, ground_at: impl Fn(DVec2) -> f64) -> Self {
        let place = |point: DVec3| {
            let ground = if placement.above_ground { ground_at(point.truncate()) } else { 0.0 };
            point + DVec3::Z * ground
        };
        let eye = place(placement.position);
        let ahead = match placement.look {
            LookAt::Direction(direction) => direction,
            LookAt::Target(target) => (place(target) - eye).try_normalize().unwrap_or(DVec3::NEG_Z),
        };
        // `document::check` refuses an up along the view; uneven ground can still turn the view into it.
        let across = |up: DVec3| ahead.cross(up).try_normalize();
        let right = across(placement.up).or_else(|| across(DVec3::Z)).or_else(|| across(DVec3::Y));
        let right = right.unwrap_or(DVec3::X);
        Self { eye, right, down: ahead.cross(right), ahead }
    }
}
