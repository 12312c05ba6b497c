use glam::{DVec2, DVec3, UVec2};

use super::{Optics, PictureColours};
// Enumerations that the author writes and that mean the same to every later stage.
pub use crate::document::{ImageMeasure, Layers, Per, PhotonMeasure, StopCriterion, System};

/// A sensor whose angles, defaults and names are resolved.
#[derive(Clone, Debug, PartialEq)]
pub enum ResolvedSensor {
    /// An image.
    Image(ImageSensor),
    /// The whole scene seen from given directions.
    Directions(DirectionSensor),
    /// Photon packets of sun, sky and emission.
    Photons(PhotonSensor),
}

impl ResolvedSensor {
    /// Criteria that end its measurement.
    #[must_use]
    pub fn until(&self) -> &[StopCriterion] {
        match self {
            Self::Image(sensor) => &sensor.until,
            Self::Directions(sensor) => &sensor.until,
            Self::Photons(sensor) => &sensor.until,
        }
    }
}

/// A direction towards a sensor, as its angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Zenith angle, rad.
    pub zenith: f64,
    /// Azimuth of the sensor, clockwise from north, rad.
    pub azimuth: f64,
}

impl View {
    /// The direction with these angles, degrees.
    #[must_use]
    pub const fn from_degrees(zenith: f64, azimuth: f64) -> Self {
        Self { zenith: zenith.to_radians(), azimuth: azimuth.to_radians() }
    }

    /// Unit vector from the scene towards the sensor.
    #[must_use]
    pub fn direction(self) -> DVec3 {
        let (sin_zenith, cos_zenith) = self.zenith.sin_cos();
        let (sin_azimuth, cos_azimuth) = self.azimuth.sin_cos();
        DVec3::new(sin_zenith * sin_azimuth, sin_zenith * cos_azimuth, cos_zenith)
    }
}

/// Number of paths of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageSamples {
    /// Paths per pixel.
    PerPixel(u32),
    /// Paths per square metre of the footprint of a parallel projection, measured perpendicular to the view direction.
    PerArea(f64),
}

/// An image of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageSensor {
    /// Columns and rows; if the projection has a pixel size, they follow from the stage.
    pub size: UVec2,
    /// Projection of its points to rays.
    pub optics: Optics,
    /// Paths traced for it without `until`.
    pub samples: ImageSamples,
    /// The first that holds ends the measurement; without any, `samples` do.
    pub until: Vec<StopCriterion>,
    /// Quantities to report.
    pub measure: Vec<ImageMeasure>,
    /// True if each image of light has a denoised one beside it.
    pub is_denoised: bool,
    /// Colours of its picture.
    pub picture: PictureColours,
    /// Transport system that estimates it; photon packets support only parallel projections.
    pub system: System,
}

/// Reflectance factors of the scene towards given directions.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectionSensor {
    /// Directions towards the sensors.
    pub views: Vec<View>,
    /// The first that holds ends the measurement.
    pub until: Vec<StopCriterion>,
    /// Quantities to report.
    pub measure: Vec<ImageMeasure>,
    /// Plane that light must leave through to count.
    pub plane: Option<CountingPlane>,
    /// Transport system that estimates it; if absent, the one that takes fewer rays.
    pub system: Option<System>,
}

/// A measure of a photon sensor, with the directions that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonProduct {
    /// Quantity that photons are counted for.
    pub measure: PhotonMeasure,
    /// Directions of `BrfViews` and `RadianceViews`; empty for other measures.
    pub views: Vec<View>,
}

/// Photon packets from sun and sky, and from what emits.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotonSensor {
    /// Packets per m² of the terrain's rectangle; for emitted light, lines along which packets start.
    pub per_area: f64,
    /// The first that holds ends the measurement; without any, `per_area` does.
    pub until: Vec<StopCriterion>,
    /// Quantities to report.
    pub products: Vec<PhotonProduct>,
    /// Plane that light must leave through, or lie below, to count.
    pub plane: Option<CountingPlane>,
    /// Transport system: packets or photons.
    pub system: System,
}

/// A horizontal rectangle through which light is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CountingPlane {
    /// Its middle, m, local frame.
    pub center: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
    /// Height, m; that of the highest point of the scene if absent.
    pub height: Option<f64>,
}

/// A cone of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Its middle.
    pub axis: View,
    /// Between its middle and its border, rad.
    pub half_angle: f64,
}

impl Cone {
    /// The cone around a direction with a full opening angle, degrees.
    #[must_use]
    pub const fn from_degrees(zenith: f64, azimuth: f64, opening: f64) -> Self {
        Self { axis: View::from_degrees(zenith, azimuth), half_angle: 0.5 * opening.to_radians() }
    }
}
