//! Profiles, clumps and shoots.

use super::*;

/// Heights above the ground of all leaf centres.
fn heights(crown: &GeneratedCrown) -> Vec<f64> {
    grow_crown(crown).unwrap().discs.iter().map(|disc| f64::from(disc.center.z)).collect()
}

/// Kolmogorov and Smirnov: the largest distance between the sample's distribution and the closed
/// form, times the root of the count, exceeds 2.2 with probability 1.3e-4.
fn assert_distribution(what: &str, mut sample: Vec<f64>, cdf: impl Fn(f64) -> f64) {
    sample.sort_by(f64::total_cmp);
    let count = sample.len() as f64;
    let gap = |(index, &value): (usize, &f64)| {
        let expected = cdf(value);
        (expected - index as f64 / count).abs().max((expected - (index + 1) as f64 / count).abs())
    };
    let largest = sample.iter().enumerate().map(gap).fold(0.0, f64::max);
    let statistic = largest * count.sqrt();
    assert!(statistic < 2.2, "{what}: {statistic}");
}

fn with_profile(shape: &CrownShape, leaf_profile: LeafProfile) -> GeneratedCrown {
    GeneratedCrown { leaf_profile, ..spec(shape.clone(), DISC) }
}

#[test]
fn leaf_area_follows_its_profile_by_height_in_any_crown() {
    // Nothing below 3 m, a ramp up to 5 m, a step down, even to 7 m: areas 2 (ramp) and 2.
    let points = vec![(3.0, 0.0), (5.0, 2.0), (5.0, 1.0), (7.0, 1.0)];
    let cdf = |z: f64| match z - 3.0 {
        ..0.0 => 0.0,
        h @ 0.0..2.0 => h * h / 8.0,
        h @ 2.0..4.0 => h / 4.0,
        _ => 1.0,
    };
    for shape in shapes() {
        let crown = with_profile(&shape, LeafProfile::Area(points.clone()));
        assert_distribution(&format!("{shape:?}"), heights(&crown), cdf);
    }
}

#[test]
fn leaf_area_density_is_per_volume() {
    // Density proportional to the height above the base, in a cylinder: z² / h²; in a cone with its
    // cross-section (1 - z/h)²: 6 z² - 8 z³ + 3 z⁴ of z/h.
    let ramp = || LeafProfile::Density(vec![(2.0, 0.0), (8.0, 3.0)]);
    let part = |z: f64| ((z - 2.0) / 6.0).clamp(0.0, 1.0);
    let cylinder = heights(&with_profile(&shapes()[2], ramp()));
    assert_distribution("cylinder", cylinder, |z| part(z).powi(2));
    let cone = heights(&with_profile(&shapes()[1], ramp()));
    assert_distribution("cone", cone, |z| {
        let z = part(z);
        6.0 * z * z - 8.0 * z.powi(3) + 3.0 * z.powi(4)
    });
    // What is the same everywhere is what no profile is.
    for shape in shapes() {
        let even = with_profile(&shape, LeafProfile::Density(vec![(0.0, 5.0), (100.0, 5.0)]));
        let (found, expected) = (
            heights(&even),
            heights(&GeneratedCrown { seed: SEED + 1, ..spec(shape.clone(), DISC) }),
        );
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let spread = |values: &[f64]| {
            let mean = mean(values);
            values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len().pow(2) as f64
        };
        let z = (mean(&found) - mean(&expected)) / (spread(&found) + spread(&expected)).sqrt();
        assert!(z.abs() < MOST, "{shape:?}: z = {z}");
    }
}

