use std::path::{Path, PathBuf};

use super::Failure;
use crate::document::Scene;

/// Hash of a scene as it was resolved and of the content of each file that it reads, hexadecimal.
/// Equal hashes, versions and seeds give equal results.
pub(super) fn hash(scene: &Scene, files: &[PathBuf]) -> Result<String, Failure> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(scene.resolved().to_ron().as_bytes());
    for path in files {
        hasher.update(content(path)?.as_bytes());
    }
    Ok(hasher.finalize().to_hex().to_string())
}

/// Hash of what a file holds.
pub(super) fn content(path: &Path) -> Result<blake3::Hash, Failure> {
    let error = |source| Failure::Read { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(error)?;
    Ok(blake3::Hasher::new().update_reader(file).map_err(error)?.finalize())
}
