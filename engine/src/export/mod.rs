//! The geometry of a scene for other programs: glTF 2.0, PLY and LAS.
//!
//! | file | subject |
//! |---|---|
//! | `contents` | entities of the world that are written: prototypes, instances, the ground, colours |
//! | `gltf`, `buffer` | meshes once, and their instances; the binary part |
//! | `ply` | all triangles |
//! | `las`, `surface` | points on leaves, drawn uniformly by area |
//!
//! Periodic scenes are written as what the tile holds: each instance once, where it stands.

mod buffer;
mod contents;
mod gltf;
mod las;
mod ply;
mod surface;

use std::io;
use std::path::{Path, PathBuf};

use crate::output::{OutputError, put_file};
use crate::run::{Failure, LoadedScene, Progress};

use self::contents::ExportedScene;

/// File format of a scene's geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// glTF 2.0: JSON, and a binary file beside it.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// Triangles, binary.
    Ply,
    /// Points on leaves, LAS 1.4.
    Las,
    /// Points on leaves, LAS 1.4 compressed.
    Laz,
}

/// Settings of an export.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExportSettings {
    /// Format.
    pub format: ExportFormat,
    /// Number of sides of the polygons that discs become; their areas stay.
    pub disc_sides: u32,
    /// True to write a node per instance, for programs without `EXT_mesh_gpu_instancing`.
    pub is_flat: bool,
    /// Points per m² of leaf, counted on one side.
    pub points_per_m2: f64,
    /// True to draw points on wood and ground too.
    pub has_all_surfaces: bool,
    /// Largest file, bytes.
    pub limit: u64,
}

impl Default for ExportSettings {
    fn default() -> Self {
        Self {
            format: ExportFormat::Glb,
            disc_sides: 8,
            is_flat: false,
            points_per_m2: 100.0,
            has_all_surfaces: false,
            limit: 4 << 30,
        }
    }
}

/// Files of an export, and what they hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The files.
    pub files: Vec<PathBuf>,
    /// Contents of the files, one line per kind.
    pub contents: Vec<String>,
}

/// Reason why a scene is not exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum ExportError {
    #[error("{what} would take {size}, more than {limit}: {help}")]
    TooLarge { what: String, size: String, limit: String, help: &'static str },
    #[error(
        "no surface of the scene has a leaf material: add `--all-surfaces` to draw points on wood and ground"
    )]
    NoLeaves,
    #[error("{}: {source}", path.display())]
    Las { path: PathBuf, source: Box<::las::Error> },
    #[error(transparent)]
    Scene(#[from] Failure),
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Writes the geometry of a scene into a file, which appears when it is complete.
///
/// # Errors
/// If the file would be larger than the limit, or cannot be written.
pub fn export(
    loaded: &LoadedScene,
    file: &Path,
    settings: &ExportSettings,
    progress: &dyn Progress,
) -> Result<Exported, ExportError> {
    progress.stage("writing");
    let scene = ExportedScene::new(loaded)?;
    let written = |done| progress.fraction("export", done);
    match settings.format {
        // Each mesh is written once.
        ExportFormat::Gltf | ExportFormat::Glb => gltf::write(&scene, file, settings),
        ExportFormat::Ply => ply::write(&scene, file, settings, &written),
        ExportFormat::Las | ExportFormat::Laz => las::write(&scene, file, settings, &written),
    }
}

/// Writes a file in one step.
fn put(
    path: &Path,
    fill: impl FnOnce(&mut std::fs::File) -> io::Result<()>,
) -> Result<(), ExportError> {
    Ok(put_file(path, fill)?)
}
