//! A scene that a world has followed, with all that differs between scenes of the same paths.

use std::path::PathBuf;

use super::provenance::FileHashes;
use super::scene_world::SceneWorld;
use super::setting::context;
use super::{Failure, check_scene, failure, provenance};
use crate::document::Scene;
use crate::extract::SceneOptics;
use crate::products::Context;

/// A scene that is ready to be measured.
pub(super) struct SettledScene {
    pub(super) scene: Scene,
    pub(super) optics: SceneOptics,
    pub(super) context: Context,
    /// Hash of the scene and its files.
    pub(super) hash: String,
    /// Files that were read.
    pub(super) files: Vec<PathBuf>,
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
        Ok(Self {
            context: context(&scene, world.resources.responses.all(), &optics),
            hash: provenance::hash(&scene, &files, hashes)?,
            skipped: messages.skipped().cloned().collect(),
            notes: messages.notes().cloned().collect(),
            warnings: messages.diagnostics().map(failure::one_line).collect(),
            scene,
            optics,
            files,
        })
    }
}
