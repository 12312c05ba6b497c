use crate::products::ProductSize;

/// Size of a number in a table, with what parts it from the next, bytes: about what the shortest
/// text takes that reads back as the same f64.
const NUMBER: u64 = 20;

/// Size of a number or name that tells where a value lies: these have few digits.
const PLACE: u64 = 8;

/// Size of what an image's files, its legend among them, or a table hold beside their values, bytes.
const HEADERS: u64 = 12_000;
const HEADER: u64 = 300;

/// Size of an opaque pixel in the PNG with a legend and in that without, bytes.
const PIXEL: u64 = 2 * 2;

/// Size of the files of a product that is to be measured, bytes: exact but for compression, for how
/// many digits its numbers have, and for headers.
#[must_use]
pub fn file_size(extent: ProductSize) -> u64 {
    match extent {
        ProductSize::Image { pixels, bands } => {
            // EXR and ENVI: values, errors and coverage each; PNG.
            let pixel = 2 * 4 * (2 * bands + 1) + PIXEL;
            pixels.saturating_mul(pixel).saturating_add(HEADERS)
        }
        ProductSize::Table { rows, axes, bands } => {
            // Once in the table, once in the summary.
            let row = 2 * NUMBER * 2 * bands + PLACE * axes;
            rows.saturating_mul(row).saturating_add(HEADER)
        }
        // Of a triangle three corners with their colour, their numbers, its colour; and the values.
        ProductSize::Faces { faces, bands } => {
            faces.saturating_mul(3 * 15 + 13 + 3 + 8 * bands).saturating_add(HEADER)
        }
    }
}
