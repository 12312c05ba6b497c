//! Sensors and their transport systems.

mod camera;
mod directions;
mod image;
mod photons;
mod system;

pub use camera::{Fisheye, FisheyeProjection, Look, Perspective};
pub use directions::{Directions, Views, VirtualPlane};
pub use image::{Cover, ImageMeasure, ImageOptions, Orthographic, Picture};
pub use photons::{Layers, Per, PhotonMeasure, Photons};
pub use system::System;

use super::until::{Ends, StopCriterion};
use super::{Band, Scene};

choice! {
    /// A sensor.
    pub enum Sensor ("a sensor") {
        /// Parallel-projection image.
        Orthographic(..Orthographic),
        /// Image of a camera in the scene or beside it, straight lines stay straight.
        Perspective(..Perspective),
        /// Image of a camera that sees a hemisphere or more of its surroundings, as a disc as wide
        /// as the image's shorter side; no data beside it. Of the sun it sees what it lights, not
        /// the disc.
        Fisheye(..Fisheye),
        /// The scene seen from many directions: the mean over all lines through the rectangle of its
        /// ground. `scenes/ISOLATED.md` says what that is where the scene ends.
        Directions(..Directions),
        /// Photon packets from sun and sky, and from what surfaces and `thermal_sky` emit.
        Photons(..Photons),
    }
}

impl Sensor {
    /// Options of an image; `None` for directions and photons.
    #[must_use]
    pub const fn image_options(&self) -> Option<&ImageOptions> {
        match self {
            Self::Orthographic(sensor) => Some(&sensor.image),
            Self::Perspective(sensor) => Some(&sensor.image),
            Self::Fisheye(sensor) => Some(&sensor.image),
            Self::Directions(_) | Self::Photons(_) => None,
        }
    }

    /// Quantities that an image or a list of directions reports; `None` for photons.
    #[must_use]
    pub fn image_measures(&self) -> Option<&[ImageMeasure]> {
        match self {
            Self::Directions(sensor) => Some(&sensor.measure),
            Self::Orthographic(_) | Self::Perspective(_) | Self::Fisheye(_) => {
                self.image_options().map(|image| image.measure.as_slice())
            }
            Self::Photons(_) => None,
        }
    }

    /// Returns whether any quantity that it reports meets the condition for its kind.
    pub fn any_measure(
        &self,
        of_image: impl Fn(&ImageMeasure) -> bool,
        of_photons: impl Fn(&PhotonMeasure) -> bool,
    ) -> bool {
        match self {
            Self::Photons(sensor) => sensor.measure.iter().any(of_photons),
            Self::Orthographic(_)
            | Self::Perspective(_)
            | Self::Fisheye(_)
            | Self::Directions(_) => self.image_measures().into_iter().flatten().any(of_image),
        }
    }

    /// Virtual plane through which light counts, if there is one.
    #[must_use]
    pub const fn virtual_plane(&self) -> Option<&VirtualPlane> {
        match self {
            Self::Orthographic(sensor) => sensor.virtual_plane.as_ref(),
            Self::Directions(sensor) => sensor.virtual_plane.as_ref(),
            Self::Photons(sensor) => sensor.virtual_plane.as_ref(),
            Self::Perspective(_) | Self::Fisheye(_) => None,
        }
    }

