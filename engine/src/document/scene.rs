use std::borrow::Cow;

use indexmap::IndexMap;

use super::decode::{Decode, Fields, Reader, Variant, example_of_keys};
use super::encode::{Encode, Text, differs};
use super::syntax::Node;

/// Named values in document order.
pub type Map<T> = IndexMap<String, T>;

record! {
    /// A scene file: a function of its `params`.
    pub struct Scene ("the scene") {
        /// Version of the language; this is version 1.
        format: u32 => "1",
        /// What a person calls the scene.
        title: String = String::new(),
        /// Values that `"=expr"` strings may use.
        params: Map<f64> = Map::new(),
        /// Where the local frame lies on Earth.
        frame: Frame = Frame { origin_m: (0.0, 0.0, 0.0) },
        /// Spectral bands, in the order of all band lists.
        bands: Vec<Band> => r#"[(name: "red", center_nm: 660.0, width_nm: 10.0)]"#,
        /// Spectra that materials and lights may name.
        spectra: Map<Spectrum> = Map::new(),
        /// Surfaces.
        materials: Map<Material> = Map::new(),
        /// Mesh prototypes.
        meshes: Map<Mesh> = Map::new(),
        /// The ground.
        terrain: Terrain => r#"Plane(size_m: (100.0, 100.0), material: "soil")"#,
        /// What stands on it.
        instances: Vec<Instances> = Vec::new(),
        /// The sun; without it only the sky lights the scene.
        sun: Option<Sun> = None,
        /// The sky.
        sky: Sky = Sky::None,
        /// What lies beyond the terrain's rectangle.
        boundary: Boundary = Boundary::Isolated,
        /// What measures the light.
        sensors: Map<Sensor> => r#"{ "brf": Directions(views: PrincipalPlane) }"#,
        /// How light is traced.
        transport: Transport = Transport::default(),
        /// Named sets of changes to `params`.
        variants: Map<Map<f64>> = Map::new(),
    }
}

record! {
    /// Anchor of the local frame.
    pub struct Frame ("the frame") {
        /// Easting, northing and height (UTM, say) of the local origin, m. Results do not depend on it.
        origin_m: (f64, f64, f64) = (0.0, 0.0, 0.0),
    }
}

record! {
    /// A spectral band.
    pub struct Band ("a band") {
        /// Its name in all outputs.
        name: String => r#""red""#,
        /// Centre wavelength, nm.
        center_nm: f64 => "660.0",
        /// Full width, nm; 0 means the centre wavelength alone.
        width_nm: f64 = 0.0,
    }
}

