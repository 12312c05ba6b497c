//! Cameras in the scene or beside it.

use super::ImageOptions;

record! {
    /// Image of a camera; straight lines stay straight.
    pub struct Perspective ("a perspective image") {
        /// Columns and rows.
        size_px: (u32, u32) => "(256, 192)",
        /// Position of the camera, m.
        position_m: (f64, f64, f64) => "(0.0, -50.0, 30.0)",
        /// Point in the middle of the image, m.
        target_m: (f64, f64, f64) => "(50.0, 50.0, 5.0)",
        /// Direction that is up in the image; it need not be perpendicular to the view.
        up: (f64, f64, f64) = (0.0, 0.0, 1.0),
        /// Full angles of view across and down the image, degrees, each its own.
        fov_deg: (f64, f64) => "(40.0, 30.0)",
        /// True if heights of position and target count from the ground below each.
        above_ground: bool = false,
        /// True if pixels without a hit show the sky; otherwise they hold no
        /// data.
        sees_sky: bool = false,
        /// Samples per pixel.
        samples_per_px: u32 = 64,
        /// Keys of all images.
        image as keys: ImageOptions = ImageOptions::default(),
    }
}

record! {
    /// Image of a camera that sees a hemisphere or more.
    pub struct Fisheye ("a fisheye image") {
        /// Columns and rows.
        size_px: (u32, u32) => "(256, 256)",
        /// Position of the camera, m.
        position_m: (f64, f64, f64) => "(50.0, 50.0, 1.5)",
        /// Direction or point in the middle of the image.
        look: Look = Look::Up,
        /// Direction that is up in the image; north if it looks `Up` or `Down`, the vertical if not.
        up: Option<(f64, f64, f64)> = None,
        /// Full angle of view, degrees: the disc's edge shows half of it off the axis.
        fov_deg: f64 = 180.0,
        /// Mapping of angles off the axis to distances from the middle.
        projection: FisheyeProjection = FisheyeProjection::Equisolid,
        /// True if heights of position and target count from the ground below each.
        above_ground: bool = false,
        /// True if pixels without a hit show the sky; otherwise they hold no
        /// data.
        sees_sky: bool = true,
        /// Samples per pixel.
        samples_per_px: u32 = 64,
        /// Keys of all images.
        image as keys: ImageOptions = ImageOptions::default(),
    }
}

choice! {
    /// Direction or point that a fisheye camera looks at.
    pub enum Look ("where a camera looks") {
        /// Straight up; north is at the top of the image and east on its left, as in a photograph.
        Up,
        /// Straight down; north is at the top of the image.
        Down,
        /// A direction.
        Towards {
            /// Angle of the view from the upward vertical, degrees: 90 is the horizon.
            zenith_deg: f64 => "90.0",
            /// Azimuth of the direction, clockwise from north, degrees.
            azimuth_deg: f64 = 0.0,
        },
        /// A point.
        Target {
            /// The point, m.
            at_m: (f64, f64, f64) => "(0.0, 0.0, 0.0)",
        },
    }
}

choice! {
    /// Mapping of an angle θ off the axis to the distance from the middle of a fisheye image.
    #[derive(Copy, Eq)]
    pub enum FisheyeProjection ("a fisheye projection") {
        /// Proportional to sin(θ/2): equal areas of the image are equal solid angles.
        Equisolid,
        /// Proportional to θ.
        Equidistant,
        /// Proportional to sin θ: equal areas of the image are equal fractions of the irradiance.
        Orthographic,
        /// Proportional to tan(θ/2): circles stay circles.
        Stereographic,
    }
}
