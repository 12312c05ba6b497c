use glam::DQuat;
use proptest::prelude::*;

use super::*;

fn pieces(corners: &[DVec3]) -> Pieces {
    let mut pieces = Pieces::default();
    assert_eq!(triangulate(corners, &mut pieces), Ok(()));
    pieces
}

/// Area of all triangles.
fn area(corners: &[DVec3]) -> f64 {
    let pieces = pieces(corners);
    let points: Vec<DVec3> = corners.iter().chain(&pieces.crossings).copied().collect();
    let area_of = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|i| points[i]);
        (b - a).cross(c - a).length() / 2.0
    };
    pieces.triangles.iter().map(area_of).sum()
}

/// Number of counter-clockwise turns of a closed line around a point.
fn winding_number(line: &[DVec2], point: DVec2) -> i32 {
    let mut winding = 0;
    for (&start, &end) in line.iter().zip(line.iter().cycle().skip(1)) {
        let is_above = |corner: DVec2| corner.y > point.y;
        if is_above(start) != is_above(end) {
            let side = turn([start, end, point]);
            winding += match is_above(end) {
                true if side > 0.0 => 1,
                false if side < 0.0 => -1,
                _ => 0,
            };
        }
    }
    winding
}

fn shoelace(points: &[DVec2]) -> f64 {
    let following = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(following).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

fn polygon(points: &[(f64, f64)]) -> Vec<DVec3> {
    // In a slanted plane whose map to (x, y) keeps areas up to the factor sqrt(1 + 1 + 4).
    points.iter().map(|&(x, y)| DVec3::new(x, y, x - 2.0 * y + 7.0)).collect()
}

#[test]
fn triangles_of_concave_polygons_cover_them_once() {
    let slant = 6_f64.sqrt();
    let arrow = [(0.0, 0.0), (2.0, -1.0), (0.0, 2.0), (-2.0, -1.0)];
    let l = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
    let comb = [
        (0.0, 0.0),
        (5.0, 0.0),
        (5.0, 3.0),
        (4.0, 3.0),
        (4.0, 1.0),
        (3.0, 1.0),
        (3.0, 3.0),
        (2.0, 3.0),
        (2.0, 1.0),
        (1.0, 1.0),
        (1.0, 3.0),
        (0.0, 3.0),
    ];
    for (points, expected) in [(&arrow[..], 4.0), (&l, 5.0), (&comb, 11.0)] {
        for start in 0..points.len() {
            let mut turned = points.to_vec();
            turned.rotate_left(start);
            let corners = polygon(&turned);
            assert!((area(&corners) - expected * slant).abs() < 1e-12, "{turned:?}");
            let backwards: Vec<_> = corners.into_iter().rev().collect();
            assert!((area(&backwards) - expected * slant).abs() < 1e-12, "{turned:?}");
        }
    }
}

#[test]
fn triangles_run_around_like_their_polygon() {
    let corners = polygon(&[(0.0, 0.0), (2.0, -1.0), (0.0, 2.0), (-2.0, -1.0)]);
    for t in pieces(&corners).triangles {
        let [a, b, c] = t.map(|i| corners[i]);
        assert!((b - a).cross(c - a).z > 0.0, "{t:?}");
    }
}

/// A square of 4 m² with one excursion of zero width.
fn square_with(excursion: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut points = vec![(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)];
    points.extend(excursion);
    points.push((-1.0, 1.0));
    points
}

#[test]
fn excursions_of_zero_width_have_no_area() {
    let slant = 6_f64.sqrt();
    let spikes: [&[(f64, f64)]; 9] = [
        // From the middle of a side and from a corner; short, long and inwards.
        &[(0.0, 1.0), (0.0, 3.0), (0.0, 1.0)],
        &[(0.0, 1.0), (0.0, 1.5), (0.0, 1.0)],
        &[(0.0, 1.0), (0.0, 1e4), (0.0, 1.0)],
        &[(1.0, 3.0), (1.0, 1.0)],
        &[(3.0, 3.0), (1.0, 1.0)],
        &[(0.0, 1.0), (0.0, 0.0), (0.0, 1.0)],
        // Of several points, and forked.
        &[(0.0, 1.0), (0.5, 2.0), (-0.3, 3.0), (0.2, 5.0), (-0.3, 3.0), (0.5, 2.0), (0.0, 1.0)],
        &[(0.0, 1.0), (0.0, 2.0), (1.0, 3.0), (0.0, 2.0), (-1.0, 3.0), (0.0, 2.0), (0.0, 1.0)],
        // Through the polygon and out on the other side.
        &[(0.0, 1.0), (0.1, -3.0), (0.0, 1.0)],
    ];
    for spike in spikes {
        let mut points = square_with(spike);
        for _ in 0..points.len() {
            points.rotate_left(1);
            let corners = polygon(&points);
            assert!((area(&corners) - 4.0 * slant).abs() < 1e-6, "{points:?}: {}", area(&corners));
            let backwards: Vec<_> = corners.into_iter().rev().collect();
            assert!((area(&backwards) - 4.0 * slant).abs() < 1e-6, "{points:?}");
            assert!(!pieces(&backwards).is_crossed, "{points:?}");
        }
    }
}

#[test]
fn spikes_narrower_than_f32_resolves_have_no_area_either() {
    for width in [1e-6, 1e-8, 1e-11, 1e-14, 1e-16, -1e-16, -1e-12, -1e-9, -1e-7] {
        let mut points = square_with(&[(0.0, 1.0), (0.7, 3.0), (-width, 1.0)]);
        for _ in 0..points.len() {
            points.rotate_left(1);
            let covered = area(&polygon(&points)) / 6_f64.sqrt();
            assert!((covered - 4.0).abs() < 3.0 * f64::abs(width) + 1e-9, "{width}: {covered}");
        }
    }
}

#[test]
fn what_an_outline_encloses_counts_once() {
    let crossed = |points: &[(f64, f64)], expected: f64| {
        let corners = polygon(points);
        let covered = area(&corners) / 6_f64.sqrt();
        assert!((covered - expected).abs() < 1e-9, "{points:?}: {covered}");
        assert!(pieces(&corners).is_crossed, "{points:?}");
    };
    let bowtie = [(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)];
    crossed(&bowtie, 2.0);
    // A triangle and a square that are run around twice.
    let triangle = [(0.0, 0.0), (2.0, 0.0), (0.0, 2.0)];
    crossed(&[triangle, triangle].concat(), 2.0);
    let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
    crossed(&[square, square].concat(), 4.0);
    // A pentagram: its middle, which the outline runs around twice, is inside.
    let star = |i: u32| {
        let (sin, cos) = (f64::from(2 * i) * std::f64::consts::TAU / 5.0).sin_cos();
        (cos, sin)
    };
    crossed(&(0..5).map(star).collect::<Vec<_>>(), 1.122_569_941_449_635_5);
}

#[test]
fn a_bowtie_stands_in_any_plane() {
    for normal in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(1.0, 2.0, -2.0) / 3.0] {
        let (right, up) = normal.any_orthonormal_pair();
        let flat = [(-1.0, -1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, 1.0)];
        let corners = flat.map(|(x, y)| DVec3::ONE + x * right + y * up);
        assert!((area(&corners) - 2.0).abs() < 1e-12, "{normal}: {}", area(&corners));
        let crossings = pieces(&corners).crossings;
        let is_middle = |point: &DVec3| point.distance(DVec3::ONE) < 1e-9;
        assert!(crossings.iter().any(is_middle), "{crossings:?}");
    }
}

