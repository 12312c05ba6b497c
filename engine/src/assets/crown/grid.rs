//! Grid that finds what is near a place.

use glam::{DVec3, I64Vec3};

/// An item with a place.
pub(super) trait Located {
    /// Its place.
    fn place(&self) -> DVec3;
}

impl Located for DVec3 {
    fn place(&self) -> DVec3 {
        *self
    }
}

/// Items in a hashed grid: lists of those whose cells share a bucket.
pub(super) struct LeafGrid<T> {
    /// Side of a cell: items within this distance are in the same cell or in neighbours.
    cell: f64,
    /// First item of each bucket's list.
    heads: Vec<u32>,
    /// Next item of the list of each item.
    next: Vec<u32>,
    items: Vec<T>,
}

/// Ends a list.
const NONE: u32 = u32::MAX;

impl<T: Located> LeafGrid<T> {
    /// A grid for `count` items that finds those within `reach`.
    pub(super) fn new(reach: f64, count: usize) -> Self {
        Self {
            cell: reach,
            heads: vec![NONE; (2 * count).next_power_of_two()],
            next: Vec::with_capacity(count),
            items: Vec::with_capacity(count),
        }
    }

    /// Distance within which items are found.
    pub(super) fn reach(&self) -> f64 {
        self.cell
    }

    /// Returns whether a condition holds for an item near a place. All items within the reach are asked, and
    /// some beyond it.
    pub(super) fn any_near(&self, place: DVec3, condition: impl Fn(&T) -> bool) -> bool {
        let cell = self.cell_of(place);
        let neighbours = (0..27).map(|i| I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        for neighbour in neighbours {
            let mut index = self.heads[self.bucket(cell + neighbour)];
            while index != NONE {
                if condition(&self.items[index as usize]) {
                    return true;
                }
                index = self.next[index as usize];
            }
        }
        false
    }

    pub(super) fn add(&mut self, item: T) {
        let bucket = self.bucket(self.cell_of(item.place()));
        self.next.push(self.heads[bucket]);
        self.heads[bucket] = self.items.len() as u32;
        self.items.push(item);
    }

    /// Items in the order in which they were added.
    pub(super) fn into_items(self) -> Vec<T> {
        self.items
    }

    fn cell_of(&self, place: DVec3) -> I64Vec3 {
        (place / self.cell).floor().as_i64vec3()
    }

    fn bucket(&self, I64Vec3 { x, y, z }: I64Vec3) -> usize {
        let mut bits = 0_u64;
        for axis in [x, y, z] {
            bits = (bits ^ axis as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            bits ^= bits >> 32;
        }
        bits as usize & (self.heads.len() - 1)
    }
}
