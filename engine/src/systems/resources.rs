use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use hecs::Entity;

use super::georeference::CoordinateSystem;
use super::map_reflectance::ReadMap;
use super::resolve_bands::BandResponses;
use super::spectra::LastLeaf;
use super::{Changes, Messages};
use crate::components::{MaterialId, PrototypeId, SceneExtents, SceneId};
use crate::document::{
    Bands, Boundary, Diagnostic, Frame, Map, NamePattern, ScenePath, Spectrum, unknown_name,
};

/// Data of a scene that belongs to no entity: settings, entities by name, and messages.
#[derive(Clone, Debug)]
pub struct Resources {
    /// Folder that paths of files are relative to.
    pub folder: PathBuf,
    /// Anchor of the local frame on the map.
    pub frame: Frame,
    /// Boundary of the scene.
    pub boundary: Boundary,
    /// Seed of the random streams.
    pub seed: u64,
    /// Spectral bands.
    pub bands: Bands,
    /// Responses of the bands, and the irradiance that fractions are weighted with.
    pub responses: BandResponses,
    /// Named spectra.
    pub spectra: Map<Spectrum>,
    /// Patterns of instances that are left out.
    pub hide: Vec<NamePattern>,
    /// Patterns of instances that are kept; all if empty.
    pub select: Vec<NamePattern>,
    /// True if a sensor measures emitted light.
    pub measures_emission: bool,

    /// Materials; the place of each is its [`MaterialId`].
    pub materials: Map<Entity>,
    /// Mesh prototypes; the place of each is its [`PrototypeId`].
    pub meshes: Map<Entity>,
    /// Plantings in document order.
    pub plantings: Vec<Entity>,
    /// Sensors in document order.
    pub sensors: Map<Entity>,
    /// The terrain.
    pub terrain: Entity,
    /// The sun.
    pub sun: Entity,
    /// The sky.
    pub sky: Entity,

    /// Coordinate reference system of the frame; `None` if the scene does not name one.
    pub frame_crs: Option<CoordinateSystem>,
    /// Materials that the ground and placed meshes have, each with the first mesh in document order that has it; `None`
    /// if only the ground does.
    pub used_materials: BTreeMap<MaterialId, Option<SceneId>>,
    /// Extents of all geometry.
    pub extents: SceneExtents,

    /// Kinds that changed and that systems further down the schedule may depend on.
    pub changes: Changes,
    /// Messages of the systems.
    pub messages: Messages,
    /// The leaf that PROSPECT has computed last: its reflectance and transmittance are asked for one after the other.
    pub(super) last_leaf: Option<LastLeaf>,
    /// Maps of reflectance that have been read.
    pub(super) reflectance_maps: Vec<ReadMap>,
}

impl Resources {
    /// Resources of an empty world; paths in scenes are relative to `folder`.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            frame: Frame { origin_m: (0.0, 0.0, 0.0), crs: None },
            boundary: Boundary::Isolated,
            seed: 0,
            bands: Bands::default(),
            responses: BandResponses::default(),
            spectra: Map::new(),
            hide: Vec::new(),
            select: Vec::new(),
            measures_emission: false,
            materials: Map::new(),
            meshes: Map::new(),
            plantings: Vec::new(),
            sensors: Map::new(),
            terrain: Entity::DANGLING,
            sun: Entity::DANGLING,
            sky: Entity::DANGLING,
            frame_crs: None,
            used_materials: BTreeMap::new(),
            extents: SceneExtents::default(),
            changes: Changes::NONE,
            messages: Messages::default(),
            last_leaf: None,
            reflectance_maps: Vec::new(),
        }
    }

    /// Returns whether the terrain's rectangle repeats without end.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.boundary == Boundary::Periodic
    }

    /// Path of a file that the scene names; notes that it is read.
    pub fn file(&mut self, name: &str) -> PathBuf {
        let path = self.folder.join(name);
        self.messages.file(path.clone());
        path
    }

    /// Adds an error or a warning.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        self.messages.report(diagnostic);
    }

    /// Material of a name; reports an error at `path` if there is none.
    pub fn material(&mut self, name: &str, path: &ScenePath) -> Option<MaterialId> {
        let index = self.materials.get_index_of(name);
        if index.is_none() {
            let known = self.materials.keys().map(String::as_str);
            let problem = unknown_name(path, "material", name, known);
            self.report(problem);
        }
        index.map(|index| MaterialId(index as u32))
    }

    /// Mesh prototype of a name; reports an error at `path` if there is none.
    pub fn prototype(&mut self, name: &str, path: &ScenePath) -> Option<PrototypeId> {
        let index = self.meshes.get_index_of(name);
        if index.is_none() {
            let known = self.meshes.keys().map(String::as_str);
            let problem = unknown_name(path, "mesh", name, known);
            self.report(problem);
        }
        index.map(|index| PrototypeId(index as u32))
    }
}
