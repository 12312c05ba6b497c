//! Size of files before they are written.

use crate::document::FileFormat;
use crate::products::ProductSize;

/// Size of a number and its separator in a table, bytes: about that of the shortest text that reads back as the
/// same f64.
const NUMBER: u64 = 20;

/// Size of a number or name on an axis, bytes: these have few digits.
const PLACE: u64 = 8;

/// Size of the headers and the legend of an image's files, and of the header of a table, bytes.
const HEADERS: u64 = 12_000;
const HEADER: u64 = 300;

/// Size of an opaque pixel in the PNG with a legend and in that without, bytes.
const PIXEL: u64 = 2 * 2;

/// Size of the files of a product before it is measured, bytes. Compression, the digits of numbers and headers are
/// estimated.
#[must_use]
pub fn file_size(extent: ProductSize, formats: &[FileFormat]) -> u64 {
    match extent {
        ProductSize::Image { pixels, bands, .. } => {
            let values = 4 * (2 * bands + 1);
            let pixel = |format| match format {
                FileFormat::Exr | FileFormat::Envi | FileFormat::Zarr | FileFormat::NetCdf => {
                    values
                }
                // Overviews have a third of the pixels.
                FileFormat::GeoTiff => values * 4 / 3,
                FileFormat::Png => PIXEL,
            };
            let all = FileFormat::ALL.into_iter().filter(|format| formats.contains(format));
            let pixel = all.map(pixel).sum();
            pixels.saturating_mul(pixel).saturating_add(HEADERS)
        }
        ProductSize::Table { rows, axes, bands } => {
            // Once in the table, once in the summary.
            let row = 2 * NUMBER * 2 * bands + PLACE * axes;
            let of_datasets = datasets(formats) * (16 * bands + PLACE * axes);
            rows.saturating_mul(row + of_datasets).saturating_add(HEADER)
        }
        // Of a triangle three corners with their colour, their numbers, its colour; and the values.
        ProductSize::Faces { faces, bands } => {
            faces.saturating_mul(3 * 15 + 13 + 3 + 8 * bands).saturating_add(HEADER)
        }
    }
}

/// Number of data sets in these formats.
fn datasets(formats: &[FileFormat]) -> u64 {
    let all = [FileFormat::Zarr, FileFormat::NetCdf];
    all.iter().filter(|format| formats.contains(format)).count() as u64
}

/// Rows of tiles of a band that a `GeoTIFF` or a Zarr store is made of: as numbers, as bytes, and compressed.
const COPIES: u64 = 3;

/// Additional memory for making the files of a product, bytes.
#[must_use]
pub fn memory_of_files(extent: ProductSize, formats: &[FileFormat]) -> u64 {
    let row_of_tiles = |format| match format {
        FileFormat::GeoTiff => super::geotiff::TILE as u64,
        FileFormat::Zarr => super::zarr::TILE as u64,
        FileFormat::Exr | FileFormat::Envi | FileFormat::Png | FileFormat::NetCdf => 0,
    };
    let tiles = match extent {
        ProductSize::Image { width, pixels, .. } => {
            let rows = formats.iter().map(|format| row_of_tiles(*format)).max().unwrap_or(0);
            COPIES * 4 * width.saturating_mul(rows).min(pixels)
        }
        ProductSize::Table { .. } | ProductSize::Faces { .. } => 0,
    };
    // When the tiles are made, all blocks of rows are gone.
    extent.memory_of_files().max(tiles)
}
