//! Crowns that are generated leaf by leaf.

use std::ops::RangeInclusive;

use super::super::scene::{
    Branches, Clumps, CrownShape, GeneratedCrown, LeafAngle, LeafProfile, LeafShape, Trunk,
};
use super::{Report, ScenePath};

pub(super) fn check_crown(path: &ScenePath, crown: &GeneratedCrown, report: &mut Report<'_>) {
    let GeneratedCrown {
        shape,
        base_m,
        leaf_area_m2,
        leaf_profile,
        clumps,
        leaf,
        leaf_material: _,
        trunk,
        branches,
        wood_material,
        leaf_angle,
        overlap: _,
        min_distance_m,
        seed: _,
    } = crown;
    check_shape(&path.key("shape"), shape, report);
    check_leaf(&path.key("leaf"), leaf, report);
    check_angle(&path.key("leaf_angle"), leaf_angle, report);
    check_profile(&path.key("leaf_profile"), leaf_profile, report);
    if let Some(clumps) = clumps {
        check_clumps(path, clumps, branches.as_ref(), leaf_profile, report);
    }
    report.finite(path.key("base_m"), &[*base_m]);
    report.at_least(path.key("min_distance_m"), *min_distance_m, 0.0);
    report.at_least(path.key("leaf_area_m2"), *leaf_area_m2, 0.0);
    check_wood(path, trunk.as_ref(), branches.as_ref(), wood_material.is_some(), report);
}

fn check_shape(path: &ScenePath, shape: &CrownShape, report: &mut Report<'_>) {
    match shape {
        CrownShape::Ellipsoid { diameter_m, height_m }
        | CrownShape::Cone { diameter_m, height_m }
        | CrownShape::Cylinder { diameter_m, height_m }
        | CrownShape::HalfEllipsoid { diameter_m, height_m } => {
            check_lengths(path, &[("diameter_m", *diameter_m), ("height_m", *height_m)], report);
        }
        CrownShape::AsymmetricGaussian { diameter_m, height_m, widest_m, below_m, above_m } => {
            let lengths = [
                ("diameter_m", *diameter_m),
                ("height_m", *height_m),
                ("below_m", *below_m),
                ("above_m", *above_m),
            ];
            check_lengths(path, &lengths, report);
            if *height_m > 0.0 && !(0.0..=*height_m).contains(widest_m) {
                let message = format!("expected a height within the crown, found {widest_m}");
                let help = format!("write a height above the crown's base, from 0 to {height_m}");
                report.error(path.key("widest_m"), message, help);
            }
        }
        CrownShape::Box { size_m: (x, y, z) } => {
            for (axis, length) in [*x, *y, *z].into_iter().enumerate() {
                report.above_zero(path.key("size_m").index(axis), length);
            }
        }
    }
}

fn check_leaf(path: &ScenePath, leaf: &LeafShape, report: &mut Report<'_>) {
    match leaf {
        LeafShape::Disc { radius_m } => check_lengths(path, &[("radius_m", *radius_m)], report),
        LeafShape::Square { side_m } => check_lengths(path, &[("side_m", *side_m)], report),
        LeafShape::Rhombus { length_m, width_m } => {
            check_lengths(path, &[("length_m", *length_m), ("width_m", *width_m)], report);
        }
        LeafShape::Shoot {
            length_m,
            needles,
            needle_length_m,
            needle_width_m,
            needle_angle_deg,
        } => {
            let lengths = [
                ("length_m", *length_m),
                ("needle_length_m", *needle_length_m),
                ("needle_width_m", *needle_width_m),
            ];
            check_lengths(path, &lengths, report);
            report.at_least(path.key("needles"), f64::from(*needles), 1.0);
            let help = "0 points along the twig, 90 away from it";
            check_range(path, "needle_angle_deg", *needle_angle_deg, 0.0..=90.0, help, report);
        }
    }
}

fn check_angle(path: &ScenePath, angle: &LeafAngle, report: &mut Report<'_>) {
    match *angle {
        LeafAngle::Ellipsoidal { x: Some(x), mean_deg: None } => {
            let help = "1 is spherical, more is flatter";
            check_range(path, "x", x, 1e-4..=1e4, help, report);
        }
        LeafAngle::Ellipsoidal { x: None, mean_deg: Some(mean) } => {
            let help = "the mean of a spherical distribution is 57.3";
            check_range(path, "mean_deg", mean, 0.1..=89.9, help, report);
        }
        LeafAngle::Ellipsoidal { .. } if report.is_whole(path) => {
            let message = "expected either `x` or `mean_deg`, and not both";
            report.error(path, message, "write, for example, `Ellipsoidal(mean_deg: 57.3)`");
        }
        LeafAngle::Beta { mu, nu } => {
            let help = "the mean angle is 90° nu / (mu + nu)";
            check_range(path, "mu", mu, 0.1..=100.0, help, report);
            check_range(path, "nu", nu, 0.1..=100.0, help, report);
        }
        _ => {}
    }
}

