use glam::{DVec2, DVec3};

use super::{CountingPlane, View};
pub use crate::document::FisheyeProjection;

/// Projection of the points of an image to rays.
#[derive(Clone, Debug, PartialEq)]
pub enum Optics {
    /// Parallel rays.
    Orthographic(OrthographicOptics),
    /// Rays through one point, straight lines stay straight.
    Perspective(PerspectiveOptics),
    /// Rays through one point, a whole hemisphere or more.
    Fisheye(FisheyeOptics),
}

/// Parallel projection.
#[derive(Clone, Debug, PartialEq)]
pub struct OrthographicOptics {
    /// Part of the scene that the image shows.
    pub footprint: Footprint,
    /// Side of a square pixel, m: the footprint grows to whole pixels around its middle.
    pub pixel: Option<f64>,
    /// Direction towards the sensor.
    pub view: View,
    /// Plane that light must leave through to be seen.
    pub plane: Option<CountingPlane>,
}

/// Part of the scene that a parallel projection shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Footprint {
    /// A rectangle in the plane perpendicular to the view.
    Rectangle {
        /// Its width and height, m.
        extent: DVec2,
        /// The ground point in its middle, m, local frame.
        center: DVec2,
    },
    /// The smallest rectangle around all that stands on the terrain's rectangle.
    WholeScene,
}

/// Perspective projection.
#[derive(Clone, Debug, PartialEq)]
pub struct PerspectiveOptics {
    /// Position and orientation of the camera.
    pub placement: CameraPlacement,
    /// Full angles of view across and down the image, rad, each below π.
    pub field: DVec2,
    /// True if pixels without a hit show the sky; otherwise they hold no data.
    pub sees_sky: bool,
}

/// Fisheye projection: a disc in the middle of the image, as wide as the image's shorter side.
#[derive(Clone, Debug, PartialEq)]
pub struct FisheyeOptics {
    /// Position and orientation of the camera.
    pub placement: CameraPlacement,
    /// Mapping of angles off the axis to distances from the middle.
    pub projection: FisheyeProjection,
    /// Full angle of view, rad: the disc's edge is half of it off the axis.
    pub field: f64,
    /// True if pixels without a hit show the sky; otherwise they hold no data.
    pub sees_sky: bool,
}

/// Position and orientation of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPlacement {
    /// Position, m, local frame.
    pub position: DVec3,
    /// Direction or point in the middle of the image.
    pub look: LookAt,
    /// Direction that is up in the image; it need not be perpendicular to the view.
    pub up: DVec3,
    /// True if the heights of position and target count from the ground below each of them.
    pub above_ground: bool,
}

/// Direction or point in the middle of a camera's image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookAt {
    /// A direction from the camera; a unit vector.
    Direction(DVec3),
    /// A point, m, local frame.
    Target(DVec3),
}

/// Colours of the picture of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PictureColours {
    /// Bands chosen by wavelength, stretched.
    Quicklook,
    /// Given channels.
    Colours {
        /// Sources of red, green and blue.
        channels: Channels,
        /// Stops over the exposure that shows a white surface on the horizontal as white.
        exposure: Option<f64>,
    },
}

/// Sources of the red, green and blue of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// One band each, by its index in the list of bands.
    Bands([usize; 3]),
    /// Colours as the eye sees them, by the CIE observer.
    Cie,
}