choice! {
    /// A quantity as a function of wavelength, or given band by band.
    pub enum Spectrum ("a spectrum") {
        /// The same at every wavelength.
        Constant(f64 => "0.3"),
        /// One value a band of this scene.
        Bands(Vec<f64> => "[0.1, 0.2]"),
        /// Points (wavelength nm, value), joined by straight lines and averaged over each band.
        Points(Vec<(f64, f64)> => "[(400.0, 0.05), (800.0, 0.3)]"),
        /// Such points from two columns of a CSV file.
        Table {
            /// Path, relative to the scene file.
            file: String => r#""spectra/soil.csv""#,
            /// Header of the column of wavelengths, nm.
            wavelength: String = "wavelength_nm".to_owned(),
            /// Header of the column of values; if absent, the second column of the file.
            value: Option<String> = None,
        },
        /// One of the scene's `spectra`.
        Named(String => r#""soil""#),
        /// Leaf reflectance or transmittance (whichever the key asks for) by PROSPECT-PRO.
        Prospect {
            /// Leaf structure parameter N, 1 to 3.
            n: f64 = 1.5,
            /// Chlorophyll a + b, µg cm⁻².
            chlorophyll_ug_cm2: f64 = 40.0,
            /// Carotenoids, µg cm⁻².
            carotenoid_ug_cm2: f64 = 8.0,
            /// Anthocyanins, µg cm⁻².
            anthocyanin_ug_cm2: f64 = 0.0,
            /// Brown pigments, arbitrary units.
            brown: f64 = 0.0,
            /// Equivalent water thickness, cm.
            water_cm: f64 = 0.01,
            /// Dry matter, g cm⁻²; 0 where proteins and other carbon are given instead.
            dry_matter_g_cm2: f64 = 0.009,
            /// Proteins, g cm⁻².
            protein_g_cm2: f64 = 0.0,
            /// Carbon-based constituents other than proteins, g cm⁻².
            carbon_g_cm2: f64 = 0.0,
        },
    }
}

choice! {
    /// A surface.
    pub enum Material ("a material") {
        /// Reflects diffusely on both sides; opaque.
        Lambertian {
            /// Reflectance of the front side, and of the back unless that is given.
            reflectance: Spectrum => "Constant(0.3)",
            /// Reflectance of the back side.
            back_reflectance: Option<Spectrum> = None,
        },
        /// Reflects and transmits diffusely.
        Leaf {
            /// Reflectance of the front side, and of the back unless that is given.
            reflectance: Spectrum => "Constant(0.3)",
            /// Transmittance, the same in both directions.
            transmittance: Spectrum => "Constant(0.2)",
            /// Reflectance of the back side.
            back_reflectance: Option<Spectrum> = None,
        },
    }
}

choice! {
    /// The axis of a file's model that points to the zenith.
    pub enum Axis ("an axis") {
        /// x points up, y to the east, z to the north.
        X,
        /// y points up; x stays east and -z points north.
        Y,
        /// z points up: the frame of sunfleck.
        Z,
    }
}

choice! {
    /// A mesh prototype.
    pub enum Mesh ("a mesh") {
        /// Wavefront OBJ; groups, and within them materials, are the parts.
        Obj {
            /// Path, relative to the scene file.
            file: String => r#""assets/tree.obj""#,
            /// Which axis points up.
            up: Axis => "Z",
            /// Length of the file's unit, m.
            unit_m: f64 => "1.0",
            /// Material of each part.
            parts: Map<String> = Map::new(),
            /// Material of the parts that `parts` does not name.
            material: Option<String> = None,
            /// What becomes the origin.
            origin: Origin = Origin::File,
        },
        /// glTF 2.0 or GLB; materials are the parts.
        Gltf {
            /// Path, relative to the scene file.
            file: String => r#""assets/tree.glb""#,
            /// Which axis points up (Y, if the file keeps to the standard).
            up: Axis => "Y",
            /// Length of the file's unit, m.
            unit_m: f64 => "1.0",
            /// Material of each part.
            parts: Map<String> = Map::new(),
            /// Material of the parts that `parts` does not name.
            material: Option<String> = None,
            /// What becomes the origin.
            origin: Origin = Origin::File,
        },
        /// A cloud of discs: CSV with the header `radius,x,y,z,nx,ny,nz`, or a RAMI `.def` text
        /// with rows `r x y z nx ny nz`; m, z up.
        Discs {
            /// Path, relative to the scene file.
            file: String => r#""assets/crown.csv""#,
            /// Material of the discs.
            material: String => r#""leaf""#,
        },
        /// A tree or shrub generated leaf by leaf.
        Crown {
            /// Outline of the crown.
            shape: CrownShape => "Ellipsoid(diameter_m: 3.0, height_m: 5.0)",
            /// Height of the crown's lowest point above the ground, m.
            base_m: f64 => "2.0",
            /// One-sided area of all leaves, m².
            leaf_area_m2: f64 => "30.0",
            /// Distribution of leaf inclinations.
            leaf_angle: LeafAngle = LeafAngle::Spherical,
            /// Shape and size of a leaf.
            leaf: LeafShape => "Disc(radius_m: 0.05)",
            /// Material of the leaves.
            leaf_material: String => r#""leaf""#,
            /// Trunk, if any.
            trunk: Option<Trunk> = None,
            /// Branches from the trunk into the crown, if any.
            branches: Option<Branches> = None,
            /// Material of trunk and branches.
            wood_material: Option<String> = None,
            /// Another number is another tree of the same kind.
            seed: u64 = 1,
        },
    }
}

choice! {
    /// What becomes the origin of a prototype.
    pub enum Origin ("an origin") {
        /// The file's own origin.
        File,
        /// The middle of the bounding box, at its lowest height.
        BaseCenter,
    }
}

choice! {
    /// Outline of a generated crown.
    pub enum CrownShape ("a crown shape") {
        /// Ellipsoid of revolution.
        Ellipsoid {
            /// Largest width, m.
            diameter_m: f64 => "3.0",
            /// From its lowest to its highest point, m.
            height_m: f64 => "5.0",
        },
        /// Upright cone.
        Cone {
            /// Width at its base, m.
            diameter_m: f64 => "3.0",
            /// From base to tip, m.
            height_m: f64 => "5.0",
        },
        /// Upright cylinder.
        Cylinder {
            /// Width, m.
            diameter_m: f64 => "3.0",
            /// From base to top, m.
            height_m: f64 => "5.0",
        },
        /// Box, for homogeneous layers.
        Box {
            /// Extent to the east, to the north and up, m.
            size_m: (f64, f64, f64) => "(10.0, 10.0, 2.0)",
        },
    }
}

choice! {
    /// Distribution of the angle θ between leaf normal and zenith; azimuths are uniform.
    pub enum LeafAngle ("a leaf angle distribution") {
        /// g(θ) = sin θ.
        Spherical,
        /// g(θ) = 2/π.
        Uniform,
        /// g(θ) = (2/π)(1 + cos 2θ): mostly horizontal leaves.
        Planophile,
        /// g(θ) = (2/π)(1 - cos 2θ): mostly vertical leaves.
        Erectophile,
        /// g(θ) = (2/π)(1 - cos 4θ): mostly leaves at 45°.
        Plagiophile,
        /// g(θ) = (2/π)(1 + cos 4θ): mostly horizontal or vertical leaves.
        Extremophile,
    }
}

choice! {
    /// Shape of a generated leaf.
    pub enum LeafShape ("a leaf shape") {
        /// Flat disc.
        Disc {
            /// Radius, m.
            radius_m: f64 => "0.05",
        },
        /// Flat square.
        Square {
            /// Side, m.
            side_m: f64 => "0.05",
        },
        /// Flat rhombus.
        Rhombus {
            /// Long diagonal, m.
            length_m: f64 => "0.08",
            /// Short diagonal, m.
            width_m: f64 => "0.04",
        },
    }
}

record! {
    /// Trunk of a generated tree: a tapered, closed prism.
    pub struct Trunk ("the trunk") {
        /// Height of its tip, m.
        height_m: f64 => "5.0",
        /// Diameter at the ground, m.
        diameter_m: f64 => "0.2",
        /// Diameter at the tip, m.
        tip_diameter_m: f64 = 0.01,
    }
}

record! {
    /// Branches of a generated tree, spread along the trunk within the crown.
    pub struct Branches ("the branches") {
        /// How many.
        count: u32 => "12",
        /// Diameter at the trunk, m.
        diameter_m: f64 => "0.2",
        /// Angle from the zenith, degrees.
        zenith_deg: f64 = 60.0,
    }
}

choice! {
    /// The ground.
    pub enum Terrain ("a terrain") {
        /// Horizontal rectangle.
        Plane {
            /// Extent to the east and to the north, m.
            size_m: (f64, f64) => "(100.0, 100.0)",
            /// Material.
            material: String => r#""soil""#,
            /// South-west corner, m.
            corner_m: (f64, f64) = (0.0, 0.0),
            /// Height, m.
            height_m: f64 = 0.0,
        },
    }
}

choice! {
    /// Instances of mesh prototypes.
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
        },
    }
}

