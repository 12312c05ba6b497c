//! Leaves that intersect no other leaf.

use glam::{DVec3, I64Vec3, Vec3};

use super::stream::{Purpose, Stream};
use super::{CrownError, CrownSpec, Places};
use crate::components::Disc;

/// Places that a leaf is tried at, at most.
const MOST_TRIES: u64 = 10_000;

/// Places that all leaves are tried at, at most: so many, and so many more per leaf.
const ALL_TRIES: (u64, u64) = (100_000, 30);

/// Factor by which leaves are larger when they are compared, so that rounding to f32 joins none.
const MARGIN: f64 = 1.0 + 1e-4;

/// A flat, convex piece of a leaf.
pub(super) trait Flat: Copy {
    /// A point of its plane, in its middle.
    fn middle(&self) -> DVec3;

    /// Unit normal.
    fn normal(&self) -> DVec3;

    /// Radius of the sphere around its middle that holds it.
    fn reach(&self) -> f64;

    /// The part of its intersection with a plane, as an interval along the direction of that line; `None` if it
    /// does not touch the plane.
    fn chord(&self, cut: &Cut) -> Option<(f64, f64)>;
}

/// A plane that cuts a piece, and the unit direction of the line in which it does.
pub(super) struct Cut {
    middle: DVec3,
    normal: DVec3,
    along: DVec3,
}

impl Flat for Disc {
    fn middle(&self) -> DVec3 {
        self.center.as_dvec3()
    }

    fn normal(&self) -> DVec3 {
        self.normal.as_dvec3().normalize_or(DVec3::Z)
    }

    fn reach(&self) -> f64 {
        MARGIN * f64::from(self.radius)
    }

    fn chord(&self, cut: &Cut) -> Option<(f64, f64)> {
        let (middle, normal, radius) = (self.middle(), self.normal(), self.reach());
        // In the disc's plane, across the line: the way to the line and half of the chord are the sides of a
        // right triangle.
        let across = normal.cross(cut.along);
        let way = (cut.middle - middle).dot(cut.normal) / across.dot(cut.normal);
        let half = (radius * radius - way * way).sqrt();
        let foot = cut.along.dot(middle);
        (way.abs() <= radius).then_some((foot - half, foot + half))
    }
}

impl Flat for [Vec3; 4] {
    fn middle(&self) -> DVec3 {
        let [a, b, c, d] = self.map(Vec3::as_dvec3);
        0.25 * (a + b + c + d)
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c, d] = self.map(Vec3::as_dvec3);
        (c - a).cross(d - b).normalize_or(DVec3::Z)
    }

    fn reach(&self) -> f64 {
        let middle = self.middle();
        MARGIN * self.iter().map(|c| c.as_dvec3().distance(middle)).fold(0.0, f64::max)
    }

    fn chord(&self, cut: &Cut) -> Option<(f64, f64)> {
        let middle = self.middle();
        let corners = self.map(|corner| middle + MARGIN * (corner.as_dvec3() - middle));
        let heights = corners.map(|corner| (corner - cut.middle).dot(cut.normal));
        let mut chord: Option<(f64, f64)> = None;
        for start in 0..4 {
            let end = (start + 1) % 4;
            let (low, high) = (heights[start], heights[end]);
            if low.min(high) > 0.0 || low.max(high) < 0.0 {
                continue;
            }
            // A side in the plane counts by its start, and the next side by its end.
            let share = if low - high == 0.0 { 0.0 } else { low / (low - high) };
            let at = cut.along.dot(corners[start].lerp(corners[end], share));
            chord = Some(chord.map_or((at, at), |(least, most)| (least.min(at), most.max(at))));
        }
        chord
    }
}

/// Returns whether two pieces have a point in common. Pieces in one plane count if their spheres intersect.
pub(super) fn intersect<F: Flat>(a: &F, b: &F) -> bool {
    let (middle, other) = (a.middle(), b.middle());
    let reach = a.reach() + b.reach();
    if middle.distance_squared(other) > reach * reach {
        return false;
    }
    let normals = (a.normal(), b.normal());
    let Some(along) = normals.0.cross(normals.1).try_normalize() else {
        return (other - middle).dot(normals.0).abs() <= 1e-9 * reach;
    };
    let Some(first) = a.chord(&Cut { middle: other, normal: normals.1, along }) else {
        return false;
    };
    let Some(second) = b.chord(&Cut { middle, normal: normals.0, along }) else { return false };
    first.0 <= second.1 && second.0 <= first.1
}

