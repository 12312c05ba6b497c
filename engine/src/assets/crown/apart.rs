//! Leaves that intersect no other leaf, or keep a minimum distance.

use glam::{DVec3, Vec3};

use super::grid::{LeafGrid, Located};
use super::stream::{Purpose, Stream};
use super::{CrownError, GeneratedCrown, Places};
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

impl<F: Flat> Located for F {
    fn place(&self) -> DVec3 {
        self.middle()
    }
}

/// Leaves that have their place.
struct Settled<F> {
    pieces: LeafGrid<F>,
    /// Centres, if they keep a minimum distance.
    centers: Option<LeafGrid<DVec3>>,
}

impl<F: Flat> Settled<F> {
    fn new(crown: &GeneratedCrown, leaves: usize, leaf: &[F]) -> Self {
        // All pieces are of one size but for rounding.
        let reach = MARGIN * leaf.iter().map(Flat::reach).fold(0.0, f64::max);
        let distance = crown.min_distance_m;
        Self {
            pieces: LeafGrid::new(2.0 * reach, leaves * leaf.len()),
            centers: (distance > 0.0).then(|| LeafGrid::new(distance, leaves)),
        }
    }

    fn has_room_at(&self, center: DVec3) -> bool {
        self.centers.as_ref().is_none_or(|centers| {
            let distance = centers.reach();
            !centers.any_near(center, |other| other.distance_squared(center) < distance * distance)
        })
    }

    fn intersects(&self, leaf: &[F]) -> bool {
        leaf.iter()
            .any(|piece| self.pieces.any_near(piece.middle(), |other| intersect(piece, other)))
    }

    fn add(&mut self, center: DVec3, leaf: &mut Vec<F>) {
        if let Some(centers) = &mut self.centers {
            centers.add(center);
        }
        leaf.drain(..).for_each(|piece| self.pieces.add(piece));
    }
}

/// Pieces of `count` leaves that keep the distances that the crown asks for: none intersects a piece of another
/// leaf, or their centres are at least so far apart. `leaf` makes the pieces of a leaf around its centre.
///
/// Random sequential addition: each leaf keeps its inclination and turn, and is tried at one place of its
/// random stream after the other until it fits. So the first leaves, and all that are apart from those before
/// them, are where they are in the crown of independent leaves.
///
/// # Errors
/// A leaf that finds no place.
pub(super) fn place<F, L, P>(
    crown: &GeneratedCrown,
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
    let mut settled: Option<Settled<F>> = None;
    let mut tries = ALL_TRIES.0 + ALL_TRIES.1 * count as u64;
    for index in 0..count as u64 {
        let around = leaf(index);
        let random = &mut Stream::new(crown.seed, Purpose::Position, index);
        let most = tries.min(MOST_TRIES);
        let center = (0..most).find_map(|_| {
            tries -= 1;
            let center = places.draw(index, random) + DVec3::Z * crown.base_m;
            // Discs are stored in f32: the distance holds between stored centres.
            let stored = center.as_vec3().as_dvec3();
            if settled.as_ref().is_some_and(|settled| !settled.has_room_at(stored)) {
                return None;
            }
            candidate.clear();
            candidate.extend(around(center));
            let crosses = |settled: &Settled<F>| !crown.overlap && settled.intersects(&candidate);
            (!settled.as_ref().is_some_and(crosses)).then_some(stored)
        });
        let Some(center) = center else { return Err(no_room(crown, index, count as u64)) };
        settled
            .get_or_insert_with(|| Settled::new(crown, count, &candidate))
            .add(center, &mut candidate);
    }
    Ok(settled.map_or_else(Vec::new, |settled| settled.pieces.into_items()))
}

fn no_room(crown: &GeneratedCrown, placed: u64, count: u64) -> CrownError {
    let distance = crown.min_distance_m;
    if distance == 0.0 {
        return CrownError::NoRoom { placed, count };
    }
    // Equal fractions of the volume are filled if the cube of the distance falls as the number of leaves grows. The
    // factor is for the rim, where a larger distance fits more leaves, and for saturation.
    let possible = 0.85 * distance * (placed as f64 / count as f64).cbrt();
    // Two digits.
    let possible = format!("{possible:.1e}").parse().unwrap_or(possible);
    CrownError::NoRoomAtDistance { placed, count, distance, possible }
}