record! {
    /// The sun.
    pub struct Sun ("the sun") {
        /// Angle from the vertical, degrees, below 90.
        zenith_deg: f64 => "30.0",
        /// Where the sun is, clockwise from north, degrees.
        azimuth_deg: f64 = 0.0,
        /// Irradiance on a plane perpendicular to the beam, W m⁻² nm⁻¹; with `sky: Fraction(..)`
        /// that of sun and sky together.
        irradiance: Spectrum = Spectrum::Constant(1.0),
    }
}

choice! {
    /// The sky.
    pub enum Sky ("a sky") {
        /// Black.
        None,
        /// Isotropic; the share of the total irradiance that is diffuse, band by band
        /// (`SKY_TO_TOTAL`): the sun keeps `irradiance (1 - s)`, the sky gives the horizontal plane
        /// `irradiance s cos(sun zenith)`.
        Fraction(Vec<f64> => "[0.1, 0.05]"),
        /// Isotropic, of its own irradiance.
        Isotropic {
            /// Irradiance on the horizontal plane, W m⁻² nm⁻¹.
            irradiance: Spectrum => "Constant(0.2)",
        },
    }
}

choice! {
    /// What lies beyond the terrain's rectangle.
    pub enum Boundary ("a boundary") {
        /// The same scene again, without end.
        Periodic,
        /// Nothing.
        Isolated,
    }
}

