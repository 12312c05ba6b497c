use std::fmt::Write as _;

use glam::{DVec3, Vec3};
use proptest::prelude::*;

use super::*;
use crate::assets::{Loaded, read_obj};
use crate::components::MeshPart;

fn read(text: &str) -> Result<Loaded<Mesh>, AssetError> {
    read_obj(file(text).path(), &AS_IS, &PartsBy::Group)
}

fn mesh(text: &str) -> Mesh {
    let loaded = read(text).unwrap();
    assert_lawful(&loaded.value);
    assert_eq!(loaded.warnings, [""; 0]);
    loaded.value
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn corners_may_be_written_in_every_way_of_the_format() {
    let expected = [[0, 1, 2]];
    for face in ["f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//1", "f 1/1/1 2/2/2 3/3/3"] {
        let text = format!("{SQUARE}vt 0 0\nvn 0 0 1\n{face}\n");
        assert_eq!(mesh(&text).triangles, expected, "{face}");
    }
    assert_eq!(mesh(&format!("{SQUARE}f -4 -3 -2\n")).triangles, expected);
    assert_eq!(mesh(&format!("{SQUARE}f 1 \\\n 2 \\\r\n3\n")).triangles, expected);
    assert_eq!(mesh(&format!("f 1 2 3\n{SQUARE}")).triangles, expected, "vertices may follow");
    assert_eq!(
        mesh(&format!("\u{feff}# caf\u{e9}\r\n{SQUARE}\r\n  f\t1 2   3  ")).triangles,
        expected
    );
    // A negative index counts from its own line, not from the end of the file.
    assert_eq!(mesh(&format!("{SQUARE}f -4 -3 -2\nv 9 9 9\nf 1 3 5\n")).triangles[0], [0, 1, 2]);
}

#[test]
fn comments_may_be_in_any_encoding() {
    let mut text = b"# caf\xe9\n".to_vec();
    text.extend_from_slice(SQUARE.as_bytes());
    text.extend_from_slice(b"f 1 2 3\n");
    assert_eq!(
        read_obj(file(text).path(), &AS_IS, &PartsBy::Group).unwrap().value.triangles.len(),
        1
    );
}

#[test]
fn groups_and_their_materials_are_the_parts_in_first_appearance_order() {
    let names = |body: &str| -> Vec<(String, usize)> {
        let mesh = mesh(&format!("{SQUARE}{body}"));
        mesh.parts.iter().map(|part| (part.name.clone(), part.triangles.len())).collect()
    };
    let named = |parts: &[(&str, usize)]| -> Vec<(String, usize)> {
        parts.iter().map(|&(name, count)| (name.to_owned(), count)).collect()
    };
    assert_eq!(names("f 1 2 3\n"), named(&[("default", 1)]));
    assert_eq!(names("usemtl bark\nf 1 2 3\n"), named(&[("bark", 1)]));
    assert_eq!(names("g leaf\nusemtl green\nf 1 2 3\n"), named(&[("leaf", 1)]));
    assert_eq!(
        names("g tree\nusemtl bark\nf 1 2 3\nusemtl tree\nf 1 3 4\n"),
        named(&[("tree/bark", 1), ("tree", 1)])
    );
    // Triangles of one part come together though the file returns to it.
    assert_eq!(
        names("o a\nf 1 2 3\ng b\nf 1 2 4\nf 2 3 4\no a\nf 1 3 4\n"),
        named(&[("a", 2), ("b", 2)])
    );
    // The name of a group with a space, as exporters write it.
    assert_eq!(names("g  old  oak \nf 1 2 3\n"), named(&[("old oak", 1)]));
}

#[test]
fn triangles_of_a_part_keep_the_order_of_the_file() {
    let mesh = mesh(&format!("{SQUARE}g a\nf 1 2 3\ng b\nf 1 2 4\ng a\nf 2 3 4\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 2, 3], [0, 1, 3]]);
}

#[test]
fn polygons_are_cut_into_triangles_that_cover_them() {
    let concave = "v 0 0 0\nv 2 -1 0\nv 0 2 0\nv -2 -1 0\nf 1 2 3 4\n";
    let mesh = mesh(concave);
    assert_eq!(mesh.part_area(&mesh.parts[0]), 4.0);
    for t in 0..2 {
        let [a, b, c] = mesh.corners(t);
        assert!((b - a).cross(c - a).z > 0.0, "fronts stay in front");
    }
}

#[test]
fn axes_turn_and_units_scale() {
    let import = Import { up: Axis::Y, unit_m: 0.01, origin: Origin::File };
    let text = "v 100 200 300\nv 0 0 0\nv 100 0 0\nf 1 2 3\n";
    let mesh = read_obj(file(text).path(), &import, &PartsBy::Group).unwrap().value;
    assert_eq!(mesh.vertices, [Vec3::new(1.0, -3.0, 2.0), Vec3::ZERO, Vec3::X]);
}

/// Coordinates at a map position, with steps of a millimetre that f32 could not tell apart there.
#[test]
fn a_model_at_map_coordinates_keeps_its_millimetres() {
    let text = "v 500000.000 5400000.000 310.000\nv 500000.003 5400000.000 310.000\n\
                v 500000.000 5400000.001 310.002\nv 1 1 1\nf 1 2 3\n";
    let import = Import { origin: Origin::BaseCenter, ..AS_IS };
    let loaded = read_obj(file(text).path(), &import, &PartsBy::Group).unwrap();
    let expected = [[-0.0015, -0.0005, 0.0], [0.0015, -0.0005, 0.0], [-0.0015, 0.0005, 0.002]];
    for (vertex, expected) in loaded.value.vertices.iter().zip(expected) {
        // f64 keeps 1e-9 m at these coordinates.
        assert!((*vertex - Vec3::from(expected)).abs().max_element() < 2e-9, "{vertex}");
    }
    assert_eq!(loaded.warnings, [""; 0]);

    let error = read(text).unwrap_err();
    assert!(matches!(error, AssetError::NoFaces { .. }), "in f32 nothing is left: {error}");
    let text = "v 500000 5400000 310\nv 500003 5400000 310\nv 500000 5400001 312\nf 1 2 3\n";
    let warning = &read(text).unwrap().warnings[0];
    assert!(warning.contains("less than 0.1 mm") && warning.contains("BaseCenter"), "{warning}");
}

#[test]
fn the_base_is_that_of_the_faces_not_of_stray_vertices() {
    let text = format!("v -9 -9 -9\n{SQUARE}f 2 3 4\n");
    let import = Import { origin: Origin::BaseCenter, ..AS_IS };
    let mesh = read_obj(file(text).path(), &import, &PartsBy::Group).unwrap().value;
    assert_lawful(&mesh);
    assert_eq!(mesh.bounds(), Some((Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, 0.5, 0.0))));
}

#[test]
fn faces_without_area_are_dropped_and_counted() {
    let body = "v 2 0 0\ng a\nf 1 2 3\nf 1 2 5\nf 1 1 2\nf 2 2 2\ng flat\nf 1 2 5\n";
    let Loaded { value, warnings } = read(&format!("{SQUARE}{body}")).unwrap();
    assert_lawful(&value);
    assert_eq!(value.parts, [MeshPart { name: "a".to_owned(), triangles: 0..1, discs: 0..0 }]);
    assert!(warnings[0].ends_with(": 4 triangles without area were dropped"), "{warnings:?}");
    assert!(warnings[1].ends_with(": part \"flat\" has no triangle and was left out"));
    assert_eq!(warnings.len(), 2);
}

#[test]
fn unknown_keywords_are_a_warning() {
    let loaded = read(&format!("{SQUARE}curv 0 1\nf 1 2 3\ncurv 1 2\n")).unwrap();
    assert_eq!(loaded.warnings.len(), 1);
    assert!(loaded.warnings[0].ends_with("lines with \"curv\" were left out (first: line 5)"));
}

#[test]
fn errors_name_the_line_and_say_what_to_write() {
    for (text, expected) in [
        ("v 0 0\n", ":1: this vertex has 2 coordinates; write three: `v x y z`"),
        ("v 0 0 x\n", ":1: a coordinate is \"x\"; write a finite number such as 1.5 or 2e-3"),
        (
            "\n# c\nv 0 nan 0\n",
            ":3: a coordinate is \"nan\"; write a finite number such as 1.5 or 2e-3",
        ),
        (
            "v 0 1e999 0\n",
            ":1: a coordinate is \"1e999\"; write a finite number such as 1.5 or 2e-3",
        ),
        (
            "v 0 1e39 0\n",
            ":1: coordinate 1e39 m is too large to keep; check the file and the length of its unit",
        ),
        ("v 0 0 0\nf 1 2\n", ":2: this face has 2 corners; write at least three"),
        (
            "v 0 0 0\nf 0 1 1\n",
            ":2: corner 0 names no vertex, and there is 1 vertex above it; count from 1 at the first, or from -1 \
             backwards",
        ),
        (
            "v 0 0 0\nf 1 1 9\n",
            ":2: corner 9 names no vertex, and there is 1 vertex above it; count from 1 at the first, or from -1 \
             backwards",
        ),
        (
            "v 0 0 0\nf -1 -1 -2\n",
            ":2: corner -2 names no vertex, and there is 1 vertex above it; count from 1 at the first, or from -1 \
             backwards",
        ),
        (
            "v 0 0 0\nf 1 1 1.5\n",
            ":2: \"1.5\" is no corner; write a vertex index as 7, 7/1, 7//3, 7/1/3 or -1",
        ),
        (
            "",
            ": holds no face that has an area; a mesh needs lines such as `v 0 0 0` and `f 1 2 3`, \
             or triangles",
        ),
    ] {
        assert_eq!(message(&read(text).unwrap_err()), expected, "{text:?}");
    }
    for text in ["f 1/x 1 1", "f 1/1/1/1 1 1", "f /1 1 1", "f 99999999999999999999 1 1"] {
        let error = read(&format!("v 0 0 0\n{text}\n")).unwrap_err();
        assert!(matches!(error, AssetError::BadCorner { line: 2, .. }), "{text}: {error}");
    }
    let extreme = format!("v 0 0 0\nf {} {} 1\n", i64::MIN, i64::MAX);
    assert!(matches!(read(&extreme).unwrap_err(), AssetError::NoSuchVertex { line: 2, .. }));
    let bad_unit = Import { unit_m: 0.0, ..AS_IS };
    let error = read_obj(file(SQUARE).path(), &bad_unit, &PartsBy::Group).unwrap_err();
    assert!(matches!(error, AssetError::BadUnit { unit_m: 0.0, .. }), "{error}");
}

/// Warning about a square of material `pane` beside a library with this text.
fn transparency_warning(library: impl AsRef<[u8]>) -> Option<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.obj");
    let text = format!("mtllib a.mtl\n{SQUARE}usemtl pane\nf 1 2 3 4\nusemtl wall\nf 1 2 3 4\n");
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join("a.mtl"), library).unwrap();
    let warnings = read_obj(&path, &AS_IS, &PartsBy::Group).unwrap().warnings;
    assert!(warnings.len() < 2, "{warnings:?}");
    warnings.first().map(|warning| warning.split(" of this file").next().unwrap().to_owned())
}

