//! Document and assets to entities; every error of the scene in one pass, each with its place.

mod astray;
mod beside;
mod canopy;
mod crossing;
mod doubts;
mod files;
mod fill;
mod georaster;
mod heights;
mod images;
mod instances;
mod land_cover;
mod lay;
mod light;
mod materials;
mod meshes;
mod parts;
mod plausible;
mod raster;
mod reach;
mod relief;
mod scatter;
mod sensors;
mod spectra;
mod spectrum_table;
mod standing;
mod stems;
mod systems;
mod terrain;
mod thermal;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DVec2;
use hecs::{Entity, Or, World};

use crate::assets::Axes;
use crate::components::{MaterialId, Mesh, PartMaterials, Placement, SceneId, TerrainPatch};
use crate::document::{Diagnostic, Scene};
use crate::terrain::Ground;
use lay::Georeference;
use systems::System;

pub use files::missing_files;
pub(crate) use files::named_files;
use reach::{Origins, Reach};

/// A world, and how it came about.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct Spawned {
    /// All entities of the scene.
    pub world: World,
    /// Files that were read, without repetition, in document order.
    pub files: Vec<PathBuf>,
    /// Definitions that nothing uses and that were not built.
    pub skipped: Vec<String>,
    /// What was taken without a word in the scene, or left out of its files.
    pub notes: Vec<String>,
    /// What the author should know.
    pub warnings: Vec<Diagnostic>,
    /// The same of meshes, instances and terrain alone.
    of_geometry: Notes,
}

impl Spawned {
    /// Extent of all geometry.
    pub(crate) fn reach(&self) -> &Reach {
        &self.of_geometry.reach
    }

    /// Places in the document that instances come from.
    pub(crate) fn origins(&self) -> &Origins {
        &self.of_geometry.origins
    }
}

/// What spawning notes on the way.
#[derive(Clone, Default)]
struct Notes {
    files: Vec<PathBuf>,
    skipped: Vec<String>,
    remarks: Vec<String>,
    problems: Vec<Diagnostic>,
    reach: Reach,
    origins: Origins,
}

/// What the steps of spawning share.
pub(crate) struct Spawner<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    files: Vec<PathBuf>,
    skipped: Vec<String>,
    notes: Vec<String>,
    problems: Vec<Diagnostic>,
    reach: Reach,
    origins: Origins,
    /// South-west corner and extent of the ground, m.
    rectangle: (DVec2, DVec2),
    /// Where rasters lie; `None` if that of the terrain does not say.
    georeference: Option<Georeference>,
    /// What the coordinates of the terrain's raster are by its file.
    terrain_axes: Axes,
    /// Coordinate reference system of the scene, as soon as something says it.
    system: Option<System>,
}

/// Makes the world of a scene; paths in it are relative to `folder`.
///
/// Meshes, spectra and materials that nothing uses are neither read nor built.
///
/// # Errors
/// All that is wrong with the scene.
pub fn spawn(scene: &Scene, folder: &Path) -> Result<Spawned, Vec<Diagnostic>> {
    let missing = missing_files(scene, folder);
    if !missing.is_empty() {
        return Err(missing);
    }
    let mut spawner = Spawner::new(scene, folder, Notes::default());
    let mut world = World::new();
    spawner.frame_system();
    let patch = spawner.terrain();
    let ground = patch.as_ref().map(Ground::of);
    if let (Some(patch), Some(ground)) = (&patch, &ground) {
        spawner.doubt_overhangs(patch, ground);
        spawner.warn_flat_raster(patch);
        spawner.doubt_seams(ground);
    }
    let meshes = spawner.meshes();
    let placements = spawner.instances(&meshes, ground.as_ref());
    spawner.check_patterns();
    let meshes = spawner.keep_placed(meshes, &placements);
    if let Some(ground) = &ground {
        spawner.check_standing(&placements, &meshes, ground);
        spawner.doubt_places(&placements, &meshes, ground);
    }
    spawner.doubt_sizes(&meshes);
    if let Some(ground) = &ground {
        spawner.warn_implausible_plants(&placements, &meshes, ground.size().element_product());
    }
    if let Some(patch) = &patch {
        spawner.check_reach(&placements, &meshes, patch);
    }
    world.spawn_batch(patch.into_iter().map(|patch| (SceneId(0), patch)));
    let of_geometry = spawner.notes();
    for (id, mesh) in meshes {
        world.spawn((SceneId(id), mesh.name, mesh.mesh, mesh.materials));
    }
    world.spawn_batch(placements.into_iter().map(|placement| (placement,)));
    spawner.finish(world, of_geometry)
}

