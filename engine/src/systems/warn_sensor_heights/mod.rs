mod camera_beside;

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use hecs::World;

use super::Resources;
use super::measure_bounds::placed_meshes;
use super::resolve_sensors::resolve_plane;
use super::warn_floating_instances::vertical_extent;
use crate::components::{Instance, InstanceQuery, MeshBounds, TerrainPatch};
use crate::document::{
    Diagnostic, Fisheye, Layers, Look, Perspective, PhotonMeasure, ScenePath, Sensor, VirtualPlane,
};
use crate::terrain::Ground;

use camera_beside::problem_of_camera_beside;

/// Depth below the ground that is rounding, per metre of its height and relief.
const ROUNDING: f64 = 1e-6;
/// Depth of a target below the ground from which it is doubtful, as a fraction of its distance.
const DEEP: f64 = 0.1;
/// Number of points along each side of the grid on which the ground is compared with a plane.
const POINTS: u32 = 64;

/// The ground that heights are compared with.
struct Relief<'a> {
    ground: &'a Ground,
    /// Height of the lowest and of the highest point, m.
    lowest: f64,
    highest: f64,
    is_periodic: bool,
}

/// A camera of a document: where it is and what it looks at, m.
struct CameraPlace {
    position: DVec3,
    target: Option<DVec3>,
    /// Key of the document that holds the target.
    target_key: &'static str,
    is_above_ground: bool,
}

impl CameraPlace {
    fn of(sensor: &Sensor) -> Option<Self> {
        let (position, target, target_key, is_above_ground) = match sensor {
            Sensor::Perspective(Perspective { position_m, target_m, above_ground, .. }) => {
                (position_m, Some(*target_m), "target_m", *above_ground)
            }
            Sensor::Fisheye(Fisheye { position_m, look, above_ground, .. }) => {
                let target = match look {
                    Look::Target { at_m } => Some(*at_m),
                    Look::Up | Look::Down | Look::Towards { .. } => None,
                };
                (position_m, target, "look", *above_ground)
            }
            Sensor::Orthographic(_) | Sensor::Directions(_) | Sensor::Photons(_) => return None,
        };
        let target = target.map(DVec3::from);
        Some(Self { position: DVec3::from(*position), target, target_key, is_above_ground })
    }
}

impl<'a> Relief<'a> {
    fn new(patch: &TerrainPatch, ground: &'a Ground, is_periodic: bool) -> Self {
        Self { ground, lowest: patch.lowest(), highest: patch.highest(), is_periodic }
    }

    /// Height of the ground at a place, m: of the periodic copy there, or of the lowest ground beside an
    /// isolated one; `None` in a hole.
    fn height(&self, at: DVec2) -> Option<f64> {
        let (corner, size) = (self.ground.corner(), self.ground.size());
        let inside = (at - corner) / size;
        if self.is_periodic {
            return self.ground.height(corner + (inside - inside.floor()) * size);
        }
        if self.is_beside(at) { Some(self.lowest) } else { self.ground.height(at) }
    }

    /// Returns whether a place lies beside the ground of an isolated scene.
    fn is_beside(&self, at: DVec2) -> bool {
        !self.is_periodic && self.ground.gap(at) > 0.0
    }

    /// ``the ground reaches from (0, 0) to (20, 20) m``
    fn extent_text(&self) -> String {
        let (low, high) = (self.ground.corner(), self.ground.corner() + self.ground.size());
        format!(
            "the ground reaches from ({}, {}) to ({}, {}) m",
            metres(low.x),
            metres(low.y),
            metres(high.x),
            metres(high.y)
        )
    }

    /// Depth below a height that is more than rounding.
    fn is_below(&self, z: f64, height: f64) -> bool {
        height - z > ROUNDING * (height.abs() + self.highest - self.lowest)
    }

    /// Fraction of a rectangle in which the ground is above a height.
    fn share_above(&self, corner: DVec2, size: DVec2, z: f64) -> f64 {
        let mut count = (0_u32, 0_u32);
        for index in 0..POINTS * POINTS {
            let cell = DVec2::new(f64::from(index % POINTS), f64::from(index / POINTS)) + 0.5;
            let at = corner + size * cell / f64::from(POINTS);
            if let Some(height) = self.height(at) {
                count.0 += u32::from(self.is_below(z, height));
                count.1 += 1;
            }
        }
        f64::from(count.0) / f64::from(count.1.max(1))
    }

    /// ``the ground lies at 0 m``, ``the ground lies between 300.05 and 301.95 m``.
    fn text(&self) -> String {
        let (low, high) = (metres(self.lowest), metres(self.highest));
        if low == high {
            format!("the ground lies at {low} m")
        } else {
            format!("the ground lies between {low} and {high} m")
        }
    }
}

