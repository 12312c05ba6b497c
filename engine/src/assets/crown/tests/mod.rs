mod angles;
mod apart;
mod gaps;
mod places;

use std::collections::HashMap;
use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::*;
use crate::document::{Branches, Clumps, LeafAngle, Trunk};

const SEED: u64 = 20_261_122;

fn spec(shape: CrownShape, leaf: LeafShape) -> GeneratedCrown {
    GeneratedCrown { seed: SEED, ..GeneratedCrown::new(shape, 2.0, 40.0, leaf, "leaf".into()) }
}

fn shapes() -> [CrownShape; 6] {
    [
        CrownShape::Ellipsoid { diameter_m: 4.0, height_m: 6.0 },
        CrownShape::Cone { diameter_m: 4.0, height_m: 6.0 },
        CrownShape::Cylinder { diameter_m: 4.0, height_m: 6.0 },
        CrownShape::Box { size_m: (4.0, 3.0, 6.0) },
        CrownShape::HalfEllipsoid { diameter_m: 4.0, height_m: 6.0 },
        CrownShape::AsymmetricGaussian {
            diameter_m: 4.0,
            height_m: 6.0,
            widest_m: 2.0,
            below_m: 1.0,
            above_m: 2.0,
        },
    ]
}

const DISC: LeafShape = LeafShape::Disc { radius_m: 0.02 };

const SHOOT: LeafShape = LeafShape::Shoot {
    length_m: 0.1,
    needles: 30,
    needle_length_m: 0.05,
    needle_width_m: 0.004,
    needle_angle_deg: 50.0,
};

fn tree(shape: CrownShape) -> GeneratedCrown {
    GeneratedCrown {
        trunk: Some(Trunk { height_m: 7.0, diameter_m: 0.4, tip_diameter_m: 0.05 }),
        branches: Some(Branches { count: 25, diameter_m: 0.1, zenith_deg: 60.0 }),
        ..spec(shape, DISC)
    }
}

/// Mean of the values less what it should be, in standard errors of the mean.
fn z_score(values: impl Iterator<Item = f64>, expected: f64) -> f64 {
    let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        n += 1.0;
        sum += value - expected;
        squares += (value - expected).powi(2);
    }
    let mean = sum / n;
    mean / ((squares / n - mean * mean) / (n - 1.0)).sqrt()
}

/// Two-sided significance 6e-5 of each of these tests, over a fixed seed.
const MOST: f64 = 4.0;

fn assert_mean(what: &str, values: impl Iterator<Item = f64>, expected: f64) {
    let z = z_score(values, expected);
    assert!(z.abs() < MOST, "{what}: z = {z}");
}

#[test]
fn leaf_area_is_what_was_asked_for() {
    for shape in shapes() {
        for leaf in [
            DISC,
            LeafShape::Square { side_m: 0.05 },
            LeafShape::Rhombus { length_m: 0.06, width_m: 0.03 },
            SHOOT,
        ] {
            let crown = spec(shape.clone(), leaf.clone());
            let mesh = grow_crown(&crown).unwrap();
            let [part] = &mesh.parts[..] else { panic!("{:?}", mesh.parts) };
            assert_eq!(part.name, "leaf");
            let count =
                (40.0 / leaves::area(&leaf)).round() as usize * leaves::pieces(&leaf) as usize;
            assert_eq!(mesh.discs.len() + mesh.triangles.len() / 2, count);
            let area = mesh.part_area(part);
            // One f32 radius rounds all discs alike: 2 × 2^-24; corners round at random, 5e-7 m of
            // 0.03 m each, over the root of thousands of leaves.
            assert!((area / 40.0 - 1.0).abs() < 1.2e-6, "{leaf:?}: {area}");
        }
    }
}

#[test]
fn squares_and_rhombi_are_flat_parallelograms_of_their_shape() {
    let rhombus = LeafShape::Rhombus { length_m: 0.06, width_m: 0.03 };
    let square = LeafShape::Square { side_m: 0.05 };
    for (leaf, ratio, side) in [(rhombus, 2.0, 0.0335_f32), (square, 1.0, 0.05)] {
        let mesh = grow_crown(&spec(shapes()[0].clone(), leaf)).unwrap();
        for (t, quad) in mesh.triangles.chunks(2).zip(mesh.vertices.chunks(4)) {
            assert_eq!(t[0][0], t[1][0]);
            assert_eq!(t[0][2], t[1][1], "the triangles share a diagonal");
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| quad[i]);
            assert!((a + c - b - d).length() < 5e-6);
            assert!(((a - c).length() / (b - d).length() - ratio).abs() < 2e-4);
            assert!(((b - a).length() / side - 1.0).abs() < 5e-3);
            assert!((a - c).dot(b - d).abs() < 1e-6);
        }
    }
}

