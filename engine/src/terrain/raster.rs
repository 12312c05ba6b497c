use super::Cells;
use super::cover::{CoverGrid, HOLE};
use super::grid::HeightGrid;
use super::surface::{Parts, TerrainSurface};
use super::tin::triangulate;
use crate::components::TerrainPatch;

/// The ground of a raster of heights, m, triangulated so that its surface passes within `tolerance`
/// of the height at the centre of every cell, measured vertically, plus the rounding of f32 over the
/// heights' range. Cells of NaN are holes, cut out along the sides of the cells.
///
/// From the outermost centres the ground goes on to the sides of the rectangle with the slope that
/// it has there. `cover` holds the part of each of its cells, 0 up to the number of `parts`, and
/// covers the rectangle; where it changes, so do triangles, exactly.
///
/// `None` if there is no height at all.
#[must_use]
pub fn raster(
    heights: &Cells<f64>,
    tolerance: f64,
    cover: Option<&Cells<u16>>,
    parts: Parts,
    is_periodic: bool,
) -> Option<TerrainPatch> {
    let (corner, size) = (heights.corner, heights.size);
    let grid = HeightGrid::of_cells(heights.columns, heights.rows, &heights.values, size);
    let (low, high) = grid.range()?;
    let mut parts_of_cells =
        cover.map_or_else(|| CoverGrid::whole(size), |cover| of(cover, heights));
    if heights.values.iter().any(|height| height.is_nan()) {
        let holes = heights.values.iter().map(|h| if h.is_nan() { HOLE } else { 0 }).collect();
        let holes = Cells { values: holes, ..heights.with(Vec::new()) };
        parts_of_cells = parts_of_cells.with_holes_of(&of(&holes, heights));
    }
    let rounding = (high - low).max(low.abs().max(high.abs()) * f64::from(f32::EPSILON))
        * f64::from(f32::EPSILON);
    let tin = triangulate(&grid, &parts_of_cells, tolerance.max(rounding));
    let surface = TerrainSurface::new(corner, size, &tin.corners, tin.triangles);
    Some(surface.finish(parts, is_periodic))
}

/// A cover over the rectangle of the heights, clipped to it.
fn of(cover: &Cells<u16>, heights: &Cells<f64>) -> CoverGrid {
    let shift = cover.corner - heights.corner;
    let lines = |count: usize, axis: usize| -> (Vec<f64>, std::ops::Range<usize>) {
        let line = |i: usize| shift[axis] + cover.size[axis] * i as f64 / count as f64;
        let size = heights.size[axis];
        // Lines beside the rectangle, or on its sides but for rounding, are not needed.
        let room = 1e-9 * size;
        let first = (0..count).rev().find(|&i| line(i) <= room).unwrap_or(0);
        let end = (first + 1..=count).find(|&i| line(i) >= size - room).unwrap_or(count);
        let mut lines: Vec<f64> = (first..=end).map(line).collect();
        let last = lines.len() - 1;
        (lines[0], lines[last]) = (0.0, size);
        (lines, first..end)
    };
    let (xs, columns) = lines(cover.columns, 0);
    let (ys, rows) = lines(cover.rows, 1);
    let row = |y: usize| (cover.rows - 1 - y) * cover.columns;
    let parts = rows.flat_map(|y| &cover.values[row(y)..][columns.clone()]).copied().collect();
    CoverGrid { xs, ys, parts }
}
