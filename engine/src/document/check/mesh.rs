//! Mesh prototypes.

use super::super::scene::{Branches, CrownShape, LeafShape, Map, Mesh, Scene, Trunk};
use super::Report;

pub(super) fn check_meshes(scene: &Scene, report: &mut Report<'_>) {
    report.own_names("meshes", "a mesh", &scene.meshes);
    for (name, mesh) in &scene.meshes {
        let path = format!("meshes.{name}");
        match mesh {
            Mesh::Obj { unit_m, parts, material, .. }
            | Mesh::Gltf { unit_m, parts, material, .. } => {
                report.above_zero(&format!("{path}.unit_m"), *unit_m);
                check_parts(&path, parts, material.as_deref(), scene, report);
            }
            Mesh::Discs { material, .. } => {
                check_material(&path, "material", material, scene, report);
            }
            Mesh::Crown { .. } => check_crown(&path, mesh, scene, report),
        }
    }
}

pub(super) fn check_material(
    path: &str,
    key: &str,
    material: &str,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    report.name(&format!("{path}.{key}"), "material", material, &scene.materials, "materials");
}

fn check_parts(
    path: &str,
    parts: &Map<String>,
    material: Option<&str>,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    for (part, material) in parts {
        check_material(path, &format!("parts.{part}"), material, scene, report);
    }
    if let Some(material) = material {
        check_material(path, "material", material, scene, report);
    }
    if parts.is_empty() && material.is_none() && report.is_whole(path) {
        let help = "write `material: \"leaf\"` for all of it, or `parts: { \"crown\": \"leaf\" }`";
        report.error(path, "this mesh has no material", help);
    }
}

fn check_crown(path: &str, crown: &Mesh, scene: &Scene, report: &mut Report<'_>) {
    let Mesh::Crown {
        shape,
        base_m,
        leaf_area_m2,
        leaf,
        leaf_material,
        trunk,
        branches,
        wood_material,
        leaf_angle: _,
        seed: _,
    } = crown
    else {
        return;
    };
    let lengths: &[(&str, f64)] = match shape {
        CrownShape::Ellipsoid { diameter_m, height_m }
        | CrownShape::Cone { diameter_m, height_m }
        | CrownShape::Cylinder { diameter_m, height_m } => {
            &[("diameter_m", *diameter_m), ("height_m", *height_m)]
        }
        CrownShape::Box { size_m: (x, y, z) } => {
            &[("size_m[0]", *x), ("size_m[1]", *y), ("size_m[2]", *z)]
        }
    };
    check_lengths(&format!("{path}.shape"), lengths, report);
    let lengths: &[(&str, f64)] = match leaf {
        LeafShape::Disc { radius_m } => &[("radius_m", *radius_m)],
        LeafShape::Square { side_m } => &[("side_m", *side_m)],
        LeafShape::Rhombus { length_m, width_m } => {
            &[("length_m", *length_m), ("width_m", *width_m)]
        }
    };
    check_lengths(&format!("{path}.leaf"), lengths, report);
    report.finite(&format!("{path}.base_m"), &[*base_m]);
    // A bare tree is a tree; a crown of nothing is not.
    if trunk.is_some() {
        report.at_least(&format!("{path}.leaf_area_m2"), *leaf_area_m2, 0.0);
    } else {
        report.above_zero(&format!("{path}.leaf_area_m2"), *leaf_area_m2);
    }
    check_material(path, "leaf_material", leaf_material, scene, report);
    check_wood(path, trunk.as_ref(), branches.as_ref(), wood_material.as_deref(), scene, report);
}

fn check_wood(
    path: &str,
    trunk: Option<&Trunk>,
    branches: Option<&Branches>,
    wood_material: Option<&str>,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    if let Some(trunk) = trunk {
        let at = format!("{path}.trunk");
        let lengths = [("height_m", trunk.height_m), ("diameter_m", trunk.diameter_m)];
        check_lengths(&at, &lengths, report);
        report.at_least(&format!("{at}.tip_diameter_m"), trunk.tip_diameter_m, 0.0);
        if trunk.tip_diameter_m > trunk.diameter_m && trunk.diameter_m > 0.0 {
            let message = format!(
                "the trunk's tip ({} m) is thicker than its foot ({} m)",
                trunk.tip_diameter_m, trunk.diameter_m
            );
            let help = "write a `tip_diameter_m` of at most `diameter_m`";
            report.error(&at, message, help);
        }
    }
    if let Some(branches) = branches {
        let at = format!("{path}.branches");
        check_lengths(&at, &[("diameter_m", branches.diameter_m)], report);
        if !(0.0..=180.0).contains(&branches.zenith_deg) {
            let message =
                format!("expected an angle from 0 to 180°, found {}", branches.zenith_deg);
            report.error(&format!("{at}.zenith_deg"), message, "0 points up, 180 down");
        }
        if trunk.is_none() && report.is_whole(path) {
            let help = "write, for example, `trunk: (height_m: 5.0, diameter_m: 0.2)`";
            report.error(&at, "branches grow from a trunk, and there is none", help);
        }
    }
    match wood_material {
        Some(material) => check_material(path, "wood_material", material, scene, report),
        None if (trunk.is_some() || branches.is_some()) && report.is_whole(path) => {
            let message = "this crown has wood, but no `wood_material`";
            report.error(path, message, "write, for example, `wood_material: \"bark\"`");
        }
        None => {}
    }
}

fn check_lengths(path: &str, lengths: &[(&str, f64)], report: &mut Report<'_>) {
    for (key, length) in lengths {
        report.above_zero(&format!("{path}.{key}"), *length);
    }
}