/// Means of z and of the squared distances from the centroid, from the moments of the solids.
#[test]
fn leaves_are_uniform_in_the_volume() {
    let height = 6.0;
    for (shape, mean_z, [x2, y2, z2]) in [
        // Ball: r²/5 along each axis.
        (shapes()[0].clone(), 3.0, [0.8, 0.8, 9.0 / 5.0]),
        // Cone: h/4; 3 r²/20; 3 h²/80.
        (shapes()[1].clone(), 1.5, [0.6, 0.6, 3.0 * 36.0 / 80.0]),
        // Cylinder: r²/4; h²/12.
        (shapes()[2].clone(), 3.0, [1.0, 1.0, 3.0]),
        // Box: a²/12.
        (shapes()[3].clone(), 3.0, [16.0 / 12.0, 9.0 / 12.0, 3.0]),
        // Half a ball: 3 h/8; r²/5; h²/5 - (3 h/8)².
        (shapes()[4].clone(), 2.25, [0.8, 0.8, 36.0 / 5.0 - 2.25 * 2.25]),
    ] {
        let mesh = grow_crown(&spec(shape.clone(), DISC)).unwrap();
        assert!(mesh.discs.len() > 30_000);
        let points: Vec<DVec3> =
            mesh.discs.iter().map(|d| d.center.as_dvec3() - 2.0 * DVec3::Z).collect();
        for point in &points {
            let flat = point.truncate();
            let inside = match shape {
                CrownShape::Ellipsoid { .. } => {
                    (flat / 2.0).length_squared() + ((point.z - 3.0) / 3.0).powi(2) <= 1.0 + 1e-6
                }
                CrownShape::HalfEllipsoid { .. } => {
                    (flat / 2.0).length_squared() + (point.z / 6.0).powi(2) <= 1.0 + 1e-6
                }
                CrownShape::Cone { .. } => flat.length() <= 2.0 * (1.0 - point.z / 6.0) + 1e-6,
                CrownShape::Cylinder { .. } => flat.length() <= 2.0 + 1e-6,
                CrownShape::Box { .. } => flat.x.abs() <= 2.0 + 1e-6 && flat.y.abs() <= 1.5 + 1e-6,
                CrownShape::AsymmetricGaussian { .. } => unreachable!("tested in `places`"),
            };
            assert!(inside && (-1e-6..=height + 1e-6).contains(&point.z), "{shape:?} {point}");
        }
        let all = |f: fn(&DVec3) -> f64| points.iter().map(f);
        assert_mean("x", all(|p| p.x), 0.0);
        assert_mean("y", all(|p| p.y), 0.0);
        assert_mean("x y", all(|p| p.x * p.y), 0.0);
        assert_mean("z", all(|p| p.z), mean_z);
        assert_mean("x²", all(|p| p.x * p.x), x2);
        assert_mean("y²", all(|p| p.y * p.y), y2);
        assert_mean("z²", points.iter().map(|p| (p.z - mean_z).powi(2)), z2);
    }
}

