use glam::DVec2;

/// Fraction of a pixel below which an extent counts as a whole number of pixels.
const ROUNDING: f64 = 1e-6;

/// Whole square pixels that cover a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGrid {
    /// Columns and rows; each a whole number of at least 1.
    pub counts: DVec2,
    /// Width and height of all pixels together, m.
    pub extent: DVec2,
    /// True if the pixels cover more than the rectangle, beyond rounding.
    pub has_grown: bool,
}

impl PixelGrid {
    /// Returns the fewest pixels of the given side, m, that cover a rectangle of the given width and
    /// height, m.
    #[must_use]
    pub fn covering(extent: DVec2, side: f64) -> Self {
        let exact = extent / side;
        let nearest = exact.round();
        let is_whole =
            (exact - nearest).abs().cmple(DVec2::splat(ROUNDING)) & nearest.cmpge(DVec2::ONE);
        let counts = DVec2::select(is_whole, nearest, exact.ceil().max(DVec2::ONE));
        Self { counts, extent: counts * side, has_grown: !is_whole.all() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extent_of_whole_pixels_keeps_its_size() {
        let grid = PixelGrid::covering(DVec2::new(0.3, 20.0), 0.1);
        assert_eq!(grid.counts, DVec2::new(3.0, 200.0));
        assert!(!grid.has_grown, "0.3 / 0.1 is 2.9999999999999996");
        assert!(grid.extent.abs_diff_eq(DVec2::new(0.3, 20.0), 1e-12));
    }

    #[test]
    fn any_other_extent_grows_to_the_next_whole_pixel() {
        let grid = PixelGrid::covering(DVec2::new(10.2, 0.1), 0.5);
        assert_eq!((grid.counts, grid.extent), (DVec2::new(21.0, 1.0), DVec2::new(10.5, 0.5)));
        assert!(grid.has_grown);
    }
}
