use std::f64::consts::FRAC_PI_4;

use super::*;
use crate::assets::crown::apart::{Flat, intersect};
use crate::components::Disc;

const SQUARE: LeafShape = LeafShape::Square { side_m: 0.1 };

const RHOMBUS: LeafShape = LeafShape::Rhombus { length_m: 0.2, width_m: 0.05 };

fn apart(shape: CrownShape, leaf: LeafShape, leaf_area_m2: f64) -> GeneratedCrown {
    GeneratedCrown { leaf_area_m2, overlap: false, ..spec(shape, leaf) }
}

/// Returns whether a segment passes through a disc or a triangle: independent of how crowns decide.
fn pierces(
    [start, end]: [DVec3; 2],
    point: DVec3,
    normal: DVec3,
    holds: &dyn Fn(DVec3) -> bool,
) -> bool {
    let (from, to) = ((start - point).dot(normal), (end - point).dot(normal));
    from * to < 0.0 && holds(start.lerp(end, from / (from - to)))
}

/// Returns whether the rim of one disc, in 720 chords, passes through the other one.
fn discs_meet(a: &Disc, b: &Disc) -> bool {
    if a.center.distance(b.center) > a.radius + b.radius {
        return false;
    }
    let pass = |a: &Disc, b: &Disc| {
        let (center, normal) = (a.center.as_dvec3(), a.normal());
        let (other, other_normal) = (b.center.as_dvec3(), b.normal());
        let (right, up) = normal.any_orthonormal_pair();
        let radius = f64::from(a.radius);
        let rim = |i: u32| {
            let (sin, cos) = (PI * f64::from(i) / 360.0).sin_cos();
            center + radius * (cos * right + sin * up)
        };
        (0..720).any(|i| {
            pierces([rim(i), rim(i + 1)], other, other_normal, &|p| {
                p.distance(other) < f64::from(b.radius)
            })
        })
    };
    pass(a, b) || pass(b, a)
}

/// Returns whether a side of one flat quadrilateral passes through the other one.
fn quads_meet(a: &[Vec3; 4], b: &[Vec3; 4]) -> bool {
    // No side or diagonal is as long.
    if a[0].distance(b[0]) > 0.5 {
        return false;
    }
    let pass = |a: &[Vec3; 4], b: &[Vec3; 4]| {
        let (a, b) = (a.map(Vec3::as_dvec3), b.map(Vec3::as_dvec3));
        let normal = (b[2] - b[0]).cross(b[3] - b[1]).normalize_or(DVec3::Z);
        let holds =
            |p: DVec3| (0..4).all(|i| (b[(i + 1) % 4] - b[i]).cross(p - b[i]).dot(normal) >= 0.0);
        (0..4).any(|i| pierces([a[i], a[(i + 1) % 4]], b[0], normal, &holds))
    };
    pass(a, b) || pass(b, a)
}

/// Number of pairs of pieces of different leaves that meet.
fn meeting<P: Copy>(pieces: &[P], per_leaf: usize, meet: impl Fn(&P, &P) -> bool) -> usize {
    let pairs = (0..pieces.len()).flat_map(|a| (0..a / per_leaf * per_leaf).map(move |b| (a, b)));
    pairs.filter(|&(a, b)| meet(&pieces[a], &pieces[b])).count()
}

fn quads(mesh: &Mesh) -> Vec<[Vec3; 4]> {
    mesh.vertices.as_chunks::<4>().0.to_vec()
}