/// G(20°) = E|n·Ω| of the literature's distributions; E cos 2θ and E cos 4θ of g(θ).
#[test]
fn normals_follow_the_leaf_angle_distribution() {
    let (sin, cos) = 20_f64.to_radians().sin_cos();
    let toward = DVec3::new(sin, 0.0, cos);
    for (leaf_angle, g_20, cos_2, cos_4) in [
        (LeafAngle::Spherical, Some(0.5), -1.0 / 3.0, -1.0 / 15.0),
        (LeafAngle::Uniform, None, 0.0, 0.0),
        (LeafAngle::Planophile, Some(0.79823), 0.5, 0.0),
        (LeafAngle::Erectophile, Some(0.43692), -0.5, 0.0),
        (LeafAngle::Plagiophile, None, 0.0, -0.5),
        (LeafAngle::Extremophile, None, 0.0, 0.5),
    ] {
        let crown = GeneratedCrown { leaf_angle, ..spec(shapes()[0].clone(), DISC) };
        let mesh = grow_crown(&crown).unwrap();
        let normals: Vec<DVec3> = mesh.discs.iter().map(|d| d.normal.as_dvec3()).collect();
        assert!(normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6));
        let name = format!("{:?}", crown.leaf_angle);
        let all = |f: fn(&DVec3) -> f64| normals.iter().map(f);
        if let Some(g_20) = g_20 {
            assert_mean(&name, normals.iter().map(|n| n.dot(toward).abs()), g_20);
        }
        let theta = |n: &DVec3| n.z.abs().min(1.0).acos();
        assert_mean(&name, normals.iter().map(|n| (2.0 * theta(n)).cos()), cos_2);
        assert_mean(&name, normals.iter().map(|n| (4.0 * theta(n)).cos()), cos_4);
        assert_mean(&name, all(|n| n.z.signum()), 0.0);
        assert_mean(&name, all(|n| n.y.atan2(n.x).cos()), 0.0);
        assert_mean(&name, all(|n| n.y.atan2(n.x).sin()), 0.0);
        assert_mean(&name, all(|n| (2.0 * n.y.atan2(n.x)).cos()), 0.0);
    }
}

#[test]
fn flat_leaves_have_the_normals_of_discs() {
    let quads = grow_crown(&spec(shapes()[0].clone(), LeafShape::Square { side_m: 0.1 })).unwrap();
    let radius_m = 0.1 / PI.sqrt();
    let discs = grow_crown(&spec(shapes()[0].clone(), LeafShape::Disc { radius_m })).unwrap();
    assert_eq!(discs.discs.len(), quads.triangles.len() / 2);
    for (leaf, disc) in discs.discs.iter().enumerate() {
        let [a, b, c] = quads.corners(2 * leaf);
        let normal = (b - a).cross(c - a).try_normalize().unwrap();
        assert!((normal - disc.normal).length() < 1e-3, "{normal} {}", disc.normal);
        assert!((0.5 * (a + c) - disc.center).length() < 1e-5);
    }
}

#[test]
fn a_crown_depends_on_its_seed_and_nothing_else() {
    let crown = spec(shapes()[1].clone(), DISC);
    let mesh = grow_crown(&crown).unwrap();
    assert_eq!(mesh, grow_crown(&crown).unwrap());
    let other = grow_crown(&GeneratedCrown { seed: SEED + 1, ..crown.clone() }).unwrap();
    let same = mesh.discs.iter().zip(&other.discs).filter(|(a, b)| a.center == b.center).count();
    assert_eq!(same, 0);
    // More leaves leave the first ones where they are.
    let more = grow_crown(&GeneratedCrown { leaf_area_m2: 50.0, ..crown }).unwrap();
    assert!(mesh.discs.iter().zip(&more.discs).all(|(a, b)| a.center == b.center));
}

fn wood(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    let part = mesh.parts.last().unwrap();
    assert_eq!(part.name, "wood");
    part.triangles.clone().map(|t| mesh.corners(t as usize)).collect()
}

#[test]
fn wood_is_closed_and_faces_outwards() {
    for tip_diameter_m in [0.05, 0.0] {
        let mut crown = tree(shapes()[0].clone());
        crown.trunk = crown.trunk.map(|trunk| Trunk { tip_diameter_m, ..trunk });
        let mesh = grow_crown(&crown).unwrap();
        let mut edges: HashMap<(u32, u32), i32> = HashMap::new();
        for &[a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from.min(to), from.max(to))).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&balance| balance == 0), "each edge runs once each way");
        crown.branches = None;
        let trunk = wood(&grow_crown(&crown).unwrap());
        let volume: f64 = trunk
            .iter()
            .map(|t| t.map(Vec3::as_dvec3))
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        // A frustum over twelve-cornered ends of area 3 r².
        let (r, s) = (0.2, 0.5 * tip_diameter_m);
        let expected = 7.0 * (r * r + r * s + s * s);
        assert!((volume / expected - 1.0).abs() < 1e-5, "{volume} {expected}");
    }
}