choice! {
    /// A sensor.
    pub enum Sensor ("a sensor") {
        /// Parallel-projection image.
        Orthographic {
            /// Columns and rows.
            size_px: (u32, u32) => "(256, 256)",
            /// Width and height of the footprint in the plane perpendicular to the view, m.
            extent_m: (f64, f64) => "(50.0, 50.0)",
            /// Point on the ground in the middle of the image, m; the terrain's middle if absent.
            center_m: Option<(f64, f64)> = None,
            /// Zenith angle of the sensor, degrees.
            zenith_deg: f64 = 0.0,
            /// Where the sensor is, clockwise from north, degrees. A nadir image has north up at 180.
            azimuth_deg: f64 = 180.0,
            /// Samples a pixel.
            samples_per_px: u32 = 64,
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Brf],
            /// Which transport system estimates it.
            system: System = System::Backward,
        },
        /// The scene seen from many directions.
        Directions {
            /// Where the sensors are.
            views: Views => "PrincipalPlane",
            /// When it is good enough.
            until: Until = Until::RelError(0.005),
            /// What to report.
            measure: Vec<ImageMeasure> = vec![ImageMeasure::Brf],
            /// Which transport system estimates it.
            system: System = System::Backward,
        },
        /// Photon packets from sun and sky.
        Photons {
            /// Packets a square metre of the terrain's rectangle.
            per_m2: f64 = 1000.0,
            /// What to count them for.
            measure: Vec<PhotonMeasure> = vec![PhotonMeasure::Albedo],
        },
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
    /// When a measurement is good enough.
    pub enum Until ("an end of the measurement") {
        /// Its median relative standard error is at most this.
        RelError(f64 => "0.005"),
        /// It has run for so many seconds.
        Seconds(f64 => "60.0"),
        /// So many samples a direction.
        Samples(u64 => "1000"),
    }
}

choice! {
    /// What an image holds.
    pub enum ImageMeasure ("a measure of an image") {
        /// Radiance, W m⁻² sr⁻¹ nm⁻¹.
        Radiance,
        /// Bidirectional reflectance factor; under a sky it is the HDRF and is named so.
        Brf,
    }
}

choice! {
    /// What photons are counted for.
    pub enum PhotonMeasure ("a measure of photons") {
        /// BRF in so many equal-area cells of the hemisphere.
        BrfCells(u32 => "150"),
        /// BRF towards directions, by virtual photons.
        BrfViews(Views => "PrincipalPlane"),
        /// Reflected over incident flux.
        Albedo,
        /// Share of the incident flux that each material absorbs in each layer.
        Fapar {
            /// Thickness of a layer, m.
            layer_m: f64 = 1.0,
        },
        /// Down- and upwelling flux density, W m⁻² nm⁻¹, on the terrain and at the top of the scene.
        Fluxes {
            /// Side of a square pixel, m.
            pixel_m: f64 = 1.0,
            /// Further heights, m.
            heights_m: Vec<f64> = Vec::new(),
        },
    }
}

choice! {
    /// A transport system.
    pub enum System ("a transport system") {
        /// Paths from the sensor.
        Backward,
        /// Photon packets from sun and sky.
        Forward,
    }
}

record! {
    /// How light is traced.
    pub struct Transport ("`transport`") {
        /// Another number is another, independent estimate.
        seed: u64 = 1,
        /// How weak paths end.
        roulette: Roulette = Roulette::default(),
        /// Count light that was scattered once, and no more.
        first_order_only: bool = false,
    }
}

record! {
    /// Russian roulette: from some order on a path ends with some probability; those that survive
    /// carry its power on.
    pub struct Roulette ("the roulette") {
        /// Orders of scattering before it starts.
        after_order: u32 = 5,
        /// Probability to end, below 1.
        kill: f64 = 0.05,
    }
}

impl Default for Roulette {
    fn default() -> Self {
        Self { after_order: 5, kill: 0.05 }
    }
}

impl Default for Transport {
    fn default() -> Self {
        Self { seed: 1, roulette: Roulette::default(), first_order_only: false }
    }
}
