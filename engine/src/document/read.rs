//! Reading: a file or a text to a scene, with all that is wrong in it.

use std::io;
use std::path::Path;

use super::check::check_readable;
use super::decode::{Decode, Findings, Reader};
use super::diagnostic::Diagnostic;
use super::params::{settle_params, survey};
use super::scene::Scene;
use super::source::Source;
use super::syntax::parse;

/// A scene file may hold so many bytes; large stands belong into tables.
const FILE_SIZE: u64 = 256 << 20;

/// How a scene is to be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Parameters to set, by name; they go before those of the file and of the variant.
    pub set: Vec<(String, f64)>,
    /// The variant to apply.
    pub variant: Option<String>,
}

/// A scene as it was read.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The scene, with placeholders where it could not be read.
    pub scene: Scene,
    /// The text it was read from.
    pub source: Source,
    /// All that is wrong, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

impl Reading {
    /// Whether nothing is wrong that keeps the scene from running.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        !self.diagnostics.iter().any(Diagnostic::is_error)
    }

    /// What a person reads: each diagnostic with its place.
    #[must_use]
    pub fn render(&self) -> String {
        self.source.render(&self.diagnostics)
    }
}

/// Why there is nothing to read a scene from.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum ReadError {
    #[error("cannot read {file}: {source}")]
    Io { file: String, source: io::Error },
    #[error("{file} is a folder: name the scene file in it")]
    Folder { file: String },
    #[error(
        "{file} holds {bytes} bytes, more than the {limit} that a scene file may hold: put long lists into tables (CSV)"
    )]
    TooLarge { file: String, bytes: u64, limit: u64 },
    #[error("{file} is {found}, not UTF-8 text: save it as UTF-8")]
    NotUtf8 { file: String, found: String },
    #[error("{file} is empty: a scene starts with `Scene(` and ends with `)`")]
    Empty { file: String },
    #[error("{rendered}")]
    Syntax { diagnostic: Box<Diagnostic>, rendered: String },
}

/// The scene of a file.
///
/// # Errors
/// Where the file cannot be read, or is not RON. Whatever else is wrong with the scene is among
/// [`Reading::diagnostics`].
pub fn read_file(path: &Path, options: &Options) -> Result<Reading, ReadError> {
    let file = path.display().to_string();
    let io_error = |source| ReadError::Io { file: file.clone(), source };
    let metadata = std::fs::metadata(path).map_err(io_error)?;
    if metadata.is_dir() {
        return Err(ReadError::Folder { file });
    }
    if metadata.len() > FILE_SIZE {
        return Err(ReadError::TooLarge { file, bytes: metadata.len(), limit: FILE_SIZE });
    }
    let bytes = std::fs::read(path).map_err(io_error)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let found = if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            "UTF-16 text".to_owned()
        } else {
            let line = bytes[..valid].split(|&byte| byte == b'\n').count();
            format!("something else from line {line} on")
        };
        ReadError::NotUtf8 { file: file.clone(), found }
    })?;
    read_text(&file, &text, options)
}

/// The scene of a text; `name` is what places in it are called by.
///
/// # Errors
/// Where the text is not RON. Whatever else is wrong with the scene is among
/// [`Reading::diagnostics`].
pub fn read_text(name: &str, text: &str, options: &Options) -> Result<Reading, ReadError> {
    let file = name.to_owned();
    if text.len() as u64 > FILE_SIZE {
        return Err(ReadError::TooLarge { file, bytes: text.len() as u64, limit: FILE_SIZE });
    }
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(ReadError::Empty { file });
    }
    if text.contains('\0') {
        return Err(ReadError::NotUtf8 { file, found: "UTF-16 or binary".to_owned() });
    }
    let source = Source::new(name, text);
    let tree = parse(text).map_err(|error| {
        let place = source.place_of(error.span);
        let diagnostic = Diagnostic::error("", error.message).at(place);
        let diagnostic = Diagnostic { help: error.help, ..diagnostic };
        let rendered = source.describe(&diagnostic).trim_end().to_owned();
        ReadError::Syntax { diagnostic: Box::new(diagnostic), rendered }
    })?;

    let mut reader = Reader::new(&source);
    let params = settle_params(&tree, options, &mut reader);
    survey(&tree, &params, &mut reader);
    let mut scene = Scene::decode(&tree, &mut reader);
    scene.params = params;
    let Findings { mut diagnostics, dropped, broken } = reader.finish();

    let source = source.with_tree(tree);
    if dropped == 0 {
        diagnostics.extend(check_readable(&scene, &broken));
    }
    for diagnostic in &mut diagnostics {
        if diagnostic.place.is_none() && !diagnostic.path.is_empty() {
            diagnostic.place = source.place(&diagnostic.path);
        }
    }
    // What has no place of its own stands last.
    diagnostics.sort_by_key(|one| one.place.as_ref().map_or(u32::MAX, |place| place.span.start));
    if dropped > 0 {
        diagnostics.push(Diagnostic::error("", format!("and {dropped} more errors")));
    }
    Ok(Reading { scene, source, diagnostics })
}

impl Scene {
    /// The scene as a file: what is read back from it is equal.
    #[must_use]
    pub fn to_ron(&self) -> String {
        use super::encode::{Encode as _, Text};
        match self.encode() {
            Text::Group { items, .. } => Text::record("Scene", items).into_file(),
            leaf @ Text::Leaf(_) => leaf.into_file(),
        }
    }
}