#[test]
fn branches_start_on_the_trunk_and_end_within_the_crown() {
    for shape in shapes() {
        for zenith_deg in [0.0, 30.0, 60.0, 90.0, 120.0, 180.0] {
            let mut crown = tree(shape.clone());
            crown.branches = crown.branches.map(|b| Branches { zenith_deg, ..b });
            let mesh = grow_crown(&crown).unwrap();
            let (mut high, mut wide) = (0.0_f32, 0.0_f32);
            for corner in wood(&mesh).into_iter().flatten() {
                assert!(corner.is_finite());
                high = high.max(corner.z);
                wide = wide.max(corner.truncate().length());
                // Half a branch's thickness may stand out of the outline's corners.
                let (x, y, z) = (corner.x, corner.y, corner.z);
                assert!(x.abs() < 2.06 && y.abs() < 2.06 && (-0.01..8.06).contains(&z), "{corner}");
            }
            assert!(high >= 7.0);
            if (60.0..=90.0).contains(&zenith_deg) {
                assert!(wide > 1.0, "{shape:?} {zenith_deg}: branches reach out, {wide}");
            }
        }
    }
}

#[test]
fn winter_trees_have_wood_alone() {
    let crown = GeneratedCrown { leaf_area_m2: 0.0, ..tree(shapes()[0].clone()) };
    let mesh = grow_crown(&crown).unwrap();
    assert_eq!(mesh.parts.len(), 1);
    assert_eq!(mesh.parts[0].name, "wood");
    let tree = grow_crown(&tree(shapes()[0].clone())).unwrap();
    let names: Vec<_> = tree.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["leaf", "wood"]);
    assert_eq!(tree.parts[1].discs.start as usize, tree.discs.len());
    let bare = GeneratedCrown { trunk: None, branches: None, ..crown };
    assert_eq!(grow_crown(&bare).unwrap().bounds(), None, "neither leaves nor wood");
}

#[test]
fn what_cannot_grow_is_an_error() {
    let good = tree(shapes()[0].clone());
    let trunk =
        |height_m, diameter_m, tip_diameter_m| Some(Trunk { height_m, diameter_m, tip_diameter_m });
    let branches = |count, diameter_m, zenith_deg| Some(Branches { count, diameter_m, zenith_deg });
    let nan = f64::NAN;
    for (crown, fragment) in [
        (GeneratedCrown { leaf_area_m2: nan, ..good.clone() }, "leaf_area_m2 is NaN"),
        (GeneratedCrown { leaf_area_m2: -1.0, ..good.clone() }, "leaf_area_m2 is -1"),
        (GeneratedCrown { leaf_area_m2: f64::INFINITY, ..good.clone() }, "leaf_area_m2 is inf"),
        (GeneratedCrown { leaf_area_m2: 1e6, ..good.clone() }, "more than 5e7"),
        (GeneratedCrown { leaf_area_m2: 1e-4, ..good.clone() }, "less than half of one leaf"),
        (GeneratedCrown { base_m: nan, ..good.clone() }, "base_m is NaN"),
        (
            GeneratedCrown { leaf: LeafShape::Disc { radius_m: 0.0 }, ..good.clone() },
            "leaf.radius_m is 0",
        ),
        (
            GeneratedCrown { shape: CrownShape::Box { size_m: (1.0, -2.0, 3.0) }, ..good.clone() },
            "shape.size_m.1 is -2",
        ),
        (
            GeneratedCrown { trunk: trunk(8.5, 0.3, 0.1), ..good.clone() },
            "above the crown's top at 8 m",
        ),
        (GeneratedCrown { trunk: trunk(2.0, 0.3, 0.1), ..good.clone() }, "below the crown's base"),
        (
            GeneratedCrown { trunk: trunk(7.0, 0.3, 0.4), ..good.clone() },
            "trunk.tip_diameter_m is 0.4",
        ),
        (GeneratedCrown { trunk: trunk(nan, 0.3, 0.1), ..good.clone() }, "trunk.height_m is NaN"),
        (GeneratedCrown { trunk: None, ..good.clone() }, "branches need a trunk"),
        (
            GeneratedCrown { branches: branches(5, 0.1, 200.0), ..good.clone() },
            "branches.zenith_deg is 200",
        ),
        (
            GeneratedCrown { branches: branches(u32::MAX, 0.1, 60.0), ..good.clone() },
            "more than 1000000",
        ),
        (
            GeneratedCrown { branches: branches(5, -0.1, 60.0), ..good.clone() },
            "branches.diameter_m is -0.1",
        ),
    ] {
        let error = grow_crown(&crown).unwrap_err().to_string();
        assert!(error.contains(fragment), "{error} / {fragment}");
    }
}
