//! Area of the part of a disc that lies in a convex polygon.

use glam::DVec2;

/// Area of the intersection of the unit disc about the origin and a polygon, without unit; its sign is that of the
/// polygon's sense of rotation.
///
/// Green's theorem turns the area into a sum over the edges: each contributes the signed area of its triangle with
/// the origin inside the disc, which is made of triangles and circle segments in closed form.
pub(super) fn disc_area(corners: &[DVec2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&a, &b)| edge_area(a, b)).sum()
}

/// Signed area of the intersection of the unit disc and the triangle of the origin and an edge.
fn edge_area(a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let length = along.length_squared();
    if length == 0.0 {
        return 0.0;
    }
    // The line crosses the circle at `middle ± half`, in units of the edge.
    let middle = -a.dot(along) / length;
    let offset = a.perp_dot(along);
    let half = 1.0 / length - (offset / length).powi(2);
    if half <= 0.0 {
        return sector(a, b);
    }
    let half = half.sqrt();
    let (enter, leave) = (middle - half, middle + half);
    if leave <= 0.0 || enter >= 1.0 {
        return sector(a, b);
    }
    let first = if enter > 0.0 { a + along * enter } else { a };
    let last = if leave < 1.0 { a + along * leave } else { b };
    let mut area = 0.5 * first.perp_dot(last);
    if enter > 0.0 {
        area += sector(a, first);
    }
    if leave < 1.0 {
        area += sector(last, b);
    }
    area
}

/// Signed area of the sector of the unit disc between two directions, which are less than π apart.
fn sector(a: DVec2, b: DVec2) -> f64 {
    0.5 * a.perp_dot(b).atan2(a.dot(b))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> [DVec2; 4] {
        let [[x0, y0], [x1, y1]] = [low, high];
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(DVec2::from)
    }

    #[test]
    fn a_disc_in_a_square_is_whole_and_a_square_in_a_disc_too() {
        assert!((disc_area(&rectangle([-1.0, -1.0], [1.0, 1.0])) - PI).abs() < 1e-14);
        assert!((disc_area(&rectangle([-9.0, -7.0], [4.0, 6.0])) - PI).abs() < 1e-14);
        assert!((disc_area(&rectangle([-0.5, -0.5], [0.5, 0.5])) - 1.0).abs() < 1e-14);
        assert!(disc_area(&rectangle([1.5, -1.0], [2.0, 1.0])).abs() < 1e-14);
        assert!(disc_area(&rectangle([0.8, 0.8], [2.0, 2.0])).abs() < 1e-14);
    }

    /// Area of the disc left of `x = d`: `π - acos d + d √(1 - d²)`.
    #[test]
    fn a_line_cuts_off_a_circle_segment() {
        for step in -9..10 {
            let d = 0.1 * f64::from(step);
            let expected = PI - d.acos() + d * (1.0 - d * d).sqrt();
            let area = disc_area(&rectangle([-1.0, -1.0], [d, 1.0]));
            assert!((area - expected).abs() < 1e-14, "{d}: {area} for {expected}");
        }
    }

    /// A quarter of the disc, seen from a corner that lies in it: `∫ (√(1 - x²) - b) dx` from a to √(1 - b²).
    #[test]
    fn a_corner_inside_the_disc_leaves_the_integral() {
        let (a, b) = (0.3_f64, -0.2_f64);
        let primitive = |x: f64| 0.5 * (x * (1.0 - x * x).sqrt() + x.asin());
        let end = (1.0 - b * b).sqrt();
        // Above the axis all of it, below it down to b while the circle is farther.
        let above = primitive(1.0) - primitive(a);
        let below = -b * (end - a) + primitive(1.0) - primitive(end);
        let area = disc_area(&rectangle([a, b], [3.0, 3.0]));
        assert!((area - above - below).abs() < 1e-14, "{area}");
    }
}
