use glam::DVec2;

/// Heights at the points of a rectilinear grid: the centres of a raster's cells, and the edges of
/// its rectangle, where the slope of the outermost cells goes on for half a cell.
#[derive(Clone, Debug)]
pub(super) struct HeightGrid {
    /// Positions from west to east, m from the corner; the first is 0.
    pub(super) xs: Vec<f64>,
    /// Positions from south to north, m from the corner.
    pub(super) ys: Vec<f64>,
    /// Heights, m, shape `[ys, xs]`; NaN where there is no data.
    pub(super) heights: Vec<f64>,
}

impl HeightGrid {
    /// Creates the grid from heights of cells, shape `[rows, columns]` with row 0 in the north, over a rectangle.
    pub(super) fn of_cells(columns: usize, rows: usize, cells: &[f64], size: DVec2) -> Self {
        let points = |count: usize, size: f64| -> Vec<f64> {
            let inner = (0..count).map(|cell| (cell as f64 + 0.5) / count as f64 * size);
            std::iter::once(0.0).chain(inner).chain(std::iter::once(size)).collect()
        };
        let (xs, ys) = (points(columns, size.x), points(rows, size.y));
        let width = xs.len();
        let mut heights = vec![f64::NAN; width * ys.len()];
        for (row, cells) in cells.chunks_exact(columns).rev().enumerate() {
            let line = &mut heights[(row + 1) * width..(row + 2) * width];
            line[1..=columns].copy_from_slice(cells);
            line[0] = beyond(line[1], line[2.min(columns)]);
            line[width - 1] = beyond(line[width - 2], line[(width - 2).max(2) - 1]);
        }
        for x in 0..width {
            let at = |y: usize| y * width + x;
            heights[x] = beyond(heights[at(1)], heights[at(2.min(rows))]);
            heights[at(rows + 1)] = beyond(heights[at(rows)], heights[at(rows.max(2) - 1)]);
        }
        Self { xs, ys, heights }
    }

    /// Lowest and highest height, m; `None` where there is none at all.
    pub(super) fn range(&self) -> Option<(f64, f64)> {
        let known = self.heights.iter().filter(|height| !height.is_nan());
        known.fold(None, |range, &height| {
            let (low, high) = range.unwrap_or((height, height));
            Some((height.min(low), height.max(high)))
        })
    }

    pub(super) fn point(&self, node: usize) -> DVec2 {
        DVec2::new(self.xs[node % self.xs.len()], self.ys[node / self.xs.len()])
    }

    /// Bilinear height at a place on the grid, from the corners around it that have one.
    pub(super) fn height(&self, at: DVec2) -> Option<f64> {
        let (x, u) = interval(&self.xs, at.x);
        let (y, v) = interval(&self.ys, at.y);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (dx, dy, weight) in [
            (0, 0, (1.0 - u) * (1.0 - v)),
            (1, 0, u * (1.0 - v)),
            (0, 1, (1.0 - u) * v),
            (1, 1, u * v),
        ] {
            let height = self.heights[(y + dy) * self.xs.len() + x + dx];
            if !height.is_nan() && weight > 0.0 {
                sum += weight * height;
                weights += weight;
            }
        }
        (weights > 0.0).then(|| sum / weights)
    }
}

/// Half a step beyond `last`, along the line from `before`; `before` may be `last` itself.
fn beyond(last: f64, before: f64) -> f64 {
    if before.is_nan() { last } else { last + 0.5 * (last - before) }
}

/// The interval of ascending points that holds a value, and where in it the value is, 0 to 1.
fn interval(points: &[f64], value: f64) -> (usize, f64) {
    let index = points.partition_point(|&point| point <= value).clamp(1, points.len() - 1) - 1;
    let (low, high) = (points[index], points[index + 1]);
    (index, ((value - low) / (high - low)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tilted_plane_goes_on_to_the_edges() {
        // z = 2 x - 3 y + 10 at the centres of 4 x 3 cells of 5 m x 2 m.
        let height = |x: f64, y: f64| 2.0 * x - 3.0 * y + 10.0;
        let cells: Vec<f64> = (0..3)
            .flat_map(|row| (0..4).map(move |column| (column, row)))
            .map(|(column, row)| height(f64::from(column) * 5.0 + 2.5, 5.0 - 2.0 * f64::from(row)))
            .collect();
        let grid = HeightGrid::of_cells(4, 3, &cells, DVec2::new(20.0, 6.0));
        for (node, &found) in grid.heights.iter().enumerate() {
            let at = grid.point(node);
            assert!((found - height(at.x, at.y)).abs() < 1e-12, "{at}: {found}");
        }
        let at = DVec2::new(7.3, 4.4);
        assert!((grid.height(at).unwrap_or(f64::NAN) - height(at.x, at.y)).abs() < 1e-12);
    }

    #[test]
    fn a_single_cell_is_level() {
        let grid = HeightGrid::of_cells(1, 1, &[3.0], DVec2::ONE);
        assert_eq!(grid.heights, [3.0; 9]);
    }

    #[test]
    fn no_height_is_made_of_no_data() {
        let grid = HeightGrid::of_cells(3, 1, &[1.0, f64::NAN, 5.0], DVec2::new(3.0, 1.0));
        assert_eq!(grid.height(DVec2::new(1.5, 0.5)), None);
        assert_eq!(grid.height(DVec2::new(1.0, 0.5)), Some(1.0));
        assert_eq!(grid.range(), Some((1.0, 5.0)));
    }
}
