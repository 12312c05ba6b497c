//! World to stage, with places in the document for errors of the ray engine.

use std::sync::Arc;

use super::Failure;
use super::scene_world::SceneWorld;
use super::setting::setting;
use crate::accel::{BuildError, TwoLevelBvh};
use crate::components::{InstanceCount, SceneExtents, SceneId};
use crate::counts::counted;
use crate::document::{Diagnostic, Scene, ScenePath};
use crate::extract::{SceneOptics, Setting, Stage, extract};
use crate::products::data_size;
use crate::systems::{Resources, place_of_instance};

/// Extracts the stage of a world, with the optics of one scene or several; builds the ray engine unless it is there. `free` is the memory that
/// the ray engine may take, bytes.
///
/// # Errors
/// If the ray engine takes more memory than there is, or it refuses a mesh or an instance.
pub(super) fn staged(
    world: &mut SceneWorld,
    scene: &Scene,
    optics: &SceneOptics,
    free: u64,
) -> Result<Stage, Failure> {
    let built = world.geometry.clone();
    world.builds += usize::from(built.is_none());
    let stage = stage_with(built, world, &setting(scene), optics, free)?;
    world.geometry = Some(stage.geometry.clone());
    Ok(stage)
}

/// Extracts the stage of a world with a ray engine, which is built if there is none.
///
/// # Errors
/// As of [`staged`].
pub(super) fn stage_with(
    built: Option<Arc<TwoLevelBvh>>,
    world: &SceneWorld,
    setting: &Setting,
    optics: &SceneOptics,
    free: u64,
) -> Result<Stage, Failure> {
    if built.is_none()
        && let Some(problem) = check_memory(&world.resources.extents, free)
    {
        return Err(Failure::Problems(vec![problem]));
    }
    extract(&world.world, optics, setting, built)
        .map_err(|error| Failure::Problems(vec![located(&error, world)]))
}

/// Error of the ray engine, at its place in the document.
fn located(error: &BuildError, world: &SceneWorld) -> Diagnostic {
    let path = match *error {
        BuildError::Vertex { mesh, .. }
        | BuildError::Corner { mesh, .. }
        | BuildError::Disc { mesh, .. }
        | BuildError::Surfaces { mesh, .. }
        | BuildError::Parts { mesh, .. }
        | BuildError::TooManyPrimitives { mesh, .. } => mesh_path(mesh, world),
        BuildError::Mesh { instance, .. } | BuildError::Transform { instance } => {
            // Instance 0 is the ground.
            match instance.checked_sub(1) {
                Some(placed) => {
                    let id = SceneId(placed as u32);
                    place_of_instance(id, &world.world, &world.resources).0
                }
                None => "terrain".into(),
            }
        }
        BuildError::Domain { .. } => "terrain".into(),
        BuildError::TooManyCopies { .. } => "instances".into(),
    };
    Diagnostic::error(path, error.to_string())
}

/// Path of a mesh of the stage: the ground, then all placed meshes in document order.
fn mesh_path(mesh: usize, SceneWorld { world, resources, .. }: &SceneWorld) -> ScenePath {
    let Resources { meshes, .. } = resources;
    let is_placed =
        |entity: hecs::Entity| world.get::<&InstanceCount>(entity).is_ok_and(|count| count.0 > 0);
    let mut placed = meshes.iter().filter(|(_, entity)| is_placed(**entity));
    match mesh.checked_sub(1).and_then(|index| placed.nth(index)) {
        Some((name, _)) => ScenePath::from("meshes").name(name),
        None => "terrain".into(),
    }
}

/// Memory of a triangle or disc while its tree is built, bytes.
const PRIMITIVE_BYTES: u64 = 130;

/// Memory of an instance or an image while the tree over them is built, bytes.
const RECORD_BYTES: u64 = 330;

/// Returns an error if the ray engine will take more memory for the scene than is free, bytes.
fn check_memory(extents: &SceneExtents, free: u64) -> Option<Diagnostic> {
    let meshes = extents.primitives.saturating_mul(PRIMITIVE_BYTES);
    let records = extents.records.saturating_mul(RECORD_BYTES);
    let all = meshes.saturating_add(records);
    if all <= free {
        return None;
    }
    let message = format!(
        "the ray engine takes {} of memory for {} in meshes and {}, images \
             in neighbouring tiles included, and {} are free",
        data_size(all),
        counted(extents.primitives, "triangle or disc"),
        counted(extents.records, "instance"),
        data_size(free)
    );
    let (path, help) = if records > meshes {
        (&extents.most_records, "place fewer instances, or choose a larger tile")
    } else {
        (&extents.largest_mesh, "take meshes of fewer triangles, and place them more often")
    };
    Some(Diagnostic::error(path, message).help(help))
}
