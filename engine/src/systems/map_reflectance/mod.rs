mod layers;
mod values;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use hecs::World;

use super::georeference::{
    MapFrame, RasterQuantity, RasterSource, check_georaster, extent_on_map, locate_raster,
};
use super::spectra::{self, resolve_spectrum};
use super::{Resources, set_component};
use crate::assets::{
    AssetError, LayerTerm, Raster, RasterError, RasterExtent, RasterFile, RasterLayers, Scaling,
    companions,
};
use crate::components::{
    CellLayout, MappedReflectance, MaterialId, ReflectanceCells, SceneId, SurfaceOptics,
    TerrainPatch,
};
use crate::document::{Diagnostic, Material, ReflectanceMap, ScenePath};
use crate::geometry::{Rectangle, place_text};

use layers::{MapLayers, choose_layers};
use values::{LayerNames, check_values};

/// A map that has been read, and what it was read from.
#[derive(Clone, Debug)]
pub(super) struct ReadMap {
    source: MapSource,
    grid: Raster,
    cells: Arc<ReflectanceCells>,
}

/// All that the values of a map depend on.
#[derive(Clone, Debug, PartialEq)]
struct MapSource {
    /// The file and those beside it, with the times of their last change.
    files: Vec<(PathBuf, Option<SystemTime>)>,
    terrain: Rectangle,
    extent: Option<RasterExtent>,
    terms: Vec<LayerTerm>,
    scaling: Option<Scaling>,
    /// Reflectance of cells without data, by layer.
    elsewhere: Option<Vec<f32>>,
}

/// Reads the maps of the ground's reflectance. Reads `document::Material`, [`TerrainPatch`] and [`MapFrame`], and the
/// resources `spectra`, `bands`, `responses` and `used_materials`; writes [`SurfaceOptics`] of materials that are maps.
///
/// Maps that have not changed since the last run are not read again.
pub(super) fn map_reflectance(world: &mut World, resources: &mut Resources) {
    let known = std::mem::take(&mut resources.reflectance_maps);
    let mut frame = world.get::<&MapFrame>(resources.terrain).ok().map(|map| (*map).clone());
    let materials: Vec<_> =
        resources.materials.iter().map(|(name, &entity)| (name.clone(), entity)).collect();
    for (index, (name, entity)) in materials.into_iter().enumerate() {
        let map =
            match &*world.get::<&Material>(entity).expect("`spawn` gives materials their source") {
                Material::ReflectanceMap(map) => map.clone(),
                _ => continue,
            };
        let path = ScenePath::from("materials").name(&name);
        let is_of_ground = match resources.used_materials.get(&MaterialId(index as u32)) {
            Some(&Some(mesh)) => {
                refuse_mesh(mesh, &name, &path, resources);
                false
            }
            Some(None) => true,
            None => false,
        };
        let optics = match (terrain(world, resources), &mut frame) {
            (Some(terrain), Some(frame)) if is_of_ground => {
                let mut site = Site { path, terrain, frame, known: &known, resources };
                site.mapped(&map)
            }
            _ => None,
        };
        set_component(world, entity, optics.map(SurfaceOptics::Mapped));
    }
}

/// Rectangle of the ground, if there is any.
fn terrain(world: &World, resources: &Resources) -> Option<Rectangle> {
    let patch = world.get::<&TerrainPatch>(resources.terrain).ok()?;
    Some(Rectangle { min: patch.corner, max: patch.corner + patch.size })
}

/// Refuses a map on a mesh that stands on the ground.
fn refuse_mesh(mesh: SceneId, name: &str, path: &ScenePath, resources: &mut Resources) {
    let (mesh, _) =
        resources.meshes.get_index(mesh.0 as usize).expect("meshes are numbered in order");
    let message = format!(
        "`{name}` is a map of the ground's reflectance, but the mesh `{mesh}` has it as a material"
    );
    let help = "give the mesh a material of its own, such as `Lambertian(reflectance: Constant(0.3))`: \
                a map is for the terrain alone";
    resources.report(Diagnostic::error(path, message).help(help));
}

/// A map that is to be read, and where it belongs.
struct Site<'a> {
    /// Path of the material.
    path: ScenePath,
    terrain: Rectangle,
    frame: &'a mut MapFrame,
    known: &'a [ReadMap],
    resources: &'a mut Resources,
}

