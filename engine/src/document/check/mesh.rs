//! Mesh prototypes.

use super::super::diagnostic::Diagnostic;
use super::super::scene::{MeshFile, Prototype, Scene};
use super::crown::check_crown;
use super::{Report, ScenePath};

pub(super) fn check_meshes(scene: &Scene, report: &mut Report<'_>) {
    report.own_names("meshes", "a mesh", &scene.meshes);
    for (name, mesh) in &scene.meshes {
        let path = ScenePath::from("meshes").name(name);
        match mesh {
            Prototype::Obj(obj) => check_file(&path, &obj.mesh_file(), report),
            Prototype::Gltf(gltf) => check_file(&path, &gltf.mesh_file(), report),
            Prototype::Ply(ply) => report.above_zero(path.key("unit_m"), ply.unit_m),
            Prototype::Discs { .. } => {}
            Prototype::Faces { faces_m, .. } => {
                check_faces(&path.key("faces_m"), faces_m, report);
            }
            Prototype::Crown(crown) => check_crown(&path, crown, report),
        }
    }
}

/// Most corners of a polygon: cutting a concave one takes the square of them.
const MOST_CORNERS: usize = 2048;

fn check_faces(path: &ScenePath, faces: &[Vec<(f64, f64, f64)>], report: &mut Report<'_>) {
    if faces.is_empty() {
        report.error(path, "this mesh has no face", "write three or more corners of each");
    }
    for (index, face) in faces.iter().enumerate() {
        let path = path.index(index);
        if !(3..=MOST_CORNERS).contains(&face.len()) {
            let message = format!("expected 3 to {MOST_CORNERS} corners, found {}", face.len());
            report.push(Diagnostic::error(&path, message));
        }
        for (number, &(x, y, z)) in face.iter().enumerate() {
            report.finite(path.index(number), &[x, y, z]);
        }
    }
}

fn check_file(path: &ScenePath, mesh: &MeshFile<'_>, report: &mut Report<'_>) {
    report.above_zero(path.key("unit_m"), mesh.unit_m);
    if mesh.parts.is_empty() && mesh.material.is_none() && report.is_whole(path) {
        let help = "write `material: \"leaf\"` for all of it, or `parts: { \"crown\": \"leaf\" }`";
        report.error(path, "this mesh has no material", help);
    }
}
