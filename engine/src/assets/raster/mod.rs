//! Rasters: ESRI ASCII grids, ENVI files, Esri's `.bil` and `.flt`, and `GeoTIFF`.

mod ascii;
mod bands;
mod directory;
mod envi;
mod envi_library;
mod error;
mod esri;
mod geokeys;
mod geotiff;
mod layers;
mod metadata;
mod names;
mod raw;
mod sidecar;
mod strange;
mod tiff_picture;
mod window;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::AssetError;
use super::crs::{Axes, Crs, Heights};
use super::format::{self, FileReader};
use super::text::open;

pub use bands::{BandRaster, RasterBand, read_bands};
pub(super) use envi_library::{EnviLibrary, is_spectral_library};
pub use error::RasterError;
pub use layers::{BandDescription, LayerTerm, RasterFile, RasterLayers};
pub use metadata::Scaling;
pub(crate) use sidecar::companions;
pub use window::RasterExtent;

pub use crate::components::Projection;

/// Most cells of a raster: 512 MiB of values.
const MOST_CELLS: u64 = 1 << 26;

/// Values of cells, north up.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// Cells from west to east.
    pub columns: usize,
    /// Cells from north to south.
    pub rows: usize,
    /// Values with the file's scale and offset applied, shape `[rows, columns]`, row 0 in the north;
    /// NaN where there is no data.
    pub values: Vec<f64>,
    /// Georeference, if the file has one.
    pub place: Option<RasterGeoreference>,
    /// Names of classes by their value, if it is an ENVI classification; else empty.
    pub class_names: Vec<String>,
    /// Unit of its values, if the file says so.
    pub heights: Option<Heights>,
    /// Cells without data by a value that the file does not name as such.
    pub assumed: Option<Assumed>,
}

/// A value that most likely stands for no data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assumed {
    /// The value as it is stored.
    pub value: f64,
    /// Number of cells that hold it.
    pub count: usize,
}

/// Georeference of a raster, in the units of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct RasterGeoreference {
    /// South-west corner of the south-westernmost cell (not its centre), in the unit of the coordinates.
    pub corner: DVec2,
    /// Width and height of a cell, in the same unit.
    pub cell: DVec2,
    /// Coordinate reference system, as far as the file says.
    pub crs: Crs,
    /// Projection as ENVI names it, if it is an ENVI file.
    pub projection: Option<Projection>,
}

impl RasterGeoreference {
    /// The georeference in the system that a file beside the raster names, if the raster names none.
    fn or_in(self, crs: Option<Crs>) -> Self {
        match crs {
            Some(crs) if self.crs.name.is_empty() => Self { crs, ..self },
            _ => self,
        }
    }
}

impl Raster {
    /// Returns whether its coordinates are degrees, or must be taken for degrees: cells of a twentieth and less
    /// within the globe's range and not at its origin.
    #[must_use]
    pub fn is_in_degrees(&self) -> bool {
        self.place.as_ref().is_some_and(|place| match place.crs.axes {
            Axes::Degrees => true,
            Axes::Metres | Axes::Length(_) | Axes::World | Axes::Geocentric => false,
            Axes::Unknown => {
                let far = place.corner + place.cell * self.size_in_cells();
                let within = place.corner.x >= -180.0
                    && far.x <= 360.0
                    && place.corner.y >= -90.0
                    && far.y <= 90.0;
                within && place.cell.max_element() < 0.05 && place.corner != DVec2::ZERO
            }
        })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size_in_cells(&self) -> DVec2 {
        DVec2::new(self.columns as f64, self.rows as f64)
    }

    /// Number of cells without data.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.values.iter().filter(|value| value.is_nan()).count()
    }

    /// The raster itself when all in it is lawful.
    fn checked(self) -> Result<Self, RasterError> {
        if let Some(index) = self.values.iter().position(|value| value.is_infinite()) {
            let (column, row) = (index % self.columns, index / self.columns);
            return Err(RasterError::Infinite { column, row });
        }
        let place = self.place.as_ref().map(|place| (place.corner, place.cell));
        match place {
            Some((corner, cell))
                if !(cell.is_finite() && corner.is_finite() && cell.min_element() > 0.0) =>
            {
                Err(RasterError::BadCell { width: cell.x, height: cell.y })
            }
            _ => Ok(self),
        }
    }
}

