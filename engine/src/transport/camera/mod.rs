//! Cameras: points of an image to rays, one file a projection.

mod fisheye;
mod orthographic;
mod perspective;
mod stand;

use glam::{DVec2, UVec2};

use crate::accel::Ray;
use crate::components::{ImageSamples, ImageSensor, Optics};
use crate::extract::Stage;

pub use fisheye::Fisheye;
pub use orthographic::{Projection, footprint, wanted_footprint};
pub use perspective::Perspective;

/// What turns points of an image into rays.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// Parallel rays.
    Orthographic(Projection),
    /// Rays through one point, straight lines stay straight.
    Perspective(Perspective),
    /// Rays through one point, a whole hemisphere or more.
    Fisheye(Fisheye),
}

impl Camera {
    /// The camera of an image sensor.
    #[must_use]
    pub fn of(sensor: &ImageSensor, stage: &Stage) -> Self {
        let size = sensor.size;
        match &sensor.optics {
            Optics::Orthographic(optics) => {
                Self::Orthographic(Projection::of_image(optics, size, stage))
            }
            Optics::Perspective(optics) => Self::Perspective(Perspective::new(optics, size, stage)),
            Optics::Fisheye(optics) => Self::Fisheye(Fisheye::new(optics, size, stage)),
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

    /// Whether light that arrives against this ray counts; adds to the number of rays that this took.
    pub fn admits(&self, ray: &Ray, stage: &Stage, rays: &mut u64) -> bool {
        match self {
            Self::Orthographic(camera) => camera.admits(ray, stage, rays),
            Self::Perspective(_) | Self::Fisheye(_) => true,
        }
    }

    /// Whether a ray that leaves the scene upwards sees the sky; otherwise it has no data.
    #[must_use]
    pub const fn sees_sky(&self) -> bool {
        match self {
            Self::Orthographic(_) => false,
            Self::Perspective(camera) => camera.sees_sky,
            Self::Fisheye(camera) => camera.sees_sky,
        }
    }

    /// Paths a pixel; of images through one point, a square metre is taken for a pixel.
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
