//! The ground.

use super::{FilePath, Map, Material, Prototype, Ref};

choice! {
    /// The ground.
    pub enum Terrain ("a terrain") {
        /// Horizontal rectangle.
        Plane(..TerrainPlane),
        /// Heights from a file: ESRI ASCII grid, ENVI or `GeoTIFF`. It lies where the file says, less
        /// the frame's origin.
        Raster(..TerrainRaster),
        /// A mesh, whose rectangle is the one around it.
        Mesh {
            /// Its name among `meshes`.
            mesh: Ref<Prototype> => r#""hill""#,
            /// Position of its origin, m.
            at_m: (f64, f64, f64) = (0.0, 0.0, 0.0),
        },
    }
}

record! {
    /// Horizontal rectangle of ground.
    pub struct TerrainPlane ("a level terrain") {
        /// Extent to the east and to the north, m.
        size_m: (f64, f64) => "(100.0, 100.0)",
        /// Material.
        material: Ref<Material> => r#""soil""#,
        /// South-west corner, m.
        corner_m: (f64, f64) = (0.0, 0.0),
        /// Height, m.
        height_m: f64 = 0.0,
    }
}

record! {
    /// Terrain from a raster of heights.
    pub struct TerrainRaster ("a terrain from a raster") {
        /// Path, relative to the scene file.
        file: FilePath => r#""dem.asc""#,
        /// Material of all of it.
        material: Option<Ref<Material>> => r#""soil""# = None,
        /// Materials by class, in place of `material`.
        land_cover: Option<LandCover> = None,
        /// Largest distance of the ground above or below a cell's height, m; 0 keeps every cell.
        tolerance_m: f64 = 0.0,
        /// Unit of the coordinates, where the file does not say; degrees are refused without it.
        coordinates: Option<Coordinates> = None,
        /// Part of the raster that is read, to whole cells; all of it if left out.
        window: Option<RasterWindow> = None,
        /// Length of the unit of the heights, m, in place of the file's: 0.01 for centimetres, 0.3048
        /// for feet. Without it, heights that the file says are in feet become metres.
        height_unit_m: Option<f64> => "0.01" = None,
        /// Treatment of cells without data.
        no_data: NoData = NoData::Refuse,
        /// South-west corner, m, in place of the file's.
        corner_m: Option<(f64, f64)> = None,
        /// Extent to the east and to the north, m, in place of the file's.
        size_m: Option<(f64, f64)> = None,
        /// Height of the lowest cell, m, in place of the file's.
        lowest_m: Option<f64> = None,
    }
}

record! {
    /// Part of a raster.
    pub struct RasterWindow ("a window of a raster") {
        /// South-west corner, m, local frame: the map less `frame.origin_m`.
        corner_m: (f64, f64) => "(0.0, 0.0)",
        /// Extent to the east and to the north, m.
        size_m: (f64, f64) => "(200.0, 200.0)",
    }
}

record! {
    /// Classes of the ground from a raster.
    pub struct LandCover ("a land cover") {
        /// Path, relative to the scene file.
        file: FilePath => r#""classes.asc""#,
        /// Material of each class, by its number or, of ENVI classifications, its name.
        classes: Map<Ref<Material>> => r#"{ "1": "soil", "2": "grass" }"#,
    }
}

choice! {
    /// Unit of the coordinates of a raster.
    pub enum Coordinates ("coordinates") {
        /// Metres east and north.
        Metres,
        /// Longitude and latitude on WGS 84, taken for metres as they are in the raster's middle.
        Degrees,
    }
}

choice! {
    /// Treatment of cells without data.
    pub enum NoData ("what becomes of cells without data") {
        /// They are an error.
        Refuse,
        /// They get the mean of the cells around them, ring by ring.
        Neighbours,
        /// They lie at this height, m, in the raster's heights.
        Height(f64),
        /// They are holes: light that falls into them is lost.
        Hole,
    }
}

choice! {
    /// Surroundings of the terrain's rectangle.
    pub enum Boundary ("a boundary") {
        /// Endless copies of the scene.
        Periodic,
        /// Nothing.
        Isolated,
    }
}
