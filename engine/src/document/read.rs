//! Reading: a file or a text to a scene, with all that is wrong in it.

use std::io;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

use super::diagnostic::{Diagnostic, nearest};
use super::encode::Encode as _;
use super::parsed::ParsedScene;
use super::path::ScenePath;
use super::ron_text::{Group, Node, Text, parse};
use super::scene::{FileFormat, Param, Scene};
use super::source::Source;

/// A scene may hold so many bytes, included files among them; large stands belong into tables.
pub(super) const FILE_SIZE: u64 = 256 << 20;

/// Options for reading a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Parameters to set, by name; they go before those of the file, of the variant and of the point.
    pub set: Vec<(String, Param)>,
    /// Parameters at a point of a sweep; they go before those of the file and of the variant.
    pub point: Vec<(String, Param)>,
    /// The variant to apply.
    pub variant: Option<String>,
    /// File formats of images, in place of those of the file.
    pub output: Option<Vec<FileFormat>>,
}

/// A scene as it was read.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The scene, with placeholders where it could not be read.
    pub scene: Scene,
    /// The text it was read from.
    pub source: Arc<Source>,
    /// Errors and warnings, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
    pub(super) options: ReadOptions,
}

impl Reading {
    /// Returns whether the scene has no error, so that it can run.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        !self.diagnostics.iter().any(Diagnostic::is_error)
    }

    /// Text of all diagnostics, each with its place.
    #[must_use]
    pub fn render(&self) -> String {
        self.source.render(&self.diagnostics)
    }
}

/// Reason why no scene could be read.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum ReadError {
    #[error("cannot read {file}: {source}")]
    Io { file: String, source: io::Error },
    #[error("there is no file {file}{near}")]
    Missing { file: String, near: String },
    #[error("{file} is a folder: name the scene file in it")]
    Folder { file: String },
    #[error("{file} is neither a file nor a folder")]
    NoFile { file: String },
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
pub fn read_file(path: &Path, options: &ReadOptions) -> Result<Reading, ReadError> {
    Ok(ParsedScene::from_file(path)?.read(options))
}

/// Number of names in a folder among which the nearest is looked for.
const MOST_NAMES: usize = 10_000;

/// Text about the file that was meant where there is none: the nearest name of a scene in its folder.
fn nearby(path: &Path) -> String {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let Ok(entries) = std::fs::read_dir(folder.unwrap_or_else(|| Path::new("."))) else {
        let shown = folder.unwrap_or(path).display();
        return format!(": there is no folder {shown} that can be read");
    };
    let names = entries.flatten().take(MOST_NAMES).map(|entry| entry.file_name());
    let mut names: Vec<String> = names
        .filter(|name| Path::new(name).extension().is_some_and(|ending| ending == "ron"))
        .filter_map(|name| name.into_string().ok())
        .collect();
    names.sort_unstable();
    let wrong = path.file_name().unwrap_or_default().to_string_lossy();
    nearest(&wrong, names.iter().map(String::as_str)).map_or_else(String::new, |near| {
        format!(": did you mean `{}`?", path.with_file_name(near).display())
    })
}

/// The text of a scene file. What is no file on a disk (a pipe, say) might never end or never start:
/// whether that will do is for the caller to say.
///
/// # Errors
/// If it cannot be read, or is not UTF-8 text.
pub fn text_of_file(path: &Path, only_files: bool) -> Result<String, ReadError> {
    let file = path.display().to_string();
    let io_error = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => ReadError::Missing { file: file.clone(), near: nearby(path) },
        _ => ReadError::Io { file: file.clone(), source },
    };
    let metadata = std::fs::metadata(path).map_err(io_error)?;
    if metadata.is_dir() {
        return Err(ReadError::Folder { file });
    }
    if only_files && !metadata.is_file() {
        return Err(ReadError::NoFile { file });
    }
    let mut bytes = Vec::new();
    let opened = std::fs::File::open(path).map_err(io_error)?;
    opened.take(FILE_SIZE + 1).read_to_end(&mut bytes).map_err(io_error)?;
    let length = metadata.len().max(bytes.len() as u64);
    if length > FILE_SIZE {
        return Err(ReadError::TooLarge { file, bytes: length, limit: FILE_SIZE });
    }
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
    refuse_odd(&file, &text)?;
    Ok(text)
}

/// The tree of a scene's text as it stands: formulas and includes are values. `name` stands for its file in messages.
///
/// # Errors
/// Where the text is not RON.
pub fn tree_of_text(name: &str, text: &str) -> Result<Node, ReadError> {
    refuse_odd(name, text)?;
    parse_text(&Source::new(name, text))
}

/// The tree of a text.
pub(super) fn parse_text(source: &Source) -> Result<Node, ReadError> {
    parse(source.text()).map_err(|error| {
        let place = source.place_of(error.span);
        let diagnostic = Diagnostic::error(ScenePath::root(), error.message).at(place);
        let diagnostic = Diagnostic { help: error.help, ..diagnostic };
        let rendered = source.describe(&diagnostic).trim_end().to_owned();
        ReadError::Syntax { diagnostic: Box::new(diagnostic), rendered }
    })
}

/// Texts that cannot be a scene.
pub(super) fn refuse_odd(file: &str, text: &str) -> Result<(), ReadError> {
    let file = file.to_owned();
    if text.len() as u64 > FILE_SIZE {
        return Err(ReadError::TooLarge { file, bytes: text.len() as u64, limit: FILE_SIZE });
    }
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(ReadError::Empty { file });
    }
    if text.contains('\0') {
        return Err(ReadError::NotUtf8 { file, found: "UTF-16 or binary".to_owned() });
    }
    Ok(())
}

/// The scene of a text; `name` is what places in it are called by, and files that it includes are
/// relative to the folder of `name`.
///
/// # Errors
/// Where the text is not RON. Whatever else is wrong with the scene is among
/// [`Reading::diagnostics`].
pub fn read_text(name: &str, text: &str, options: &ReadOptions) -> Result<Reading, ReadError> {
    Ok(ParsedScene::new(name, text)?.read(options))
}

impl Scene {
    /// The scene as a file: what is read back from it is equal.
    #[must_use]
    pub fn to_ron(&self) -> String {
        self.to_text().into_file()
    }

    /// The scene on one line, which reads back as an equal one.
    #[must_use]
    pub fn to_ron_line(&self) -> String {
        self.to_text().into_line()
    }

    pub(super) fn to_text(&self) -> Text {
        match self.encode() {
            Text::Group(Group { items, .. }) => Text::record("Scene", items),
            leaf @ Text::Leaf(_) => leaf,
        }
    }
}
