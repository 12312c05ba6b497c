//! Types of a scene file.

mod band;
mod crown;
mod ground;
mod instances;
mod light;
mod material;
mod mesh;
mod output;
mod param;
mod program;
mod reference;
mod sensor;
mod spectrum;
mod thermal;
mod transport;
mod until;

use indexmap::IndexMap;

pub use band::{Band, BandSet, Bands, Response};
pub use crown::{Branches, Clumps, CrownShape, LeafAngle, LeafProfile, LeafShape, Trunk};
pub use ground::{
    Boundary, Coordinates, LandCover, NoData, RasterWindow, Terrain, TerrainPlane, TerrainRaster,
};
pub use instances::{
    Area, CanopyHeights, Distribution, INSTANCE_COLUMNS, InstanceList, InstanceTable, Instances,
    Rule, Scatter, SpeciesMeshes, Stems, TableCoordinates, meant_column,
};
pub use light::{Sky, Spa, Sun, SunPosition};
pub use material::{
    Coating, Lambertian, Leaf, Material, RasterBands, ReflectanceMap, Rpv, Soilspect,
    SurfaceQuantity,
};
pub use mesh::{Axis, GeneratedCrown, Gltf, MeshFile, Obj, Origin, PartsBy, Ply, Prototype};
pub use output::FileFormat;
pub use param::Param;
pub use program::{DerivativeSteps, Include, Sweep};
pub use reference::{Definition, FilePath, InstancesName, NamePattern, Ref};
pub use sensor::{
    Cover, Directions, Fisheye, FisheyeProjection, ImageMeasure, ImageOptions, Layers, Look,
    Orthographic, Per, Perspective, PhotonMeasure, Photons, Picture, Sensor, System, Views,
    VirtualPlane,
};
pub use spectrum::{
    Prospect, SoilMixture, Spectrum, SpectrumFile, TabulatedSpectrum, ValueUnit, WavelengthUnit,
};
pub(crate) use thermal::THERMAL_NM;
pub use thermal::{BandSource, Temperature, ThermalSky};
pub use transport::{Roulette, Transport};
pub use until::{Ends, StopCriterion};

/// Named values in document order.
pub type Map<T> = IndexMap<String, T>;

record! {
    /// A scene file: a function of its `params`.
    pub struct Scene ("the scene") {
        /// Version of the language; this is version 1.
        format: u32 => "1",
        /// Title of the scene.
        title: String = String::new(),
        /// Values that `"=expr"` strings may use. A text stands for a string: with `"leaf": "birch.csv"`,
        /// `file: "=leaf"` is `file: "birch.csv"`.
        params: Map<Param> = Map::new(),
        /// Other files, whose definitions have names that start with the include's: `birch.leaf`.
        /// Reading a scene takes them into it and leaves nothing here.
        include: Map<Include> = Map::new(),
        /// Position of the local frame on Earth.
        frame: Frame = Frame { origin_m: (0.0, 0.0, 0.0), crs: None },
        /// Spectral bands, in the order of all band lists: a list, or those of a sensor, such as
        /// `Sensor("Sentinel-2A MSI", ["B4", "B8A"])`, or `Hyperspectral(..)`.
        bands: Bands => r#"[(name: "red", center_nm: 660.0, width_nm: 10.0)]"#,
        /// Spectra that materials and lights may name.
        spectra: Map<Spectrum> = Map::new(),
        /// Surfaces.
        materials: Map<Material> = Map::new(),
        /// Mesh prototypes.
        meshes: Map<Prototype> = Map::new(),
        /// The ground.
        terrain: Terrain => r#"Plane(size_m: (100.0, 100.0), material: "soil")"#,
        /// Instances of meshes. Heights of lists and tables are those of the local frame unless `on_terrain` is true.
        instances: Vec<Instances> = Vec::new(),
        /// Patterns of instances that are left out, such as `"oak"` (a mesh) or `"plot 7/*"` (all that
        /// stands by the instances of that name). The others stay where they are.
        hide: Vec<NamePattern> = Vec::new(),
        /// Patterns of instances that are kept, as those of `hide`; all if empty.
        select: Vec<NamePattern> = Vec::new(),
        /// The sun; without it only the sky lights the scene.
        sun: Option<Sun> = None,
        /// The sky.
        sky: Sky = Sky::None,
        /// Emission of the sky, in bands that hold emission.
        thermal_sky: ThermalSky = ThermalSky::None,
        /// Surroundings of the terrain's rectangle.
        boundary: Boundary = Boundary::Isolated,
        /// Sensors, by name.
        sensors: Map<Sensor> => r#"{ "brf": Directions(views: PrincipalPlane) }"#,
        /// Options of the light transport.
        transport: Transport = Transport::default(),
        /// File formats of images; an image takes more disk with each. Tables, charts and the summary are always
        /// written.
        output: Vec<FileFormat> = FileFormat::DEFAULT.to_vec(),
        /// Named sets of changes to `params`.
        variants: Map<Map<Param>> = Map::new(),
        /// Points that `sunfleck sweep` runs the scene at.
        sweep: Option<Sweep> = None,
    }
}

record! {
    /// Anchor of the local frame.
    pub struct Frame ("the frame") {
        /// Easting, northing and height (UTM, say) of the local origin, m. Results do not depend on it.
        origin_m: (f64, f64, f64) = (0.0, 0.0, 0.0),
        /// Coordinate reference system of `origin_m`: a projected one in metres, by its number, such as
        /// `"EPSG:32632"`. Rasters and polygons must be in it, and images say so. Without it, it is that
        /// of the first file that names one.
        crs: Option<String> => r#""EPSG:32632""# = None,
    }
}
