//! The scene seen from many directions.

use super::{Ends, ImageMeasure, StopCriterion, System};

record! {
    /// Mean radiance or reflectance of the scene towards each of many directions.
    pub struct Directions ("directions") {
        /// Directions towards the sensors.
        views: Views => "PrincipalPlane",
        /// Criteria that end the measurement.
        until: Ends = Ends::from(StopCriterion::RelError(0.005)),
        /// Quantities to report.
        measure: Vec<ImageMeasure> = vec![ImageMeasure::Brf],
        /// Only light that leaves through it counts; it is what is seen.
        virtual_plane: Option<VirtualPlane> = None,
        /// Transport system that estimates it; if absent the one that takes fewer rays: photon packets
        /// for what a whole scene reflects in several directions, paths from the sensor for the rest.
        system: Option<System> = None,
    }
}

record! {
    /// A horizontal rectangle through which light leaves the scene.
    pub struct VirtualPlane ("a virtual plane") {
        /// Its middle, m; that of the terrain if absent.
        center_m: Option<(f64, f64)> = None,
        /// Extent to the east and to the north, m; that of the terrain if absent.
        size_m: Option<(f64, f64)> = None,
        /// Height, m; that of the highest point of the scene if absent.
        height_m: Option<f64> = None,
    }
}

choice! {
    /// Directions towards sensors.
    pub enum Views ("views") {
        /// Directions in the sun's vertical plane; positive angles are on the sun's side.
        PrincipalPlane {
            /// Largest zenith angle, degrees.
            max_deg: f64 = 75.0,
            /// Step, degrees.
            step_deg: f64 = 5.0,
        },
        /// Directions in the plane perpendicular to it; positive angles are 90° clockwise of the sun.
        CrossPlane {
            /// Largest zenith angle, degrees.
            max_deg: f64 = 75.0,
            /// Step, degrees.
            step_deg: f64 = 5.0,
        },
        /// Pairs (zenith, azimuth), degrees.
        List(Vec<(f64, f64)> => "[(30.0, 90.0), (60.0, 90.0)]"),
    }
}
