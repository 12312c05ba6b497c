use glam::{DMat3, DVec3};

use super::{PrototypeId, SceneId};

/// Where an instance of a mesh prototype stands; small, because a scene has up to 10⁷ of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Position of the prototype's origin, m, local frame.
    pub position: DVec3,
    /// Right-handed turn about the vertical (counter-clockwise seen from above), rad.
    pub yaw: f32,
    /// Lean from the vertical, rad, applied after the turn.
    pub tilt: f32,
    /// Azimuth towards which it leans, clockwise from north, rad.
    pub tilt_azimuth: f32,
    /// Horizontal scale of the prototype, before it turns.
    pub scale_horizontal: f32,
    /// Vertical scale of the prototype.
    pub scale_vertical: f32,
    /// What stands here.
    pub prototype: PrototypeId,
    /// Document order over all instances.
    pub id: SceneId,
}

impl Placement {
    /// Factor by which the scales enlarge areas. It is exact if both are equal; leaves of all directions grow by
    /// nearly this factor if they differ.
    #[must_use]
    pub fn area_factor(&self) -> f64 {
        let (across, up) = (f64::from(self.scale_horizontal), f64::from(self.scale_vertical));
        (across * across * up).abs().powf(2.0 / 3.0)
    }

    /// Linear part of `world_from_object`: scale, then turn, then lean.
    #[must_use]
    pub fn world_from_object(&self) -> DMat3 {
        let scale = DVec3::new(
            self.scale_horizontal.into(),
            self.scale_horizontal.into(),
            self.scale_vertical.into(),
        );
        let turn = DMat3::from_rotation_z(self.yaw.into());
        let upright = turn * DMat3::from_diagonal(scale);
        if self.tilt == 0.0 {
            return upright;
        }
        // Leaning towards azimuth a turns about the horizontal axis 90° counter-clockwise of it.
        let (sin, cos) = f64::from(self.tilt_azimuth).sin_cos();
        DMat3::from_axis_angle(DVec3::new(-cos, sin, 0.0), self.tilt.into()) * upright
    }
}

#[cfg(test)]
mod tests {
    use super::{PrototypeId, SceneId, *};

    fn placement() -> Placement {
        Placement {
            position: DVec3::ZERO,
            yaw: 0.0,
            tilt: 0.0,
            tilt_azimuth: 0.0,
            scale_horizontal: 1.0,
            scale_vertical: 1.0,
            prototype: PrototypeId(0),
            id: SceneId(0),
        }
    }

    #[test]
    fn a_lean_of_30_degrees_to_the_east_moves_the_top_east() {
        let tilt = 30_f32.to_radians();
        let lean = Placement { tilt, tilt_azimuth: 90_f32.to_radians(), ..placement() };
        let top = lean.world_from_object() * DVec3::Z;
        assert!((top - DVec3::new(0.5, 0.0, 0.75_f64.sqrt())).length() < 1e-6, "{top}");
    }

    #[test]
    fn a_yaw_of_90_degrees_turns_east_to_north() {
        let turned = Placement { yaw: 90_f32.to_radians(), scale_horizontal: 2.0, ..placement() };
        let east = turned.world_from_object() * DVec3::X;
        assert!((east - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-6, "{east}");
    }
}
