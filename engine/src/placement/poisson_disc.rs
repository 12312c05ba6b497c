//! Stems with a minimum distance: random sequential addition.

use glam::DVec2;
use rayon::prelude::*;

use super::buckets::Buckets;
use super::{MOST_STEMS, PlacementError, Region};
use crate::geometry::Rectangle;
use crate::sampling::Key;

/// Number of points with a minimum distance of 1 per unit area when there is no room for more: random
/// sequential addition covers 0.547 of the plane with discs.
///
/// Source: Torquato, Uche and Stillinger (2006), Phys. Rev. E 74, 061308.
const AT_RANDOM: f64 = 0.547 * 4.0 / std::f64::consts::PI;

/// Number of times that cells are cut into four. Gaps that remain are at most 2⁻¹⁶ of the distance wide.
const MOST_CUTS: u32 = 16;

/// Returns points by random sequential addition: uniform points of a region are drawn one after the other, and
/// each is kept if it is at least `distance` from all before it, until there are `wanted`, or no room is left.
///
/// Points are drawn only where there may be room: at first in cells that cover the region, then, repeatedly, in
/// the quarters of these that no disc covers as a whole. The distribution is the same.
///
/// In a tile that repeats, distances count across its borders.
///
/// Source: Ebeida, Mitchell, Patney, Davidson and Owens (2012), "A simple algorithm for maximal
/// Poisson-disk sampling in high dimensions", Computer Graphics Forum 31, 785–794.
///
/// # Errors
/// No room for as many as are wanted; more than a scatter may have.
pub(super) fn poisson_disc(
    region: &Region,
    tile: Option<Rectangle>,
    distance: f64,
    wanted: Option<usize>,
    stream: Key,
) -> Result<Vec<DVec2>, PlacementError> {
    let bounds = region.bounds();
    let at_random = AT_RANDOM * region.area() / (distance * distance);
    if wanted.is_none() && at_random > MOST_STEMS as f64 {
        return Err(PlacementError::TooManyStems { stems: at_random, most: MOST_STEMS });
    }
    if let Some(tile) = tile {
        let side = tile.size().min_element();
        if side < distance && wanted != Some(0) {
            return Err(PlacementError::TooCloseToItself { distance, side });
        }
    }
    let expected = wanted.map_or(at_random, |wanted| wanted as f64).max(1.0);
    let mut buckets =
        Buckets::new(tile.unwrap_or(bounds), tile.is_some(), distance, expected as usize);
    let mut cells = OpenCells::new(bounds, distance, expected);
    cells.active.retain(|&cell| region.may_overlap(cells.grid.rectangle(cell)));
    let mut darts = 0_u64;
    let is_full = |buckets: &Buckets| wanted.is_some_and(|wanted| buckets.points.len() >= wanted);
    for _ in 0..=MOST_CUTS {
        for dart in 0..cells.active.len() {
            if is_full(&buckets) || cells.active.is_empty() {
                break;
            }
            if dart % AHEAD == 0 {
                (darts..).take(AHEAD).for_each(|d| buckets.touch(cells.throw(stream, d).point));
            }
            let Dart { index, rectangle, point } = cells.throw(stream, darts);
            darts += 1;
            if region.contains(point) && !buckets.is_taken(point) {
                buckets.push(point);
                if buckets.covers(rectangle) {
                    cells.active.swap_remove(index);
                }
            }
        }
        if is_full(&buckets) || cells.active.is_empty() {
            break;
        }
        cells.cut(|rectangle| !buckets.covers(rectangle) && region.may_overlap(rectangle));
    }
    match wanted {
        Some(wanted) if buckets.points.len() < wanted => Err(PlacementError::NoRoom {
            placed: buckets.points.len(),
            wanted,
            distance,
            at_random,
            at_most: tightest(region, tile, distance),
        }),
        _ => Ok(buckets.points),
    }
}

/// Number of darts whose surroundings are read together before they are thrown one by one: each dart waits for memory,
/// and the processor fetches that of several at once.
const AHEAD: usize = 8;

/// Upper bound of the number of stems at least `distance` apart: `2 A / (√3 d²)`. Where the plane does not repeat,
/// A includes a border of d/2, because discs may reach beyond the region by that much.
fn tightest(region: &Region, tile: Option<Rectangle>, distance: f64) -> f64 {
    let grown = region.bounds().size() + distance;
    let area = match tile {
        Some(tile) => tile.size().x * tile.size().y,
        None => grown.x * grown.y,
    };
    (2.0 / 3_f64.sqrt() * area / (distance * distance)).floor()
}

/// Grid of cells of one size.
struct CellGrid {
    corner: DVec2,
    side: DVec2,
}

impl CellGrid {
    fn rectangle(&self, [column, row]: [u32; 2]) -> Rectangle {
        let at = |column: u32, row: u32| {
            self.corner + self.side * DVec2::new(f64::from(column), f64::from(row))
        };
        Rectangle { min: at(column, row), max: at(column + 1, row + 1) }
    }
}

/// Point in an open cell.
struct Dart {
    /// Index of the cell.
    index: usize,
    rectangle: Rectangle,
    point: DVec2,
}

/// Cells where there may be room.
struct OpenCells {
    grid: CellGrid,
    active: Vec<[u32; 2]>,
}

impl OpenCells {
    /// Creates cells so small that a stem inside covers them, or larger ones if few stems are expected.
    fn new(bounds: Rectangle, distance: f64, expected: f64) -> Self {
        let size = bounds.size();
        let side = (distance / 2_f64.sqrt()).max((size.x * size.y / (4.0 * expected)).sqrt());
        let count = (size / side).ceil().clamp(DVec2::ONE, DVec2::splat(f64::from(1_u32 << 15)));
        let (columns, rows) = (count.x as u32, count.y as u32);
        let active = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        Self { active: active.collect(), grid: CellGrid { corner: bounds.min, side: size / count } }
    }

    /// Draws a point in one of the cells, of which there is at least one.
    fn throw(&self, stream: Key, dart: u64) -> Dart {
        let draw = |number| stream.uniform(3 * dart + number);
        let index = (draw(0) * self.active.len() as f64) as usize;
        let rectangle = self.grid.rectangle(self.active[index]);
        Dart { index, rectangle, point: rectangle.at(draw(1), draw(2)) }
    }

    /// Cuts each into four and keeps some of these.
    fn cut(&mut self, is_kept: impl Fn(Rectangle) -> bool + Sync) {
        self.grid.side *= 0.5;
        let grid = &self.grid;
        self.active = self
            .active
            .par_iter()
            .flat_map_iter(|&[column, row]| {
                [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [2 * column + x, 2 * row + y])
            })
            .filter(|&cell| is_kept(grid.rectangle(cell)))
            .collect();
    }
}
