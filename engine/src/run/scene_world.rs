use std::path::Path;
use std::sync::Arc;

use hecs::World;

use crate::accel;
use crate::document::{Diagnostic, Scene};
use crate::spawn::{missing_files, spawn};
use crate::systems::{Changes, Resources, run_schedule};

/// World of a scene, which follows changes of the scene and derives anew only what depends on them.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct SceneWorld {
    /// Entities with their components.
    pub world: World,
    /// Settings, entities by name, and messages.
    pub resources: Resources,
    /// Ray engine of the scene; `None` until it is built, and after a change of the geometry.
    pub(super) geometry: Option<Arc<accel::TwoLevelBvh>>,
    /// Number of times that the ray engine was built.
    pub(super) builds: usize,
    /// Names of the systems that the last change made run.
    pub ran: Vec<&'static str>,
}

impl SceneWorld {
    /// Empty world; paths in scenes are relative to `folder`.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        let (world, resources) = (World::new(), Resources::new(folder));
        Self { world, resources, geometry: None, builds: 0, ran: Vec::new() }
    }

    /// World of a scene.
    ///
    /// # Errors
    /// All errors of the scene.
    pub fn from_scene(scene: &Scene, folder: &Path) -> Result<Self, Vec<Diagnostic>> {
        let mut world = Self::new(folder);
        world.set(scene)?;
        Ok(world)
    }

    /// Makes the next stage build the ray engine anew, after a change of meshes that no system has made.
    pub fn forget_geometry(&mut self) {
        self.geometry = None;
    }

    /// Warnings about the scene; errors too if it has any.
    #[must_use]
    pub fn diagnostics(&self) -> Vec<Diagnostic> {
        self.resources.messages.diagnostics().cloned().collect()
    }

    /// Makes the world that of a scene. Meshes, spectra and materials that nothing uses are neither read nor built.
    ///
    /// # Errors
    /// All errors of the scene.
    pub fn set(&mut self, scene: &Scene) -> Result<(), Vec<Diagnostic>> {
        let missing = missing_files(scene, &self.resources.folder);
        if !missing.is_empty() {
            return Err(missing);
        }
        let changes = spawn(scene, &mut self.world, &mut self.resources);
        let run = run_schedule(&mut self.world, &mut self.resources, changes);
        if run.changes.intersects(Changes::GEOMETRY) {
            self.geometry = None;
        }
        self.ran = run.ran;
        let diagnostics = self.diagnostics();
        if diagnostics.iter().any(Diagnostic::is_error) { Err(diagnostics) } else { Ok(()) }
    }
}
