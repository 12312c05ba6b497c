//! Rays in a periodic scene: one tile after the other.

use glam::{DVec2, DVec3};

use crate::accel::layout::{Domain, TwoLevelBvh};

use super::hit::{Departure, Ray};

/// Ray in one tile.
#[derive(Clone, Copy)]
pub(super) struct TileRay<'a> {
    pub bvh: &'a TwoLevelBvh,
    /// Origin in the tile's frame, m.
    pub origin: DVec3,
    pub direction: DVec3,
    /// Number of periods from the frame of the ray to that of the tile.
    pub tile: [i32; 2],
    pub from: Option<Departure>,
    /// Primitives at this distance or farther do not count.
    pub limit: f64,
}

/// Maximum number of tiles that a ray crosses: far more than any ray that is not exactly
/// horizontal crosses between the heights of a scene, and the only end of one that is.
const MAX_TILES: u32 = 1 << 20;

/// Iterator over the tiles that a ray crosses up to `limit`.
///
/// The ray is the same in every tile except for its origin, which is the original one moved by whole
/// periods: errors do not accumulate from tile to tile. In an isolated scene there is one
/// tile without sides.
pub(super) struct TileIter<'a> {
    bvh: &'a TwoLevelBvh,
    ray: &'a Ray,
    limit: f64,
    /// Next tile, if there is one.
    tile: Option<DVec2>,
    /// Distance at which the ray enters that tile.
    enter: f64,
    /// Distance at which the ray leaves the heights of the scene.
    end: f64,
    /// Number of tiles left.
    left: u32,
}

impl<'a> TileIter<'a> {
    #[inline]
    pub(super) fn new(bvh: &'a TwoLevelBvh, ray: &'a Ray, limit: f64) -> Self {
        let mut tiles =
            Self { bvh, ray, limit, tile: Some(DVec2::ZERO), enter: 0.0, end: 0.0, left: 1 };
        let domain = &bvh.domain;
        if domain.is_periodic {
            let (z, slope) = (ray.origin.z, ray.direction.z);
            match height_range(z, slope, bvh.bottom(), bvh.top()) {
                None => tiles.tile = None,
                Some((start, end)) => {
                    let entry = ray.origin + start * ray.direction;
                    tiles.tile = Some(((entry.truncate() - domain.min) / domain.size()).floor());
                    (tiles.enter, tiles.end, tiles.left) = (start, end, MAX_TILES);
                }
            }
        }
        tiles
    }

    /// Returns the ray in a periodic tile; the tile after it becomes the next.
    fn cross(&mut self, tile: DVec2) -> TileRay<'a> {
        let &Ray { origin, direction, from } = self.ray;
        let (domain, size) = (&self.bvh.domain, self.bvh.domain.size());
        let ahead = DVec2::new(
            f64::from(u8::from(direction.x > 0.0)),
            f64::from(u8::from(direction.y > 0.0)),
        );
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
        let limit = self.limit.min(exit + room / slope);
        self.enter = self.enter.max(exit);
        self.left -= 1;
        let is_last = self.enter > self.end || self.enter >= self.limit || self.left == 0;
        let step = if x <= y {
            DVec2::new(direction.x.signum(), 0.0)
        } else {
            DVec2::new(0.0, direction.y.signum())
        };
        self.tile = (!is_last).then_some(tile + step);
        let tile = [tile.x as i32, tile.y as i32];
        TileRay { bvh: self.bvh, origin: here, direction, tile, from, limit }
    }
}

impl<'a> Iterator for TileIter<'a> {
    type Item = TileRay<'a>;

    #[inline]
    fn next(&mut self) -> Option<TileRay<'a>> {
        let tile = self.tile.take()?;
        if self.bvh.domain.is_periodic {
            return Some(self.cross(tile));
        }
        let &Ray { origin, direction, from } = self.ray;
        Some(TileRay { bvh: self.bvh, origin, direction, tile: [0, 0], from, limit: self.limit })
    }
}

/// Range of distances at which a ray is between two heights; `None` if it never is.
fn height_range(z: f64, slope: f64, bottom: f64, top: f64) -> Option<(f64, f64)> {
    if slope == 0.0 {
        return (bottom <= z && z <= top).then_some((0.0, f64::INFINITY));
    }
    let (near, far) = if slope < 0.0 { (top, bottom) } else { (bottom, top) };
    let (start, end) = ((near - z) / slope, (far - z) / slope);
    (end >= 0.0).then_some((start.max(0.0), end))
}

/// Point in the tile of a periodic domain that corresponds to `point`, and the number of periods between the two.
pub(super) fn wrap(domain: &Domain, point: DVec3) -> (DVec3, [i32; 2]) {
    if !domain.is_periodic {
        return (point, [0, 0]);
    }
    let size = domain.size();
    let shift = ((point.truncate() - domain.min) / size).floor();
    let moved = point - (shift * size).extend(0.0);
    let inside = moved.truncate().clamp(domain.min, domain.max);
    (inside.extend(point.z), [shift.x as i32, shift.y as i32])
}
