use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use super::Failure;
use crate::document::{Ends, FileFormat, Fisheye, Perspective, Scene, Sensor};
use crate::files;

/// Hash of a scene as it was resolved and of the content of each file that it reads, hexadecimal.
/// Equal hashes, versions and seeds give equal results.
pub(super) fn hash(
    scene: &Scene,
    files: &[PathBuf],
    known: &FileHashes,
) -> Result<String, Failure> {
    Ok(scene_hash(scene, files, known)?.to_hex().to_string())
}

pub(super) fn scene_hash(
    scene: &Scene,
    files: &[PathBuf],
    known: &FileHashes,
) -> Result<blake3::Hash, Failure> {
    let mut hasher = blake3::Hasher::new();
    // Numbers are the same in every format.
    let scene = Scene { output: FileFormat::DEFAULT.to_vec(), ..scene.resolved() };
    hasher.update(scene.to_ron().as_bytes());
    for path in files {
        hasher.update(known.of(path)?.as_bytes());
    }
    Ok(hasher.finalize())
}

/// Hashes of results that depend on all of these: each made of its own and of all.
pub(super) fn joint_hashes(own: &[&str]) -> Vec<String> {
    let mut all = blake3::Hasher::new();
    for hash in own {
        all.update(hash.as_bytes());
    }
    let joint = |hash: &&str| all.clone().update(hash.as_bytes()).finalize().to_hex().to_string();
    own.iter().map(joint).collect()
}

/// Hash of a scene without the stop criteria of its sensors: scenes with equal hashes draw the same samples.
pub(super) fn stream_hash(scene: &Scene, files: &[PathBuf]) -> Result<[u8; 32], Failure> {
    let mut scene = scene.clone();
    without_stop_criteria(&mut scene);
    Ok(*scene_hash(&scene, files, &FileHashes::default())?.as_bytes())
}

/// Removes all that says how long sensors measure.
pub(super) fn without_stop_criteria(scene: &mut Scene) {
    for sensor in scene.sensors.values_mut() {
        match sensor {
            Sensor::Orthographic(sensor) => {
                (sensor.samples_per_px, sensor.samples_per_m2) = (None, None);
                sensor.image.until = None;
            }
            Sensor::Perspective(Perspective { samples_per_px, image, .. })
            | Sensor::Fisheye(Fisheye { samples_per_px, image, .. }) => {
                (*samples_per_px, image.until) = (2, None);
            }
            Sensor::Directions(sensor) => sensor.until = Ends(Vec::new()),
            Sensor::Photons(sensor) => (sensor.per_m2, sensor.until) = (1.0, None),
        }
    }
}

/// Hashes of what files hold, by path: each file is read once for all scenes that name it, and again if it has changed.
#[derive(Default)]
pub(super) struct FileHashes(Mutex<HashMap<PathBuf, FileHash>>);

/// Hash of a file, and what tells whether it has changed.
struct FileHash {
    length: u64,
    changed: Option<SystemTime>,
    hash: blake3::Hash,
}

impl FileHashes {
    /// Hash of what a file holds.
    pub(super) fn of(&self, path: &Path) -> Result<blake3::Hash, Failure> {
        let error = |source| Failure::Read { path: path.to_owned(), source };
        let metadata = std::fs::metadata(path).map_err(error)?;
        let (length, changed) = (metadata.len(), metadata.modified().ok());
        // Threads that ask for the same file wait for the first, which reads it.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.get(path)
            && (known.length, known.changed) == (length, changed)
        {
            return Ok(known.hash);
        }
        let file = files::open(path).map_err(error)?;
        let hash = blake3::Hasher::new().update_reader(file).map_err(error)?.finalize();
        known.insert(path.to_owned(), FileHash { length, changed, hash });
        Ok(hash)
    }
}