#[test]
fn no_leaf_intersects_another_whatever_its_shape() {
    let number = |leaf: &LeafShape, area: f64| (area / leaves::area(leaf)).round() as usize;
    for shape in shapes() {
        let disc = LeafShape::Disc { radius_m: 0.2 };
        let crown = apart(shape.clone(), disc.clone(), 100.0);
        let overlapping = grow_crown(&GeneratedCrown { overlap: true, ..crown.clone() }).unwrap();
        let mesh = grow_crown(&crown).unwrap();
        assert_eq!(mesh.discs.len(), number(&disc, 100.0));
        assert!(meeting(&overlapping.discs, 1, discs_meet) > 100, "{shape:?}");
        assert_eq!(meeting(&mesh.discs, 1, discs_meet), 0, "{shape:?}");
        // Leaves that overlap none before them stay; all keep their normal and size.
        assert_eq!(mesh.discs[0], overlapping.discs[0]);
        let same =
            |(a, b): (&Disc, &Disc)| a.normal == b.normal && (a.radius - b.radius).abs() == 0.0;
        assert!(mesh.discs.iter().zip(&overlapping.discs).all(same));
    }
    for leaf in [SQUARE, RHOMBUS] {
        let crown = apart(shapes()[0].clone(), leaf.clone(), 25.0);
        let overlapping = grow_crown(&GeneratedCrown { overlap: true, ..crown.clone() }).unwrap();
        let mesh = grow_crown(&crown).unwrap();
        assert_eq!(quads(&mesh).len(), number(&leaf, 25.0));
        assert!(meeting(&quads(&overlapping), 1, quads_meet) > 20, "{leaf:?}");
        assert_eq!(meeting(&quads(&mesh), 1, quads_meet), 0, "{leaf:?}");
    }
    let small = CrownShape::Ellipsoid { diameter_m: 2.0, height_m: 2.0 };
    let crown = apart(small, SHOOT, 1.2);
    let overlapping = grow_crown(&GeneratedCrown { overlap: true, ..crown.clone() }).unwrap();
    let mesh = grow_crown(&crown).unwrap();
    assert_eq!(quads(&mesh).len(), 30 * number(&SHOOT, 1.2));
    assert!(meeting(&quads(&overlapping), 30, quads_meet) > 10);
    assert_eq!(meeting(&quads(&mesh), 30, quads_meet), 0);
}

#[test]
fn leaves_apart_keep_area_angles_and_density() {
    let crown = apart(
        CrownShape::Box { size_m: (4.0, 4.0, 4.0) },
        LeafShape::Disc { radius_m: 0.05 },
        // 1.5 m² m⁻³: a fifth of all places is taken.
        96.0,
    );
    let mesh = grow_crown(&crown).unwrap();
    let area: f64 = mesh.discs.iter().map(|disc| PI * f64::from(disc.radius).powi(2)).sum();
    assert!((area / 96.0 - 1.0).abs() < 1e-5, "{area}");
    // Spherical: |cos θ| is uniform, with mean 1/2, and its square has mean 1/3.
    let cos = || mesh.discs.iter().map(|disc| f64::from(disc.normal.z.abs()));
    assert_mean("|cos θ|", cos(), 0.5);
    assert_mean("cos² θ", cos().map(|cos| cos * cos), 1.0 / 3.0);
    // Even in the box.
    for (axis, middle) in [(0, 0.0), (1, 0.0), (2, 4.0)] {
        let place = || mesh.discs.iter().map(|disc| f64::from(disc.center[axis]) - middle);
        assert_mean("place", place(), 0.0);
        assert_mean("place squared", place().map(|x| x * x), 4.0 * 4.0 / 12.0);
    }
    // Normals do not depend on the place: none is rejected for its leaf's inclination.
    assert_mean(
        "tilt by height",
        mesh.discs
            .iter()
            .map(|d| (f64::from(d.normal.z.abs()) - 0.5) * (f64::from(d.center.z) - 4.0)),
        0.0,
    );
}

#[test]
fn crowns_without_room_are_errors_soon() {
    // 40 m² of discs of 1 m in 50 m³, and a hundred leaves in one small clump.
    let crowded = apart(shapes()[0].clone(), LeafShape::Disc { radius_m: 1.0 }, 400.0);
    let clumped = GeneratedCrown {
        clumps: Some(Clumps { count: 1, radius_m: 0.05, height_m: None, on_branches: false }),
        ..apart(shapes()[0].clone(), DISC, 4.0)
    };
    for crown in [crowded, clumped] {
        let error = grow_crown(&crown).unwrap_err().to_string();
        assert!(error.contains("overlap is false, and only"), "{error}");
        assert!(error.contains("leaves find a place"), "{error}");
    }
}

/// Smallest distance of two points [m].
fn nearest(points: &[DVec3]) -> f64 {
    let pairs =
        points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| a.distance(*b)).fold(f64::INFINITY, f64::min)
}

fn centers(mesh: &Mesh) -> Vec<DVec3> {
    mesh.discs.iter().map(|disc| disc.center.as_dvec3()).collect()
}

