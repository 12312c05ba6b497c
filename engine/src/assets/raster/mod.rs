//! Rasters: ESRI ASCII grids, ENVI files and `GeoTIFF`.

mod ascii;
mod directory;
mod envi;
mod error;
mod geotiff;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::DVec2;

use super::AssetError;
use super::text::open;

pub(crate) use envi::companion;
pub use error::RasterError;

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
    /// Values, shape `[rows, columns]`, row 0 in the north; NaN where there is no data.
    pub values: Vec<f64>,
    /// Where it lies, if the file says so.
    pub place: Option<Place>,
    /// Names of classes by their value, if it is an ENVI classification; else empty.
    pub class_names: Vec<String>,
}

/// Where a raster lies, in the units of its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// South-west corner of the south-westernmost cell (its corner, not its centre).
    pub corner: DVec2,
    /// Width and height of a cell.
    pub cell: DVec2,
    /// What the coordinates are.
    pub unit: Unit,
    /// How ENVI names the projection in its `map info`: name, and what follows the size of cells.
    pub projection: Option<Projection>,
}

/// What coordinates are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Metres east and north.
    Metres,
    /// Longitude and latitude.
    Degrees,
    /// Something else, by its name.
    Other(String),
    /// The file does not say.
    Unknown,
}

impl Raster {
    /// Whether its coordinates are, or must be taken for, degrees: cells of a twentieth and less
    /// within the globe's range and not at its origin.
    #[must_use]
    pub fn is_in_degrees(&self) -> bool {
        self.place.as_ref().is_some_and(|place| match place.unit {
            Unit::Degrees => true,
            Unit::Metres | Unit::Other(_) => false,
            Unit::Unknown => {
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

/// Reads the first band of a raster; the format follows from the content.
///
/// ENVI rasters may be named by their values or by their header.
///
/// # Errors
/// What the file lacks or says wrongly.
pub fn read_raster(path: &Path) -> Result<Raster, AssetError> {
    let mut start = Vec::new();
    open(path)?
        .take(8)
        .read_to_end(&mut start)
        .map_err(|cause| AssetError::Unreadable { file: path.to_owned(), cause })?;
    let raster = if is_tiff(&start) {
        geotiff::read(open(path)?)
    } else if let Some(header) = envi::header_of(path, &start) {
        envi::read(path, &header)
    } else {
        return ascii::read(path);
    };
    let raster = raster.and_then(Raster::checked);
    raster.map_err(|problem| AssetError::Raster { file: path.to_owned(), problem })
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

/// Whether a value stands for no data: programs round the largest numbers when they write them.
fn is_no_data(value: f64, no_data: Option<f64>) -> bool {
    value.is_nan() || no_data.is_some_and(|no| (value - no).abs() <= 2e-6 * no.abs())
}

fn length(file: &File) -> u64 {
    file.metadata().map_or(0, |data| data.len())
}
