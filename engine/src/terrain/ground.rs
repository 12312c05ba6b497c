use glam::{DVec2, DVec3, UVec2};

use crate::components::TerrainPatch;

/// Height and slope of the ground at any place: of the very triangles that rays hit.
///
/// Triangles are kept in the cells of a regular grid over the ground's rectangle; a query looks at
/// those of one cell.
#[derive(Clone, Debug)]
pub struct Ground {
    pub(super) corner: DVec2,
    pub(super) size: DVec2,
    /// Corners of triangles, m above `base`, x and y in units of `size`.
    pub(super) triangles: Box<[[DVec3; 3]]>,
    pub(super) base: f64,
    pub(super) cells: UVec2,
    /// First entry of `held` for each cell, and the number of entries at the end.
    pub(super) starts: Box<[u32]>,
    pub(super) held: Box<[u32]>,
}

/// Places along a side of the ground where both sides are compared.
const PLACES: usize = 512;

/// Cells that hold a triangle, on average at most: one that lies like those of a raster is in four or so.
const MOST_HELD: u64 = 32;

/// Tolerance beside the edges of a triangle, in units of the rectangle: the corners are f32.
pub(super) const EDGE: f64 = 1e-7;

impl Ground {
    /// Creates the ground of a terrain.
    #[must_use]
    pub fn of(patch: &TerrainPatch) -> Self {
        let up = DVec3::new(1.0, 1.0, patch.unit);
        // What is vertical has no height, and what is degenerate no slope.
        let triangles: Box<[[DVec3; 3]]> = (0..patch.mesh.triangles.len())
            .map(|index| patch.mesh.corners(index).map(|corner| corner.as_dvec3() * up))
            .filter(|corners| doubled_area(corners) != 0.0)
            .collect();
        let cells = UVec2::splat(side(&triangles));
        let mut starts = vec![0_u32; cells.element_product() as usize + 1];
        for corners in &triangles {
            for_each_cell(corners, cells, |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut held = vec![0; *starts.last().unwrap_or(&0) as usize];
        for (index, corners) in triangles.iter().enumerate() {
            for_each_cell(corners, cells, |cell| {
                held[next[cell] as usize] = index as u32;
                next[cell] += 1;
            });
        }
        Self {
            corner: patch.corner,
            size: patch.size,
            triangles,
            base: patch.base,
            cells,
            starts: starts.into(),
            held: held.into(),
        }
    }

    /// Distance of a place from the rectangle along one of the axes, m; negative inside.
    #[must_use]
    pub fn gap(&self, place: DVec2) -> f64 {
        (self.corner - place).max(place - (self.corner + self.size)).max_element()
    }

    /// Step between opposite sides up to which they meet: a lower one may be meant, m.
    pub const SEAM: f64 = 1.0;

    /// Largest difference in height between its western and eastern side, and between its southern and northern one, m.
    #[must_use]
    pub fn steps_between_sides(&self) -> DVec2 {
        let step = |axis: usize| {
            let steps = (0..=PLACES).filter_map(|place| {
                let mut at = DVec2::splat(place as f64 / PLACES as f64);
                let mut height = |side: f64| {
                    at[axis] = side;
                    self.height(self.corner + at * self.size)
                };
                Some((height(1.0)? - height(0.0)?).abs())
            });
            steps.fold(0.0, f64::max)
        };
        DVec2::new(step(0), step(1))
    }

    /// South-west corner of its rectangle, m.
    #[must_use]
    pub const fn corner(&self) -> DVec2 {
        self.corner
    }

    /// Extent of its rectangle to the east and to the north, m.
    #[must_use]
    pub const fn size(&self) -> DVec2 {
        self.size
    }

    /// Height of the ground, the highest where it overhangs, m; `None` beside its rectangle and
    /// where it has a hole.
    #[must_use]
    pub fn height(&self, at: DVec2) -> Option<f64> {
        self.find(at).map(|(height, _)| self.base + height)
    }

    /// Upward unit normal of the ground; `None` where there is no height.
    #[must_use]
    pub fn normal(&self, at: DVec2) -> Option<DVec3> {
        let (_, triangle) = self.find(at)?;
        let [a, b, c] = self.triangles[triangle].map(|corner| corner * self.size.extend(1.0));
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some(if normal.z < 0.0 { -normal } else { normal })
    }

    /// The highest triangle at a place, and its height there above `base`.
    fn find(&self, at: DVec2) -> Option<(f64, usize)> {
        let at = (at - self.corner) / self.size;
        let inside =
            at.cmpge(DVec2::splat(-EDGE)).all() && at.cmple(DVec2::splat(1.0 + EDGE)).all();
        if !inside {
            return None;
        }
        let cell = cell_of(at, self.cells);
        let cell = (cell.y * self.cells.x + cell.x) as usize;
        self.held[self.starts[cell] as usize..self.starts[cell + 1] as usize]
            .iter()
            .filter_map(|&index| {
                height_in(&self.triangles[index as usize], at).map(|z| (z, index as usize))
            })
            .reduce(|best, other| if other.0 > best.0 { other } else { best })
    }
}

/// Cells along each side of the grid: about one triangle a cell, but fewer cells where triangles lie over one
/// another, so that no terrain is held more than a few times.
fn side(triangles: &[[DVec3; 3]]) -> u32 {
    let most = (MOST_HELD * triangles.len() as u64).min(u32::MAX.into());
    let mut side = (triangles.len() as f64).sqrt().ceil().clamp(1.0, 4096.0) as u32;
    let held = |side: u32| -> u64 {
        let reached = |corners| {
            let (low, high) = reach(corners, UVec2::splat(side));
            u64::from((high - low + 1).element_product())
        };
        triangles.iter().map(reached).sum()
    };
    while side > 1 && held(side) > most {
        side /= 2;
    }
    side
}

fn doubled_area([a, b, c]: &[DVec3; 3]) -> f64 {
    (b - a).truncate().perp_dot((c - a).truncate())
}

/// Height of a triangle at a place on it.
fn height_in(corners: &[DVec3; 3], at: DVec2) -> Option<f64> {
    let [a, b, c] = corners;
    let area = doubled_area(corners);
    let (ab, ac, ap) = ((b - a).truncate(), (c - a).truncate(), at - a.truncate());
    let (v, w) = (ap.perp_dot(ac) / area, ab.perp_dot(ap) / area);
    // The same distance beside each edge, whatever the shape of the triangle.
    let room = EDGE * (ab.length() + ac.length()) / area.abs();
    let u = 1.0 - v - w;
    (u >= -room && v >= -room && w >= -room).then(|| {
        // A place beside the edge is taken for the nearest one on it: thin triangles may be steep.
        let (v, w) = (v.max(0.0), w.max(0.0));
        let sum = u.max(0.0) + v + w;
        a.z + ((b.z - a.z) * v + (c.z - a.z) * w) / sum
    })
}

pub(super) fn cell_of(at: DVec2, cells: UVec2) -> UVec2 {
    let last = (cells - 1).as_dvec2();
    (at * cells.as_dvec2()).floor().clamp(DVec2::ZERO, last).as_uvec2()
}

/// The first and the last cell that the box around a triangle reaches.
fn reach(corners: &[DVec3; 3], cells: UVec2) -> (UVec2, UVec2) {
    let [a, b, c] = corners.map(DVec3::truncate);
    let room = DVec2::splat(2.0 * EDGE);
    (cell_of(a.min(b).min(c) - room, cells), cell_of(a.max(b).max(c) + room, cells))
}

/// Calls `f` with every cell that the box around a triangle reaches.
fn for_each_cell(corners: &[DVec3; 3], cells: UVec2, mut f: impl FnMut(usize)) {
    let (low, high) = reach(corners, cells);
    for y in low.y..=high.y {
        for x in low.x..=high.x {
            f((y * cells.x + x) as usize);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::components::MaterialId;
    use crate::terrain::plane;

    #[test]
    fn a_plane_has_its_height_inside_its_rectangle_alone() {
        let corner = DVec2::new(100.0, -20.0);
        let patch = plane(corner, DVec2::new(10.0, 5.0), 7.5, MaterialId(0));
        let ground = Ground::of(&patch);
        for inside in [corner, corner + DVec2::new(10.0, 5.0), corner + DVec2::new(3.0, 2.0)] {
            assert_eq!(ground.height(inside), Some(7.5), "{inside}");
            assert_eq!(ground.normal(inside), Some(DVec3::Z), "{inside}");
        }
        for outside in [DVec2::ZERO, corner - DVec2::X * 0.01, corner + DVec2::new(1.0, 5.01)] {
            assert_eq!(ground.height(outside), None, "{outside}");
        }
    }

    #[test]
    fn triangles_that_lie_over_one_another_are_held_a_few_times() {
        let mut patch = plane(DVec2::ZERO, DVec2::new(10.0, 10.0), 0.0, MaterialId(0));
        // A few thousand of the size of the whole rectangle, each a little higher than the one before.
        let count = 3000;
        for layer in 1..count {
            let height = layer as f32 / 1000.0;
            let first = patch.mesh.vertices.len() as u32;
            let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
            patch.mesh.vertices.extend(corners.map(|(x, y)| Vec3::new(x, y, height)));
            let square = [[0, 1, 2], [0, 2, 3]];
            patch.mesh.triangles.extend(square.map(|three| three.map(|corner| first + corner)));
        }
        let ground = Ground::of(&patch);
        assert!(ground.held.len() <= MOST_HELD as usize * ground.triangles.len());
        for place in [DVec2::new(0.1, 9.9), DVec2::new(5.0, 5.0), DVec2::new(9.0, 1.0)] {
            let height = ground.height(place).unwrap_or(f64::NAN);
            assert!((height - f64::from(count - 1) / 1000.0).abs() < 1e-6, "{place}: {height}");
        }
    }

    #[test]
    fn height_and_normal_are_those_of_the_triangle_below() {
        let mut patch = plane(DVec2::ZERO, DVec2::new(20.0, 10.0), 100.0, MaterialId(0));
        patch.unit = 10.0;
        // z = x / 2 over the whole rectangle, in units of 10 m; and a roof over a part of it.
        patch.mesh.vertices[1].z = 1.0;
        patch.mesh.vertices[2].z = 1.0;
        let first = patch.mesh.vertices.len() as u32;
        patch.mesh.vertices.extend([
            Vec3::new(0.5, 0.5, 2.0),
            Vec3::new(0.6, 0.5, 2.0),
            Vec3::new(0.5, 0.6, 2.0),
        ]);
        patch.mesh.triangles.push([first, first + 1, first + 2]);
        let ground = Ground::of(&patch);
        let height = |x, y| ground.height(DVec2::new(x, y)).unwrap_or(f64::NAN);
        assert!((height(4.0, 7.0) - 102.0).abs() < 1e-5);
        assert!((height(19.0, 1.0) - 109.5).abs() < 1e-5);
        assert!((height(10.5, 5.2) - 120.0).abs() < 1e-5, "the highest counts");
        let normal = ground.normal(DVec2::new(4.0, 7.0)).unwrap_or(DVec3::ZERO);
        let tilted = DVec3::new(-1.0, 0.0, 2.0) / 5_f64.sqrt();
        assert!((normal - tilted).length() < 1e-6, "{normal}");
    }
}
