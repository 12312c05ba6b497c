//! A scene file run again and again, with changes to what measures it.

use std::path::{Path, PathBuf};

use super::scene_world::SceneWorld;
use super::{Failure, Options, Progress, folder_of, in_pool, origin, read, run_in};
use crate::document::{Reading, Scene};
use crate::products::Report;

/// A scene file that was read once. Its runs may differ in light, spectra and sensors: meshes,
/// instances and terrain are built by the first and kept for the others.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct Runs {
    reading: Reading,
    file: PathBuf,
    options: Options,
    world: SceneWorld,
}

impl Runs {
    /// Reads a scene file.
    ///
    /// # Errors
    /// All that is wrong with it, rendered for a person.
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

    /// Runs a scene that was made from it; `quality` counts on top of that of the options.
    ///
    /// # Errors
    /// All that is wrong with the scene.
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
        report.map(|report| Report { origin: Some(origin(file, &options)), ..report })
    }
}