/// The squared radius of an asymmetric Gaussian is a Gaussian: of height z above the widest place the
/// volume is `∝ exp(-(z / s)²)`. Leaves are uniform in each cross-section.
#[test]
fn an_asymmetric_gaussian_is_filled_evenly() {
    const STEPS: usize = 6000;
    let crown = spec(shapes()[5].clone(), DISC);
    let section = |z: f64| {
        let z = z - 2.0;
        (-(z / if z < 0.0 { 1.0 } else { 2.0 }).powi(2)).exp()
    };
    let mut up_to = vec![0.0];
    for step in 0..STEPS {
        let z = 6.0 * (step as f64 + 0.5) / STEPS as f64;
        up_to.push(up_to[step] + section(z));
    }
    let cdf = |z: f64| {
        let at = ((z - 2.0) / 6.0).clamp(0.0, 1.0) * STEPS as f64;
        let below = (at as usize).min(STEPS - 1);
        (up_to[below] + (up_to[below + 1] - up_to[below]) * (at - below as f64)) / up_to[STEPS]
    };
    assert_distribution("heights", heights(&crown), cdf);
    let mesh = grow_crown(&crown).unwrap();
    let share = |disc: &crate::components::Disc| {
        let center = disc.center.as_dvec3();
        center.truncate().length_squared() / (4.0 * section(center.z - 2.0))
    };
    assert!(mesh.discs.iter().all(|disc| share(disc) < 1.0 + 1e-5));
    assert_distribution("circles", mesh.discs.iter().map(share).collect(), |share| share);
}

#[test]
fn clumps_hold_equal_numbers_of_leaves_within_the_crown() {
    for shape in shapes() {
        for on_branches in [false, true] {
            let clumps = Clumps { count: 37, radius_m: 0.3, height_m: Some(0.2), on_branches };
            let crown = GeneratedCrown { clumps: Some(clumps), ..tree(shape.clone()) };
            let mesh = grow_crown(&crown).unwrap();
            let centers: Vec<DVec3> =
                mesh.discs.iter().map(|d| d.center.as_dvec3() - 2.0 * DVec3::Z).collect();
            // Nothing but rounding puts leaves outside.
            let inwards = |p: &DVec3| (*p - 3.0 * DVec3::Z) * (1.0 - 1e-6) + 3.0 * DVec3::Z;
            assert!(centers.iter().map(inwards).all(|p| shape::contains(&shape, p)), "{shape:?}");
            for clump in 0..37 {
                let leaves: Vec<DVec3> = centers.iter().skip(clump).step_by(37).copied().collect();
                assert!(leaves.len().abs_diff(mesh.discs.len() / 37) <= 1);
                // All in one ellipsoid: no two are farther apart than its diameter.
                let farthest = |axis: fn(&DVec3) -> f64| {
                    let values = leaves.iter().map(axis);
                    let (low, high) = values
                        .fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
                    high - low
                };
                assert!(farthest(|p| p.x) < 0.6 + 1e-5 && farthest(|p| p.y) < 0.6 + 1e-5);
                assert!(farthest(|p| p.z) < 0.2 + 1e-5);
            }
        }
    }
}

