use std::path::Path;

use super::failure::one_line;
use super::provenance::{self, FileHashes};
use super::reading::{folder_of, read};
use super::setting::setting;
use super::staging::{stage_with, staged};
use super::{Failure, Options, Progress, SceneWorld};
use crate::document::{Reading, Scene};
use crate::extract::{SceneOptics, Setting, Stage};

/// A scene and its world: what every question about a scene is asked of, be it answered by a run or not.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct LoadedScene {
    /// The scene as read, with where its parts stand in the text.
    pub reading: Reading,
    /// Its world, with all derived components.
    pub world: SceneWorld,
}

impl LoadedScene {
    /// Reads a scene file and makes its world; builds no ray engine.
    ///
    /// # Errors
    /// All errors of the scene, rendered for a person.
    pub fn from_file(
        path: &Path,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Self, Failure> {
        progress.stage("reading the scene");
        let reading = read(path, options)?;
        progress.stage("loading");
        let world = SceneWorld::from_scene(&reading.scene, folder_of(path))
            .map_err(|problems| Failure::Problems(problems).with_source(&reading.source))?;
        Ok(Self { reading, world })
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.reading.scene
    }

    /// Warnings about the scene, one line each.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let of_world = self.world.diagnostics();
        self.reading.diagnostics.iter().chain(&of_world).map(one_line).collect()
    }

    /// Builds the stage of the scene, with its ray engine.
    ///
    /// # Errors
    /// If the ray engine takes more memory than there is, or it refuses a mesh or an instance.
    pub fn stage(&mut self, options: &Options, progress: &dyn Progress) -> Result<Stage, Failure> {
        progress.stage("building");
        let Self { reading, world } = self;
        let optics = SceneOptics::from_world(&world.world, reading.scene.bands.len());
        staged(world, &reading.scene, &optics, options.free_memory())
            .map_err(|failure| failure.with_source(&reading.source))
    }

    /// Builds the stage of the scene as if its rectangle did not repeat, for pictures of it from outside. Its ray engine is
    /// not kept for other stages.
    ///
    /// # Errors
    /// As of [`stage`](Self::stage).
    pub fn isolated_stage(
        &self,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<Stage, Failure> {
        progress.stage("building");
        let Self { reading, world } = self;
        let isolated = Setting { is_periodic: false, ..setting(&reading.scene) };
        let optics = SceneOptics::from_world(&world.world, reading.scene.bands.len());
        stage_with(None, world, &isolated, &optics, options.free_memory())
            .map_err(|failure| failure.with_source(&reading.source))
    }

    /// Returns the hash of the scene as it was resolved and of the content of each file that it reads, hexadecimal.
    ///
    /// # Errors
    /// If a file cannot be read again.
    pub fn hash(&self) -> Result<String, Failure> {
        let files = self.world.resources.messages.files();
        provenance::hash(self.scene(), &files, &FileHashes::default())
    }
}
