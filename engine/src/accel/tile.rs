//! Rays in a periodic scene: one tile after the other.

use glam::{DVec2, DVec3};

use super::{Domain, Ray, scene::Scene, trace::Query, types::Boundary};

/// Tiles that a ray may cross before it counts as gone: far more than any ray that is not exactly
/// horizontal crosses between the heights of a scene, and the only end of one that is.
pub(super) const MOST_TILES: u32 = 1 << 20;

/// Asks `search` in each tile that a ray crosses up to `limit`, until it finds something.
///
/// The ray is the same in every tile but for its origin, which is moved by whole periods from where
/// the ray really starts: nothing adds up from tile to tile.
#[inline]
pub(super) fn walk<T>(
    scene: &Scene,
    ray: &Ray,
    limit: f64,
    search: impl Fn(&Query<'_>) -> Option<T>,
) -> Option<T> {
    let &Ray { origin, direction, from } = ray;
    let domain = scene.domain();
    if domain.boundary == Boundary::Isolated {
        return search(&Query { scene, origin, direction, tile: [0, 0], from, limit });
    }
    let (bottom, top) = (scene.bottom(), scene.top());
    let (start, end) = height_range(origin.z, direction.z, bottom, top)?;
    let size = scene.size();
    let entry = origin + start * direction;
    let mut tile = (entry.truncate() - domain.min) / size;
    tile = tile.floor();
    let ahead =
        DVec2::new(f64::from(u8::from(direction.x > 0.0)), f64::from(u8::from(direction.y > 0.0)));
    let mut enter = start;
    for _ in 0..MOST_TILES {
        let here = origin - (tile * size).extend(0.0);
        // Rounding moves the sides of the tile by less than this.
        let room = (-50_f64).exp2()
            * (here.abs().max_element()
                + domain.min.abs().max_element()
                + domain.max.abs().max_element());
        let side = domain.min + ahead * size;
        let leave = |axis: usize| {
            let slope = direction[axis];
            if slope == 0.0 { f64::INFINITY } else { (side[axis] - here[axis]) / slope }
        };
        let (x, y) = (leave(0), leave(1));
        let exit = x.min(y);
        let slope = if x < y { direction.x } else { direction.y }.abs();
        let within = limit.min(exit + room / slope);
        let query = Query {
            scene,
            origin: here,
            direction,
            tile: [tile.x as i32, tile.y as i32],
            from,
            limit: within,
        };
        if let Some(found) = search(&query) {
            return Some(found);
        }
        enter = enter.max(exit);
        if enter > end || enter >= limit {
            return None;
        }
        let step = |axis: usize| direction[axis].signum();
        if x <= y {
            tile.x += step(0);
        } else {
            tile.y += step(1);
        }
    }
    None
}

/// Where a ray is between two heights, as a range of distances.
fn height_range(z: f64, slope: f64, bottom: f64, top: f64) -> Option<(f64, f64)> {
    if slope == 0.0 {
        return (bottom <= z && z <= top).then_some((0.0, f64::INFINITY));
    }
    let (near, far) = if slope < 0.0 { (top, bottom) } else { (bottom, top) };
    let (start, end) = ((near - z) / slope, (far - z) / slope);
    (end >= 0.0).then_some((start.max(0.0), end))
}

/// The same place in the tile of a periodic domain, and how many periods it was moved back.
pub(super) fn wrap(domain: &Domain, point: DVec3) -> (DVec3, [i32; 2]) {
    if domain.boundary == Boundary::Isolated {
        return (point, [0, 0]);
    }
    let size = domain.max - domain.min;
    let shift = ((point.truncate() - domain.min) / size).floor();
    let moved = point - (shift * size).extend(0.0);
    let inside = moved.truncate().clamp(domain.min, domain.max);
    (inside.extend(point.z), [shift.x as i32, shift.y as i32])
}