#[test]
fn centers_of_leaves_keep_their_minimum_distance() {
    for shape in shapes() {
        let independent = GeneratedCrown { leaf_area_m2: 1.0, ..spec(shape.clone(), DISC) };
        let crown = GeneratedCrown { min_distance_m: 0.2, ..independent.clone() };
        let (mesh, all) = (grow_crown(&crown).unwrap(), grow_crown(&independent).unwrap());
        assert_eq!(mesh.discs.len(), all.discs.len());
        assert!(nearest(&centers(&all)) < 0.1, "{shape:?}");
        assert!(nearest(&centers(&mesh)) >= 0.2, "{shape:?}: {}", nearest(&centers(&mesh)));
        // Leaves that are apart from those before them stay; all keep their normal.
        let stay = mesh.discs.iter().zip(&all.discs).filter(|(a, b)| a.center == b.center).count();
        assert!(2 * stay > mesh.discs.len(), "{shape:?}: {stay}");
        assert!(mesh.discs.iter().zip(&all.discs).all(|(a, b)| a.normal == b.normal));
    }
    // Squares of 0.1 m, whose centres are the means of their corners.
    let crown = GeneratedCrown {
        leaf_area_m2: 5.0,
        min_distance_m: 0.25,
        ..spec(shapes()[0].clone(), SQUARE)
    };
    let centers: Vec<DVec3> = quads(&grow_crown(&crown).unwrap())
        .iter()
        .map(|[a, b, c, d]| 0.25 * (a + b + c + d).as_dvec3())
        .collect();
    assert!((0.2499..0.26).contains(&nearest(&centers)), "{}", nearest(&centers));
    // With both conditions neither fails.
    let crown = GeneratedCrown {
        min_distance_m: 0.2,
        ..apart(shapes()[0].clone(), LeafShape::Disc { radius_m: 0.2 }, 60.0)
    };
    let mesh = grow_crown(&crown).unwrap();
    assert_eq!(meeting(&mesh.discs, 1, discs_meet), 0);
    assert!(nearest(&self::centers(&mesh)) >= 0.2);
}

#[test]
fn distances_without_room_are_errors_with_one_that_has_room() {
    let crown = GeneratedCrown { min_distance_m: 0.5, ..spec(shapes()[0].clone(), DISC) };
    let error = grow_crown(&crown).unwrap_err();
    let AssetError::Crown(CrownError::NoRoomAtDistance { placed, count, possible, .. }) = error
    else {
        panic!("{error}");
    };
    assert!((100..count).contains(&placed), "{placed} of {count}");
    let text = error.to_string();
    assert!(text.contains("min_distance_m is 0.5, and only"), "{text}");
    grow_crown(&GeneratedCrown { min_distance_m: possible, ..crown.clone() }).unwrap();
    assert!(grow_crown(&GeneratedCrown { min_distance_m: 1.25 * possible, ..crown }).is_err());
    for bad in [-0.1, f64::NAN, 1e-9] {
        let crown = GeneratedCrown { min_distance_m: bad, ..spec(shapes()[0].clone(), DISC) };
        assert!(grow_crown(&crown).unwrap_err().to_string().contains("min_distance_m is"), "{bad}");
    }
}

#[test]
fn discs_intersect_where_their_chords_do() {
    let disc = |x: f32, z: f32, tilt: f64| Disc {
        center: Vec3::new(x, 0.0, z),
        normal: Vec3::new(tilt.sin() as f32, 0.0, tilt.cos() as f32),
        radius: 1.0,
    };
    let flat = disc(0.0, 0.0, 0.0);
    for (other, expected) in [
        // Upright, through the flat one's plane at x: from -1 to 1 it meets.
        (disc(0.9, 0.0, 2.0 * FRAC_PI_4), true),
        (disc(1.1, 0.0, 2.0 * FRAC_PI_4), false),
        (disc(0.5, 0.9, 2.0 * FRAC_PI_4), true),
        (disc(0.5, 1.1, 2.0 * FRAC_PI_4), false),
        // Chords of half-lengths 0.436 and 0.436 about one middle.
        (disc(0.9, 0.9, 2.0 * FRAC_PI_4), true),
        // At 45°, the lower rim of the other is at z - 0.707.
        (disc(0.0, 0.7, FRAC_PI_4), true),
        (disc(0.0, 0.72, FRAC_PI_4), false),
        // In parallel planes, and in one.
        (disc(0.1, 0.001, 0.0), false),
        (disc(1.9, 0.0, 0.0), true),
        (disc(2.1, 0.0, 0.0), false),
    ] {
        assert_eq!(intersect(&flat, &other), expected, "{other:?}");
        assert_eq!(intersect(&other, &flat), expected, "{other:?}");
    }
    assert!((flat.reach() - 1.0).abs() < 1e-3);
}
