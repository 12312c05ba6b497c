//! Heights of the ground below plants, which heights of plants are counted from.

use glam::{DVec2, UVec2, Vec3};

use crate::components::TerrainPatch;
use crate::terrain::{Ground, GroundPlane, Relief};

/// Height of the ground below any place of a scene, also beside the terrain's rectangle.
#[derive(Debug)]
pub(in crate::queries) struct GroundHeights<'a> {
    ground: &'a Ground,
    is_periodic: bool,
    /// Height, m, if it is the same everywhere.
    level: Option<f64>,
    has_holes: bool,
    cells: UVec2,
    /// Lowest and highest ground of each cell, m.
    ranges: Vec<(f64, f64)>,
}

/// Cells along a side of the grid of ranges, at most.
const MOST_CELLS: f64 = 1024.0;

/// Cells that a query for a range looks at, at most.
const MOST_LOOKED_AT: u32 = 64;

impl<'a> GroundHeights<'a> {
    /// Heights of a terrain.
    pub(in crate::queries) fn new(
        patch: &TerrainPatch,
        ground: &'a Ground,
        is_periodic: bool,
    ) -> Self {
        let (lowest, highest, has_holes) = (patch.lowest(), patch.highest(), patch.has_holes());
        let level = (lowest.to_bits() == highest.to_bits() && !has_holes).then_some(lowest);
        let side = (patch.mesh.triangles.len() as f64).sqrt().clamp(1.0, MOST_CELLS);
        let cells = UVec2::splat(side as u32);
        // Over holes there is no range.
        let mut ranges = Vec::new();
        if level.is_none() && !has_holes {
            ranges.resize(cells.element_product() as usize, (f64::INFINITY, f64::NEG_INFINITY));
            for triangle in 0..patch.first_cut as usize {
                let corners = patch.mesh.corners(triangle).map(Vec3::as_dvec3);
                let heights = corners.map(|corner| patch.base + patch.unit * corner.z);
                let low = corners.map(|corner| cell(corner.truncate(), cells));
                let (first, last) =
                    (low[0].min(low[1]).min(low[2]), low[0].max(low[1]).max(low[2]));
                for place in places(first, last) {
                    let range = &mut ranges[(place.y * cells.x + place.x) as usize];
                    for height in heights {
                        *range = (range.0.min(height), range.1.max(height));
                    }
                }
            }
        }
        Self { ground, is_periodic, level, has_holes, cells, ranges }
    }

    /// Height of the ground, m, if it is the same everywhere.
    pub(in crate::queries) const fn level(&self) -> Option<f64> {
        self.level
    }

    /// Height of the ground below a place, m; beside the rectangle of an isolated scene, that of the nearest place in
    /// it. `None` over a hole.
    pub(in crate::queries) fn below(&self, place: DVec2) -> Option<f64> {
        let (corner, size) = (self.ground.corner(), self.ground.size());
        let place = if self.is_periodic {
            place - ((place - corner) / size).floor() * size
        } else {
            place.clamp(corner, corner + size)
        };
        self.level.or_else(|| self.ground.height(place.clamp(corner, corner + size)))
    }

    /// Heights of the ground below a rectangle, m; `None` if it is too wide to tell, or there may be a hole.
    pub(in crate::queries) fn relief(&self, low: DVec2, high: DVec2) -> Option<Relief> {
        if let Some(level) = self.level {
            return Some(Relief::Plane(GroundPlane::level(level)));
        }
        let (corner, size) = (self.ground.corner(), self.ground.size());
        let tile = if self.is_periodic { ((low - corner) / size).floor() } else { DVec2::ZERO };
        let offset = tile * size;
        let (inner_low, inner_high) = (low - offset, high - offset);
        let is_inside = inner_low.cmpge(corner).all() && inner_high.cmple(corner + size).all();
        if is_inside && let Some(relief) = self.ground.relief(inner_low, inner_high, self.has_holes)
        {
            return Some(match relief {
                Relief::Plane(GroundPlane { height, anchor, slope }) => {
                    Relief::Plane(GroundPlane { height, anchor: anchor + offset, slope })
                }
                range @ Relief::Range { .. } => range,
            });
        }
        if self.is_periodic && !is_inside {
            return None;
        }
        self.wide_range((low - corner - offset) / size, (high - corner - offset) / size)
    }

    /// Lowest and highest ground below a rectangle, m, or wider bounds; `None` if it is too wide to tell, or there may
    /// be a hole.
    pub(in crate::queries) fn range(&self, low: DVec2, high: DVec2) -> Option<(f64, f64)> {
        Some(match self.relief(low, high)? {
            Relief::Range { lowest, highest } => (lowest, highest),
            Relief::Plane(plane) => plane.range(low, high),
        })
    }

    /// Bounds of the heights below a rectangle, in units of that of the ground, from the grid of ranges.
    fn wide_range(&self, low: DVec2, high: DVec2) -> Option<Relief> {
        // Rounding of a place must not lead out of its cell.
        let (first, last) = (cell(low - 1e-9, self.cells), cell(high + 1e-9, self.cells));
        if self.ranges.is_empty() || (last - first + 1).element_product() > MOST_LOOKED_AT {
            return None;
        }
        let ranges = places(first, last)
            .map(|place| self.ranges[(place.y * self.cells.x + place.x) as usize]);
        let (lowest, highest) = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
        (lowest <= highest).then_some(Relief::Range { lowest, highest })
    }
}

/// Cell of a place, in units of the rectangle.
fn cell(place: DVec2, cells: UVec2) -> UVec2 {
    (place * cells.as_dvec2()).floor().clamp(DVec2::ZERO, (cells - 1).as_dvec2()).as_uvec2()
}

fn places(first: UVec2, last: UVec2) -> impl Iterator<Item = UVec2> {
    (first.y..=last.y).flat_map(move |y| (first.x..=last.x).map(move |x| UVec2::new(x, y)))
}
