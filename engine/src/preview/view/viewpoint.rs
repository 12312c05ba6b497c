//! Position of the camera of a view.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, UVec2};
use hecs::World;

use crate::components::{
    CameraPlacement, Instance, InstanceQuery, LookAt, MeshBounds, PerspectiveOptics, Placement,
    SceneId, View,
};
use crate::extract::Stage;
use crate::geometry::Bounds;
use crate::transport::{PerspectiveCamera, view_axes};

/// Angle of view across the picture, degrees.
const FIELD_DEG: f64 = 34.0;

/// Zenith angle of the camera, and its azimuth beside the sun's, degrees: the sun stands behind, and shadows are visible.
const ZENITH_DEG: f64 = 64.0;
const BESIDE_SUN_DEG: f64 = 35.0;

/// Room around the scene in the picture.
const ROOM: f64 = 1.04;

/// Fraction of the ground's rectangle below which the camera looks at what stands there, and not at the whole ground.
const SMALL: f64 = 0.3;

/// Direction towards the camera for a direction towards the sun.
pub(super) fn automatic(sun: DVec3) -> View {
    // A sun in the zenith stands in the south, as it does near it.
    let azimuth =
        if sun.truncate().length() > 1e-3 { sun.x.atan2(sun.y) } else { 180_f64.to_radians() };
    View { zenith: ZENITH_DEG.to_radians(), azimuth: azimuth + BESIDE_SUN_DEG.to_radians() }
}

/// Camera that shows the scene from a direction.
pub(super) fn viewpoint(
    stage: &Stage,
    placed: Option<Bounds>,
    view: View,
    size: UVec2,
) -> PerspectiveCamera {
    let Bounds { min: low, max: high } = shown_box(stage, placed);
    let target = 0.5 * (low + high);
    let pixels = size.as_dvec2();
    let tangent = (0.5 * FIELD_DEG.to_radians()).tan();
    let tangents = DVec2::new(tangent, tangent * pixels.y / pixels.x);
    let towards = view.direction();
    let (right, down) = view_axes(view);
    let needed = (0..8).map(|corner| {
        let pick = |bit: u32, axis: usize| if corner & bit == 0 { low[axis] } else { high[axis] };
        let offset = DVec3::new(pick(1, 0), pick(2, 1), pick(4, 2)) - target;
        let across = DVec2::new(offset.dot(right), offset.dot(down)).abs() / tangents;
        ROOM * across.max_element() + offset.dot(towards)
    });
    let distance = needed.fold(1e-3, f64::max);
    let placement = CameraPlacement {
        position: target + distance * towards,
        look: LookAt::Target(target),
        // Straight down, up is where an oblique camera looks.
        up: if towards.z > 0.999 {
            -right.cross(DVec3::Z).normalize_or(DVec3::Y)
        } else {
            DVec3::Z
        },
        above_ground: false,
    };
    let field = 2.0 * tangents.map(f64::atan);
    PerspectiveCamera::new(&PerspectiveOptics { placement, field, sees_sky: true }, size, stage)
}

/// Box around all instances, m; `None` without instances.
pub(super) fn placed_box(world: &World) -> Option<Bounds> {
    let mut query = world.query::<(&SceneId, &MeshBounds)>();
    let reach = |bounds: &MeshBounds| f64::from(bounds.low.abs().max(bounds.high.abs()).length());
    let reaches: BTreeMap<u32, f64> =
        query.iter().map(|(id, bounds)| (id.0, reach(bounds))).collect();
    let mut instances = world.query::<InstanceQuery<'_>>();
    let mut all: Option<Bounds> = None;
    for components in &mut instances {
        let Placement { prototype, position, scale, .. } =
            Instance::from_components(components).placement;
        let reach = reaches.get(&prototype.0).copied().unwrap_or(0.0);
        let reach = reach * f64::from(scale.horizontal.max(scale.vertical));
        let own = Bounds { min: position - reach, max: position + reach };
        all =
            Some(all.map_or(own, |all| Bounds {
                min: all.min.min(own.min),
                max: all.max.max(own.max),
            }));
    }
    all
}

/// Box that the camera shows: the ground and what stands on it, or what stands on a small part of it.
fn shown_box(stage: &Stage, placed: Option<Bounds>) -> Bounds {
    let low = stage.corner.extend(stage.ground);
    let ground = Bounds { min: low, max: (stage.corner + stage.size).extend(stage.top()) };
    let Some(Bounds { min, max }) = placed else { return ground };
    let side = (max - min).truncate().max_element();
    if side < SMALL * stage.size.max_element() {
        // Some ground around, which shows the shadow.
        let around = DVec3::new(0.3 * side, 0.3 * side, 0.0);
        let (min, max) = (min - around, max + around);
        // Spheres around meshes reach below the ground and above what is there.
        return Bounds {
            min: min.max(DVec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, low.z)),
            max: max.min(DVec3::new(f64::INFINITY, f64::INFINITY, stage.top())),
        };
    }
    // What stands far beside the ground is left out.
    let most = 0.3 * stage.size.max_element();
    let min = ground.min.min(min.max(ground.min - most));
    let max = ground.max.max(max.min(ground.max + most));
    Bounds { min: DVec3::new(min.x, min.y, low.z), max: DVec3::new(max.x, max.y, stage.top()) }
}
