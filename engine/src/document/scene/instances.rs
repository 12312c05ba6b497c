//! Instances of meshes on the ground.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::super::decode::{Decode, Reader};
use super::super::describe::Book;
use super::super::diagnostic::nearest;
use super::super::encode::Encode;
use super::super::leaves::Walk;
use super::super::ron_text::{Node, Text, Value};
use super::{FilePath, InstancesName, Map, Prototype, Ref};

choice! {
    /// Instances of mesh prototypes.
    pub enum Instances ("instances") {
        /// Places from a text table.
        Table(..InstanceTable),
        /// Places written here.
        List(..InstanceList),
        /// Places by a rule, on the terrain. The same seed and name give the same places.
        Scatter(..Scatter),
        /// Trees as a canopy height model shows them, on the terrain.
        CanopyHeights(..CanopyHeights),
    }
}

record! {
    /// Instances at places from a text table.
    pub struct InstanceTable ("a table of instances") {
        /// Path, relative to the scene file.
        file: FilePath => r#""stand.csv""#,
        /// Mesh that stands there, or the mesh of each species: `{ "birch": "birch.tree" }`.
        of: SpeciesMeshes => r#""tree""#,
        /// Names of the columns where the file has no header, or in place of those in its header:
        /// `x_m`, `y_m`, `z_m`, `yaw_deg` or `yaw_rad`, `tilt_deg`, `tilt_azimuth_deg`, `species`
        /// (a key of `of`), and for the size `scale` and `scale_vertical`, or `height_m` and
        /// `crown_diameter_m`. With `height_m` the top of the mesh is so high above its origin,
        /// with `crown_diameter_m` (or `diameter_m`) the mean of its extents to the east and to the
        /// north is so wide; where one of the two is missing, the mesh keeps its proportions.
        /// Columns of other names are let be.
        columns: Option<Vec<String>> = None,
        /// True if heights count from the terrain below each place. Without a column `z_m` they do in any case, and
        /// stems beside the ground stand at height 0.
        on_terrain: bool = false,
        /// Origin of the coordinates; if absent, whichever of the two puts the stems on the terrain.
        coordinates: Option<TableCoordinates> = None,
        /// Name for `hide` and `select`.
        name: Option<InstancesName> = None,
    }
}

record! {
    /// Instances at places that the scene lists.
    pub struct InstanceList ("a list of instances") {
        /// Mesh that stands there.
        of: Ref<Prototype> => r#""tree""#,
        /// Positions, m.
        at_m: Vec<(f64, f64, f64)> => "[(20.0, 30.0, 0.0)]",
        /// Turn of each (counter-clockwise seen from above), degrees; none if empty.
        yaw_deg: Vec<f64> = Vec::new(),
        /// Scale of each; 1 if empty.
        scale: Vec<f64> = Vec::new(),
        /// True if heights count from the terrain below each place.
        on_terrain: bool = false,
        /// Name for `hide` and `select`.
        name: Option<InstancesName> = None,
    }
}

record! {
    /// Instances that a rule of placement puts on the terrain.
    pub struct Scatter ("scattered instances") {
        /// Meshes and their shares. One more leaves all stems in place: some become its own.
        of: IndexMap<Ref<Prototype>, f64> => r#"{ "oak": 0.7, "birch": 0.3 }"#,
        /// Rule by which places are chosen.
        rule: Rule,
        /// Number of stems.
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
        /// Depth of the mesh's origin below the terrain, m.
        sink_m: f64 = 0.0,
        /// Name for `hide` and `select`, and of the random numbers: with it, instances may come
        /// and go before these without moving them.
        name: Option<InstancesName> = None,
        /// Another number is another forest under the same light; that of `transport` if absent.
        seed: Option<u64> = None,
    }
}

record! {
    /// Trees as a canopy height model shows them.
    pub struct CanopyHeights ("trees of a canopy height model") {
        /// Raster of heights above the ground, m: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where
        /// the file says, as the terrain does; over the whole terrain if the file does not.
        file: FilePath => r#""chm.asc""#,
        /// Meshes. Each tree gets the one whose ratio of height to crown diameter is nearest to
        /// its own, scaled to both.
        of: Vec<Ref<Prototype>> => r#"["oak", "fir"]"#,
        /// Length of the unit of the heights, m, in place of the file's: 0.01 for centimetres, 0.3048
        /// for feet. Without it, heights that the file says are in feet become metres.
        height_unit_m: Option<f64> => "0.01" = None,
        /// Minimum height of a tree, m; anything lower is none.
        min_height_m: f64 = 3.0,
        /// Two numbers a, b: of tops less than half of a m + b h² from one of height h m, only
        /// the highest counts.
        window: (f64, f64) = (2.51, 0.009),
        /// Depth of the mesh's origin below the terrain, m.
        sink_m: f64 = 0.0,
        /// Name for `hide` and `select`, and of the random numbers that turn the trees.
        name: Option<InstancesName> = None,
    }
}

choice! {
    /// Rule by which places are chosen.
    pub enum Rule ("a rule of placement") {
        /// Each place on its own, everywhere equally likely.
        Uniform,
        /// Uniform places, without those too close to an earlier one. In a periodic scene the distance
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
            /// Largest displacement of a stem from its place, to the east and to the north, m.
            jitter_m: f64 = 0.0,
        },
    }
}

