//! Spatial hash of stems, to find those nearby.

use glam::DVec2;

use crate::geometry::Rectangle;

/// End of the list of a bucket.
const NONE: u32 = u32::MAX;

/// Points in buckets that are at least as wide as the distance of queries, across the borders of a rectangle that
/// repeats.
#[derive(Debug)]
pub(super) struct Buckets {
    rectangle: Rectangle,
    is_periodic: bool,
    columns: usize,
    rows: usize,
    distance: f64,
    heads: Vec<u32>,
    next: Vec<u32>,
    pub(super) points: Vec<DVec2>,
}

impl Buckets {
    /// Creates buckets for about this number of points.
    pub(super) fn new(
        rectangle: Rectangle,
        is_periodic: bool,
        distance: f64,
        points: usize,
    ) -> Self {
        let size = rectangle.size();
        let side = distance.max((size.x * size.y / points.max(1) as f64).sqrt());
        let count = |length: f64| ((length / side).floor() as usize).clamp(1, 1 << 24);
        let (columns, rows) = (count(size.x), count(size.y));
        Self {
            rectangle,
            is_periodic,
            columns,
            rows,
            distance,
            heads: vec![NONE; columns * rows],
            next: Vec::new(),
            points: Vec::new(),
        }
    }

    fn place(&self, point: DVec2) -> (usize, usize) {
        let share = (point - self.rectangle.min) / self.rectangle.size();
        let index = |share: f64, count: usize| ((share * count as f64) as usize).min(count - 1);
        (index(share.x, self.columns), index(share.y, self.rows))
    }

    pub(super) fn push(&mut self, point: DVec2) {
        let (column, row) = self.place(point);
        let head = &mut self.heads[row * self.columns + column];
        self.next.push(*head);
        *head = self.points.len() as u32;
        self.points.push(point);
    }

    /// Returns the offset from one point to another, or to its nearest periodic image.
    pub(super) fn offset(&self, from: DVec2, to: DVec2) -> DVec2 {
        let offset = to - from;
        if !self.is_periodic {
            return offset;
        }
        let size = self.rectangle.size();
        offset - size * (offset / size).round()
    }

    /// Returns whether a condition holds for the offset from a point to any point within the distance, at least.
    pub(super) fn any_near(&self, point: DVec2, is_near: impl Fn(DVec2) -> bool) -> bool {
        let (column, row) = self.place(point);
        let columns = around(column, self.columns, self.is_periodic);
        let rows = around(row, self.rows, self.is_periodic);
        rows.into_iter().flatten().any(|row| {
            columns.into_iter().flatten().any(|column| {
                let mut at = self.heads[row * self.columns + column];
                while at != NONE {
                    if is_near(self.offset(point, self.points[at as usize])) {
                        return true;
                    }
                    at = self.next[at as usize];
                }
                false
            })
        })
    }

    /// Returns whether any point is nearer than the distance.
    pub(super) fn is_taken(&self, point: DVec2) -> bool {
        let least = self.distance * self.distance;
        self.any_near(point, |offset| offset.length_squared() < least)
    }

    /// Returns whether all of a rectangle is nearer than the distance to one of the points.
    pub(super) fn covers(&self, Rectangle { min, max }: Rectangle) -> bool {
        let (center, half) = (0.5 * (min + max), 0.5 * (max - min));
        let least = self.distance * self.distance;
        self.any_near(center, |offset| (offset.abs() + half).length_squared() < least)
    }
}

/// Returns an index and its neighbours, each once.
fn around(index: usize, count: usize, is_periodic: bool) -> [Option<usize>; 3] {
    let (below, above) = if is_periodic {
        ((index + count - 1) % count, (index + 1) % count)
    } else {
        (index.wrapping_sub(1), index + 1)
    };
    let below = (below < count && below != index).then_some(below);
    let above = (above < count && above != index && Some(above) != below).then_some(above);
    [Some(index), below, above]
}
