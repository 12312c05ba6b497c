//! Tests of primitives in `f64`, which decide every hit, whatever instruction set found the candidate.

use glam::DVec3;

/// Distance along a ray, in units of `direction`, to the plane of three corners; `None` if
/// parallel.
#[inline(always)]
pub(super) fn plane_distance(corners: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let [a, b, c] = *corners;
    let normal = (b - a).cross(c - a);
    let slope = normal.dot(direction);
    (slope != 0.0).then(|| normal.dot(a - origin) / slope)
}

/// Returns whether the line of a ray passes through a triangle or parallelogram, or by it at less than
/// `blur`, a bound of the distance that rounding may have moved the ray by.
///
/// A ray through a common edge or corner of several primitives thus hits at least one of them, even
/// if they belong to instances with their own rounding. A primitive that is parallel to the ray is not hit.
#[inline(always)]
pub(super) fn contains(
    corners: &[DVec3; 3],
    is_parallelogram: bool,
    origin: DVec3,
    direction: DVec3,
    blur: f64,
) -> bool {
    let size = direction.abs();
    let along =
        if size.z >= size.x && size.z >= size.y { 2 } else { usize::from(size.y >= size.x) };
    let (right, up) = ((along + 1) % 3, (along + 2) % 3);
    // Corners are sheared along the ray, which does not lengthen distances across it.
    let (shear_right, shear_up) =
        (direction[right] / direction[along], direction[up] / direction[along]);
    let flat = |corner: DVec3| {
        let v = corner - origin;
        (v[right] - shear_right * v[along], v[up] - shear_up * v[along])
    };
    // Twice the area of the triangle of an edge and the ray: 0 if the ray is on the edge.
    let side = |a: (f64, f64), b: (f64, f64)| {
        let area = a.0 * b.1 - a.1 * b.0;
        let room = blur * ((b.0 - a.0).abs() + (b.1 - a.1).abs());
        i32::from(area > room) - i32::from(area < -room)
    };
    let [a, b, c] = corners.map(flat);
    let sides = if is_parallelogram {
        let d = flat(corners[1] + corners[2] - corners[0]);
        [side(a, b), side(b, d), side(d, c), side(c, a)]
    } else {
        [side(a, b), side(b, c), side(c, a), 0]
    };
    sides.iter().any(|&side| side > 0) != sides.iter().any(|&side| side < 0)
}

/// Distance along a ray to a disc; `None` if it misses or is parallel.
#[inline(always)]
pub(super) fn disc_distance(
    center: DVec3,
    normal: DVec3,
    radius: f64,
    origin: DVec3,
    direction: DVec3,
) -> Option<f64> {
    let slope = normal.dot(direction);
    if slope == 0.0 {
        return None;
    }
    let distance = normal.dot(center - origin) / slope;
    let off = origin + distance * direction - center;
    (off.length_squared() <= radius * radius).then_some(distance)
}
