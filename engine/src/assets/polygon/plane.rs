use glam::{DVec2, DVec3};

/// Share of the square of its extent below which a polygon's mean normal is rounding.
const FLAT: f64 = 1e-12;

/// A polygon in the plane across its mean normal (Newell), counter-clockwise, relative to its first corner.
pub(super) fn project(corners: &[DVec3]) -> Vec<DVec2> {
    // Relative to the first corner: far from the origin, products of coordinates lose all digits.
    let from_first = |index: usize| corners[index % corners.len()] - corners[0];
    let double_area: DVec3 =
        (0..corners.len()).map(|i| from_first(i).cross(from_first(i + 1))).sum();
    let far = (0..corners.len()).map(|i| from_first(i).abs().max_element()).fold(0.0, f64::max);
    let normal = if double_area.length() > FLAT * far * far {
        double_area.normalize_or(DVec3::Z)
    } else {
        normal_of_widest(corners)
    };
    let (right, up) = normal.any_orthonormal_pair();
    let flat = |i| DVec2::new(right.dot(from_first(i)), up.dot(from_first(i)));
    // The pair may be left-handed with the normal or not: that is asked, not assumed.
    let handed = right.cross(up).dot(normal).signum();
    (0..corners.len()).map(|i| flat(i) * DVec2::new(handed, 1.0)).collect()
}

/// Normal of a wide triangle of corners: of an outline that crosses itself, areas may cancel.
fn normal_of_widest(corners: &[DVec3]) -> DVec3 {
    let first = corners[0];
    let farthest = |measure: &dyn Fn(DVec3) -> f64| {
        let farther = |a: DVec3, b: DVec3| if measure(b) > measure(a) { b } else { a };
        corners.iter().copied().reduce(farther).unwrap_or(first)
    };
    let second = farthest(&|point| point.distance_squared(first));
    let along = second - first;
    let third = farthest(&|point| along.cross(point - first).length_squared());
    along.cross(third - first).try_normalize().unwrap_or(DVec3::Z)
}
