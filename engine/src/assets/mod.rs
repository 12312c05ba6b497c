//! Assets: values that are read from files or generated; each function takes a path and returns a value.
//!
//! | function | from | to |
//! |---|---|---|
//! | [`read_obj`], [`read_gltf`], [`read_ply`] | Wavefront OBJ, glTF 2.0 and GLB, PLY | [`Mesh`](crate::components::Mesh) |
//! | [`read_discs`] | CSV or RAMI text | [`Mesh`](crate::components::Mesh) |
//! | [`mesh_of_faces`] | polygons in the scene | [`Mesh`](crate::components::Mesh) |
//! | [`grow_crown`] | a [`GeneratedCrown`](crate::document::GeneratedCrown) | [`Mesh`](crate::components::Mesh) |
//! | [`read_instances`] | a text table | [`StemTable`] |
//! | [`read_geojson`], [`read_polygons`] | GeoJSON, a text table | [`Polygon`](crate::geometry::Polygon)s |
//! | [`read_raster`] | ESRI ASCII grid, ENVI, GeoTIFF | [`Raster`] |
//! | [`RasterFile`] | bands of ESRI ASCII grids, ENVI, GeoTIFF | [`RasterLayers`] |
//! | [`read_bands`] | ENVI, GeoTIFF, EXR | [`BandRaster`] |
//! | [`read_spectrum`] | text tables, ENVI, ECOSTRESS and USGS libraries, ASD files | [`SpectrumTable`] |

mod areas;
mod crown;
pub(crate) mod crs;
mod discs;
mod error;
mod face_cutter;
mod faces;
mod format;
mod gltf;
mod import;
mod instances;
mod numbers;
mod obj;
mod ply;
mod polygon;
mod raster;
mod signatures;
mod spectrum;
mod table;
mod text;

pub use areas::{Areas, read_geojson, read_polygons};
pub use crown::{CrownError, grow_crown};
pub use crs::{Axes, Crs, Heights, Length, TargetSystem, UtmZone};
pub use discs::read_discs;
pub use error::AssetError;
pub use faces::mesh_of_faces;
pub use gltf::{GltfError, read_gltf};
pub use import::Import;
pub(crate) use instances::degrees_to_metres;
pub use instances::{StemRow, StemTable, read_instances};
pub use obj::read_obj;
pub use ply::{PlyError, read_ply};
pub(crate) use raster::companions;
pub use raster::{
    Assumed, BandDescription, BandRaster, LayerTerm, Projection, Raster, RasterBand, RasterError,
    RasterExtent, RasterFile, RasterGeoreference, RasterLayers, Scaling, read_bands, read_raster,
};
pub use spectrum::{
    SpectrumColumns, SpectrumFormat, SpectrumPoint, SpectrumProblem, SpectrumTable, read_spectrum,
};

/// Value from a file, with warnings for the author of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// Value.
    pub value: T,
    /// Each a sentence that names the file.
    pub warnings: Vec<String>,
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#[allow(clippy::float_cmp, reason = "what is read back is exact")]
mod tests;
