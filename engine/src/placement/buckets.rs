//! Spatial hash of stems, to find those nearby.

use std::hint::black_box;

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
    cells: Vec<Bucket>,
    /// Index of the point before each one in its bucket, or [`NONE`].
    previous: Vec<u32>,
    pub(super) points: Vec<DVec2>,
}

/// Newest point of a bucket, held in place: a query then reads three short pieces of memory, one per row.
#[derive(Clone, Copy, Debug)]
struct Bucket {
    /// Not a number if there is none.
    newest: DVec2,
    /// Its index, or [`NONE`].
    index: u32,
    /// Index of the point before it, or [`NONE`].
    previous: u32,
}

impl Bucket {
    const EMPTY: Self = Self { newest: DVec2::NAN, index: NONE, previous: NONE };
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
            cells: vec![Bucket::EMPTY; columns * rows],
            previous: Vec::new(),
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
        let bucket = &mut self.cells[row * self.columns + column];
        self.previous.push(bucket.index);
        let index = self.points.len() as u32;
        *bucket = Bucket { newest: point, previous: bucket.index, index };
        self.points.push(point);
    }

    /// Returns the offset from one point to another, or to its nearest periodic image.
    pub(super) fn offset(&self, from: DVec2, to: DVec2) -> DVec2 {
        let offset = to - from;
        if !self.is_periodic {
            return offset;
        }
        let size = self.rectangle.size();
        if offset.abs().cmplt(0.25 * size).all() {
            // The nearest image is the point itself.
            return offset;
        }
        offset - size * (offset / size).round()
    }

    /// Returns whether a condition holds for the offset from a point to any point within the distance, at least.
    pub(super) fn any_near(&self, point: DVec2, is_near: impl Fn(DVec2) -> bool) -> bool {
        let (column, row) = self.place(point);
        let columns = around(column, self.columns, self.is_periodic);
        let rows = around(row, self.rows, self.is_periodic);
        rows.into_iter().flatten().any(|row| {
            columns.into_iter().flatten().any(|column| {
                let bucket = &self.cells[row * self.columns + column];
                if bucket.index == NONE {
                    return false;
                }
                if is_near(self.offset(point, bucket.newest)) {
                    return true;
                }
                let mut at = bucket.previous;
                while at != NONE {
                    if is_near(self.offset(point, self.points[at as usize])) {
                        return true;
                    }
                    at = self.previous[at as usize];
                }
                false
            })
        })
    }

    /// Reads the buckets around a point, so that they are in the cache afterwards.
    pub(super) fn touch(&self, point: DVec2) {
        let (column, row) = self.place(point);
        let rows = around(row, self.rows, self.is_periodic);
        for row in rows.into_iter().flatten() {
            black_box(self.cells[row * self.columns + column].index);
        }
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
