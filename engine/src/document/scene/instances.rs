//! What stands on the ground.

use std::borrow::Cow;

use super::super::decode::{Decode, Reader, Variant, example_of_keys};
use super::super::encode::{Encode, Text, differs};
use super::super::syntax::Node;
use super::Map;

choice! {
    /// Instances of mesh prototypes.
    #[expect(clippy::large_enum_variant, reason = "a scene has few of them")]
    pub enum Instances ("instances") {
        /// Places from a text table.
        Table {
            /// Path, relative to the scene file.
            file: String => r#""stand.csv""#,
            /// Mesh that stands there.
            of: String => r#""tree""#,
            /// Names of the columns where the file has no header: `x_m`, `y_m`, `z_m`, `yaw_deg`
            /// or `yaw_rad`, `tilt_deg`, `tilt_azimuth_deg`, `scale`, `scale_vertical`.
            columns: Option<Vec<String>> = None,
            /// Whether heights count from the terrain below each place.
            on_terrain: bool = false,
            /// Name for `hide` and `select`.
            name: Option<String> = None,
        },
        /// Places written here.
        List {
            /// Mesh that stands there.
            of: String => r#""tree""#,
            /// Positions, m.
            at_m: Vec<(f64, f64, f64)> => "[(20.0, 30.0, 0.0)]",
            /// Turn of each (counter-clockwise seen from above), degrees; none if empty.
            yaw_deg: Vec<f64> = Vec::new(),
            /// Scale of each; 1 if empty.
            scale: Vec<f64> = Vec::new(),
            /// Whether heights count from the terrain below each place.
            on_terrain: bool = false,
            /// Name for `hide` and `select`.
            name: Option<String> = None,
        },
        /// Places by a rule, on the terrain. The same seed and name give the same places.
        Scatter {
            /// Meshes and their shares. One more leaves all stems in place: some become its own.
            of: Map<f64> => r#"{ "oak": 0.7, "birch": 0.3 }"#,
            /// How places are chosen.
            rule: Rule,
            /// How many.
            stems: Stems = Stems::Fill,
            /// Only in these; everywhere if empty.
            inside: Vec<Area> = Vec::new(),
            /// Not in these.
            outside: Vec<Area> = Vec::new(),
            /// Turn (counter-clockwise seen from above), degrees.
            yaw_deg: Distribution = Distribution::Uniform((0.0, 360.0)),
            /// Lean from the vertical, degrees.
            tilt_deg: Distribution = Distribution::Fixed(0.0),
            /// Azimuth of the lean, degrees.
            tilt_azimuth_deg: Distribution = Distribution::Uniform((0.0, 360.0)),
            /// Height, m, to which a mesh is scaled as a whole; as it is if absent.
            height_m: Option<Distribution> = None,
            /// Further scale.
            scale: Distribution = Distribution::Fixed(1.0),
            /// Further vertical scale; that of `scale` if absent.
            scale_vertical: Option<Distribution> = None,
            /// How deep the mesh's origin lies below the terrain, m.
            sink_m: f64 = 0.0,
            /// Name for `hide` and `select`, and of the random numbers: with it, instances may come
            /// and go before these without moving them.
            name: Option<String> = None,
            /// Another number is another forest under the same light; that of `transport` if absent.
            seed: Option<u64> = None,
        },
        /// Trees as a canopy height model shows them, on the terrain.
        CanopyHeights {
            /// Raster of heights above the ground, m: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where
            /// the file says, as the terrain does; over the whole terrain if the file does not.
            file: String => r#""chm.asc""#,
            /// Meshes. Each tree gets the one whose ratio of height to crown diameter is nearest to
            /// its own, scaled to both.
            of: Vec<String> => r#"["oak", "fir"]"#,
            /// What is lower is no tree, m.
            min_height_m: f64 = 3.0,
            /// Two numbers a, b: of tops less than half of a m + b h² from one of height h m, only
            /// the highest counts.
            window: (f64, f64) = (2.51, 0.009),
            /// How deep the mesh's origin lies below the terrain, m.
            sink_m: f64 = 0.0,
            /// Name for `hide` and `select`, and of the random numbers that turn the trees.
            name: Option<String> = None,
        },
    }
}

