mod land_cover;
mod no_data;
mod raster;
mod steepness;

use glam::{DVec2, DVec3};
use hecs::World;

use super::Resources;
use super::georeference::{MapFrame, frame_projection};
use super::load_meshes::{load, note_file, part_materials};
use crate::components::TerrainPatch;
use crate::document::{self, Diagnostic, ScenePath, Terrain};
use crate::terrain::{self, Ground, plane};

use raster::raster_patch;

/// Minimum extent of the ground, m: positions within it would be rounding, and a mesh would reach over more
/// periodic tiles than can be counted.
const SMALLEST_M: f64 = 1e-3;

/// Triangulates the terrain. Reads `document::Terrain`, `document::Prototype` of a terrain that is a mesh, and the frame;
/// writes [`TerrainPatch`], [`Ground`] and [`MapFrame`] of the terrain.
pub(super) fn triangulate_terrain(world: &mut World, resources: &mut Resources) {
    let entity = resources.terrain;
    // Whatever is absent already need not be removed.
    drop(world.remove::<(TerrainPatch, Ground)>(entity));
    let mut map = MapFrame::from_frame(resources);
    let patch = {
        let terrain = world.get::<&Terrain>(entity).expect("`spawn` gives the terrain its source");
        terrain_patch(&terrain, world, &mut map, resources)
    };
    world.insert_one(entity, map).expect("the terrain exists");
    if let Some(patch) = patch {
        let ground = Ground::of(&patch);
        world.insert(entity, (patch, ground)).expect("the terrain exists");
    }
}

/// Ground of a terrain; `None` after an error.
fn terrain_patch(
    terrain: &Terrain,
    world: &World,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<TerrainPatch> {
    let patch = patch_of_any_size(terrain, world, map, resources)?;
    let DVec2 { x, y } = patch.size;
    if x.min(y) >= SMALLEST_M {
        return Some(patch);
    }
    let path = match terrain {
        Terrain::Plane(_) => ScenePath::from(["terrain", "size_m"]),
        Terrain::Raster(_) | Terrain::Mesh { .. } => "terrain".into(),
    };
    let message = format!("the ground is {x:?} m x {y:?} m: at least {SMALLEST_M} m are expected");
    let problem = Diagnostic::error(path, message).help("extents are in metres");
    resources.report(problem);
    None
}

fn patch_of_any_size(
    terrain: &Terrain,
    world: &World,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<TerrainPatch> {
    let projection = frame_projection(map, resources);
    let patch = match terrain {
        Terrain::Plane(ground) => {
            let material = resources.material(&ground.material, &["terrain", "material"].into())?;
            let (corner, size) = (DVec2::from(ground.corner_m), DVec2::from(ground.size_m));
            plane(corner, size, ground.height_m, material)
        }
        Terrain::Raster(raster) => return raster_patch(raster, map, resources),
        Terrain::Mesh { mesh, at_m } => mesh_patch(mesh, DVec3::from(*at_m), world, resources)?,
    };
    Some(TerrainPatch { projection, ..patch })
}

/// Ground of a mesh prototype.
fn mesh_patch(
    name: &str,
    at: DVec3,
    world: &World,
    resources: &mut Resources,
) -> Option<TerrainPatch> {
    resources.prototype(name, &["terrain", "mesh"].into())?;
    let mesh = world.get::<&document::Prototype>(resources.meshes[name]);
    let mesh = mesh.expect("`spawn` gives each mesh prototype its source");
    note_file(&mesh, resources);
    let path = ScenePath::from("meshes").name(name);
    let loaded = match load(&mesh, &resources.folder) {
        Ok(loaded) => loaded,
        Err(error) => {
            resources.report(Diagnostic::error(path, error.to_string()));
            return None;
        }
    };
    let warnings = loaded.warnings.into_iter().map(|w| Diagnostic::warning(&path, w));
    warnings.for_each(|warning| resources.report(warning));
    let materials = part_materials(&mesh, &loaded.value, &path, resources);
    let names = loaded.value.parts.iter().map(|part| part.name.clone());
    let parts = names.zip(materials).collect();
    let patch = terrain::mesh(&loaded.value, at, parts, resources.is_periodic());
    if patch.is_none() {
        let message = format!("`{name}` covers no ground: it has no extent to the east or north");
        resources.report(
            Diagnostic::error(["terrain", "mesh"], message)
                .help("check `up` of the mesh: it says which axis of the file points up"),
        );
    }
    patch
}
