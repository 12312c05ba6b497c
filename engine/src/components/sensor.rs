use glam::{DVec2, DVec3, UVec2};

use super::{Optics, Picture};

/// Something that measures light.
#[derive(Clone, Debug, PartialEq)]
pub enum Sensor {
    /// An image.
    Image(ImageSensor),
    /// The whole scene seen from given directions.
    Directions(Directions),
    /// What becomes of photons sent from sun and sky.
    Photons(Photons),
}

impl Sensor {
    /// What ends its measurement.
    #[must_use]
    pub fn until(&self) -> &[Stop] {
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
    /// The same as photons of one band, absorbed or scattered as a whole.
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
    /// Where the sensor is, clockwise from north, rad.
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

/// What an image holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageMeasure {
    /// Radiance, W m⁻² sr⁻¹ nm⁻¹.
    Radiance,
    /// Bidirectional reflectance factor `π L / E`; the HDRF under a sky.
    Brf,
    /// The same split by order of scattering: uncollided, single, multiple.
    Orders,
    /// Temperature of the black body of this radiance, K, in bands that hold emission.
    BrightnessTemperature,
    /// Shares of sunlit and shaded ground and canopy.
    FourComponents,
    /// Share of the ground, or of the sky in a camera that looks up.
    GapFraction,
}

impl ImageMeasure {
    /// Whether it is made of light, and not of what is seen first.
    #[must_use]
    pub const fn is_light(self) -> bool {
        matches!(self, Self::Radiance | Self::Brf | Self::Orders | Self::BrightnessTemperature)
    }
}

/// How many paths an image is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageSamples {
    /// So many a pixel.
    PerPixel(u32),
    /// So many a square metre of a parallel projection's footprint, perpendicular to the view.
    PerArea(f64),
}

/// An image of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageSensor {
    /// Columns and rows; where the projection has a pixel size, they follow from the stage.
    pub size: UVec2,
    /// How its points become rays.
    pub optics: Optics,
    /// Paths traced for it, unless `until` says more.
    pub samples: ImageSamples,
    /// The first that holds ends the measurement; without any, `samples` do.
    pub until: Vec<Stop>,
    /// What to report.
    pub measure: Vec<ImageMeasure>,
    /// How its picture is coloured.
    pub picture: Picture,
    /// Which transport system estimates it; photon packets draw parallel projections alone.
    pub system: System,
}

/// When a measurement is good enough.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// The median relative standard error of each product is at most this.
    RelError(f64),
    /// That of each of these products is at most this.
    RelErrors(Vec<(String, f64)>),
    /// This much time has passed, s.
    Seconds(f64),
    /// This many samples a pixel, samples a direction or photon packets were drawn.
    Samples(u64),
}

/// Reflectance factors of the scene towards given directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Directions {
    /// Where the sensors are.
    pub views: Vec<View>,
    /// The first that holds ends the measurement.
    pub until: Vec<Stop>,
    /// What to report.
    pub measure: Vec<ImageMeasure>,
    /// Only light that leaves through it counts.
    pub plane: Option<VirtualPlane>,
    /// Which transport system estimates it; none if the one that takes fewer rays is to.
    pub system: Option<System>,
}

/// What photons are counted for.
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
    /// Splits what the sensor says of reflected light by order of scattering.
    Orders,
    /// Fraction of the incident flux that each material absorbs in each horizontal layer, and what
    /// reaches the ground.
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
    /// Whether it holds light in absolute units, of whatever sources the bands name.
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
    pub until: Vec<Stop>,
    /// What to report.
    pub measure: Vec<PhotonMeasure>,
    /// Only what leaves through it, or lies below it, counts.
    pub plane: Option<VirtualPlane>,
    /// What they are followed as: packets or photons.
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

/// What absorbed power is told of, the finer with the coarser.
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
