//! Tests of the readers over files on disk.

mod areas;
mod glb;
mod gltf;
mod hostile;
mod obj;
mod ply;
mod raster;
mod tables;
mod trees;

use std::io::Write;

use tempfile::NamedTempFile;

use super::{AssetError, Import};
use crate::components::Mesh;
use crate::document::{Axis, Origin, PartsBy};

/// A file with this content, as long as the value lives.
fn file(content: impl AsRef<[u8]>) -> NamedTempFile {
    let mut file = NamedTempFile::new().unwrap();
    file.write_all(content.as_ref()).unwrap();
    file
}

/// Takes the file's coordinates as they are.
const AS_IS: Import = Import { up: Axis::Z, unit_m: 1.0, origin: Origin::File };

/// The message without the folder of its file.
fn message(error: &AssetError) -> String {
    let text = error.to_string();
    text.rsplit_once(".tmp").map_or(text.clone(), |(_, rest)| rest[6..].to_owned())
}

fn part_names(mesh: &Mesh) -> Vec<&str> {
    mesh.parts.iter().map(|part| part.name.as_str()).collect()
}

/// Asserts what every mesh promises: lawful numbers, parts that cover all primitives in order.
fn assert_lawful(mesh: &Mesh) {
    assert!(mesh.clone().checked().is_ok());
    let (mut triangles, mut discs) = (0, 0);
    for part in &mesh.parts {
        assert_eq!((part.triangles.start, part.discs.start), (triangles, discs), "{part:?}");
        assert!(part.triangles.len() + part.discs.len() > 0, "{part:?}");
        (triangles, discs) = (part.triangles.end, part.discs.end);
    }
    assert_eq!(triangles as usize, mesh.triangles.len());
    assert_eq!(discs as usize, mesh.discs.len());
    let mut used = vec![false; mesh.vertices.len()];
    mesh.triangles.iter().flatten().for_each(|&corner| used[corner as usize] = true);
    assert!(used.into_iter().all(|used| used), "no vertex is left over");
}
