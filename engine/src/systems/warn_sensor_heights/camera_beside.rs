//! Warns of cameras that stand beside the ground, mostly because their coordinates are those of a map.

use glam::{DVec2, DVec3};

use super::{CameraPlace, Relief, metres};
use crate::document::{Diagnostic, ScenePath};
use crate::systems::coordinate_advice::far_from;

/// Horizontal distance from the ground, over the height of the camera, from which other coordinates must be
/// meant: satellites are far away, but high.
const FAR_HEIGHTS: f64 = 10.0;

/// A problem if a camera stands so far beside the ground that it cannot be meant, and if there is nothing below
/// a camera that looks at all directions. `frame` is the origin of the scene on the map, m.
pub(super) fn problem_of_camera_beside(
    camera: &CameraPlace,
    path: &ScenePath,
    relief: &Relief<'_>,
    frame: DVec2,
) -> Option<Diagnostic> {
    let at = camera.position.truncate();
    let gap = relief.ground.gap(at);
    if gap <= 0.0 {
        return None;
    }
    let path = path.key("position_m");
    let above = (camera.position.z - relief.highest).max(0.0);
    let is_far = gap > far_from(relief.ground).max(FAR_HEIGHTS * above);
    let message = format!("the camera is {} m beside the ground", metres(gap));
    if is_far {
        return Some(Diagnostic::error(path, message).help(far_help(camera, relief, frame)));
    }
    if relief.is_periodic {
        return None;
    }
    let reaches = relief.extent_text();
    let looks_beside = match camera.target {
        // A camera may look at the scene from its side.
        Some(target) => relief.ground.gap(target.truncate()) > 0.0,
        None => true,
    };
    if !looks_beside {
        return None;
    }
    if camera.is_above_ground {
        let help = format!(
            "{reaches}: move the camera, or leave `above_ground` out and write the height in the local frame"
        );
        let message = format!("{message}, so that its height above the ground has no meaning");
        return Some(Diagnostic::error(path, message).help(help));
    }
    Some(Diagnostic::warning(path, message).help(format!("{reaches}: move it")))
}

/// Advice for a camera that is far from the ground: its place in the local frame, if that is on the ground.
fn far_help(camera: &CameraPlace, relief: &Relief<'_>, frame: DVec2) -> String {
    let DVec3 { x, y, z } = camera.position;
    let local = DVec2::new(x, y) - frame;
    let reaches = relief.extent_text();
    if frame != DVec2::ZERO && relief.ground.gap(local) <= 0.0 {
        format!(
            "positions of cameras are local: less `frame.origin_m`, it is at `position_m: ({:?}, {:?}, {z:?})`",
            local.x, local.y
        )
    } else {
        format!("{reaches}; positions of cameras are those of the local frame, in metres")
    }
}
