//! Mesh prototypes.

use super::super::diagnostic::Diagnostic;
use super::super::scene::{Map, Mesh, Scene};
use super::Report;
use super::crown::check_crown;

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
            Mesh::Faces { faces_m, material } => {
                check_faces(&format!("{path}.faces_m"), faces_m, report);
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

/// Most corners of a polygon: cutting a concave one takes the square of them.
const MOST_CORNERS: usize = 2048;

fn check_faces(path: &str, faces: &[Vec<(f64, f64, f64)>], report: &mut Report<'_>) {
    if faces.is_empty() {
        report.error(path, "this mesh has no face", "write three or more corners of each");
    }
    for (index, face) in faces.iter().enumerate() {
        let path = format!("{path}[{index}]");
        if !(3..=MOST_CORNERS).contains(&face.len()) {
            let message = format!("expected 3 to {MOST_CORNERS} corners, found {}", face.len());
            report.push(Diagnostic::error(&path, message));
        }
        for (number, &(x, y, z)) in face.iter().enumerate() {
            report.finite(&format!("{path}[{number}]"), &[x, y, z]);
        }
    }
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
