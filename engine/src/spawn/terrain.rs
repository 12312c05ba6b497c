use glam::{DVec2, DVec3};

use super::Spawner;
use super::meshes::load;
use crate::components::{MaterialId, TerrainPatch};
use crate::document::{Boundary, Diagnostic, Sensor, Terrain, check_maps, unknown_name};
use crate::terrain::{self, plane};

/// Minimum extent of the ground, m: positions within it would be rounding, and a mesh would reach over more
/// periodic tiles than can be counted.
const SMALLEST_M: f64 = 1e-3;

impl Spawner<'_> {
    /// The terrain, unless something is wrong with it.
    pub(super) fn terrain(&mut self) -> Option<TerrainPatch> {
        let patch = self.patch()?;
        let DVec2 { x, y } = patch.size;
        if x.min(y) >= SMALLEST_M {
            return Some(patch);
        }
        let path = match &self.scene.terrain {
            Terrain::Plane { .. } => "terrain.size_m",
            Terrain::Raster { .. } | Terrain::Mesh { .. } => "terrain",
        };
        let message =
            format!("the ground is {x:?} m x {y:?} m: at least {SMALLEST_M} m are expected");
        let problem = Diagnostic::error(path, message).help("extents are in metres");
        self.problems.push(problem);
        None
    }

    fn patch(&mut self) -> Option<TerrainPatch> {
        let scene = self.scene;
        let projection = self.frame_projection();
        let patch = match &scene.terrain {
            Terrain::Plane { size_m, material, corner_m, height_m } => {
                let material = self.known_material(material, "terrain.material")?;
                plane(DVec2::from(*corner_m), DVec2::from(*size_m), *height_m, material)
            }
            Terrain::Raster { .. } => return self.raster(),
            Terrain::Mesh { mesh, at_m } => self.terrain_mesh(mesh, DVec3::from(*at_m))?,
        };
        Some(TerrainPatch { projection, ..patch })
    }

    pub(super) fn is_periodic(&self) -> bool {
        self.scene.boundary == Boundary::Periodic
    }

    fn terrain_mesh(&mut self, name: &str, at: DVec3) -> Option<TerrainPatch> {
        let scene = self.scene;
        let Some(mesh) = scene.meshes.get(name) else {
            let known = scene.meshes.keys().map(String::as_str);
            self.problems.push(unknown_name("terrain.mesh", "mesh", name, known));
            return None;
        };
        self.note_file(mesh);
        let path = format!("meshes.{name}");
        let loaded = match load(mesh, self.folder) {
            Ok(loaded) => loaded,
            Err(error) => {
                self.problems.push(Diagnostic::error(path, error.to_string()));
                return None;
            }
        };
        let warnings = loaded.warnings.into_iter().map(|w| Diagnostic::warning(&path, w));
        self.problems.extend(warnings);
        let materials: Vec<MaterialId> = self.part_materials(mesh, &loaded.value, &path);
        let names = loaded.value.parts.iter().map(|part| part.name.clone());
        let parts = names.zip(materials).collect();
        let patch = terrain::mesh(&loaded.value, at, parts, self.is_periodic());
        if patch.is_none() {
            let message =
                format!("`{name}` covers no ground: it has no extent to the east or north");
            self.problems.push(
                Diagnostic::error("terrain.mesh", message)
                    .help("check `up` of the mesh: it says which axis of the file points up"),
            );
        }
        patch
    }

    /// Maps of fluxes over ground whose extent its file tells.
    pub(super) fn check_flux_maps(&mut self, size: DVec2) {
        if matches!(self.scene.terrain, Terrain::Plane { .. }) {
            return;
        }
        for (name, sensor) in &self.scene.sensors {
            let Sensor::Photons { measure, .. } = sensor else { continue };
            for (index, measure) in measure.iter().enumerate() {
                let path = format!("sensors.{name}.measure[{index}]");
                let bands = self.scene.bands.len();
                self.problems.extend(check_maps(&path, measure, bands, size.into()));
            }
        }
    }
}
