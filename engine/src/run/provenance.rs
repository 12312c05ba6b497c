use std::path::PathBuf;

use super::Failure;
use crate::document::Scene;

/// Hash of a scene as it was resolved and of the content of each file that it reads, hexadecimal.
/// Equal hashes, versions and seeds give equal results.
pub(super) fn hash(scene: &Scene, files: &[PathBuf]) -> Result<String, Failure> {
    let mut hasher = blake3::Hasher::new();
    hasher.update(scene.to_ron().as_bytes());
    for path in files {
        let content = blake3::Hasher::new()
            .update_reader(
                std::fs::File::open(path)
                    .map_err(|source| Failure::Read { path: path.clone(), source })?,
            )
            .map_err(|source| Failure::Read { path: path.clone(), source })?
            .finalize();
        hasher.update(content.as_bytes());
    }
    Ok(hasher.finalize().to_hex().to_string())
}