#[test]
fn clumps_on_branches_are_on_branches() {
    let clumps = Clumps { count: 500, radius_m: 1e-6, height_m: None, on_branches: true };
    let crown = GeneratedCrown { clumps: Some(clumps), ..tree(shapes()[0].clone()) };
    let branches = wood::branches(&crown);
    for disc in &grow_crown(&crown).unwrap().discs {
        let center = disc.center.as_dvec3();
        let nearest = branches.iter().map(|branch| {
            let along = branch.end - branch.start;
            let part =
                ((center - branch.start).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (branch.start + part * along - center).length()
        });
        assert!(nearest.fold(f64::MAX, f64::min) < 1e-5, "{center}");
    }
}

#[test]
fn needles_stand_around_their_twig_at_their_angle() {
    let crown = GeneratedCrown { leaf_area_m2: 0.5, ..spec(shapes()[0].clone(), SHOOT) };
    let mesh = grow_crown(&crown).unwrap();
    let middle = |a: Vec3, b: Vec3| 0.5 * (a.as_dvec3() + b.as_dvec3());
    for shoot in mesh.vertices.chunks(4 * 30) {
        let needles: Vec<(DVec3, DVec3)> =
            shoot.chunks(4).map(|q| (middle(q[0], q[1]), middle(q[2], q[3]))).collect();
        let twig = (needles[29].0 - needles[0].0).try_normalize().unwrap();
        let length = (needles[29].0 - needles[0].0).length();
        assert!((length / (0.1 * 29.0 / 30.0) - 1.0).abs() < 0.02, "{length}");
        let mut sum = DVec3::ZERO;
        for (base, tip) in &needles {
            let needle = *tip - *base;
            assert!((needle.length() / 0.05 - 1.0).abs() < 0.02);
            let angle = (needle.dot(twig) / needle.length()).acos().to_degrees();
            assert!((angle - 50.0).abs() < 0.05, "{angle}");
            sum += needle - needle.dot(twig) * twig;
        }
        // All around: the golden angle leaves little of thirty needles' sum.
        assert!(sum.length() < 0.05 * 30.0 * 0.06, "{sum}");
    }
}

#[test]
fn profiles_and_clumps_that_cannot_be_are_errors() {
    let good = tree(shapes()[0].clone());
    let area = |points: &[(f64, f64)]| LeafProfile::Area(points.to_vec());
    let with = |leaf_profile| GeneratedCrown { leaf_profile, ..good.clone() };
    let clumps = |count, radius_m, on_branches| {
        Some(Clumps { count, radius_m, height_m: None, on_branches })
    };
    let shoot = |needles, needle_angle_deg| LeafShape::Shoot {
        length_m: 0.1,
        needles,
        needle_length_m: 0.01,
        needle_width_m: 0.001,
        needle_angle_deg,
    };
    let widest = CrownShape::AsymmetricGaussian {
        diameter_m: 1.0,
        height_m: 6.0,
        widest_m: 6.5,
        below_m: 1.0,
        above_m: 1.0,
    };
    for (crown, fragment) in [
        (with(area(&[(3.0, 1.0)])), "has 1 point(s)"),
        (with(area(&[(3.0, 1.0), (f64::NAN, 1.0)])), "leaf_profile[1] is (NaN, 1)"),
        (with(area(&[(3.0, -1.0), (4.0, 1.0)])), "leaf_profile[0] is (3, -1)"),
        (with(area(&[(4.0, 1.0), (3.0, 1.0)])), "leaf_profile[1] is lower"),
        (with(area(&[(8.0, 1.0), (9.0, 1.0)])), "no leaves within the crown, from 2 to 8 m"),
        (with(area(&[(3.0, 0.0), (5.0, 0.0)])), "no leaves within the crown"),
        (GeneratedCrown { clumps: clumps(0, 0.1, false), ..good.clone() }, "clumps.count is 0"),
        (
            GeneratedCrown { clumps: clumps(u32::MAX, 0.1, false), ..good.clone() },
            "clumps.count is",
        ),
        (
            GeneratedCrown { clumps: clumps(5, -0.1, false), ..good.clone() },
            "clumps.radius_m is -0.1",
        ),
        (
            GeneratedCrown { clumps: clumps(5, 0.1, true), branches: None, ..good.clone() },
            "needs branches",
        ),
        (
            GeneratedCrown {
                clumps: clumps(5, 0.1, true),
                ..with(area(&[(3.0, 1.0), (4.0, 1.0)]))
            },
            "exclude each other",
        ),
        (GeneratedCrown { leaf: shoot(0, 50.0), ..good.clone() }, "leaf.needles is 0"),
        (GeneratedCrown { leaf: shoot(9, 91.0), ..good.clone() }, "needle_angle_deg is 91"),
        (
            GeneratedCrown { leaf: shoot(99, 50.0), leaf_area_m2: 1e3, ..good.clone() },
            "more than 5e7",
        ),
        (
            GeneratedCrown { shape: widest, trunk: None, branches: None, ..good.clone() },
            "widest_m is 6.5",
        ),
    ] {
        let error = grow_crown(&crown).unwrap_err().to_string();
        assert!(error.contains(fragment), "{error} / {fragment}");
    }
}
