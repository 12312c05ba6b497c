//! A scene that a world has followed, with all that differs between scenes of the same paths.

use std::path::PathBuf;

use super::provenance::FileHashes;
use super::scene_world::SceneWorld;
use super::setting::context;
use super::{Failure, check_scene, failure, provenance};
use crate::document::Scene;
use crate::extract::SceneOptics;
use crate::products::{Context, InputFile};

/// A scene that is ready to be measured.
pub(super) struct SettledScene {
    pub(super) scene: Scene,
    pub(super) optics: SceneOptics,
    pub(super) context: Context,
    /// Hash of the scene and its files.
    pub(super) hash: String,
    /// Folder that paths in the scene are relative to.
    pub(super) folder: PathBuf,
    /// Files that were read.
    pub(super) files: Vec<PathBuf>,
    /// These files with their hashes, by their paths in the folder of the scene.
    pub(super) inputs: Vec<InputFile>,
    pub(super) skipped: Vec<String>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
}

impl SettledScene {
    /// Makes the world that of a scene.
    ///
    /// # Errors
    /// All errors of the scene.
    pub(super) fn new(
        world: &mut SceneWorld,
        scene: Scene,
        hashes: &FileHashes,
    ) -> Result<Self, Failure> {
        check_scene(&scene)?;
        world.set(&scene).map_err(Failure::Problems)?;
        let optics = SceneOptics::from_world(&world.world, scene.bands.len());
        let messages = &world.resources.messages;
        let files = messages.files();
        let folder = &world.resources.folder;
        let input = |path: &PathBuf| {
            let hash = hashes.of(path)?.to_hex().to_string();
            let path = path.strip_prefix(folder).unwrap_or(path).to_owned();
            Ok(InputFile { path, hash })
        };
        Ok(Self {
            context: context(&scene, world.resources.responses.all(), &optics),
            folder: folder.clone(),
            hash: provenance::hash(&scene, &files, hashes)?,
            inputs: files.iter().map(input).collect::<Result<_, Failure>>()?,
            skipped: messages.skipped().cloned().collect(),
            notes: messages.notes().cloned().collect(),
            warnings: messages.diagnostics().map(failure::one_line).collect(),
            scene,
            optics,
            files,
        })
    }
}