choice! {
    /// Number of stems.
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
            file: FilePath => r#""density.asc""#,
            /// Stems per hectare of a value of 1.
            factor: f64 = 1.0,
        },
        /// Maximum number of stems that the rule has room for.
        Fill,
    }
}

choice! {
    /// Distribution of a quantity over the stems.
    pub enum Distribution ("a distribution") {
        /// One value for all stems.
        Fixed(f64 => "1.0"),
        /// Equally likely from the first value to the second.
        Uniform((f64, f64) => "0.8, 1.2"),
        /// Gaussian, cut off at `min` and `max`.
        Normal {
            /// Mean of the Gaussian, in the unit of the key.
            mean: f64 => "1.0",
            /// Its standard deviation, in the same unit.
            sd: f64 => "0.1",
            /// Smallest value, not above the mean.
            min: Option<f64> = None,
            /// Largest value, not below the mean.
            max: Option<f64> = None,
        },
        /// Its logarithm is Gaussian; cut off at `min` and `max`.
        LogNormal {
            /// Median, in the unit of the key.
            median: f64 => "1.0",
            /// Standard deviation of the natural logarithm, dimensionless.
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
            file: FilePath => r#""stand.geojson""#,
            /// True if it holds eastings and northings: `frame.origin_m` is subtracted.
            georeferenced: bool = true,
        },
        /// Polygons from a text table: columns `x_m`, `y_m`, and perhaps `ring` (another number is
        /// another ring) and `hole` (1 in rings that are holes of the outline before them).
        Table {
            /// Path, relative to the scene file.
            file: FilePath => r#""stand.csv""#,
            /// True if it holds eastings and northings: `frame.origin_m` is subtracted.
            georeferenced: bool = false,
        },
    }
}

choice! {
    /// Frame of the coordinates of a table.
    #[derive(Copy, Eq)]
    pub enum TableCoordinates ("coordinates of a table") {
        /// Map coordinates, as those of rasters: `frame.origin_m` is subtracted, also from `z_m`, unless that
        /// counts from the terrain.
        Map,
        /// Coordinates of the local frame.
        Local,
    }
}

/// Meshes of the instances in a table: one, or one for each species.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SpeciesMeshes {
    /// One value for all stems.
    One(Ref<Prototype>),
    /// One mesh per species, by the column `species`.
    BySpecies(Map<Ref<Prototype>>),
}

impl SpeciesMeshes {
    /// The meshes, in document order.
    #[must_use]
    pub fn meshes(&self) -> Vec<&str> {
        match self {
            Self::One(mesh) => vec![mesh],
            Self::BySpecies(meshes) => meshes.values().map(Ref::as_str).collect(),
        }
    }
}

impl Decode for SpeciesMeshes {
    fn expected() -> Cow<'static, str> {
        "a mesh, or a map of species to meshes".into()
    }

    fn example() -> String {
        "\"tree\"".to_owned()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [String::schema(book), Map::<Ref<Prototype>>::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::Map(_) => Self::BySpecies(Map::decode(node, reader)),
            Value::Text(_) | Value::Formula(_) | Value::Named(_) => {
                Self::One(Ref::decode(node, reader))
            }
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        Self::One(Ref::placeholder())
    }
}

impl Encode for SpeciesMeshes {
    fn encode(&self) -> Text {
        match self {
            Self::One(mesh) => mesh.encode(),
            Self::BySpecies(meshes) => meshes.encode(),
        }
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        match self {
            Self::One(mesh) => mesh.visit(walk),
            Self::BySpecies(meshes) => meshes.visit(walk),
        }
    }
}

/// The column that a name without or with another unit stands for, or one that is spelled nearly so.
#[must_use]
pub fn meant_column(name: &str, columns: &[&'static str]) -> Option<&'static str> {
    let stem = |name: &str| {
        let lower = name.trim().to_lowercase();
        let units = ["_m", "_cm", "_ft", "_deg", "_rad"];
        units.iter().find_map(|unit| lower.strip_suffix(unit)).unwrap_or(&lower).to_owned()
    };
    let same = columns.iter().find(|column| stem(column) == stem(name));
    same.copied().or_else(|| nearest(name, columns.iter().copied()))
}

/// Columns that a table of instances may have.
pub const INSTANCE_COLUMNS: [&str; 13] = [
    "x_m",
    "y_m",
    "z_m",
    "yaw_deg",
    "yaw_rad",
    "tilt_deg",
    "tilt_azimuth_deg",
    "scale",
    "scale_vertical",
    "height_m",
    "diameter_m",
    "crown_diameter_m",
    "species",
];

impl Instances {
    /// Name that the author gave.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Table(table) => table.name.as_deref(),
            Self::List(list) => list.name.as_deref(),
            Self::Scatter(scatter) => scatter.name.as_deref(),
            Self::CanopyHeights(canopy) => canopy.name.as_deref(),
        }
    }

    /// Meshes that it places, in document order.
    #[must_use]
    pub fn meshes(&self) -> Vec<&str> {
        match self {
            Self::Table(table) => table.of.meshes(),
            Self::List(list) => vec![&list.of],
            Self::Scatter(scatter) => scatter.of.keys().map(Ref::as_str).collect(),
            Self::CanopyHeights(canopy) => canopy.of.iter().map(Ref::as_str).collect(),
        }
    }
}