/// Warns of cameras, virtual planes, flux levels and layers below the ground: their heights may be meant above it, as
/// most tables give them. Reads `document::Sensor`, [`TerrainPatch`], [`Ground`], [`MeshBounds`] and the components of instances.
pub(super) fn warn_sensor_heights(world: &mut World, resources: &mut Resources) {
    let mut terrain = world.query_one::<(&TerrainPatch, &Ground)>(resources.terrain);
    let Ok((patch, ground)) = terrain.get() else { return };
    if resources.sensors.is_empty() {
        return;
    }
    let relief = Relief::new(patch, ground, resources.is_periodic());
    let mut diagnostics = Vec::new();
    for (name, &entity) in &resources.sensors {
        let sensor = world.get::<&Sensor>(entity).expect("`spawn` gives sensors their source");
        let sensor = &*sensor;
        let path = ScenePath::from("sensors").name(name);
        if let Some(camera) = CameraPlace::of(sensor) {
            let (x, y, _) = resources.frame.origin_m;
            let frame = DVec2::new(x, y);
            diagnostics.extend(warn_camera(&camera, &path, &relief, frame));
        }
        if let Some(plane) = sensor.virtual_plane() {
            diagnostics.extend(check_plane_height(plane, &path, &relief, patch));
        }
        let Sensor::Photons(photons) = sensor else { continue };
        for (index, measure) in photons.measure.iter().enumerate() {
            let at = path.key("measure").index(index);
            match measure {
                PhotonMeasure::Fluxes { heights_m, .. } => {
                    diagnostics.extend(warn_levels(heights_m, &at, &relief));
                }
                PhotonMeasure::Fapar { layer_m: Layers::Borders(borders) } => {
                    diagnostics.extend(warn_layers(borders, &at, &relief, world));
                }
                _ => {}
            }
        }
    }
    for diagnostic in diagnostics {
        resources.report(diagnostic);
    }
}

/// An error if a virtual plane lies below all ground, a warning if a part of it does.
fn check_plane_height(
    plane: &VirtualPlane,
    path: &ScenePath,
    relief: &Relief<'_>,
    patch: &TerrainPatch,
) -> Option<Diagnostic> {
    let height = plane.height_m?;
    let path = path.key("virtual_plane").key("height_m");
    let help = "heights are those of the local frame: leave `height_m` out, and the plane lies on \
                    the highest point of the scene";
    let z = metres(height);
    if relief.is_below(height, relief.lowest) {
        let message = format!("nothing leaves through a plane at {z} m: {}", relief.text());
        return Some(Diagnostic::error(path, message).help(help));
    }
    let plane = resolve_plane(Some(plane), patch.corner, patch.size)?;
    let share = relief.share_above(plane.center - 0.5 * plane.size, plane.size, height);
    (share > 0.0).then(|| {
        let message = format!(
            "{:.1} % of the plane at {z} m lie below the ground: {}",
            100.0 * share,
            relief.text()
        );
        Diagnostic::warning(path, message).help(help)
    })
}

fn warn_camera(
    camera: &CameraPlace,
    path: &ScenePath,
    relief: &Relief<'_>,
    frame: DVec2,
) -> Vec<Diagnostic> {
    let DVec3 { x, y, z } = camera.position;
    if let Some(problem) = problem_of_camera_beside(camera, path, relief, frame) {
        return vec![problem];
    }
    let Some(ground) = relief.height(DVec2::new(x, y)) else { return Vec::new() };
    let at = path.key("position_m");
    let high = metres(ground);
    if camera.is_above_ground {
        // A height above sea level that is added to that of the ground.
        let over = z - ground;
        if ground > 50.0 && over > 0.0 && over < 0.1 * ground && over < 50.0 {
            let message = format!(
                "the camera is {} m above the ground, which itself is {high} m high there",
                metres(z)
            );
            let help = format!(
                "`above_ground: true` adds the two: if {} is a height above sea level, as that of \
                 the ground is, leave `above_ground` out",
                metres(z)
            );
            return vec![Diagnostic::warning(at, message).help(help)];
        }
        return Vec::new();
    }
    if relief.is_below(z, ground) {
        let depth = metres(ground - z);
        let message = if relief.is_beside(DVec2::new(x, y)) {
            format!("the camera is {depth} m below the lowest ground, which is {high} m high")
        } else {
            format!(
                "the camera is {depth} m below the ground, which is {high} m high at ({x}, {y})"
            )
        };
        let rule = "heights are those of the local frame";
        let help = if z >= 0.0 {
            let lifted = rounded(ground + z);
            format!(
                "{rule}: write `above_ground: true` if it is {} m above the ground, which is \
                 `position_m: ({x:?}, {y:?}, {lifted:?})`",
                metres(z)
            )
        } else {
            format!("{rule}: write `above_ground: true` and a height above the ground")
        };
        return vec![Diagnostic::warning(at, message).help(help)];
    }
    warn_target(camera, path, relief).into_iter().collect()
}

