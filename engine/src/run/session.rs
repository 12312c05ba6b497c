use std::path::{Path, PathBuf};

use super::pool::in_pool;
use super::reading::{folder_of, read};
use super::scene_world::SceneWorld;
use super::{Failure, Options, Progress, run_in, scene_source};
use crate::document::{Reading, Scene};
use crate::products::Report;

/// Runs of a scene file that is read once, with changes to the scene: each run derives anew only what depends on its
/// changes.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct Session {
    reading: Reading,
    file: PathBuf,
    options: Options,
    world: SceneWorld,
}

impl Session {
    /// Reads a scene file.
    ///
    /// # Errors
    /// All errors of the scene, rendered for a person.
    pub fn read(file: &Path, options: &Options) -> Result<Self, Failure> {
        let reading = read(file, options)?;
        let world = SceneWorld::new(folder_of(file));
        Ok(Self { reading, file: file.to_owned(), options: options.clone(), world })
    }

    /// The scene as its author wrote it.
    #[must_use]
    pub const fn scene(&self) -> &Scene {
        &self.reading.scene
    }

    /// Runs a scene that was made from it; `quality` multiplies that of the options.
    ///
    /// # Errors
    /// All errors of the scene.
    pub fn run(
        &mut self,
        scene: &Scene,
        quality: f64,
        progress: &dyn Progress,
    ) -> Result<Report, Failure> {
        let mut options = self.options.clone();
        options.quality *= quality;
        let (file, source, world) = (&self.file, &self.reading.source, &mut self.world);
        let report = in_pool(&options, || {
            run_in(world, scene, &options, progress).map_err(|failure| failure.with_source(source))
        });
        report.map(|report| Report { source: Some(scene_source(file, &options)), ..report })
    }
}