/// Pieces, to be found by where they are: lists of those whose cells of a grid share a bucket.
struct Grid<F> {
    /// Side of a cell: pieces that intersect are in the same cell or in neighbours.
    cell: f64,
    /// First piece of each bucket's list.
    heads: Vec<u32>,
    /// Next piece of the list of each piece.
    next: Vec<u32>,
    pieces: Vec<F>,
}

/// Ends a list.
const NONE: u32 = u32::MAX;

impl<F: Flat> Grid<F> {
    fn new(reach: f64, count: usize) -> Self {
        Self {
            cell: 2.0 * reach,
            heads: vec![NONE; (2 * count).next_power_of_two()],
            next: Vec::with_capacity(count),
            pieces: Vec::with_capacity(count),
        }
    }

    fn cell_of(&self, piece: &F) -> I64Vec3 {
        (piece.middle() / self.cell).floor().as_i64vec3()
    }

    fn bucket(&self, I64Vec3 { x, y, z }: I64Vec3) -> usize {
        let mut bits = 0_u64;
        for axis in [x, y, z] {
            bits = (bits ^ axis as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            bits ^= bits >> 32;
        }
        bits as usize & (self.heads.len() - 1)
    }

    fn is_free(&self, piece: &F) -> bool {
        let cell = self.cell_of(piece);
        let neighbours = (0..27).map(|i| I64Vec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        for neighbour in neighbours {
            let mut index = self.heads[self.bucket(cell + neighbour)];
            while index != NONE {
                if intersect(piece, &self.pieces[index as usize]) {
                    return false;
                }
                index = self.next[index as usize];
            }
        }
        true
    }

    fn add(&mut self, piece: F) {
        let bucket = self.bucket(self.cell_of(&piece));
        self.next.push(self.heads[bucket]);
        self.heads[bucket] = self.pieces.len() as u32;
        self.pieces.push(piece);
    }
}

/// Pieces of `count` leaves, of which none intersects a piece of another leaf. `leaf` makes those of a leaf
/// around its middle.
///
/// Random sequential addition: each leaf keeps its inclination and turn, and is tried at one place of its
/// random stream after the other until it fits. So the first leaves, and all that overlap none before them,
/// are where they are in the crown whose leaves may overlap.
///
/// # Errors
/// A leaf that finds no place.
pub(super) fn place<F, L, P>(
    crown: &CrownSpec,
    count: usize,
    places: &Places<'_>,
    leaf: impl Fn(u64) -> L,
) -> Result<Vec<F>, CrownError>
where
    F: Flat,
    L: Fn(DVec3) -> P,
    P: IntoIterator<Item = F>,
{
    let mut candidate: Vec<F> = Vec::new();
    let mut grid: Option<Grid<F>> = None;
    let mut tries = ALL_TRIES.0 + ALL_TRIES.1 * count as u64;
    for index in 0..count as u64 {
        let around = leaf(index);
        let random = &mut Stream::new(crown.seed, Purpose::Position, index);
        let most = tries.min(MOST_TRIES);
        let fits = (0..most).any(|_| {
            tries -= 1;
            candidate.clear();
            candidate.extend(around(places.draw(index, random) + DVec3::Z * crown.base_m));
            grid.as_ref().is_none_or(|grid| candidate.iter().all(|piece| grid.is_free(piece)))
        });
        if !fits {
            return Err(CrownError::NoRoom { placed: index, count: count as u64 });
        }
        // All pieces are of one size but for rounding.
        let reach = || MARGIN * candidate.iter().map(Flat::reach).fold(0.0, f64::max);
        let grid = grid.get_or_insert_with(|| Grid::new(reach(), count * candidate.len()));
        candidate.drain(..).for_each(|piece| grid.add(piece));
    }
    Ok(grid.map_or_else(Vec::new, |grid| grid.pieces))
}
