//! World to stage, with places in the document for whatever the ray engine refuses.

use std::sync::Arc;

use hecs::World;

use super::{Failure, setting};
use crate::accel::{self, BuildError};
use crate::components::{Mesh, Name, SceneId};
use crate::document::{Diagnostic, Scene};
use crate::extract::{Stage, extract};
use crate::spawn::Spawned;

/// The stage of a world, of geometry that was built before if there is any. `free` is the memory that the ray
/// engine may take, bytes.
///
/// # Errors
/// If the trees of the ray engine take more memory than there is, or it refuses a mesh or an instance.
pub(super) fn staged(
    spawned: &Spawned,
    scene: &Scene,
    built: Option<Arc<accel::Scene>>,
    free: u64,
) -> Result<Stage, Failure> {
    let problem = spawned.reach().check_memory(free).filter(|_| built.is_none());
    if let Some(problem) = problem {
        return Err(Failure::Problems(vec![problem]));
    }
    extract(&spawned.world, &setting(scene), built)
        .map_err(|error| Failure::Problems(vec![located(&error, spawned, scene)]))
}

/// What the ray engine refuses, at its place in the document.
fn located(error: &BuildError, spawned: &Spawned, scene: &Scene) -> Diagnostic {
    let path = match *error {
        BuildError::Vertex { mesh, .. }
        | BuildError::Corner { mesh, .. }
        | BuildError::Disc { mesh, .. }
        | BuildError::Surfaces { mesh, .. }
        | BuildError::Parts { mesh, .. }
        | BuildError::TooManyPrimitives { mesh, .. } => mesh_path(mesh, &spawned.world),
        BuildError::Mesh { instance, .. } | BuildError::Transform { instance } => {
            // Instance 0 is the ground.
            match instance.checked_sub(1) {
                Some(placed) => spawned.origins().place(scene, placed).0,
                None => "terrain".to_owned(),
            }
        }
        BuildError::Domain { .. } => "terrain".to_owned(),
        BuildError::TooManyImages { .. } => "instances".to_owned(),
    };
    Diagnostic::error(path, error.to_string())
}

/// Path of a mesh of the stage: the ground, then all others in document order.
fn mesh_path(mesh: usize, world: &World) -> String {
    let mut query = world.query::<(&SceneId, &Name, &Mesh)>();
    let mut names: Vec<_> = query.iter().map(|(id, name, _)| (*id, name.0.clone())).collect();
    names.sort_unstable_by_key(|(id, _)| *id);
    match mesh.checked_sub(1).and_then(|index| names.get(index)) {
        Some((_, name)) => format!("meshes.{name}"),
        None => "terrain".to_owned(),
    }
}
