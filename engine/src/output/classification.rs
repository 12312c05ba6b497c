//! Classes as ENVI classification files: bytes, with names and colours in the header.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::ops::Range;

use super::band_rows::BandRows;
use super::envi::RasterSize;
use crate::products::{Class, Image, Rendering};

/// The classes of an image, if it holds numbers of classes.
pub(super) fn classes_of(image: &Image) -> Option<&[Class]> {
    match &image.rendering {
        // Numbers are bytes, and 0 is none of the classes.
        Rendering::Classes(classes) if classes.len() < 256 => Some(classes),
        _ => None,
    }
}

/// The number of each pixel's class, 0 where it has none.
pub(super) fn bytes(block: &BandRows) -> Vec<u8> {
    let number = |value: &f32| if value.is_finite() { value.clamp(0.0, 255.0) as u8 } else { 0 };
    block.values(0).iter().map(number).collect()
}

/// Reads the numbers of rows back; NaN where a pixel has no class.
pub(super) fn read_rows(
    size: RasterSize,
    rows: Range<usize>,
    mut file: &File,
) -> io::Result<Vec<f32>> {
    let mut bytes = vec![0; rows.len() * size.width];
    file.seek(SeekFrom::Start((rows.start * size.width) as u64))?;
    file.read_exact(&mut bytes)?;
    let number = |byte| if byte == 0 { f32::NAN } else { f32::from(byte) };
    Ok(bytes.into_iter().map(number).collect())
}

/// Lines of a header that name the classes and their colours.
pub(super) fn header_lines(classes: &[Class]) -> String {
    let mut colours = "0, 0, 0".to_owned();
    let mut names = "no data".to_owned();
    for Class { name, colour: [r, g, b] } in classes {
        // Writing to a string does not fail.
        let _infallible = write!(colours, ", {r}, {g}, {b}");
        let _infallible = write!(names, ", {name}");
    }
    let count = classes.len() + 1;
    format!(
        "classes = {count}\nclass lookup = {{{colours}}}\nclass names = {{{names}}}\ndata ignore value = 0\n"
    )
}
