//! Recipe of a run as text.

use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::super::manifest::relative;
use super::RecipeForm;
use crate::document::Param;
use crate::products::{InputFile, Recipe, Report};

/// Longest recipe that is readable text in a file, bytes; a longer one is packed.
const READABLE: usize = 4000;

/// Longest packed recipe that every file holds, bytes; a longer one is in the summary alone.
const LARGEST: usize = 1 << 20;

/// Largest recipe that is read, bytes: the largest scene and what is beside it.
pub(super) const MOST: u64 = 512 << 20;

/// Start of a packed recipe: Base64 (RFC 4648) of a zlib stream (RFC 1950).
const PACKED: &str = "zlib:";

/// Text in place of a recipe that is too long.
pub(super) const IN_SUMMARY: &str = "in summary.json";

/// Version of the form of recipes; older programs refuse newer ones.
pub(super) const FORMAT: u32 = 1;

/// Recipe of a run as files hold it.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct RecipeRecord {
    /// Name of the program, `sunfleck`.
    pub program: String,
    /// Version of the form.
    pub format: u32,
    /// Version of the program.
    pub version: String,
    /// Hash of the scene and its files.
    pub hash: String,
    /// Folder that paths of the scene are relative to; relative to the folder of the results where possible.
    pub folder: String,
    /// Path of the scene; relative to the folder of the results where possible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene_file: Option<String>,
    /// Variant that was applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// Parameters with other values than in the scene.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub set: IndexMap<String, Param>,
    /// Values of all parameters; the scene holds what follows from them.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub params: IndexMap<String, Param>,
    /// Factor on the numbers of samples.
    pub quality: f64,
    /// See [`Recipe::keeps_coefficients`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub keeps_coefficients: bool,
    /// See [`Recipe::is_joint`].
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_joint: bool,
    /// Hash of what each input file holds, by its path.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub files: IndexMap<String, String>,
    /// The scene as it was resolved, as one line of RON.
    pub scene: String,
    /// Folder of the results that it was read from.
    #[serde(skip)]
    pub results: PathBuf,
}

impl RecipeRecord {
    /// Record of the run of a report whose results go to a folder; `None` if it cannot be repeated.
    pub(in crate::output) fn new(report: &Report, target: &Path) -> Option<Self> {
        let Recipe { scene, folder, files, quality, keeps_coefficients, is_joint } =
            report.recipe.as_deref()?;
        let source = report.source.as_ref();
        let absolute = |path: &Path| {
            path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or(path.to_owned())
        };
        // An empty path is the working folder.
        let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let file = |InputFile { path, hash }: &InputFile| {
            (path.to_string_lossy().replace('\\', "/"), hash.clone())
        };
        Some(Self {
            program: "sunfleck".to_owned(),
            format: FORMAT,
            version: report.version.clone(),
            hash: report.hash.clone(),
            folder: relative(target, &absolute(here)),
            scene_file: source.map(|source| relative(target, &absolute(&source.file))),
            variant: source.and_then(|source| source.variant.clone()),
            set: source.map(|source| source.set.iter().cloned().collect()).unwrap_or_default(),
            params: report.params.iter().cloned().collect(),
            quality: *quality,
            keeps_coefficients: *keeps_coefficients,
            is_joint: *is_joint,
            files: files.iter().map(file).collect(),
            scene: scene.clone(),
            results: target.to_owned(),
        })
    }

    /// Folder that paths of the scene are relative to, as it is found from the results.
    #[must_use]
    pub fn scene_folder(&self) -> PathBuf {
        from(&self.results, &self.folder)
    }

    /// File of the scene, as it is found from the results; it may be gone.
    #[must_use]
    pub fn scene_file(&self) -> Option<PathBuf> {
        self.scene_file.as_ref().map(|file| from(&self.results, file))
    }
}

/// A path that may lead out of a folder, without `..`.
fn from(folder: &Path, path: &str) -> PathBuf {
    let mut found = folder.canonicalize().unwrap_or(folder.to_owned());
    for component in Path::new(path).components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => drop(found.pop()),
            other => found.push(other),
        }
    }
    found
}

/// Texts of a recipe in its forms; empty if there is none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::output) struct RecipeTexts {
    readable: String,
    packed: String,
}

impl RecipeTexts {
    /// Texts of a record.
    ///
    /// # Errors
    /// If it cannot be written as JSON: never.
    pub(in crate::output) fn new(record: Option<&RecipeRecord>) -> io::Result<Self> {
        let Some(record) = record else { return Ok(Self::default()) };
        let json = serde_json::to_string(record)?;
        let mut packed = packed(&json)?;
        if packed.len() > LARGEST {
            IN_SUMMARY.clone_into(&mut packed);
        }
        let readable = if json.len() <= READABLE { json } else { packed.clone() };
        Ok(Self { readable, packed })
    }

    pub(super) fn text(&self, form: RecipeForm) -> &str {
        match form {
            RecipeForm::Readable => &self.readable,
            RecipeForm::Packed => &self.packed,
        }
    }
}

fn packed(json: &str) -> io::Result<String> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(json.as_bytes())?;
    Ok(format!("{PACKED}{}", STANDARD.encode(encoder.finish()?)))
}

/// JSON of a text of either form; an error says what is wrong with it.
pub(super) fn unpacked(text: &str) -> Result<String, String> {
    let Some(packed) = text.strip_prefix(PACKED) else { return Ok(text.to_owned()) };
    let bytes = STANDARD.decode(packed.trim()).map_err(|error| format!("Base64: {error}"))?;
    let mut json = String::new();
    let read = ZlibDecoder::new(&bytes[..]).take(MOST).read_to_string(&mut json);
    read.map_err(|error| format!("its compressed text: {error}"))?;
    Ok(json)
}
