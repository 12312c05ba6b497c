//! Reading of recipes out of results.

use std::io;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::super::manifest::SUMMARY;
use super::extract::{Extracted, recipe_of};
use super::record::{FORMAT, IN_SUMMARY, RecipeRecord, unpacked};

/// Reason why a file does not say how to repeat its run.
#[non_exhaustive]
#[expect(missing_docs, reason = "each variant's message names its fields")]
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    #[error("cannot read {}", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{} is none of the files that sunfleck writes: name a result of `sunfleck run`, such as its summary.json", path.display())]
    NotAResult { path: PathBuf },
    #[error("{} does not say how it was made: it is {kind} of another program, or of a command that has no single run, such as `sweep`; name a result of `sunfleck run`", path.display())]
    Missing { path: PathBuf, kind: &'static str },
    #[error("{} holds results of `sunfleck {command}`, which `rerun` does not repeat: run `sunfleck {command}` again", path.display())]
    OtherCommand { path: PathBuf, command: String },
    #[error("{} is damaged: {what}; name another file of the same run", path.display())]
    Damaged { path: PathBuf, what: String },
    #[error("{} was written by sunfleck {version}, whose recipes this version ({}) does not know: use that or a newer one", path.display(), env!("CARGO_PKG_VERSION"))]
    Newer { path: PathBuf, version: String },
}

/// Reads how to repeat the run that wrote a file, or the files of a folder.
///
/// # Errors
/// If the file says nothing of it, is damaged, or was written by a newer version.
pub fn read_record(path: &Path) -> Result<RecipeRecord, RecordError> {
    let path = &if path.join(SUMMARY).is_file() { path.join(SUMMARY) } else { path.to_owned() };
    let extracted = recipe_of(path).map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData | io::ErrorKind::UnexpectedEof => {
            RecordError::Damaged { path: path.clone(), what: error.to_string() }
        }
        _ => RecordError::Read { path: path.clone(), source: error },
    })?;
    match extracted {
        Extracted::Recipe(text) if text == IN_SUMMARY && !path.ends_with(SUMMARY) => {
            let folder = path.parent().unwrap_or(Path::new(""));
            // The summary holds the recipe itself.
            read_record(&folder.join(SUMMARY))
        }
        Extracted::Recipe(text) => parsed(path, &text),
        Extracted::OtherCommand(command) => {
            Err(RecordError::OtherCommand { path: path.clone(), command })
        }
        Extracted::Nothing(kind) => Err(RecordError::Missing { path: path.clone(), kind }),
        Extracted::NotAResult => Err(RecordError::NotAResult { path: path.clone() }),
    }
}

/// Fields that every version of the record has.
#[derive(Deserialize)]
struct RecordHead {
    format: u32,
    #[serde(default)]
    version: String,
}

fn parsed(path: &Path, text: &str) -> Result<RecipeRecord, RecordError> {
    let damaged = |what: String| RecordError::Damaged { path: path.to_owned(), what };
    let json = unpacked(text).map_err(|what| damaged(format!("its recipe: {what}")))?;
    let not_json = |error: serde_json::Error| damaged(format!("its recipe: {error}"));
    let RecordHead { format, version } = serde_json::from_str(&json).map_err(not_json)?;
    if format > FORMAT {
        return Err(RecordError::Newer { path: path.to_owned(), version });
    }
    let record: RecipeRecord = serde_json::from_str(&json).map_err(not_json)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    Ok(RecipeRecord { results: folder.unwrap_or(Path::new(".")).to_owned(), ..record })
}
