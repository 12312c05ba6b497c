//! Rays in a periodic scene: one tile after the other.

use glam::{DVec2, DVec3};

use super::{Domain, Ray, scene::Scene, trace::Query, types::Boundary};

/// Tiles that a ray may cross before it counts as gone: far more than any ray that is not exactly
/// horizontal crosses between the heights of a scene, and the only end of one that is.
pub(super) const MOST_TILES: u32 = 1 << 20;

/// The tiles that a ray crosses up to `limit`, each as the query to ask in it.
///
/// The ray is the same in every tile but for its origin, which is moved by whole periods from where
/// the ray really starts: nothing adds up from tile to tile. In an isolated scene there is one
/// tile without sides.
pub(super) struct Tiles<'a> {
    scene: &'a Scene,
    ray: &'a Ray,
    limit: f64,
    /// The next tile, if there is one.
    tile: Option<DVec2>,
    /// Distances at which the ray enters it, and leaves the heights of the scene.
    enter: f64,
    end: f64,
    left: u32,
}

impl<'a> Tiles<'a> {
    #[inline]
    pub(super) fn new(scene: &'a Scene, ray: &'a Ray, limit: f64) -> Self {
        let mut tiles =
            Self { scene, ray, limit, tile: Some(DVec2::ZERO), enter: 0.0, end: 0.0, left: 1 };
        let domain = scene.domain();
        if domain.boundary == Boundary::Periodic {
            let (z, slope) = (ray.origin.z, ray.direction.z);
            match height_range(z, slope, scene.bottom(), scene.top()) {
                None => tiles.tile = None,
                Some((start, end)) => {
                    let entry = ray.origin + start * ray.direction;
                    tiles.tile = Some(((entry.truncate() - domain.min) / scene.size()).floor());
                    (tiles.enter, tiles.end, tiles.left) = (start, end, MOST_TILES);
                }
            }
        }
        tiles
    }

    /// The query of a periodic tile; the tile after it becomes the next.
    fn cross(&mut self, tile: DVec2) -> Query<'a> {
        let &Ray { origin, direction, from } = self.ray;
        let (domain, size) = (self.scene.domain(), self.scene.size());
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
        Query { scene: self.scene, origin: here, direction, tile, from, limit }
    }
}

impl<'a> Iterator for Tiles<'a> {
    type Item = Query<'a>;

    #[inline]
    fn next(&mut self) -> Option<Query<'a>> {
        let tile = self.tile.take()?;
        if self.scene.domain().boundary == Boundary::Periodic {
            return Some(self.cross(tile));
        }
        let &Ray { origin, direction, from } = self.ray;
        Some(Query { scene: self.scene, origin, direction, tile: [0, 0], from, limit: self.limit })
    }
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
