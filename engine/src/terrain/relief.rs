//! Heights of the ground over rectangles.

use glam::{DVec2, DVec3, UVec2};

use super::ground::{EDGE, Ground, cell_of};

/// Heights of the ground over a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// One triangle lies below all of it.
    Plane(GroundPlane),
    /// Lowest and highest height, m, or wider bounds.
    Range {
        /// Lower bound, m.
        lowest: f64,
        /// Upper bound, m.
        highest: f64,
    },
}

/// Plane of a triangle of the ground: height `height + slope · (place - anchor)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPlane {
    /// Height at the anchor, m.
    pub height: f64,
    /// A place, m.
    pub anchor: DVec2,
    /// Rise of the height to the east and to the north, m m⁻¹.
    pub slope: DVec2,
}

/// Cells of the grid over the ground that a query looks at, at most.
const MOST_LOOKED_AT: u32 = 16;

impl GroundPlane {
    /// Plane of one height everywhere.
    #[must_use]
    pub const fn level(height: f64) -> Self {
        Self { height, anchor: DVec2::ZERO, slope: DVec2::ZERO }
    }

    /// Height at a place, m.
    #[must_use]
    pub fn at(&self, place: DVec2) -> f64 {
        self.height + self.slope.dot(place - self.anchor)
    }

    /// Lowest and highest height over a rectangle, m.
    #[must_use]
    pub fn range(&self, low: DVec2, high: DVec2) -> (f64, f64) {
        let height = self.at(0.5 * (low + high));
        let reach = self.slope.abs().dot(0.5 * (high - low));
        (height - reach, height + reach)
    }
}

impl Ground {
    /// Heights over a rectangle, m, which must lie in that of the ground; `None` if it is too wide to tell, or if
    /// there may be a hole.
    ///
    /// - `has_holes`: true if parts of the ground have no height
    #[must_use]
    pub fn relief(&self, low: DVec2, high: DVec2, has_holes: bool) -> Option<Relief> {
        let [low, high] = [low, high].map(|place| (place - self.corner) / self.size);
        // Corners of triangles are f32.
        let [low, high] = [low - EDGE, high + EDGE];
        let (first, last) = (cell_of(low, self.cells), cell_of(high, self.cells));
        if (last - first + 1).element_product() > MOST_LOOKED_AT {
            return None;
        }
        let rectangle = UnitRectangle { low, high };
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut only = None;
        for cell in
            (first.y..=last.y).flat_map(|y| (first.x..=last.x).map(move |x| UVec2::new(x, y)))
        {
            let cell = (cell.y * self.cells.x + cell.x) as usize;
            let held = self.starts[cell] as usize..self.starts[cell + 1] as usize;
            for &index in &self.held[held] {
                let corners = &self.triangles[index as usize];
                if !rectangle.touches(corners) {
                    continue;
                }
                let plane = TrianglePlane::new(corners);
                let (low, high) = rectangle.heights(corners, &plane);
                (lowest, highest) = (lowest.min(low), highest.max(high));
                only = match only {
                    None => Some((index, plane)),
                    Some((known, plane)) if known == index => Some((known, plane)),
                    Some((_, plane)) => Some((u32::MAX, plane)),
                };
            }
        }
        match only {
            Some((index, plane))
                if index < u32::MAX && rectangle.is_in(&self.triangles[index as usize]) =>
            {
                Some(Relief::Plane(GroundPlane {
                    height: self.base + plane.corner.z,
                    anchor: self.corner + plane.corner.truncate() * self.size,
                    slope: plane.slope / self.size,
                }))
            }
            Some(_) if !has_holes => {
                Some(Relief::Range { lowest: self.base + lowest, highest: self.base + highest })
            }
            _ => None,
        }
    }
}

/// Plane of a triangle over places in units of the ground's rectangle.
struct TrianglePlane {
    corner: DVec3,
    slope: DVec2,
}

impl TrianglePlane {
    fn new([a, b, c]: &[DVec3; 3]) -> Self {
        let (u, v) = (*b - *a, *c - *a);
        let area = u.truncate().perp_dot(v.truncate());
        let slope = DVec2::new(u.z * v.y - v.z * u.y, v.z * u.x - u.z * v.x) / area;
        Self { corner: *a, slope }
    }
}

/// A rectangle in units of that of the ground.
struct UnitRectangle {
    low: DVec2,
    high: DVec2,
}

impl UnitRectangle {
    /// Smallest and largest distance of its corners from the line through two places, to the left, times the distance
    /// between those.
    fn distances(&self, from: DVec3, to: DVec3) -> (f64, f64) {
        let along = (to - from).truncate();
        let middle = along.perp_dot(0.5 * (self.low + self.high) - from.truncate());
        let half = 0.5 * (self.high - self.low);
        let reach = along.x.abs() * half.y + along.y.abs() * half.x;
        (middle - reach, middle + reach)
    }

