use glam::{DVec2, DVec3, UVec2};

use super::{Optics, Picture};

/// Something that measures light.
#[derive(Clone, Debug, PartialEq)]
pub enum Sensor {
    /// An image.
    Image(ImageSensor),
    /// The whole scene seen from given directions.
    Directions(Directions),
    /// Fates of photons from sun and sky.
    Photons(Photons),
}

impl Sensor {
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

/// A transport system: how a product is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum System {
    /// Paths from the sensor, next-event estimation to the sun.
    Backward,
    /// Photon packets from sun and sky, or from what emits.
    Forward,
    /// Photons of one band each, absorbed or scattered as a whole.
    Analog,
    /// Light that was scattered once, integrated.
    FirstOrder,
    /// Naive path tracer, one plain loop: slow, for comparison.
    Reference,
}

/// A direction towards a sensor, as its angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the vertical, rad.
    pub zenith: f64,
    /// Azimuth of the sensor, clockwise from north, rad.
    pub azimuth: f64,
}

impl View {
    /// Unit vector from the scene towards the sensor.
    #[must_use]
    pub fn direction(self) -> DVec3 {
        let (sin_zenith, cos_zenith) = self.zenith.sin_cos();
        let (sin_azimuth, cos_azimuth) = self.azimuth.sin_cos();
        DVec3::new(sin_zenith * sin_azimuth, sin_zenith * cos_azimuth, cos_zenith)
    }
}

/// Quantity of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageMeasure {
    /// Radiance, W m⁻² sr⁻¹ nm⁻¹.
    Radiance,
    /// Bidirectional reflectance factor `π L / E`; the HDRF under a sky.
    Brf,
    /// The BRF split by order of scattering: uncollided, single, multiple.
    Orders,
    /// Temperature of the black body of this radiance, K, in bands that hold emission.
    BrightnessTemperature,
    /// Fractions of sunlit and shaded ground and canopy.
    FourComponents,
    /// Fraction of the ground, or of the sky in a camera that looks up.
    GapFraction,
}

impl ImageMeasure {
    /// Returns whether it is made of light, and not of the first surface along each ray.
    #[must_use]
    pub const fn is_light(self) -> bool {
        matches!(self, Self::Radiance | Self::Brf | Self::Orders | Self::BrightnessTemperature)
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
    /// Colours of its picture.
    pub picture: Picture,
    /// Transport system that estimates it; photon packets support only parallel projections.
    pub system: System,
}

/// Criterion that ends a measurement.
#[derive(Clone, Debug, PartialEq)]
pub enum StopCriterion {
    /// The median relative standard error of each product is at most this.
    RelError(f64),
    /// The median relative standard error of each of these products is at most this.
    RelErrors(Vec<(String, f64)>),
    /// This much time has passed, s.
    Seconds(f64),
    /// This many samples a pixel, samples a direction or photon packets were drawn.
    Samples(u64),
}

/// Reflectance factors of the scene towards given directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Directions towards the sensors.
    pub views: Vec<View>,
    /// The first that holds ends the measurement.
    pub until: Vec<StopCriterion>,
    /// Quantities to report.
    pub measure: Vec<ImageMeasure>,
    /// Plane that light must leave through to count.
    pub plane: Option<VirtualPlane>,
    /// Transport system that estimates it; if absent, the one that takes fewer rays.
    pub system: Option<System>,
}

/// Quantity that photons are counted for.
#[derive(Clone, Debug, PartialEq)]
pub enum PhotonMeasure {
    /// BRF in this many equal-area cells of the hemisphere.
    BrfCells(u32),
    /// BRF towards these directions, by virtual photons.
    BrfViews(Vec<View>),
    /// Reflected over incident flux.
    Albedo,
    /// Radiance in this many equal-area cells of the hemisphere.
    RadianceCells(u32),
    /// Radiance towards these directions, by virtual photons.
    RadianceViews(Vec<View>),
    /// Radiance within cones of directions.
    RadianceCones(Vec<Cone>),
    /// Flux density that leaves upwards.
    Exitance,
    /// Temperature of the black body of each radiance that is measured.
    BrightnessTemperature,
    /// BRF within cones of directions.
    BrfCones(Vec<Cone>),
    /// Splits the other measures of reflected light by order of scattering.
    Orders,
    /// Fractions of the incident flux that each material absorbs in each horizontal layer, and that reach the ground.
    Fapar(Layers),
    /// Power that each instance absorbs, or each of its triangles and discs too.
    Absorbed(Per),
    /// Down- and upwelling flux density on the terrain and through horizontal planes.
    Fluxes {
        /// Side of a square pixel, m.
        pixel: f64,
        /// Heights of the planes, m, local frame.
        heights: Vec<f64>,
    },
}

impl PhotonMeasure {
    /// Returns whether it is in absolute units and includes emitted light.
    #[must_use]
    pub const fn is_absolute(&self) -> bool {
        match self {
            Self::RadianceCells(_)
            | Self::RadianceViews(_)
            | Self::RadianceCones(_)
            | Self::Exitance
            | Self::Fluxes { .. } => true,
            Self::BrfCells(_)
            | Self::BrfViews(_)
            | Self::BrfCones(_)
            | Self::Albedo
            | Self::BrightnessTemperature
            | Self::Orders
            | Self::Absorbed(_)
            | Self::Fapar(_) => false,
        }
    }
}

/// Photon packets from sun and sky, and from what emits.
#[derive(Clone, Debug, PartialEq)]
pub struct Photons {
    /// Packets a square metre of the terrain's rectangle; of emitted light, lines along which some start.
    pub per_area: f64,
    /// The first that holds ends the measurement; without any, `per_area` does.
    pub until: Vec<StopCriterion>,
    /// Quantities to report.
    pub measure: Vec<PhotonMeasure>,
    /// Plane that light must leave through, or lie below, to count.
    pub plane: Option<VirtualPlane>,
    /// Transport system: packets or photons.
    pub system: System,
}

/// A horizontal rectangle through which light is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualPlane {
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

/// Resolution of absorbed power; the finer one includes the coarser one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Per {
    /// Each instance, the terrain as the first.
    Instance,
    /// Each triangle and disc of each instance.
    Triangle,
}

/// Horizontal layers.
#[derive(Clone, Debug, PartialEq)]
pub enum Layers {
    /// From the ground to the top of the scene, of this thickness, m.
    Thickness(f64),
    /// Between these heights, m, upwards; two at least.
    Borders(Vec<f64>),
}
