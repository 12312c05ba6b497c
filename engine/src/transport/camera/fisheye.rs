use glam::{DVec2, UVec2};

use super::pose::CameraPose;
use crate::accel::Ray;
use crate::components::{self, FisheyeProjection};
use crate::extract::Stage;

/// A fisheye camera: a disc in the middle of the image, as wide as the image's shorter side.
#[derive(Clone, Debug, PartialEq)]
pub struct FisheyeCamera {
    /// Columns and rows.
    pub size: UVec2,
    /// True if it sees the sky.
    pub sees_sky: bool,
    pose: CameraPose,
    projection: FisheyeProjection,
    /// Half the angle of view, rad.
    edge: f64,
    /// Film coordinates to units of the disc's radius.
    scale: DVec2,
}

impl FisheyeCamera {
    /// The camera in a scene.
    #[must_use]
    pub fn new(camera: &components::FisheyeOptics, size: UVec2, stage: &Stage) -> Self {
        let pixels = size.as_dvec2();
        Self {
            size,
            sees_sky: camera.sees_sky,
            pose: CameraPose::new(&camera.placement, |at| stage.ground_at(at)),
            projection: camera.projection,
            edge: 0.5 * camera.field,
            scale: 2.0 * pixels / pixels.min_element(),
        }
    }

    /// 1 if it looks straight up, -1 if it looks straight down.
    #[must_use]
    pub fn upright(&self) -> Option<f64> {
        let up = self.pose.ahead.z;
        (up.abs() > 1.0 - 1e-9).then(|| up.signum())
    }

    /// The ray through film coordinates, from `(0, 0)` top left to `(1, 1)` bottom right; none
    /// beside the disc.
    #[must_use]
    pub fn ray(&self, at: DVec2) -> Option<Ray> {
        let on_disc = (at - 0.5) * self.scale;
        let distance = on_disc.length();
        if distance > 1.0 {
            return None;
        }
        let (sin, cos) = off_axis(self.projection, distance, self.edge).sin_cos();
        let CameraPose { eye, right, down, ahead } = self.pose;
        // In the very middle every way outwards is as good as another.
        let outwards = if distance > 0.0 { on_disc / distance } else { DVec2::X };
        let through = ahead * cos + (right * outwards.x + down * outwards.y) * sin;
        Some(Ray { origin: eye, direction: through / through.length(), from: None })
    }
}

/// Angle off the axis, rad, of a point at `distance` from the middle in units of the disc's radius,
/// where the disc's edge shows the angle `edge`.
///
/// Source: Schneider, Schwalbe and Maas (2009), ISPRS J. Photogramm. 64, 259-266, eqs. 1 to 4.
fn off_axis(mapping: FisheyeProjection, distance: f64, edge: f64) -> f64 {
    match mapping {
        FisheyeProjection::Equisolid => 2.0 * (distance * (0.5 * edge).sin()).min(1.0).asin(),
        FisheyeProjection::Equidistant => distance * edge,
        FisheyeProjection::Orthographic => (distance * edge.sin()).min(1.0).asin(),
        FisheyeProjection::Stereographic => 2.0 * (distance * (0.5 * edge).tan()).atan(),
    }
}

#[cfg(test)]
mod tests {
    use super::{FisheyeProjection, off_axis};

    #[test]
    fn the_edge_of_the_disc_shows_half_the_field() {
        for mapping in [
            FisheyeProjection::Equisolid,
            FisheyeProjection::Equidistant,
            FisheyeProjection::Orthographic,
            FisheyeProjection::Stereographic,
        ] {
            for degrees in [1.0_f64, 60.0, 89.0] {
                let edge = degrees.to_radians();
                let found = off_axis(mapping, 1.0, edge);
                assert!((found - edge).abs() < 1e-12, "{mapping:?}, {degrees}: {found}");
                assert!(off_axis(mapping, 0.0, edge).abs() < 1e-15, "{mapping:?}");
            }
        }
    }
}