    /// Transport systems that can measure it, or some of what it is to report.
    #[must_use]
    pub const fn systems(&self) -> &'static [System] {
        match self {
            Self::Orthographic(_) | Self::Directions(_) => {
                &[System::Backward, System::Forward, System::FirstOrder, System::Reference]
            }
            Self::Perspective(_) | Self::Fisheye(_) => {
                &[System::Backward, System::FirstOrder, System::Reference]
            }
            Self::Photons(_) => &[System::Forward, System::Analog],
        }
    }

    /// The transport system that it asks for.
    #[must_use]
    pub fn system(&self) -> Option<System> {
        match self {
            Self::Directions(sensor) => sensor.system,
            Self::Photons(sensor) => Some(sensor.system),
            Self::Orthographic(_) | Self::Perspective(_) | Self::Fisheye(_) => {
                self.image_options().map(|image| image.system)
            }
        }
    }

    /// Returns whether light is traced on its way from the sun, and not against it from the sensor alone.
    #[must_use]
    pub fn is_traced_from_sun(&self) -> bool {
        match (self, self.system()) {
            (_, Some(system)) => matches!(system, System::Forward | System::Analog),
            (
                Self::Directions(Directions { views: Views::List(views), virtual_plane, .. }),
                None,
            ) => virtual_plane.is_none() && views.len() > 1,
            (_, None) => true,
        }
    }

    /// Returns whether its directions depend on the sun's azimuth.
    #[must_use]
    pub fn follows_sun(&self) -> bool {
        let follows = |views: &Views| !matches!(views, Views::List(_));
        match self {
            Self::Directions(sensor) => follows(&sensor.views),
            Self::Photons(sensor) => sensor.measure.iter().any(|measure| match measure {
                PhotonMeasure::BrfViews(views) | PhotonMeasure::RadianceViews(views) => {
                    follows(views)
                }
                _ => false,
            }),
            Self::Orthographic(_) | Self::Perspective(_) | Self::Fisheye(_) => false,
        }
    }

    /// The sensor with the quantities that a transport system can measure in a scene; `None` if there are none.
    /// The largest limit of single products holds for all that are left if it drops some. Images are not denoised.
    #[must_use]
    pub fn measured_by(&self, by: System, scene: &Scene) -> Option<Self> {
        let mut sensor = self.clone();
        let measures = self.measures();
        match &mut sensor {
            Self::Orthographic(Orthographic { image, .. })
            | Self::Perspective(Perspective { image, .. })
            | Self::Fisheye(Fisheye { image, .. }) => {
                image.measure.retain(|measure| measure.is_measured_by(by, scene));
                image.denoised = false;
                image.system = by;
            }
            Self::Photons(Photons { measure, system, .. }) => {
                measure.retain(|measure| measure.is_measured_by(by));
                if !measure.iter().any(PhotonMeasure::is_radiance) {
                    measure.retain(|measure| *measure != PhotonMeasure::BrightnessTemperature);
                }
                *system = by;
            }
            Self::Directions(Directions { measure, system, .. }) => {
                measure.retain(|measure| measure.is_measured_by(by, scene));
                *system = Some(by);
            }
        }
        if sensor.measures() == 0 {
            return None;
        }
        if sensor.measures() < measures {
            sensor.loosen();
        }
        self.systems().contains(&by).then_some(sensor)
    }

    /// Number of its measures.
    fn measures(&self) -> usize {
        match self {
            Self::Photons(sensor) => sensor.measure.len(),
            Self::Orthographic(_)
            | Self::Perspective(_)
            | Self::Fisheye(_)
            | Self::Directions(_) => self.image_measures().map_or(0, <[ImageMeasure]>::len),
        }
    }

    /// Puts a limit for all products in the place of limits by name.
    fn loosen(&mut self) {
        let ends = match self {
            Self::Directions(sensor) => Some(&mut sensor.until),
            Self::Photons(Photons { until, .. })
            | Self::Orthographic(Orthographic { image: ImageOptions { until, .. }, .. })
            | Self::Perspective(Perspective { image: ImageOptions { until, .. }, .. })
            | Self::Fisheye(Fisheye { image: ImageOptions { until, .. }, .. }) => until.as_mut(),
        };
        for end in ends.into_iter().flat_map(|ends| &mut ends.0) {
            if let StopCriterion::RelErrors(limits) = end {
                *end = StopCriterion::RelError(limits.values().copied().fold(0.0, f64::max));
            }
        }
    }

    /// Ends of its measurement, if any are written.
    #[must_use]
    pub fn ends(&self) -> Option<&Ends> {
        match self {
            Self::Directions(sensor) => Some(&sensor.until),
            Self::Photons(sensor) => sensor.until.as_ref(),
            Self::Orthographic(_) | Self::Perspective(_) | Self::Fisheye(_) => {
                self.image_options().and_then(|image| image.until.as_ref())
            }
        }
    }

    /// Criteria that end its measurement, if any are written.
    #[must_use]
    pub fn until(&self) -> &[StopCriterion] {
        self.ends().map_or(&[], |ends| &ends.0)
    }
}
