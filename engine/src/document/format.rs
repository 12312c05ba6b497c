//! The normal form of a scene file.

use std::path::Path;

use super::read::{ReadError, parse_text, text_of_file};
use super::ron_text::normal_form;
use super::source::Source;

/// A scene file in its normal form; formatting that once more changes nothing.
///
/// Values stay as they are written. A group of values stands on one line where it has room and its
/// author has put no comma behind the last, one value a line elsewhere. Comments keep their places,
/// and of blank lines between values one.
///
/// # Errors
/// Where the text is not RON.
pub fn format(name: &str, text: &str) -> Result<String, ReadError> {
    let tree = parse_text(&Source::new(name, text))?;
    Ok(normal_form(text, &tree))
}

/// The text of a scene file as it is, and in its normal form.
///
/// # Errors
/// Where the file cannot be read, or is not RON.
pub fn format_file(path: &Path) -> Result<(String, String), ReadError> {
    let text = text_of_file(path, true)?;
    let formatted = format(&path.display().to_string(), &text)?;
    Ok((text, formatted))
}