impl Site<'_> {
    /// Reflectance of a map; `None` after an error, and where there are no bands.
    fn mapped(&mut self, map: &ReflectanceMap) -> Option<MappedReflectance> {
        // `document::check` refuses a scene without bands.
        if self.resources.bands.is_empty() {
            return None;
        }
        let quantity = spectra::SpectrumQuantity::Reflectance;
        let elsewhere = match &map.elsewhere {
            None => None,
            Some(spectrum) => {
                let path = self.path.key("elsewhere");
                Some(resolve_spectrum(spectrum, quantity, &path, self.resources)?)
            }
        };
        let path = self.resources.file(&map.file);
        let mut files = vec![path.clone()];
        files.extend(companions(&path));
        for companion in &files[1..] {
            self.resources.messages.file(companion.clone());
        }
        let mut file = self.or_report(RasterFile::open(&path))?;
        let MapLayers { terms, of_bands, elsewhere } =
            choose_layers(map, file.bands(), elsewhere.as_deref(), &self.path, self.resources)?;
        let scaling = map.scale.map(|scale| Scaling { scale, offset: map.offset });
        if scaling.is_none() && !terms.iter().all(|term| file.bands()[term.band].has_scaling()) {
            let message = "the file does not say in which unit its values are".to_owned();
            let help = "write `scale: 1.0` for fractions, 0.01 for percent, 0.0001 for reflectances \
                        that are kept as 0 to 10000";
            self.report("file", message, help);
            return None;
        }
        let changed = |file: PathBuf| {
            let time = std::fs::metadata(&file).and_then(|data| data.modified()).ok();
            (file, time)
        };
        let source = MapSource {
            files: files.into_iter().map(changed).collect(),
            terrain: self.terrain,
            extent: extent_on_map(self.terrain, self.frame),
            terms,
            scaling,
            elsewhere,
        };
        let read = match self.known.iter().find(|known| known.source == source) {
            Some(known) => {
                // Messages about it were those of the last run alone.
                self.check(map, &known.grid)?;
                known.clone()
            }
            None => self.read(map, &mut file, source, &of_bands)?,
        };
        let cells = read.cells.clone();
        self.resources.reflectance_maps.push(read);
        Some(MappedReflectance::new(cells, of_bands))
    }

    /// Reads the values of a map.
    fn read(
        &mut self,
        map: &ReflectanceMap,
        file: &mut RasterFile,
        source: MapSource,
        of_bands: &[u32],
    ) -> Option<ReadMap> {
        let mut read = |extent| file.read(extent, &source.terms, source.scaling);
        let layers = match read(source.extent.as_ref()) {
            // Maps without a place lie over the whole terrain.
            Err(AssetError::Raster { problem: RasterError::WindowOfNowhere, .. }) => read(None),
            layers => layers,
        };
        let RasterLayers { grid, mut values } = self.or_report(layers)?;
        self.check(map, &grid)?;
        let path = self.path.key("file");
        let (corner, size) = locate_raster(&grid, self.terrain, &path, self.frame, self.resources)?;
        let layout = CellLayout { columns: grid.columns, rows: grid.rows, corner, size };
        let covered = Rectangle { min: corner, max: corner + size };
        self.check_cover(covered, source.elsewhere.is_some())?;
        let names = LayerNames { bands: &self.resources.bands, of_bands };
        let elsewhere = source.elsewhere.as_deref();
        if let Err(problem) = check_values(&mut values, layout, elsewhere, source.scaling, &names) {
            self.report("file", problem.message, &problem.help);
            return None;
        }
        values.extend(source.elsewhere.iter().flatten());
        let layer_count = source.terms.iter().map(|term| term.layer + 1).max().unwrap_or(1);
        let cells = Arc::new(ReflectanceCells::new(layout, layer_count, values));
        Some(ReadMap { source, grid, cells })
    }

    /// Checks the coordinate reference system and the unit of a raster, and its values for no data.
    fn check(&mut self, map: &ReflectanceMap, grid: &Raster) -> Option<()> {
        let path = self.path.key("file");
        let source = RasterSource::new(&map.file, &path, RasterQuantity::Reflectance);
        check_georaster(grid, &source, self.frame, self.resources)
    }

    /// Refuses a map that leaves ground without a reflectance.
    fn check_cover(&mut self, covered: Rectangle, has_elsewhere: bool) -> Option<()> {
        let Rectangle { min, max } = self.terrain;
        let room = 1e-6 * (max - min);
        let covers = covered.min.cmple(min + room).all() && covered.max.cmpge(max - room).all();
        if covers || has_elsewhere {
            return Some(());
        }
        let message = format!(
            "the map reaches from {} to {} m, the terrain from {} to {} m",
            place_text(covered.min),
            place_text(covered.max),
            place_text(min),
            place_text(max)
        );
        let help = "write `elsewhere: Constant(0.2)` for the ground beside it; rasters lie where their \
                    files say, less `frame.origin_m`";
        self.report("file", message, help);
        None
    }

    fn or_report<T>(&mut self, read: Result<T, AssetError>) -> Option<T> {
        let report = |error: AssetError| {
            self.resources.report(Diagnostic::error(self.path.key("file"), error.to_string()));
        };
        read.map_err(report).ok()
    }

    fn report(&mut self, key: &'static str, message: String, help: &str) {
        let problem = Diagnostic::error(self.path.key(key), message).help(help);
        self.resources.report(problem);
    }
}
