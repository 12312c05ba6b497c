use glam::DVec2;

/// Material of the ground, by cells of a rectilinear grid over its rectangle.
#[derive(Clone, Debug)]
pub(super) struct CoverGrid {
    /// Borders of cells from west to east, m from the corner; the first and last are its sides.
    pub(super) xs: Vec<f64>,
    /// Borders of cells from south to north.
    pub(super) ys: Vec<f64>,
    /// Part of each cell, shape `[ys - 1, xs - 1]`.
    pub(super) parts: Vec<u16>,
}

/// The part that is not there.
pub(super) const HOLE: u16 = u16::MAX;

impl CoverGrid {
    /// One part all over.
    pub(super) fn whole(size: DVec2) -> Self {
        Self { xs: vec![0.0, size.x], ys: vec![0.0, size.y], parts: vec![0] }
    }

    /// This cover, with holes where the other one has any.
    pub(super) fn with_holes_of(&self, other: &Self) -> Self {
        let (xs, ys) = (merged(&self.xs, &other.xs), merged(&self.ys, &other.ys));
        let mut parts = Vec::with_capacity((xs.len() - 1) * (ys.len() - 1));
        for y in ys.windows(2) {
            for x in xs.windows(2) {
                let at = 0.5 * DVec2::new(x[0] + x[1], y[0] + y[1]);
                let hole = other.part(at) == HOLE;
                parts.push(if hole { HOLE } else { self.part(at) });
            }
        }
        Self { xs, ys, parts }
    }

    /// Part at a place.
    pub(super) fn part(&self, at: DVec2) -> u16 {
        let cell = |points: &[f64], value: f64| {
            points.partition_point(|&p| p <= value).clamp(1, points.len() - 1) - 1
        };
        self.parts[cell(&self.ys, at.y) * (self.xs.len() - 1) + cell(&self.xs, at.x)]
    }

    /// Borders between different parts: straight lines from corner to corner or junction.
    pub(super) fn borders(&self) -> Vec<[DVec2; 2]> {
        let (columns, rows) = (self.xs.len() - 1, self.ys.len() - 1);
        let part = |x: usize, y: usize| self.parts[y * columns + x];
        // Whether a border runs from lattice point (x, y) to the north, and to the east.
        let north =
            |x: usize, y: usize| x > 0 && x < columns && y < rows && part(x - 1, y) != part(x, y);
        let east =
            |x: usize, y: usize| y > 0 && y < rows && x < columns && part(x, y - 1) != part(x, y);
        let point = |x: usize, y: usize| DVec2::new(self.xs[x], self.ys[y]);
        let mut borders = Vec::new();
        for x in 1..columns {
            let mut start = None;
            for y in 0..=rows {
                let crossed = y < rows && (east(x - 1, y) || east(x, y));
                let ends = !north(x, y) || crossed;
                if let Some(from) = start.filter(|_| ends) {
                    borders.push([point(x, from), point(x, y)]);
                    start = None;
                }
                if north(x, y) {
                    start = start.or(Some(y));
                }
            }
        }
        for y in 1..rows {
            let mut start = None;
            for x in 0..=columns {
                let crossed = x < columns && (north(x, y - 1) || north(x, y));
                let ends = !east(x, y) || crossed;
                if let Some(from) = start.filter(|_| ends) {
                    borders.push([point(from, y), point(x, y)]);
                    start = None;
                }
                if east(x, y) {
                    start = start.or(Some(x));
                }
            }
        }
        borders
    }
}

/// Points of both lists in order; those that differ by rounding alone are one.
fn merged(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut all: Vec<f64> = a.iter().chain(b).copied().collect();
    all.sort_unstable_by(f64::total_cmp);
    let size = all.last().copied().unwrap_or(1.0);
    all.dedup_by(|next, kept| *next - *kept <= 1e-9 * size);
    // The sides stay exactly where they are.
    if let Some(last) = all.last_mut() {
        *last = size;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn borders_are_straight_lines_between_corners_and_junctions() {
        // From the south: 0 0 1 / 0 0 1 / 2 2 1.
        let cover = CoverGrid {
            xs: vec![0.0, 1.0, 2.0, 3.0],
            ys: vec![0.0, 1.0, 2.0, 3.0],
            parts: vec![0, 0, 1, 0, 0, 1, 2, 2, 1],
        };
        let line = |a: (f64, f64), b: (f64, f64)| [DVec2::from(a), DVec2::from(b)];
        assert_eq!(
            cover.borders(),
            [
                line((2.0, 0.0), (2.0, 2.0)),
                line((2.0, 2.0), (2.0, 3.0)),
                line((0.0, 2.0), (2.0, 2.0))
            ]
        );
    }

    #[test]
    fn holes_are_laid_over_a_cover_of_other_cells() {
        let cover = CoverGrid { xs: vec![0.0, 1.0, 3.0], ys: vec![0.0, 3.0], parts: vec![4, 5] };
        let holes = CoverGrid { xs: vec![0.0, 2.0, 3.0], ys: vec![0.0, 3.0], parts: vec![0, HOLE] };
        let both = cover.with_holes_of(&holes);
        assert_eq!((both.xs, both.parts), (vec![0.0, 1.0, 2.0, 3.0], vec![4, 5, HOLE]));
    }
}
