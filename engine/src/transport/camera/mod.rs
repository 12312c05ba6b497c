//! Cameras: points of an image to rays, one file a projection.

mod fisheye;
mod orthographic;
mod perspective;
mod pose;

use glam::{DVec2, UVec2};

use crate::accel::Ray;
use crate::components::{ImageSamples, ImageSensor, Optics};
use crate::extract::Stage;

pub use fisheye::FisheyeCamera;
pub use orthographic::{OrthographicCamera, footprint, view_axes, wanted_footprint};
pub use perspective::PerspectiveCamera;
pub use pose::CameraPose;

/// Map from points of an image to rays.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// Parallel rays.
    Orthographic(OrthographicCamera),
    /// Rays through one point, straight lines stay straight.
    Perspective(PerspectiveCamera),
    /// Rays through one point, a whole hemisphere or more.
    Fisheye(FisheyeCamera),
}

impl Camera {
    /// The camera of an image sensor.
    #[must_use]
    pub fn new(sensor: &ImageSensor, stage: &Stage) -> Self {
        let size = sensor.size;
        match &sensor.optics {
            Optics::Orthographic(optics) => {
                Self::Orthographic(OrthographicCamera::from_sensor(optics, size, stage))
            }
            Optics::Perspective(optics) => {
                Self::Perspective(PerspectiveCamera::new(optics, size, stage))
            }
            Optics::Fisheye(optics) => Self::Fisheye(FisheyeCamera::new(optics, size, stage)),
        }
    }

    /// Columns and rows.
    #[must_use]
    pub const fn size(&self) -> UVec2 {
        match self {
            Self::Orthographic(camera) => camera.size,
            Self::Perspective(camera) => camera.size,
            Self::Fisheye(camera) => camera.size,
        }
    }

    /// The ray through film coordinates, from `(0, 0)` top left to `(1, 1)` bottom right; none where
    /// the film shows nothing.
    #[must_use]
    pub fn ray(&self, at: DVec2) -> Option<Ray> {
        match self {
            Self::Orthographic(camera) => Some(camera.ray(at)),
            Self::Perspective(camera) => Some(camera.ray(at)),
            Self::Fisheye(camera) => camera.ray(at),
        }
    }

    /// Returns whether light that arrives against this ray counts; adds the number of rays that it traced.
    pub fn admits(&self, ray: &Ray, stage: &Stage, rays: &mut u64) -> bool {
        match self {
            Self::Orthographic(camera) => camera.admits(ray, stage, rays),
            Self::Perspective(_) | Self::Fisheye(_) => true,
        }
    }

    /// Returns whether a ray that leaves the scene upwards sees the sky; otherwise it has no data.
    #[must_use]
    pub const fn sees_sky(&self) -> bool {
        match self {
            Self::Orthographic(_) => false,
            Self::Perspective(camera) => camera.sees_sky,
            Self::Fisheye(camera) => camera.sees_sky,
        }
    }

    /// Paths per pixel; for images through one point, per m² counts as per pixel.
    #[must_use]
    pub fn samples(&self, samples: ImageSamples) -> f64 {
        match (samples, self) {
            (ImageSamples::PerPixel(count), _) => count.into(),
            (ImageSamples::PerArea(density), Self::Orthographic(camera)) => {
                density * camera.pixel_area()
            }
            (ImageSamples::PerArea(density), _) => density,
        }
    }
}
