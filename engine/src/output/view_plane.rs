//! Vertical planes of views, and their place relative to the sun.

/// Tolerance of azimuths of one plane, degrees.
const ALONG_DEG: f64 = 1e-3;

/// A vertical plane through the nadir, relative to the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ViewPlane {
    /// It holds the sun. Views on the side of the sun have positive zenith angles.
    Principal,
    /// It is perpendicular to the principal plane. Views at 90° clockwise of the sun have positive zenith angles.
    Cross,
    /// Any other plane, and all planes where the position of the sun is unknown.
    Other {
        /// Azimuth of the plane, from 0 up to but without 180, degrees.
        azimuth_deg: f64,
    },
}

impl ViewPlane {
    /// Returns the plane of the views at an azimuth and opposite of it.
    ///
    /// - `sun_azimuth_deg`: azimuth of the sun, degrees, if it is known
    #[must_use]
    pub fn new(azimuth_deg: f64, sun_azimuth_deg: Option<f64>) -> Self {
        let turn = sun_azimuth_deg.map(|sun| (azimuth_deg - sun).rem_euclid(180.0));
        let is_near = |to: f64| {
            let off = |turn: f64| (turn - to).abs();
            turn.is_some_and(|turn| off(turn).min(180.0 - off(turn)) < ALONG_DEG)
        };
        if is_near(0.0) {
            Self::Principal
        } else if is_near(90.0) {
            Self::Cross
        } else {
            Self::Other { azimuth_deg: azimuth_deg.rem_euclid(180.0) }
        }
    }

    /// Title of the axis of signed zenith angles.
    #[must_use]
    pub const fn axis_title(self) -> &'static str {
        match self {
            Self::Principal => "view zenith (°): − forward, + backward scattering",
            Self::Cross => "view zenith (°), + clockwise of the sun",
            Self::Other { .. } => "view zenith (°), + towards the sun",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_known_by_their_turn_from_the_sun() {
        let of = |azimuth, sun| ViewPlane::new(azimuth, Some(sun));
        for (azimuth, sun) in [(10.0, 190.0), (190.0, 10.0), (359.999_999_9, 0.0), (0.0, 180.0)] {
            assert_eq!(of(azimuth, sun), ViewPlane::Principal, "{azimuth} {sun}");
            assert_eq!(of(azimuth + 90.0, sun), ViewPlane::Cross, "{azimuth} {sun}");
        }
        assert_eq!(of(200.0, 10.0 + 30.0), ViewPlane::Other { azimuth_deg: 20.0 });
        assert_eq!(ViewPlane::new(10.0, None), ViewPlane::Other { azimuth_deg: 10.0 });
    }
}
