//! Classes as ENVI classification files: bytes, with names and colours in the header.

use std::fmt::Write as _;
use std::io::{self, Write};

use crate::products::{Class, Image, Rendering};

/// The classes of an image, if it holds numbers of classes.
pub(super) fn classes_of(image: &Image) -> Option<&[Class]> {
    match &image.rendering {
        // Numbers are bytes, and 0 is none of the classes.
        Rendering::Classes(classes) if classes.len() < 256 => Some(classes),
        _ => None,
    }
}

/// Writes the number of each pixel's class, 0 where it has none.
pub(super) fn write_pixels(image: &Image, file: &mut impl Write) -> io::Result<()> {
    let number = |value: &f32| if value.is_finite() { value.clamp(0.0, 255.0) as u8 } else { 0 };
    for row in image.values.chunks_exact(image.width) {
        file.write_all(&row.iter().map(number).collect::<Vec<u8>>())?;
    }
    Ok(())
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