    /// Returns whether it shares an area with a triangle: no side of either separates them.
    fn touches(&self, corners: &[DVec3; 3]) -> bool {
        let [a, b, c] = *corners;
        let (low, high) = (a.min(b).min(c).truncate(), a.max(b).max(c).truncate());
        let sense = sense(corners);
        self.low.cmple(high).all()
            && self.high.cmpge(low).all()
            && [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
                let (least, most) = self.distances(from, to);
                (least * sense).max(most * sense) >= 0.0
            })
    }

    /// Returns whether it lies in a triangle.
    fn is_in(&self, corners: &[DVec3; 3]) -> bool {
        let [a, b, c] = *corners;
        let sense = sense(corners);
        [(a, b), (b, c), (c, a)].into_iter().all(|(from, to)| {
            let (least, most) = self.distances(from, to);
            (least * sense).min(most * sense) >= 0.0
        })
    }

    /// Bounds of the heights of the part of a triangle that lies in it.
    fn heights(&self, corners: &[DVec3; 3], plane: &TrianglePlane) -> (f64, f64) {
        let [a, b, c] = *corners;
        let (lowest, highest) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
        let middle = 0.5 * (self.low + self.high) - plane.corner.truncate();
        let height = plane.corner.z + plane.slope.dot(middle);
        let reach = plane.slope.abs().dot(0.5 * (self.high - self.low));
        ((height - reach).clamp(lowest, highest), (height + reach).clamp(lowest, highest))
    }
}

/// 1 if the corners of a triangle turn to the left, -1 if to the right.
fn sense([a, b, c]: &[DVec3; 3]) -> f64 {
    (*b - *a).truncate().perp_dot((*c - *a).truncate()).signum()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::components::{MaterialId, TerrainPatch};
    use crate::terrain::plane;

    /// A bowl of 8 × 8 cells over 20 m × 10 m.
    fn bowl() -> TerrainPatch {
        let mut patch = plane(DVec2::new(-3.0, 7.0), DVec2::new(20.0, 10.0), 100.0, MaterialId(0));
        let height = |x: f32, y: f32| 8.0 * ((x - 0.4).powi(2) + (y - 0.5).powi(2));
        let at = |number: u32| number as f32 / 8.0;
        patch.mesh.vertices = (0..81)
            .map(|vertex| (at(vertex % 9), at(vertex / 9)))
            .map(|(x, y)| Vec3::new(x, y, height(x, y)))
            .collect();
        patch.mesh.triangles = (0..64)
            .map(|cell| cell / 8 * 9 + cell % 8)
            .flat_map(|first| [[first, first + 1, first + 10], [first, first + 10, first + 9]])
            .collect();
        patch
    }

    /// Heights at many places of each rectangle lie within the bounds, on the plane if there is one.
    #[test]
    fn heights_over_a_rectangle_are_those_at_its_places() {
        let ground = Ground::of(&bowl());
        let (mut planes, mut ranges) = (0, 0);
        for number in 0..4000_u32 {
            let at = |factor: u32| f64::from(number * factor % 997) / 997.0;
            let low = DVec2::new(-3.0 + 18.0 * at(31), 7.0 + 9.0 * at(57));
            let high = low + DVec2::new(2.0 * at(113), at(71)) * at(23);
            let relief = ground.relief(low, high, false).expect("it is small");
            for place in 0..36 {
                let part = DVec2::new(f64::from(place % 6), f64::from(place / 6)) / 5.0;
                let place = low + (high - low) * part;
                let height = ground.height(place).expect("it has no hole");
                match relief {
                    Relief::Plane(plane) => {
                        assert!((plane.at(place) - height).abs() < 1e-6, "{plane:?}");
                    }
                    Relief::Range { lowest, highest } => {
                        assert!((lowest - 1e-6..=highest + 1e-6).contains(&height));
                    }
                }
            }
            match relief {
                Relief::Plane(_) => planes += 1,
                Relief::Range { lowest, highest } => {
                    ranges += 1;
                    // The slope is 12.5 in units of the rectangle, at most; planes of neighbours go on beyond their
                    // triangles and cross it at slopes that differ by less than that.
                    let size = ((high - low) / ground.size()).length();
                    assert!(highest - lowest < 20.0 * size + 1e-3, "{lowest} to {highest}, {size}");
                }
            }
        }
        assert!(planes > 800 && ranges > 800, "{planes} {ranges}");
        assert!(ground.relief(DVec2::new(-3.0, 7.0), DVec2::new(17.0, 17.0), false).is_none());
    }
}
