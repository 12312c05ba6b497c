use hecs::World;

use super::Resources;
use super::measure_bounds::placed_meshes;
use crate::components::{InstanceCount, TerrainPatch};
use crate::counts::counted;
use crate::document::{Diagnostic, Per, PhotonMeasure, ScenePath, Sensor};

/// Memory of the sums of one triangle or instance in one band and of the products made of them, bytes.
const ABSORBED_BYTES: usize = 64;

/// Memory that the sums of absorbed power may take, GiB.
const MOST_GIB: f64 = 2.0;

/// Refuses sums of absorbed power that do not fit into memory. Reads `document::Sensor`, [`TerrainPatch`] and
/// [`InstanceCount`].
pub(super) fn check_absorption_memory(world: &mut World, resources: &mut Resources) {
    for (name, &entity) in &resources.sensors {
        let sensor = world.get::<&Sensor>(entity).expect("`spawn` gives sensors their source");
        let Sensor::Photons(photons) = &*sensor else { continue };
        for (index, measure) in photons.measure.iter().enumerate() {
            let PhotonMeasure::Absorbed { per } = measure else { continue };
            let path = ScenePath::from("sensors").name(name).key("measure").index(index);
            if let Some(problem) = problem(&path, *per, world, resources) {
                resources.messages.report(problem);
            }
        }
    }
}

fn problem(path: &ScenePath, per: Per, world: &World, resources: &Resources) -> Option<Diagnostic> {
    let patch = world.get::<&TerrainPatch>(resources.terrain);
    let ground = patch.map_or(0, |patch| patch.mesh.triangles.len());
    let (mut instances, mut triangles): (usize, usize) = (1, ground);
    for (id, mesh) in placed_meshes(world) {
        let count = world.get::<&InstanceCount>(resources.meshes[id as usize]);
        let count = count.map_or(0, |count| count.0 as usize);
        instances += count;
        triangles += count * mesh.primitives;
    }
    let (count, what, help) = match per {
        Per::Instance => (instances, "instance", "measure `Fapar`, by material"),
        Per::Triangle => (triangles, "triangle", "measure `Absorbed(per: Instance)`"),
    };
    let bands = resources.bands.len();
    let gib = (count * bands * ABSORBED_BYTES) as f64 / f64::from(1 << 30);
    if gib <= MOST_GIB {
        return None;
    }
    let message = format!(
        "absorption by {} in {} takes {gib:.1} GiB; at most {MOST_GIB} are allowed",
        counted(count, what),
        counted(bands, "band")
    );
    Some(Diagnostic::error(path, message).help(format!("{help}, or fewer bands or trees")))
}