fn check_profile(path: &ScenePath, profile: &LeafProfile, report: &mut Report<'_>) {
    let (LeafProfile::Density(points) | LeafProfile::Area(points)) = profile else { return };
    if points.len() < 2 && report.is_whole(path) {
        let message = format!("a profile has two points or more, found {}", points.len());
        report.error(path, message, "write, for example, `Density([(2.0, 0.5), (8.0, 1.0)])`");
    }
    for (index, &(height, leaves)) in points.iter().enumerate() {
        let at = path.index(index);
        report.finite(&at, &[height]);
        report.at_least(&at, leaves, 0.0);
        if index > 0 && height < points[index - 1].0 {
            let message = format!("{height} m is below the point before it");
            report.error(at, message, "write the points from the lowest height up");
        }
    }
}

fn check_clumps(
    path: &ScenePath,
    clumps: &Clumps,
    branches: Option<&Branches>,
    profile: &LeafProfile,
    report: &mut Report<'_>,
) {
    let at = path.key("clumps");
    report.at_least(at.key("count"), f64::from(clumps.count), 1.0);
    check_lengths(&at, &[("radius_m", clumps.radius_m)], report);
    if let Some(height) = clumps.height_m {
        check_lengths(&at, &[("height_m", height)], report);
    }
    if !clumps.on_branches || !report.is_whole(path) {
        return;
    }
    let at = at.key("on_branches");
    if branches.is_none_or(|branches| branches.count == 0) {
        let help = "write, for example, `branches: (count: 40, diameter_m: 0.04)`";
        report.error(&at, "clumps are to be on branches, and there are none", help);
    }
    if *profile != LeafProfile::Even {
        let help = "leave out `on_branches` or `leaf_profile`";
        report.error(at, "clumps on branches cannot follow a `leaf_profile` too", help);
    }
}

fn check_range(
    path: &ScenePath,
    key: &'static str,
    value: f64,
    lawful: RangeInclusive<f64>,
    help: &str,
    report: &mut Report<'_>,
) {
    if !lawful.contains(&value) {
        let (least, most) = lawful.into_inner();
        let message = format!("expected a number from {least} to {most}, found {value}");
        report.error(path.key(key), message, help);
    }
}

/// Diameter of a trunk over its height that no tree exceeds.
const THICKEST: f64 = 0.5;

fn check_wood(
    path: &ScenePath,
    trunk: Option<&Trunk>,
    branches: Option<&Branches>,
    has_material: bool,
    report: &mut Report<'_>,
) {
    if let Some(trunk) = trunk {
        let at = path.key("trunk");
        let lengths = [("height_m", trunk.height_m), ("diameter_m", trunk.diameter_m)];
        check_lengths(&at, &lengths, report);
        report.at_least(at.key("tip_diameter_m"), trunk.tip_diameter_m, 0.0);
        if trunk.diameter_m > THICKEST * trunk.height_m && trunk.height_m > 0.0 {
            let message =
                format!("the trunk is {} m thick and {} m high", trunk.diameter_m, trunk.height_m);
            let help = "lengths are in metres: 20 cm is 0.2";
            report.warning(at.key("diameter_m"), message, help);
        }
        if trunk.tip_diameter_m > trunk.diameter_m && trunk.diameter_m > 0.0 {
            let message = format!(
                "the trunk's tip ({} m) is thicker than its foot ({} m)",
                trunk.tip_diameter_m, trunk.diameter_m
            );
            let help = "write a `tip_diameter_m` of at most `diameter_m`";
            report.error(at, message, help);
        }
    }
    if let Some(branches) = branches {
        let at = path.key("branches");
        check_lengths(&at, &[("diameter_m", branches.diameter_m)], report);
        if !(0.0..=180.0).contains(&branches.zenith_deg) {
            let message =
                format!("expected an angle from 0 to 180°, found {}", branches.zenith_deg);
            report.error(at.key("zenith_deg"), message, "0 points up, 180 down");
        }
        if trunk.is_none() && report.is_whole(path) {
            let help = "write, for example, `trunk: (height_m: 5.0, diameter_m: 0.2)`";
            report.error(at, "branches grow from a trunk, and there is none", help);
        }
    }
    let has_wood = trunk.is_some() || branches.is_some();
    if has_wood && !has_material && report.is_whole(path) {
        let message = "this crown has wood, but no `wood_material`";
        report.error(path, message, "write, for example, `wood_material: \"bark\"`");
    }
}

fn check_lengths(path: &ScenePath, lengths: &[(&'static str, f64)], report: &mut Report<'_>) {
    for (key, length) in lengths {
        report.above_zero(path.key(key), *length);
    }
}
