use glam::{DVec2, DVec3};

use super::{View, VirtualPlane};

/// Projection of the points of an image to rays.
#[derive(Clone, Debug, PartialEq)]
pub enum Optics {
    /// Parallel rays.
    Orthographic(Orthographic),
    /// Rays through one point, straight lines stay straight.
    Perspective(Perspective),
    /// Rays through one point, a whole hemisphere or more.
    Fisheye(Fisheye),
}

/// Parallel projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Orthographic {
    /// Part of the scene that the image shows.
    pub footprint: Footprint,
    /// Side of a square pixel, m: the footprint grows to whole pixels around its middle.
    pub pixel: Option<f64>,
    /// Direction towards the sensor.
    pub view: View,
    /// Plane that light must leave through to be seen.
    pub plane: Option<VirtualPlane>,
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
    /// The least rectangle around all that stands on the terrain's rectangle.
    WholeScene,
}

/// Perspective projection.
#[derive(Clone, Debug, PartialEq)]
pub struct Perspective {
    /// Position and orientation of the camera.
    pub stand: Stand,
    /// Full angles of view across and down the image, rad, each below π.
    pub field: DVec2,
    /// True if pixels without a hit show the sky; otherwise they hold no data.
    pub sees_sky: bool,
}

/// Fisheye projection: a disc in the middle of the image, as wide as the image's shorter side.
#[derive(Clone, Debug, PartialEq)]
pub struct Fisheye {
    /// Position and orientation of the camera.
    pub stand: Stand,
    /// Mapping of angles to distances from the middle.
    pub mapping: Mapping,
    /// Full angle of view, rad: what the disc's edge shows is half of it off the axis.
    pub field: f64,
    /// True if pixels without a hit show the sky; otherwise they hold no data.
    pub sees_sky: bool,
}

/// Distance from the middle of a fisheye image over an angle θ off the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mapping {
    /// Proportional to `sin(θ/2)`: equal solid angles are equal areas.
    Equisolid,
    /// Proportional to `θ`.
    Equidistant,
    /// Proportional to `sin θ`: equal irradiance on a plane is equal area.
    Orthographic,
    /// Proportional to `tan(θ/2)`: circles stay circles.
    Stereographic,
}

/// Position and orientation of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// Position, m, local frame.
    pub position: DVec3,
    /// Direction or point in the middle of the image.
    pub look: Look,
    /// Direction that is up in the image; it need not be perpendicular to the view.
    pub up: DVec3,
    /// True if the heights of position and target count from the ground below each of them.
    pub above_ground: bool,
}

/// Direction or point in the middle of a camera's image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// A direction from the camera; a unit vector.
    Direction(DVec3),
    /// A point, m, local frame.
    Target(DVec3),
}

/// Colours of the picture of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Picture {
    /// By wavelength, stretched.
    Quicklook,
    /// By colours of its own.
    Colours {
        /// What red, green and blue are.
        channels: Channels,
        /// Stops over the exposure that shows a white surface on the horizontal as white.
        exposure: Option<f64>,
    },
}

/// What red, green and blue of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// One band each, by its place in the list of bands.
    Bands([usize; 3]),
    /// What a person would see.
    Cie,
}
