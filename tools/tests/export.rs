//! `sunfleck export` from outside: what it says of the files that it writes.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;

use assert_cmd::Command;
use tempfile::tempdir;

/// A scene with a leaf, placed where `at` says.
fn scene(at: &str) -> String {
    format!(
        r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0)],
    materials: {{ "soil": Lambertian(reflectance: Constant(0.3)) }},
    meshes: {{ "leaf": Obj(file: "leaf.obj", up: Z, unit_m: 1.0, material: "soil") }},
    terrain: Plane(size_m: (4.0, 4.0), material: "soil"),
    instances: [List(of: "leaf", at_m: [{at}])],
    sun: (zenith_deg: 30.0),
    sensors: {{ "top": Orthographic(size_px: (4, 4), extent_m: (4.0, 4.0)) }},
)"#
    )
}

/// What the command prints for a scene with so many leaves.
fn said(at: &str, arguments: &[&str]) -> String {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("leaf.ron"), scene(at)).unwrap();
    fs::write(folder.path().join("leaf.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let command = command.current_dir(folder.path()).args(["export", "leaf.ron", "--out"]);
    let output = command.args(arguments).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let file = folder.path().join(arguments[0]);
    let has_extension =
        fs::read(&file).unwrap().windows(22).any(|part| part == b"EXT_mesh_gpu_instancin");
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(
        has_extension,
        text.contains("EXT_mesh_gpu_instancing"),
        "the note goes with the extension in the file: {text}"
    );
    text
}

/// *Expected*: the note stands where the file needs the extension, and names the option that goes without it.
#[test]
fn a_gltf_with_instances_says_what_it_needs() {
    let two = "(1.0, 1.0, 0.5), (2.0, 2.0, 0.5)";
    assert_eq!(
        said(two, &["a.glb"]),
        "1 mesh, 2 instances, 4 triangles in all\n\
         needs EXT_mesh_gpu_instancing, which three.js and Babylon.js read; `--flat` writes a node per instance for \
         other programs\n\
         a.glb\n"
    );
    assert_eq!(said(two, &["a.glb", "--flat"]), "1 mesh, 2 instances, 4 triangles in all\na.glb\n");
    assert_eq!(said(two, &["a.ply"]).lines().last(), Some("a.ply"));
}

/// *Expected*: a single instance needs the extension too, and is counted in the singular.
#[test]
fn a_gltf_of_one_instance_says_what_it_needs() {
    let text = said("(1.0, 1.0, 0.5)", &["a.glb"]);
    assert!(text.starts_with("1 mesh, 1 instance, 3 triangles in all\nneeds EXT_mesh_"), "{text}");
}
