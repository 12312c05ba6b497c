//! What measures the light, and how it is traced.

use std::borrow::Cow;

use super::super::decode::{Decode, Fields, Reader, Variant, example_of_keys};
use super::super::describe::Book;
use super::super::encode::{Encode, Text, differs};
use super::super::numbers::Walk;
use super::super::syntax::{Node, Value};
use super::camera::{Cover, FisheyeProjection, Look, Picture};
use super::until::{Ends, Until};
use super::{Band, Scene};

choice! {
    /// A sensor.
    pub enum Sensor ("a sensor") {
        /// Parallel-projection image.
        Orthographic {
            /// Columns and rows; either this or `pixel_m` is required.
            size_px: Option<(u32, u32)> => "(256, 256)" = None,
            /// Side of a square pixel in the plane perpendicular to the view, m, in place of `size_px`. A
            /// footprint that is no whole number of pixels grows around its middle to the next one.
            pixel_m: Option<f64> = None,
            /// Width and height of the footprint in the plane perpendicular to the view, m.
            extent_m: Option<(f64, f64)> = None,
            /// `WholeScene`, in place of `extent_m` and `center_m`.
            cover: Option<Cover> = None,
            /// Point on the ground in the middle of the image, m; the terrain's middle if absent.
            center_m: Option<(f64, f64)> = None,
            /// Zenith angle of the sensor, degrees.
            zenith_deg: f64 = 0.0,
            /// Where the sensor is, clockwise from north, degrees. A nadir image has north up at 180.
            azimuth_deg: f64 = 180.0,
            /// Samples per pixel; 64 if neither this nor `samples_per_m2` is written.
            samples_per_px: Option<u32> = None,
            /// Samples per m² of the footprint, in place of `samples_per_px`.
            samples_per_m2: Option<f64> = None,
            /// When it is good enough; the number of samples then is no limit.
            until: Option<Ends> = None,
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Brf],
            /// How its PNG is coloured.
            picture: Picture = Picture::Quicklook,
            /// Only light that leaves through it is seen.
            virtual_plane: Option<VirtualPlane> = None,
            /// Which transport system estimates it.
            system: System = System::Backward,
        },
        /// Image of a camera in the scene or beside it, straight lines stay straight.
        Perspective {
            /// Columns and rows.
            size_px: (u32, u32) => "(256, 192)",
            /// Where the camera is, m.
            position_m: (f64, f64, f64) => "(0.0, -50.0, 30.0)",
            /// What lies in the middle of the image, m.
            target_m: (f64, f64, f64) => "(50.0, 50.0, 5.0)",
            /// What is up in the image; it need not be perpendicular to the view.
            up: (f64, f64, f64) = (0.0, 0.0, 1.0),
            /// Full angles of view across and down the image, degrees, each its own.
            fov_deg: (f64, f64) => "(40.0, 30.0)",
            /// Whether heights of position and target are above the ground below each.
            above_ground: bool = false,
            /// Whether the camera sees the sky where nothing stands before it; otherwise there is no
            /// data.
            sees_sky: bool = false,
            /// Samples per pixel.
            samples_per_px: u32 = 64,
            /// When it is good enough; `samples_per_px` then is no limit.
            until: Option<Ends> = None,
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Radiance],
            /// How its PNG is coloured.
            picture: Picture = Picture::Quicklook,
            /// Which transport system estimates it.
            system: System = System::Backward,
        },
        /// Image of a camera that sees a hemisphere or more of its surroundings, as a disc as wide
        /// as the image's shorter side; no data beside it. Of the sun it sees what it lights, not
        /// the disc.
        Fisheye {
            /// Columns and rows.
            size_px: (u32, u32) => "(256, 256)",
            /// Where the camera is, m.
            position_m: (f64, f64, f64) => "(50.0, 50.0, 1.5)",
            /// What lies in the middle of the image.
            look: Look = Look::Up,
            /// What is up in the image; north if it looks `Up` or `Down`, the vertical if not.
            up: Option<(f64, f64, f64)> = None,
            /// Full angle of view, degrees: the disc's edge shows half of it off the axis.
            fov_deg: f64 = 180.0,
            /// How angles off the axis become distances from the middle.
            projection: FisheyeProjection = FisheyeProjection::Equisolid,
            /// Whether heights of position and target are above the ground below each.
            above_ground: bool = false,
            /// Whether the camera sees the sky where nothing stands before it; otherwise there is no
            /// data.
            sees_sky: bool = true,
            /// Samples per pixel.
            samples_per_px: u32 = 64,
            /// When it is good enough; `samples_per_px` then is no limit.
            until: Option<Ends> = None,
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Radiance],
            /// How its PNG is coloured.
            picture: Picture = Picture::Quicklook,
            /// Which transport system estimates it.
            system: System = System::Backward,
        },
        /// The scene seen from many directions: the mean over all lines through the rectangle of its
        /// ground. `scenes/ISOLATED.md` says what that is where the scene ends.
        Directions {
            /// Where the sensors are.
            views: Views => "PrincipalPlane",
            /// When it is good enough.
            until: Ends = Ends::from(Until::RelError(0.005)),
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Brf],
            /// Only light that leaves through it counts; it is what is seen.
            virtual_plane: Option<VirtualPlane> = None,
            /// Which transport system estimates it; if absent the one that takes fewer rays: photon packets
            /// for what a whole scene reflects in several directions, paths from the sensor for the rest.
            system: Option<System> = None,
        },
        /// Photon packets from sun and sky, and from what surfaces and `thermal_sky` emit.
        Photons {
            /// Packets per m² of the terrain's rectangle; of emitted light, lines through the
            /// scene along each of which several start.
            per_m2: f64 = 1000.0,
            /// When it is good enough; `per_m2` then is no limit.
            until: Option<Ends> = None,
            /// What to count them for.
            measure: Vec<PhotonMeasure> = vec![PhotonMeasure::Albedo],
            /// Only light that leaves through it counts as reflected, and only what lies below it
            /// absorbs; all is normalised to its area.
            virtual_plane: Option<VirtualPlane> = None,
            /// Whether packets are followed (`Forward`) or photons (`Analog`).
            system: System = System::Forward,
        },
    }
}