/// Reads the first band of a raster, or of a part of it; the format follows from the content.
///
/// ENVI rasters and those of Esri may be named by their values or by their header. What a file does
/// not say is looked up in those beside it that GDAL writes and reads: `.prj`, `.aux.xml`, `.msk`
/// and world files.
///
/// # Errors
/// What the file lacks or says wrongly.
pub fn read_raster(path: &Path, extent: Option<&RasterExtent>) -> Result<Raster, AssetError> {
    let raster = match RasterFormat::of_file(path)? {
        RasterFormat::Tiff => geotiff::read(path, extent),
        RasterFormat::Envi(header) => envi::read(path, &header, extent),
        RasterFormat::Esri(header) => esri::read(path, &header, extent),
        RasterFormat::Ascii => return ascii::read(path, extent, None),
    };
    let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
    raster.and_then(Raster::checked).map_err(wrong)
}

/// Format of a raster, with the header of values that lie beside one.
enum RasterFormat {
    Tiff,
    Envi(PathBuf),
    Esri(PathBuf),
    Ascii,
}

impl RasterFormat {
    /// Format of a file by its content and by those beside it.
    fn of_file(path: &Path) -> Result<Self, AssetError> {
        let start = start_of(path)?;
        let wrong = |problem| AssetError::Raster { file: path.to_owned(), problem };
        if is_tiff(&start) {
            Ok(Self::Tiff)
        } else if let Some(header) = envi::header_of(path, &start) {
            Ok(Self::Envi(header))
        } else if let Some(problem) = strange::format_of(&start) {
            Err(wrong(problem))
        } else if let Some(header) = esri::header_of(path) {
            Ok(Self::Esri(header))
        } else {
            format::check(path, FileReader::Raster)?;
            if strange::is_binary(&start) {
                Err(wrong(RasterError::Binary))
            } else {
                Ok(Self::Ascii)
            }
        }
    }
}

/// First bytes of a file, by which its format is told.
fn start_of(path: &Path) -> Result<Vec<u8>, AssetError> {
    let mut start = Vec::new();
    open(path)?
        .take(512)
        .read_to_end(&mut start)
        .map_err(|cause| AssetError::Unreadable { file: path.to_owned(), cause })?;
    Ok(start)
}

fn is_tiff(start: &[u8]) -> bool {
    [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|magic| start.starts_with(magic))
}

/// The number of cells as the file claims it, if a raster can have so many.
fn cells(columns: u64, rows: u64) -> Result<usize, RasterError> {
    match columns.checked_mul(rows) {
        Some(0) => Err(RasterError::Empty { columns, rows }),
        Some(count) if count <= MOST_CELLS => Ok(count as usize),
        _ => Err(RasterError::TooMany { columns, rows, most: MOST_CELLS }),
    }
}

/// Returns whether a value stands for no data; programs round the largest numbers when they write them.
#[expect(clippy::float_cmp, reason = "an infinite value for no data is equal or is not")]
fn is_no_data(value: f64, no_data: Option<f64>) -> bool {
    value.is_nan()
        || no_data.is_some_and(|no| {
            value == no || no.is_finite() && (value - no).abs() <= 2e-6 * no.abs()
        })
}

/// Returns whether a value stands for no data in many files and is no value of heights, densities or classes.
fn is_usual_no_data(value: f64) -> bool {
    const USUAL: [f64; 6] =
        [-9999.0, -99_999.0, -999_999.0, -32_767.0, -32_768.0, -2_147_483_648.0];
    USUAL.contains(&value) || value.is_finite() && value.abs() >= 1e30
}

/// A value for no data as programs write it; `None` if it is none.
fn parse_no_data(text: &str) -> Option<f64> {
    let text = text.trim_matches(['\0', ' ', '\t', '"']);
    let lower = text.to_ascii_lowercase();
    match lower.trim_start_matches(['+', '-']) {
        // As C writes numbers on some systems.
        "1.#qnan" | "1.#ind" | "1.#snan" | "nan(ind)" | "nan(snan)" => Some(f64::NAN),
        "1.#inf" if lower.starts_with('-') => Some(f64::NEG_INFINITY),
        "1.#inf" => Some(f64::INFINITY),
        _ => text.parse().ok(),
    }
}

fn length(file: &File) -> u64 {
    file.metadata().map_or(0, |data| data.len())
}