/// Warns of a target so deep below the ground that another direction was meant.
fn warn_target(camera: &CameraPlace, path: &ScenePath, relief: &Relief<'_>) -> Option<Diagnostic> {
    let target = camera.target?;
    let ground = relief.height(target.truncate())?;
    let depth = ground - target.z;
    if depth <= DEEP * (target - camera.position).length() || depth <= 1.0 {
        return None;
    }
    let message = format!(
        "the target is {} m below the ground, which is {} m high at ({}, {})",
        metres(depth),
        metres(ground),
        target.x,
        target.y
    );
    let help = "heights are those of the local frame: give that of the target, or write \
                `above_ground: true` if both heights are above the ground";
    Some(Diagnostic::warning(path.key(camera.target_key), message).help(help))
}

fn warn_levels(heights: &[f64], path: &ScenePath, relief: &Relief<'_>) -> Vec<Diagnostic> {
    let (corner, size) = (relief.ground.corner(), relief.ground.size());
    let help = "heights are those of the local frame, not above the ground";
    let warn = |(index, &height): (usize, &f64)| {
        let share = if relief.is_below(height, relief.lowest) {
            1.0
        } else {
            relief.share_above(corner, size, height)
        };
        let z = metres(height);
        let message = match share {
            0.0 => return None,
            1.0 => format!(
                "the level at {z} m lies below the ground, and no light is there: {}",
                relief.text()
            ),
            _ => format!(
                "{:.1} % of the level at {z} m lie below the ground, and count as 0: {}",
                100.0 * share,
                relief.text()
            ),
        };
        Some(Diagnostic::warning(path.key("heights_m").index(index), message).help(help))
    };
    heights.iter().enumerate().filter_map(warn).collect()
}

fn warn_layers(
    borders: &[f64],
    path: &ScenePath,
    relief: &Relief<'_>,
    world: &World,
) -> Option<Diagnostic> {
    let layers = borders.len().saturating_sub(1);
    let top = top(world).max(relief.highest);
    let below = borders.iter().skip(1).filter(|&&end| relief.is_below(end, relief.lowest)).count();
    let above = borders.iter().take(layers).filter(|&&start| start > top).count();
    let (count, side) = match (below, above) {
        (0, 0) => return None,
        (0, above) => (above, format!("above the highest point of the scene, {} m", metres(top))),
        (below, _) => (below, "below the ground".to_owned()),
    };
    let which = if count == layers {
        "all layers lie".to_owned()
    } else if count == 1 {
        format!("1 of {layers} layers lies")
    } else {
        format!("{count} of {layers} layers lie")
    };
    let message = format!("{which} {side}, where nothing absorbs: {}", relief.text());
    let help = "heights of layers are those of the local frame, not above the ground; \
                `layer_m: 1.0` starts at the lowest ground";
    Some(Diagnostic::warning(path.key("layer_m"), message).help(help))
}

/// Height of the highest instance, m.
fn top(world: &World) -> f64 {
    let meshes = placed_meshes(world).into_iter();
    let bounds: BTreeMap<u32, MeshBounds> =
        meshes.filter_map(|(id, mesh)| Some((id, mesh.bounds?))).collect();
    let mut top = f64::NEG_INFINITY;
    for components in &mut world.query::<InstanceQuery<'_>>() {
        let Instance { placement, .. } = Instance::from_components(components);
        if let Some(bounds) = bounds.get(&placement.prototype.0) {
            top = top.max(vertical_extent(&placement, bounds).1);
        }
    }
    top
}

/// A length with centimetres, or with three digits if it is short.
fn metres(length: f64) -> String {
    let length = if length.abs() < 1e-9 { 0.0 } else { length };
    let text = if length.abs() < 0.1 { format!("{length:.2e}") } else { format!("{length:.2}") };
    match text.split_once('.') {
        Some(_) if length.abs() >= 0.1 => {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ if length == 0.0 => "0".to_owned(),
        _ => text,
    }
}

/// A length in whole centimetres.
fn rounded(length: f64) -> f64 {
    (100.0 * length).round() / 100.0
}
