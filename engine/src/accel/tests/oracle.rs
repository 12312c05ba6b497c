//! The plain way: every primitive of every instance, in `f64`.

use glam::{DMat3, DVec3, Vec3};

use crate::{
    accel::{Ray, RayBatch, TwoLevelBvh},
    components::{Disc, Mesh},
};

/// Between which distances the closest hit must lie: a primitive that is a little larger than in
/// truth is hit first, one that is a little smaller is surely hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub earliest: f64,
    pub latest: f64,
}

/// By how much primitives grow and shrink, relative to their size.
const MARGIN: f64 = 1e-9;

/// The closest hit by brute force. Copies of everything stand at `shifts`.
pub(super) fn closest(
    scene: &TwoLevelBvh,
    meshes: &[Mesh],
    count: usize,
    ray: &Ray,
    shifts: &[DVec3],
) -> Range {
    let mut range = Range { earliest: f64::INFINITY, latest: f64::INFINITY };
    for record in &scene.records[..count] {
        let object_from_world = DMat3::from_cols_array(&record.object_from_world.map(f64::from));
        let mesh = &meshes[record.mesh as usize];
        let direction = object_from_world * ray.direction;
        for &shift in shifts {
            let origin = object_from_world * (ray.origin - record.translation - shift);
            for index in 0..mesh.triangles.len() {
                triangle(&mut range, mesh.corners(index), origin, direction);
            }
            for disc in &mesh.discs {
                self::disc(&mut range, disc, origin, direction);
            }
        }
    }
    range
}

impl Range {
    fn add(&mut self, distance: f64, blur: f64, surely: bool) {
        let room = blur + 1e-12 * distance.abs();
        if distance + room <= 0.0 {
            return;
        }
        self.earliest = self.earliest.min(distance - room);
        if surely && distance - room > 0.0 {
            self.latest = self.latest.min(distance + room);
        }
    }
}

fn triangle(range: &mut Range, corners: [Vec3; 3], origin: DVec3, direction: DVec3) {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    if normal == DVec3::ZERO {
        return;
    }
    let slope = normal.dot(direction);
    let lever = (a - origin).abs().max_element() + origin.abs().max_element();
    let rounding = 1e-13 * (b - a).length() * (c - a).length();
    let error = rounding * lever / slope.abs();
    if slope.abs() <= rounding * direction.length() {
        // In the plane within rounding: hit or not, and anywhere, or parallel.
        if normal.dot(a - origin).abs() <= rounding * lever {
            range.earliest = range.earliest.min(0.0);
        }
        return;
    }
    let distance = normal.dot(a - origin) / slope;
    let at = origin + distance * direction;
    let blur = error * direction.length() + 1e-13 * lever;
    let area = normal.length();
    let inside = |p: DVec3, q: DVec3| {
        // Height above an edge, in units of the triangle's.
        let size = (q - p).length();
        ((q - p).cross(at - p).dot(normal) / (area * size), blur + MARGIN * area / size)
    };
    let sides = [inside(a, b), inside(b, c), inside(c, a)];
    if sides.iter().all(|(height, room)| *height >= -room) {
        range.add(distance, error, sides.iter().all(|(height, room)| *height >= *room));
    }
}

fn disc(range: &mut Range, disc: &Disc, origin: DVec3, direction: DVec3) {
    let Some(normal) = disc.normal.as_dvec3().try_normalize() else { return };
    if disc.radius <= 0.0 {
        return;
    }
    // The engine keeps the normal in f32: within a rounding of this one.
    let center = disc.center.as_dvec3();
    let slope = normal.dot(direction);
    let lever = (center - origin).length();
    let tilt = 1e-7;
    if slope.abs() <= 2.0 * tilt * direction.length() {
        range.earliest = range.earliest.min(0.0);
        return;
    }
    let distance = normal.dot(center - origin) / slope;
    let error = tilt * (lever + distance.abs() * direction.length()) / slope.abs();
    let off = (origin + distance * direction - center).length();
    let (radius, room) = (f64::from(disc.radius), error * direction.length() + 1e-12 * lever);
    if off <= radius * (1.0 + MARGIN) + room {
        range.add(distance, error, off <= radius * (1.0 - MARGIN) - room);
    }
}

/// Checks one ray on all instruction sets against the oracle; returns whether it hit.
pub(super) fn check(
    scenes: &[TwoLevelBvh],
    meshes: &[Mesh],
    count: usize,
    ray: &Ray,
    shifts: &[DVec3],
) -> bool {
    let range = closest(&scenes[0], meshes, count, ray, shifts);
    let hit = scenes[0].closest(ray);
    let distance = hit.map_or(f64::INFINITY, |hit| hit.distance);
    assert!(
        distance >= range.earliest && distance <= range.latest,
        "{distance} not in {range:?}: {ray:?}\n{hit:?}"
    );
    let back = Ray { direction: -ray.direction, ..*ray };
    let behind = scenes[0].closest(&back);
    for scene in scenes {
        assert_eq!(scene.closest(ray), hit, "instruction sets differ: {ray:?}");
        // More rays than slots, of both kinds.
        let rays = [*ray, back, back, *ray, back, *ray];
        let (mut occluded, mut hits) = ([false; 6], [None; 6]);
        scene.trace_each(RayBatch {
            shadow_rays: &rays,
            occluded: &mut occluded,
            closest_rays: &rays,
            hits: &mut hits,
        });
        let answers = [hit, behind, behind, hit, behind, hit];
        assert_eq!(hits, answers, "side by side: {ray:?}");
        assert_eq!(occluded, answers.map(|hit| hit.is_some()), "side by side: {ray:?}");
        assert_eq!(scene.occluded(ray), hit.is_some(), "any hit: {ray:?}");
        if let Some(hit) = hit {
            assert!(scene.occluded_within(ray, hit.distance.next_up()), "{ray:?}");
            assert!(!scene.occluded_within(ray, hit.distance), "{ray:?}");
        }
    }
    hit.is_some()
}

/// A scene for every instruction set of this processor, with and without memory that is fetched ahead.
pub(super) fn on_all_levels(build: impl Fn() -> TwoLevelBvh) -> Vec<TwoLevelBvh> {
    let levels = crate::accel::simd::SimdLevel::available().into_iter();
    let pairs = levels.flat_map(|level| [(level, false), (level, true)]);
    pairs
        .map(|(level, is_fetched_ahead)| TwoLevelBvh {
            is_fetched_ahead,
            ..build().with_level(level)
        })
        .collect()
}