impl Sensor {
    /// What an image or a list of directions is to report; `None` for photons.
    #[must_use]
    pub fn image_measures(&self) -> Option<&[ImageMeasure]> {
        match self {
            Self::Orthographic { measure, .. }
            | Self::Perspective { measure, .. }
            | Self::Fisheye { measure, .. }
            | Self::Directions { measure, .. } => Some(measure),
            Self::Photons { .. } => None,
        }
    }

    /// Transport systems that can measure it, or some of what it is to report.
    #[must_use]
    pub const fn systems(&self) -> &'static [System] {
        match self {
            Self::Orthographic { .. } | Self::Directions { .. } => {
                &[System::Backward, System::Forward, System::FirstOrder, System::Reference]
            }
            Self::Perspective { .. } | Self::Fisheye { .. } => {
                &[System::Backward, System::FirstOrder, System::Reference]
            }
            Self::Photons { .. } => &[System::Forward, System::Analog],
        }
    }

    /// The transport system that it asks for.
    #[must_use]
    pub const fn system(&self) -> Option<System> {
        match *self {
            Self::Orthographic { system, .. }
            | Self::Perspective { system, .. }
            | Self::Fisheye { system, .. }
            | Self::Photons { system, .. } => Some(system),
            Self::Directions { system, .. } => system,
        }
    }

    /// The same sensor, and of what it is to report in a scene as much as a system can measure; `None`
    /// if that is nothing. Where that is not all, the loosest of limits to the errors of single products
    /// holds for every one that is left.
    #[must_use]
    pub fn measured_by(&self, by: System, scene: &Scene) -> Option<Self> {
        let mut sensor = self.clone();
        let measures = self.measures();
        match &mut sensor {
            Self::Orthographic { measure, system, .. }
            | Self::Perspective { measure, system, .. }
            | Self::Fisheye { measure, system, .. } => {
                measure.retain(|one| one.is_measured_by(by, scene));
                *system = by;
            }
            Self::Photons { measure, system, .. } => {
                measure.retain(|one| one.is_measured_by(by));
                if !measure.iter().any(PhotonMeasure::is_radiance) {
                    measure.retain(|one| *one != PhotonMeasure::BrightnessTemperature);
                }
                *system = by;
            }
            Self::Directions { measure, system, .. } => {
                measure.retain(|one| one.is_measured_by(by, scene));
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

    /// How many measures it has.
    fn measures(&self) -> usize {
        match self {
            Self::Photons { measure, .. } => measure.len(),
            _ => self.image_measures().map_or(0, <[ImageMeasure]>::len),
        }
    }

    /// Puts a limit for all products in the place of limits by name.
    fn loosen(&mut self) {
        let ends = match self {
            Self::Directions { until, .. } => Some(until),
            Self::Orthographic { until, .. }
            | Self::Perspective { until, .. }
            | Self::Fisheye { until, .. }
            | Self::Photons { until, .. } => until.as_mut(),
        };
        for end in ends.into_iter().flat_map(|ends| &mut ends.0) {
            if let Until::RelErrors(limits) = end {
                *end = Until::RelError(limits.values().copied().fold(0.0, f64::max));
            }
        }
    }

    /// When it is good enough, if that is written.
    #[must_use]
    pub fn until(&self) -> &[Until] {
        let ends = match self {
            Self::Directions { until, .. } => Some(until),
            Self::Orthographic { until, .. }
            | Self::Perspective { until, .. }
            | Self::Fisheye { until, .. }
            | Self::Photons { until, .. } => until.as_ref(),
        };
        ends.map_or(&[], |ends| &ends.0)
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
        /// In the sun's vertical plane; positive angles are on the sun's side.
        PrincipalPlane {
            /// Largest zenith angle, degrees.
            max_deg: f64 = 75.0,
            /// Step, degrees.
            step_deg: f64 = 5.0,
        },
        /// In the plane perpendicular to it; positive angles are 90° clockwise of the sun.
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

choice! {
    /// What an image holds.
    pub enum ImageMeasure ("a measure of an image") {
        /// Radiance, W m⁻² sr⁻¹ nm⁻¹, from the sources that the band names.
        Radiance,
        /// Bidirectional reflectance factor; under a sky it is the HDRF and is named so.
        Brf,
        /// The same, split as RAMI does: `brf_uc` (scattered once, by the ground), `brf_co_sgl`
        /// (once, by anything else) and `brf_mlt` (more often).
        Orders,
        /// Temperature of the black body of this radiance, K, in bands that hold emission.
        BrightnessTemperature,
        /// Shares of sunlit ground, sunlit canopy, shaded ground and shaded canopy in what is seen;
        /// of an image the dominant one too. Sunlit is where the sun is visible from the side that
        /// is seen, so a leaf that is lit from above is shaded from below; temperatures of `SunlitShaded`
        /// count both sides of it as sunlit. Ground is the terrain.
        FourComponents,
        /// Share of the ground in what is seen, or of the sky in a camera that looks up; of directions,
        /// and of a fisheye that looks straight up or down, the leaf area index that it implies too.
        GapFraction,
    }
}

impl ImageMeasure {
    /// Returns whether a transport system estimates it in a scene. `FirstOrder` and `Reference` measure reflected
    /// light, `FirstOrder` that of all orders only where no more than one counts; the surface that is seen first is
    /// measured backwards.
    #[must_use]
    pub fn is_measured_by(&self, system: System, scene: &Scene) -> bool {
        let has_all_orders = system != System::FirstOrder || scene.transport.most_orders() == 1;
        let has_emission = !matches!(system, System::FirstOrder | System::Reference);
        match self {
            Self::Orders => system != System::Reference,
            Self::Brf => has_all_orders,
            Self::Radiance => {
                has_all_orders && (has_emission || !scene.bands.iter().any(Band::emits))
            }
            Self::BrightnessTemperature => has_emission,
            Self::FourComponents | Self::GapFraction => system == System::Backward,
        }
    }
}

choice! {
    /// What photons are counted for.
    pub enum PhotonMeasure ("a measure of photons") {
        /// BRF in this number of equal-area cells of the hemisphere.
        BrfCells(u32 => "150"),
        /// BRF towards directions, by virtual photons.
        BrfViews(Views => "PrincipalPlane"),
        /// BRF within cones: (zenith, azimuth, full opening angle), degrees.
        BrfCones(Vec<(f64, f64, f64)> => "[(30.0, 90.0, 5.0)]"),
        /// Reflected over incident flux.
        Albedo,
        /// Radiance in this number of equal-area cells of the hemisphere, W m⁻² sr⁻¹ nm⁻¹, from the sources
        /// that the band names; of an isolated scene, over the terrain's rectangle.
        RadianceCells(u32 => "150"),
        /// The same towards directions, by virtual photons.
        RadianceViews(Views => "PrincipalPlane"),
        /// The same within cones: (zenith, azimuth, full opening angle), degrees.
        RadianceCones(Vec<(f64, f64, f64)> => "[(30.0, 90.0, 5.0)]"),
        /// Flux density that leaves upwards, W m⁻² nm⁻¹, from the sources that the band names.
        Exitance,
        /// Temperature of the black body of each radiance that this sensor measures, K, in bands that
        /// hold emission.
        BrightnessTemperature,
        /// Splits this sensor's albedo and BRF as RAMI does: `_uc` (scattered once, by the ground),
        /// `_co_sgl` (once, by anything else) and `_mlt` (more often).
        Orders,
        /// Share of the incident flux that each material absorbs in each layer and in all, and what
        /// reaches the ground.
        Fapar {
            /// Thickness of a layer from the lowest ground up, m, or the heights of all borders between layers in
            /// the local frame, m.
            layer_m: Layers = Layers::Thickness(1.0),
        },
        /// Power of sun and sky that each instance absorbs, W nm⁻¹, the terrain as the first of them.
        Absorbed {
            /// `Triangle` reports what each triangle and disc absorbs too, as a coloured PLY.
            per: Per = Per::Instance,
        },
        /// Down- and upwelling flux density, W m⁻² nm⁻¹, on the terrain and at the top of the scene,
        /// from the sources that the band names: per m² of horizontal area and, on relief, also per m²
        /// of the inclined ground (`_terrain_surface`).
        Fluxes {
            /// Side of a square pixel, m.
            pixel_m: f64 = 1.0,
            /// Further heights in the local frame, m.
            heights_m: Vec<f64> = Vec::new(),
        },
    }
}

impl PhotonMeasure {
    /// Whether a transport system estimates it: photons that are followed as a whole never leave in
    /// the very direction of a view.
    #[must_use]
    pub const fn is_measured_by(&self, system: System) -> bool {
        match self {
            Self::BrfViews(_) | Self::RadianceViews(_) => matches!(system, System::Forward),
            Self::BrfCells(_)
            | Self::BrfCones(_)
            | Self::Albedo
            | Self::RadianceCells(_)
            | Self::RadianceCones(_)
            | Self::Exitance
            | Self::BrightnessTemperature
            | Self::Orders
            | Self::Fapar { .. }
            | Self::Absorbed { .. }
            | Self::Fluxes { .. } => matches!(system, System::Forward | System::Analog),
        }
    }
}

choice! {
    /// What absorbed power is told of.
    pub enum Per ("`Instance` or `Triangle`") {
        /// Each instance.
        Instance,
        /// Each instance, and each of its triangles and discs.
        Triangle,
    }
}

/// Horizontal layers: `1.0` or `[0.0, 2.0, 8.0]`.
#[derive(Clone, Debug, PartialEq)]
pub enum Layers {
    /// Thickness of all, from the ground up, m.
    Thickness(f64),
    /// Heights of their borders, m.
    Borders(Vec<f64>),
}

impl Decode for Layers {
    fn expected() -> Cow<'static, str> {
        "a thickness or a list of heights".into()
    }

    fn example() -> String {
        "1.0".to_owned()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [f64::schema(book), Vec::<f64>::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::List(_) => Self::Borders(Vec::decode(node, reader)),
            _ => Self::Thickness(f64::decode(node, reader)),
        }
    }

    fn placeholder() -> Self {
        Self::Thickness(f64::placeholder())
    }
}

impl Encode for Layers {
    fn encode(&self) -> Text {
        match self {
            Self::Thickness(thickness) => thickness.encode(),
            Self::Borders(borders) => borders.encode(),
        }
    }

    fn numbers<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        match self {
            Self::Thickness(thickness) => thickness.numbers(walk),
            Self::Borders(borders) => borders.numbers(walk),
        }
    }
}

choice! {
    /// A transport system.
    pub enum System ("a transport system") {
        /// Paths from the sensor.
        Backward,
        /// Photon packets from sun and sky, or from what emits.
        Forward,
        /// Photons of one band each, absorbed, reflected or transmitted as a whole: slow, and free of
        /// all that could be wrong with packets. For `Photons`, without views.
        Analog,
        /// Light of sun and sky that was scattered once, integrated over low-discrepancy points with no
        /// random walk. For images and directions: of `Orders` the parts `_uc` and `_co_sgl`, and, where
        /// `first_order_only` is, `Brf` and `Radiance`.
        FirstOrder,
        /// Paths from the sensor as one plain loop, for comparison: slow. For images and directions: `Brf` and
        /// `Radiance` of what is reflected.
        Reference,
    }
}

impl Copy for System {}

impl System {
    /// All transport systems.
    pub const ALL: [Self; 5] =
        [Self::Backward, Self::Forward, Self::Analog, Self::FirstOrder, Self::Reference];

    /// Name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Backward => "backward",
            Self::Forward => "forward",
            Self::Analog => "analog",
            Self::FirstOrder => "first_order",
            Self::Reference => "reference",
        }
    }
}