#[test]
fn hopeless_tangles_are_refused_and_lines_have_no_triangle() {
    let corner = |i: u64| {
        let noise = |k: u64| ((i * 7919 + k).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64;
        DVec3::new(noise(1), noise(2), 0.0)
    };
    let corners: Vec<DVec3> = (0..2000).map(corner).collect();
    assert_eq!(triangulate(&corners, &mut Pieces::default()), Err(Tangled));
    for line in [vec![DVec3::ONE; 7], (0..7).map(|i| DVec3::splat(f64::from(i % 4))).collect()] {
        assert!(area(&line) < 1e-12, "{line:?}");
    }
}

/// A polygon whose corners run around a point, by less than 180° each, so that it is simple.
fn simple() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((0.3..1.0_f64, 0.5..1.0_f64), 4..14).prop_map(|corners| {
        let whole: f64 = corners.iter().map(|(_, step)| step).sum();
        let mut angle = 0.0;
        let corner = |&(radius, step): &(f64, f64)| {
            angle += std::f64::consts::TAU * step / whole;
            DVec2::from_angle(angle) * radius
        };
        corners.iter().map(corner).collect()
    })
}

/// Start of a spike, by edge and fraction of it, and its points on the way out.
type Spike = (prop::sample::Index, f64, Vec<(f64, f64)>);