#[test]
fn libraries_say_which_materials_are_transparent() {
    for (library, expected) in [
        ("newmtl pane\nd 0.5\n", Some("`pane` (d 0.5)")),
        ("newmtl pane\nd -halo 0.5 # half\n", Some("`pane` (d 0.5)")),
        ("newmtl pane\nTr 0.25\nKd 0.5\nKa spectral leaf.rfl\nillum x\n", Some("`pane` (Tr 0.25)")),
        ("newmtl pane\ntr 0.25\nd 1\n", None),
        ("newmtl pane\nTr 0\nnewmtl pane\nd 0.1\n", Some("`pane` (d 0.1)")),
        ("newmtl pane\nd 0.5\nnewmtl pane\nd 0.1\n", Some("`pane` (d 0.5)")),
        ("newmtl pane\nmap_Tr -clamp on a.png\nd 0.5\n", Some("`pane` (map_Tr -clamp on a.png)")),
        ("newmtl pane\nnewmtl\nd 0.5\n", None),
        ("d 0.5\nnewmtl pane\nd nan\nd x\nd\n", None),
        ("newmtl wall\nd 0.5\nnewmtl  pane \nd 0\n", Some("`pane` (d 0), `wall` (d 0.5)")),
        ("", None),
    ] {
        let warning = transparency_warning(library);
        let shown = warning.as_ref().and_then(|warning| warning.rsplit("not read: ").next());
        assert_eq!(shown, expected, "{library:?}");
    }
    let latin1 = transparency_warning(b"# caf\xe9\nnewmtl pane\nd 0.5\n");
    assert!(latin1.is_some_and(|warning| warning.ends_with("(d 0.5)")));
}

