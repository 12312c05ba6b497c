//! Tiles that an image is cut into.

use glam::UVec2;

/// Side of a tile, the square of pixels that one block traces.
pub(super) const SIDE: u32 = 16;

/// Tiles of an image, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct TileGrid {
    /// Columns and rows of pixels.
    pub(super) size: UVec2,
}

impl TileGrid {
    /// Columns and rows of tiles.
    pub(super) const fn counts(self) -> UVec2 {
        UVec2::new(self.size.x.div_ceil(SIDE), self.size.y.div_ceil(SIDE))
    }

    /// Number of tiles.
    pub(super) const fn len(self) -> usize {
        let UVec2 { x, y } = self.counts();
        x as usize * y as usize
    }

    /// First pixel of a tile, and the pixel behind its last one.
    pub(super) fn corners(self, tile: usize) -> (UVec2, UVec2) {
        let across = self.counts().x as usize;
        let low = SIDE * UVec2::new((tile % across) as u32, (tile / across) as u32);
        (low, (low + SIDE).min(self.size))
    }

    /// Corners of all tiles.
    pub(super) fn iter(self) -> impl ExactSizeIterator<Item = (UVec2, UVec2)> {
        (0..self.len()).map(move |tile| self.corners(tile))
    }
}
