//! Grid of cells over triangles, to find those at a point.

use glam::DVec2;
use robust::{Coord, orient2d};

use crate::geometry::Rectangle;

/// Number of cells for each side of the outline: a cell that the outline crosses then holds few of them.
const CELLS_PER_SIDE: usize = 16;

/// Least and largest number of cells.
const CELL_COUNT: [usize; 2] = [1 << 8, 1 << 18];

/// Margin around a triangle within which it counts for a cell, in widths of cells: more than rounding.
const MARGIN: f64 = 1e-6;

/// Overlap of a cell of the grid with the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellOverlap {
    Outside,
    /// The region holds the whole cell.
    Inside,
    /// The outline passes through the cell.
    Crossed,
}

/// Cells over the bounds of a region, each with the triangles that reach into it.
#[derive(Clone, Debug)]
pub(super) struct Locator {
    bounds: Rectangle,
    columns: usize,
    rows: usize,
    coverage: Vec<CellOverlap>,
    /// First entry of `entries` for each cell, and their number at the end.
    starts: Vec<u32>,
    /// Indices of triangles, cell by cell, for cells that the outline crosses.
    entries: Vec<u32>,
}

impl Locator {
    /// Creates the grid of a region with these triangles and sides of its outline.
    pub(super) fn new(bounds: Rectangle, triangles: &[[DVec2; 3]], outline: &[[DVec2; 2]]) -> Self {
        let size = bounds.size();
        let count = (CELLS_PER_SIDE * outline.len()).clamp(CELL_COUNT[0], CELL_COUNT[1]) as f64;
        let columns = (count * size.x / size.y).sqrt().clamp(1.0, count).ceil();
        let rows = (count / columns).ceil();
        let (columns, rows) = (columns as usize, rows as usize);
        let mut locator = Self {
            bounds,
            columns,
            rows,
            coverage: vec![CellOverlap::Outside; columns * rows],
            starts: Vec::new(),
            entries: Vec::new(),
        };
        let mut coverage = std::mem::take(&mut locator.coverage);
        for triangle in triangles {
            locator.for_each_cell(triangle, |cell| coverage[cell] = CellOverlap::Inside);
        }
        for side in outline {
            locator.for_each_cell(side, |cell| coverage[cell] = CellOverlap::Crossed);
        }
        let mut next = vec![0_u32; columns * rows + 1];
        for triangle in triangles {
            locator.for_each_cell(triangle, |cell| {
                next[cell + 1] += u32::from(coverage[cell] == CellOverlap::Crossed);
            });
        }
        for cell in 0..columns * rows {
            next[cell + 1] += next[cell];
        }
        locator.starts.clone_from(&next);
        let mut entries = vec![0; next[columns * rows] as usize];
        for (index, triangle) in triangles.iter().enumerate() {
            locator.for_each_cell(triangle, |cell| {
                if coverage[cell] == CellOverlap::Crossed {
                    entries[next[cell] as usize] = index as u32;
                    next[cell] += 1;
                }
            });
        }
        Self { coverage, entries, ..locator }
    }

    fn cell_size(&self) -> DVec2 {
        self.bounds.size() / DVec2::new(self.columns as f64, self.rows as f64)
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.bounds.min.x) / self.cell_size().x) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.bounds.min.y) / self.cell_size().y) as usize).min(self.rows - 1)
    }

    /// Calls a function with each cell that a triangle or line segment reaches into, once.
    fn for_each_cell(&self, corners: &[DVec2], mut visit: impl FnMut(usize)) {
        let size = self.cell_size();
        let margin = MARGIN * size;
        let lowest = corners.iter().map(|corner| corner.y).fold(f64::INFINITY, f64::min);
        let highest = corners.iter().map(|corner| corner.y).fold(f64::NEG_INFINITY, f64::max);
        for row in self.row(lowest - margin.y)..=self.row(highest + margin.y) {
            let bottom = self.bounds.min.y + row as f64 * size.y - margin.y;
            let top = bottom + size.y + 2.0 * margin.y;
            let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
            for (index, &a) in corners.iter().enumerate() {
                let b = corners[(index + 1) % corners.len()];
                let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
                if high.y < bottom || low.y > top {
                    continue;
                }
                for y in [bottom.max(low.y), top.min(high.y)] {
                    let fraction =
                        if high.y > low.y { (y - low.y) / (high.y - low.y) } else { 0.0 };
                    let x = low.x + fraction * (high.x - low.x);
                    (left, right) = (left.min(x), right.max(x));
                }
                if low.y >= bottom && high.y <= top {
                    (left, right) = (left.min(a.x.min(b.x)), right.max(a.x.max(b.x)));
                }
            }
            if left <= right {
                let columns = self.column(left - margin.x)..=self.column(right + margin.x);
                columns.for_each(|column| visit(row * self.columns + column));
            }
        }
    }

    fn entries(&self, cell: usize) -> &[u32] {
        &self.entries[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Returns whether any triangle contains a point.
    pub(super) fn contains(&self, point: DVec2, triangles: &[[DVec2; 3]]) -> bool {
        if !self.bounds.contains(point) {
            return false;
        }
        let cell = self.row(point.y) * self.columns + self.column(point.x);
        match self.coverage[cell] {
            CellOverlap::Outside => false,
            CellOverlap::Inside => true,
            CellOverlap::Crossed => {
                self.entries(cell).iter().any(|&index| holds(&triangles[index as usize], point))
            }
        }
    }

    /// Returns whether any triangle overlaps a rectangle.
    pub(super) fn may_overlap(&self, rectangle: Rectangle, triangles: &[[DVec2; 3]]) -> bool {
        if !rectangle.overlaps(self.bounds) {
            return false;
        }
        let Rectangle { min, max } = rectangle;
        (self.row(min.y)..=self.row(max.y)).any(|row| {
            (self.column(min.x)..=self.column(max.x)).any(|column| {
                let cell = row * self.columns + column;
                let overlaps = |&index: &u32| overlaps(&triangles[index as usize], rectangle);
                match self.coverage[cell] {
                    CellOverlap::Outside => false,
                    CellOverlap::Inside => true,
                    CellOverlap::Crossed => self.entries(cell).iter().any(overlaps),
                }
            })
        })
    }
}

/// Returns whether a triangle contains a point; of the points on its outline, it does those that it lies above.
fn holds(&[a, b, c]: &[DVec2; 3], point: DVec2) -> bool {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    let is_left = |start, end| orient2d(coord(start), coord(end), coord(point)) >= 0.0;
    point.y < a.y.max(b.y).max(c.y) && is_left(a, b) && is_left(b, c) && is_left(c, a)
}

/// Returns whether a triangle and a rectangle overlap: no side of either separates them.
fn overlaps(triangle: &[DVec2; 3], Rectangle { min, max }: Rectangle) -> bool {
    let [a, b, c] = *triangle;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let is_separating = |start: DVec2, end: DVec2| {
        // The corner of the rectangle that lies farthest to the left of the side.
        let normal = (end - start).perp();
        let corner = DVec2::select(normal.cmpgt(DVec2::ZERO), max, min);
        normal.dot(corner - start) <= 0.0
    };
    low.cmplt(max).all()
        && high.cmpgt(min).all()
        && !is_separating(a, b)
        && !is_separating(b, c)
        && !is_separating(c, a)
}