fn spike() -> impl Strategy<Value = Spike> {
    let start = prop_oneof![Just(0.0), 0.0..1.0];
    let way = prop::collection::vec((-2.0..2.0, -2.0..2.0), 1..4);
    (any::<prop::sample::Index>(), start, way)
}

fn add_spike(points: &mut Vec<DVec2>, (edge, share, way): Spike) {
    let edge = edge.index(points.len());
    let start = points[edge].lerp(points[(edge + 1) % points.len()], share);
    let way: Vec<DVec2> = way.into_iter().map(DVec2::from).collect();
    let there_and_back = [start].into_iter().chain(way.iter().copied());
    let back = way.iter().rev().skip(1).copied().chain([start]);
    let spike: Vec<DVec2> = there_and_back.chain(back).collect();
    let behind = points.split_off(edge + 1);
    points.extend(spike);
    points.extend(behind);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    /// Spikes may cross each other and the polygon: on each, the ways out and back cancel.
    #[test]
    fn the_area_is_that_of_the_shoelace_formula(
        points in simple(),
        spikes in prop::collection::vec(spike(), 0..4),
        first in any::<prop::sample::Index>(),
        turn in (any::<[i8; 4]>(), -1e5..1e5_f64),
        backwards in any::<bool>(),
    ) {
        let mut points = points;
        let expected = shoelace(&points);
        for spike in spikes {
            add_spike(&mut points, spike);
        }
        let middle = first.index(points.len());
        points.rotate_left(middle);
        if backwards {
            points.reverse();
        }
        let (axis, far) = turn;
        let turn = DQuat::from_array(axis.map(|x| f64::from(x) + 0.5))
        .normalize();
        let corners: Vec<DVec3> =
            points.iter().map(|p| turn * p.extend(0.0) + DVec3::splat(far)).collect();
        // Coordinates of 10⁵ m keep 10⁻¹¹ m.
        prop_assert!((area(&corners) - expected).abs() < 1e-8, "{} {expected}", area(&corners));
        prop_assert!(!pieces(&corners).is_crossed);
    }

    /// Points are in one triangle if the outline runs around them, else in none.
    #[test]
    fn any_outline_is_covered_once(
        points in prop::collection::vec((-4..5_i8, -4..5_i8), 3..12),
        probes in prop::collection::vec((-4.5..4.5_f64, -4.5..4.5_f64), 40),
    ) {
        let flat: Vec<DVec2> =
            points.iter().map(|&(x, y)| DVec2::new(x.into(), y.into())).collect();
        let corners: Vec<DVec3> = flat.iter().map(|p| p.extend(0.0)).collect();
        let pieces = pieces(&corners);
        let all: Vec<DVec2> =
            corners.iter().chain(&pieces.crossings).map(|corner| corner.truncate()).collect();
        for probe in probes.into_iter().map(DVec2::from) {
            let holds = |t: &&[usize; 3]| winding_number(&t.map(|i| all[i]), probe) != 0;
            let covered = pieces.triangles.iter().filter(holds).count();
            let expected = usize::from(winding_number(&flat, probe) != 0);
            prop_assert_eq!(covered, expected, "{} {:?}", probe, pieces);
        }
    }
}