choice! {
    /// How places are chosen.
    pub enum Rule ("a rule of placement") {
        /// Each place on its own, everywhere equally likely.
        Uniform,
        /// The same, but for places too close to an earlier one. In a periodic scene the distance
        /// counts across the borders.
        PoissonDisc {
            /// Smallest distance between two stems, m.
            min_distance_m: f64 => "3.0",
        },
        /// Rows.
        Grid {
            /// Distance of stems across and along the rows, m.
            spacing_m: (f64, f64) => "(3.0, 2.0)",
            /// Azimuth of the rows, clockwise from north, degrees.
            row_azimuth_deg: f64 = 0.0,
            /// How far a stem may stand beside its place, to the east and to the north, m.
            jitter_m: f64 = 0.0,
        },
    }
}

choice! {
    /// How many stems there are.
    pub enum Stems ("a choice of how many stems") {
        /// A number of them.
        Count(u32 => "500"),
        /// Stems per hectare of the area where they may stand.
        PerHectare(f64 => "400.0"),
        /// Stems per hectare, place by place, from a raster: ESRI ASCII grid, ENVI or `GeoTIFF`. It
        /// lies where the file says, as the terrain does; over the whole terrain if the file does
        /// not. Beside it and where it has no data stands nothing.
        Raster {
            /// Path, relative to the scene file.
            file: String => r#""density.asc""#,
            /// Stems per hectare of a value of 1.
            factor: f64 = 1.0,
        },
        /// As many as the rule has room for.
        Fill,
    }
}

choice! {
    /// How a quantity varies from stem to stem.
    pub enum Distribution ("a distribution") {
        /// The same for all.
        Fixed(f64 => "1.0"),
        /// Equally likely from the first value to the second.
        Uniform((f64, f64) => "0.8, 1.2"),
        /// Gaussian, cut off at `min` and `max`.
        Normal {
            /// Mean of the Gaussian.
            mean: f64 => "1.0",
            /// Its standard deviation.
            sd: f64 => "0.1",
            /// Smallest value, not above the mean.
            min: Option<f64> = None,
            /// Largest value, not below the mean.
            max: Option<f64> = None,
        },
        /// Its logarithm is Gaussian; cut off at `min` and `max`.
        LogNormal {
            /// Median.
            median: f64 => "1.0",
            /// Standard deviation of the natural logarithm.
            sd_ln: f64 => "0.2",
            /// Smallest value, not above the median.
            min: Option<f64> = None,
            /// Largest value, not below the median.
            max: Option<f64> = None,
        },
    }
}

choice! {
    /// A part of the ground.
    pub enum Area ("an area") {
        /// A polygon.
        Polygon {
            /// Its corners in order, m; the last is joined to the first.
            outline_m: Vec<(f64, f64)> => "[(10.0, 10.0), (90.0, 10.0), (50.0, 80.0)]",
            /// Corners of each hole, m.
            holes_m: Vec<Vec<(f64, f64)>> = Vec::new(),
        },
        /// All polygons of a GeoJSON file in metres.
        GeoJson {
            /// Path, relative to the scene file.
            file: String => r#""stand.geojson""#,
            /// Whether it holds eastings and northings: `frame.origin_m` is subtracted.
            georeferenced: bool = true,
        },
        /// Polygons from a text table: columns `x_m`, `y_m`, and perhaps `ring` (another number is
        /// another ring) and `hole` (1 in rings that are holes of the outline before them).
        Table {
            /// Path, relative to the scene file.
            file: String => r#""stand.csv""#,
            /// Whether it holds eastings and northings: `frame.origin_m` is subtracted.
            georeferenced: bool = false,
        },
    }
}

/// Columns that a table of instances may have.
pub const INSTANCE_COLUMNS: [&str; 9] = [
    "x_m",
    "y_m",
    "z_m",
    "yaw_deg",
    "yaw_rad",
    "tilt_deg",
    "tilt_azimuth_deg",
    "scale",
    "scale_vertical",
];

impl Instances {
    /// Name that the author gave.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        let (Self::Table { name, .. }
        | Self::List { name, .. }
        | Self::Scatter { name, .. }
        | Self::CanopyHeights { name, .. }) = self;
        name.as_deref()
    }

    /// Meshes that it places, in document order.
    #[must_use]
    pub fn meshes(&self) -> Vec<&str> {
        match self {
            Self::Table { of, .. } | Self::List { of, .. } => vec![of],
            Self::Scatter { of, .. } => of.keys().map(String::as_str).collect(),
            Self::CanopyHeights { of, .. } => of.iter().map(String::as_str).collect(),
        }
    }
}