proptest! {
    /// A mesh that is written as OBJ text is read back bit for bit, and has the triangles that `tobj` finds.
    #[test]
    fn a_written_mesh_is_read_back(
        vertices in prop::collection::vec(prop::array::uniform3(-100.0..100.0_f32), 3..40),
        picks in prop::collection::vec((any::<[prop::sample::Index; 3]>(), 0..3_usize), 1..40),
    ) {
        let mut text = String::new();
        for [x, y, z] in &vertices {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        let mut expected = vec![Vec::new(); 3];
        for (corners, part) in &picks {
            let [a, b, c] = corners.map(|corner| corner.index(vertices.len()));
            let corners = [a, b, c].map(|corner| Vec3::from(vertices[corner]));
            let [p, q, r] = corners.map(Vec3::as_dvec3);
            writeln!(text, "g part{part}\nf {} {} {}", a + 1, b + 1, c + 1).unwrap();
            if (q - p).cross(r - p).length() > 0.0 {
                expected[*part].push(corners);
            }
        }
        let options = tobj::LoadOptions::default();
        let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| unreachable!()).unwrap();
        let mut with_tobj = vec![Vec::new(); 3];
        for tobj::Model { mesh, name } in &models {
            let vertex = |index: u32| {
                let start = 3 * index as usize;
                DVec3::from_slice(&mesh.positions[start..start + 3])
            };
            for corners in mesh.indices.chunks_exact(3) {
                let [a, b, c] = [0, 1, 2].map(|corner| vertex(corners[corner]));
                if (b - a).cross(c - a).length() > 0.0 {
                    let part: usize = name["part".len()..].parse().unwrap();
                    with_tobj[part].push([a, b, c].map(DVec3::as_vec3));
                }
            }
        }
        prop_assert_eq!(&with_tobj, &expected);
        let total: usize = expected.iter().map(Vec::len).sum();
        match read(&text) {
            Err(AssetError::NoFaces { .. }) => prop_assert_eq!(total, 0),
            Err(other) => prop_assert!(false, "{}", other),
            Ok(Loaded { value, .. }) => {
                assert_lawful(&value);
                prop_assert_eq!(value.triangles.len(), total);
                for part in &value.parts {
                    let corners = part.triangles.clone().map(|t| value.corners(t as usize));
                    let place: usize = part.name["part".len()..].parse().unwrap();
                    prop_assert_eq!(corners.collect::<Vec<_>>(), expected[place].clone());
                }
            }
        }
    }
}
