//! Cameras inside closed bodies: in a trunk, a wall or a rock.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::sensors::SensorEntity;
use crate::accel::Ray;
use crate::components::{Optics, ResolvedSensor};
use crate::document::{Diagnostic, ScenePath};
use crate::extract::Stage;
use crate::sampling::Key;
use crate::transport::Camera;

/// Rays that look around from a camera.
const RAYS: u64 = 64;
/// Fraction of them that meet the inside of one body, the ground left aside, from which a camera is in it.
const ENCLOSED: f64 = 0.95;

/// Warns of cameras around which all surfaces show their back and belong to one instance.
pub(super) fn warnings(sensors: &[SensorEntity], stage: &Stage) -> Vec<Diagnostic> {
    let warning = |SensorEntity { name, sensor, .. }: &SensorEntity| {
        let ResolvedSensor::Image(image) = sensor else { return None };
        if matches!(image.optics, Optics::Orthographic(_)) {
            return None;
        }
        let eye = Camera::new(image, stage).ray(DVec2::splat(0.5))?.origin;
        let width = enclosure(eye, stage)?;
        let message = format!(
            "the camera at ({:.2}, {:.2}, {:.2}) is inside a body, whose nearest side is {width:.2} m away",
            eye.x, eye.y, eye.z
        );
        let help = "surfaces show their back in nearly all directions, as inside a trunk: move the \
                    camera; if it is to be inside of a room, turn the faces of that inwards";
        let path = ScenePath::from("sensors").name(name).key("position_m");
        Some(Diagnostic::warning(path, message).help(help))
    };
    sensors.iter().filter_map(warning).collect()
}

/// Distance from a point to the nearest side of the body that it is in, as far as rays find it, m.
fn enclosure(eye: DVec3, stage: &Stage) -> Option<f64> {
    let key = Key::new(0).path("enclosure");
    let (mut instance, mut inside, mut others, mut nearest) = (None, 0_u32, 0_u32, f64::INFINITY);
    for index in 0..RAYS {
        let stream = key.index(index);
        let direction = uniform_direction(stream.uniform(0), stream.uniform(1));
        let Some(hit) = stage.geometry.closest(&Ray { origin: eye, direction, from: None }) else {
            others += 1;
            continue;
        };
        if stage.is_ground(&hit) {
            // A trunk is open where it stands on the ground.
            others += u32::from(direction.z > 0.0);
            continue;
        }
        let is_back = hit.normal.dot(direction) > 0.0;
        if is_back && *instance.get_or_insert(hit.instance) == hit.instance {
            inside += 1;
            nearest = nearest.min(hit.distance);
        } else {
            others += 1;
        }
    }
    let all = f64::from(inside + others);
    (inside >= 8 && f64::from(inside) >= ENCLOSED * all).then_some(nearest)
}

/// Direction of uniform density over the sphere, from two uniform numbers.
fn uniform_direction(u: f64, v: f64) -> DVec3 {
    let z = 2.0 * u - 1.0;
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * v).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}