/// The world of another scene that has the same meshes, instances and terrain; only the rest is
/// made anew.
///
/// # Errors
/// All that is wrong with the scene.
pub fn respawn(spawned: Spawned, scene: &Scene, folder: &Path) -> Result<Spawned, Vec<Diagnostic>> {
    let missing = missing_files(scene, folder);
    if !missing.is_empty() {
        return Err(missing);
    }
    let Spawned { mut world, of_geometry, .. } = spawned;
    let others: Vec<Entity> = world
        .query::<Entity>()
        .without::<Or<&Mesh, Or<&Placement, &TerrainPatch>>>()
        .iter()
        .collect();
    for entity in others {
        // It was found there just now.
        drop(world.despawn(entity));
    }
    Spawner::new(scene, folder, of_geometry.clone()).finish(world, of_geometry)
}

impl<'a> Spawner<'a> {
    fn new(scene: &'a Scene, folder: &'a Path, notes: Notes) -> Self {
        let Notes { files, skipped, remarks, problems, reach, origins } = notes;
        let (x, y, _) = scene.frame.origin_m;
        let georeference = Some(Georeference {
            from: DVec2::new(x, y),
            to: DVec2::ZERO,
            scale: DVec2::ONE,
            is_of_degrees: false,
            is_given: false,
        });
        let rectangle = (DVec2::ZERO, DVec2::ONE);
        let (terrain_axes, system) = (Axes::Unknown, None);
        Self {
            scene,
            folder,
            files,
            skipped,
            notes: remarks,
            problems,
            reach,
            origins,
            rectangle,
            georeference,
            terrain_axes,
            system,
        }
    }

    fn notes(&self) -> Notes {
        Notes {
            files: self.files.clone(),
            skipped: self.skipped.clone(),
            remarks: self.notes.clone(),
            problems: self.problems.clone(),
            reach: self.reach.clone(),
            origins: self.origins.clone(),
        }
    }

    /// Spawns all that is no geometry.
    fn finish(mut self, mut world: World, of_geometry: Notes) -> Result<Spawned, Vec<Diagnostic>> {
        let mut worn: BTreeSet<MaterialId> = world
            .query::<&PartMaterials>()
            .iter()
            .flat_map(|materials| materials.0.iter().copied())
            .collect();
        for patch in &mut world.query::<&TerrainPatch>() {
            worn.extend(patch.materials.0.iter().copied());
            self.rectangle = (patch.corner, patch.size);
            self.check_flux_maps(patch.size);
            self.doubt_images();
            self.warn_buried_sensors(patch, &world);
        }
        self.check_crossings();
        self.materials(&worn, &mut world);
        self.light(&mut world);
        self.emission(&mut world);
        self.sensors(&mut world);
        let Spawner { mut files, skipped, notes, problems, .. } = self;
        let mut seen = BTreeSet::new();
        files.retain(|file| seen.insert(file.clone()));
        if problems.iter().any(Diagnostic::is_error) {
            return Err(problems);
        }
        Ok(Spawned { world, files, skipped, notes, warnings: problems, of_geometry })
    }

    /// The path of a file that the scene names, and a note that it was read.
    fn file(&mut self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.files.push(path.clone());
        path
    }
}
