use hecs::World;

use super::Resources;
use super::measure_bounds::placed_meshes;
use super::warn_implausible_plants::TALLEST;
use crate::components::MeshBounds;
use crate::document::{Diagnostic, Prototype, ScenePath};

/// A mesh that a unit below a metre makes smaller than this, m, was most likely in metres.
const SMALLEST: f32 = 0.3;

/// Warns of meshes from files that are larger than any plant. Reads `document::Prototype` and [`MeshBounds`] of placed
/// meshes.
pub(super) fn warn_mesh_sizes(world: &mut World, resources: &mut Resources) {
    for mesh in placed_meshes(world).values() {
        let name = &mesh.name;
        let unit = match &*world
            .get::<&Prototype>(resources.meshes[name.as_str()])
            .expect("`spawn` gives each mesh prototype its source")
        {
            Prototype::Obj(obj) => obj.unit_m,
            Prototype::Ply(ply) => ply.unit_m,
            Prototype::Gltf(_) | Prototype::Discs { .. } => 1.0,
            Prototype::Faces { .. } | Prototype::Crown(_) => continue,
        };
        let Some(MeshBounds { low, high }) = mesh.bounds else { continue };
        let size = (high - low).max_element();
        if unit < 1.0 && size < SMALLEST {
            let message = format!("`{name}` is {size:.3} m large, with a unit of {unit} m");
            let help = "if the coordinates of its file are in metres, write `unit_m: 1.0`";
            let path = ScenePath::from("meshes").name(name);
            resources.report(Diagnostic::warning(path, message).help(help));
        }
        if f64::from(size) > TALLEST {
            let message = format!("`{name}` is {size:.0} m large");
            let help = "if its file is in centimetres, write `unit_m: 0.01`; in millimetres, \
                            `unit_m: 0.001`";
            let path = ScenePath::from("meshes").name(name);
            resources.report(Diagnostic::warning(path, message).help(help));
        }
    }
}
