//! PLY files in all encodings, and files that are broken.

use std::fmt::Write as _;

use glam::Vec3;

use super::*;
use crate::assets::{Loaded, PlyError, read_obj, read_ply};

/// A square as a quad and a triangle above it, ASCII.
const SQUARE: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 7\nproperty float x\nproperty float y\n\
property float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
0 0 0 10\n1 0 0 10\n1 1 0 10\n0 1 0 10\n0 0 1 10\n1 0 1 10\n0 1 1 10\n4 0 1 2 3\n3 4 5 6\n";

/// Binary file of the same mesh, with doubles, unsigned indices and an element that no mesh is made of.
fn binary(is_big: bool) -> Vec<u8> {
    let order = if is_big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 7\nproperty uchar red\nproperty double x\nproperty double y\n\
         property double z\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nelement face 2\n\
         property list uchar float quality\nproperty list ushort uint vertex_index\nend_header\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| {
        if is_big {
            bytes.extend(little.iter().rev());
        } else {
            bytes.extend(little);
        }
    };
    let corners: [[f64; 3]; 7] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ];
    for corner in corners {
        put(&[10]);
        for value in corner {
            put(&value.to_le_bytes());
        }
    }
    for index in [0_i32, 1, 1, 2] {
        put(&index.to_le_bytes());
    }
    for face in [&[0_u32, 1, 2, 3][..], &[4, 5, 6]] {
        put(&[1]);
        put(&0.5_f32.to_le_bytes());
        put(&(face.len() as u16).to_le_bytes());
        for index in face {
            put(&index.to_le_bytes());
        }
    }
    bytes
}

fn read(content: impl AsRef<[u8]>) -> Result<Loaded<Mesh>, AssetError> {
    read_ply(file(content).path(), &AS_IS)
}

fn problem(content: impl AsRef<[u8]>) -> PlyError {
    match read(content) {
        Err(AssetError::Ply { problem, .. }) => problem,
        other => panic!("{other:?}"),
    }
}

#[test]
fn all_encodings_hold_the_same_mesh() {
    let ascii = read(SQUARE).unwrap();
    assert_eq!(ascii.warnings, [""; 0]);
    let mesh = ascii.value;
    assert_lawful(&mesh);
    assert_eq!(part_names(&mesh), ["default"]);
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (7, 3));
    assert_eq!(mesh.vertices[2], Vec3::new(1.0, 1.0, 0.0));
    for is_big in [false, true] {
        assert_eq!(read(binary(is_big)).unwrap().value, mesh, "{is_big}");
    }
    assert_eq!(read(SQUARE.replace('\n', "\r\n")).unwrap().value, mesh, "lines of Windows");
}

/// *Expected*: what OBJ makes of the same faces, concave ones and faces that cross themselves too.
#[test]
fn polygons_are_cut_as_those_of_obj_are() {
    let corners = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4), (1, 3), (3, 3)];
    let faces: [&[usize]; 3] = [&[0, 1, 2, 3, 4], &[0, 1, 2, 4], &[0, 2, 1, 4]];
    let vertices = |prefix: &str| -> String {
        let lines = corners.iter().map(|(x, y)| format!("{prefix}{x} {y} 0.5\n"));
        lines.collect::<Vec<_>>().concat()
    };
    let mut obj = vertices("v ");
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement face \
         {}\nproperty list uchar uchar vertex_indices\nend_header\n{}",
        corners.len(),
        faces.len(),
        vertices("")
    );
    for face in faces {
        let list = |add: usize| {
            let corners = face.iter().map(|i| (i + add).to_string());
            corners.collect::<Vec<_>>().join(" ")
        };
        writeln!(obj, "f {}", list(1)).unwrap();
        writeln!(ply, "{} {}", face.len(), list(0)).unwrap();
    }
    let import = Import { up: Axis::Y, unit_m: 0.01, origin: Origin::BaseCenter };
    let from_obj = read_obj(file(obj).path(), &import, &PartsBy::Group).unwrap();
    let from_ply = read_ply(file(ply).path(), &import).unwrap();
    assert_eq!(from_ply.value, from_obj.value);
    assert_eq!(from_ply.warnings.len(), 1, "{:?}", from_ply.warnings);
    assert!(from_ply.warnings[0].contains("crosses itself (first: face 2)"));
}

#[test]
fn what_is_wrong_with_a_mesh_is_told() {
    let with = |from: &str, to: &str| {
        assert!(SQUARE.contains(from), "{from}");
        SQUARE.replace(from, to)
    };
    assert_eq!(
        problem(with("4 0 1 2 3", "4 0 1 2 7")),
        PlyError::NoSuchVertex { face: 0, index: 7, count: 7 }
    );
    assert_eq!(
        problem(with("3 4 5 6", "3 4 -1 6")),
        PlyError::NoSuchVertex { face: 1, index: -1, count: 7 }
    );
    assert_eq!(problem(with("3 4 5 6", "2 4 5")), PlyError::ShortFace { face: 1, found: 2 });
    let long =
        with("4 0 1 2 3", &format!("3000{}", " 0".repeat(3000))).replace("list uchar", "list int");
    assert!(matches!(problem(long), PlyError::LongFace { face: 0, found: 3000, most: 2048 }));
    // Words for what is no number are none in a text.
    for word in ["nan", "inf"] {
        let word = format!("1 {word} 0 10");
        assert!(matches!(problem(with("1 1 0 10", &word)), PlyError::Malformed(_)), "{word}");
    }
    for value in [f64::NAN, f64::INFINITY] {
        let mut bytes = binary(false);
        let header = b"end_header\n";
        let start = bytes.windows(header.len()).position(|w| w == header).unwrap() + header.len();
        // The x of the third vertex, behind a byte of red each and three doubles.
        let place = start + 2 * 25 + 1;
        bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
        assert!(matches!(problem(bytes), PlyError::NotFinite { vertex: 2, .. }), "{value}");
    }
    let far = with("property float x", "property double x").replace("1 1 0 10", "1e300 1 0 10");
    assert!(matches!(problem(far), PlyError::FarVertex { vertex: 2, .. }));
    assert_eq!(
        problem(with("property float z", "property float w")),
        PlyError::NoVertices("vertex")
    );
    assert_eq!(problem(with("element face 2", "element face 0")), PlyError::NoFaces);
    let strips = with("element face 2", "element tristrips 2");
    assert_eq!(problem(strips), PlyError::Strips);
    let flat = with("4 0 1 2 3", "4 0 0 1 1").replace("3 4 5 6", "3 4 4 5");
    assert!(matches!(read(flat), Err(AssetError::NoFaces { .. })));
    for (from, to) in [
        ("ascii 1.0", "ascii 2.0"),
        ("format ascii", "format text"),
        ("element vertex 7", "element vertex many"),
        ("element vertex 7", "element vertex -1"),
        ("1 1 0 10", "1 x 0 10"),
        ("1 1 0 10", "1 1 0"),
        ("end_header\n", ""),
    ] {
        assert!(matches!(problem(with(from, to)), PlyError::Malformed(_)), "{from} {to}");
    }
}

#[test]
fn lies_about_sizes_take_no_memory_and_no_time() {
    for count in ["1000000000", "4294967295", "18446744073709551615"] {
        for element in ["element vertex 7", "element face 2"] {
            let name = element.rsplit_once(' ').unwrap().0;
            assert!(read(SQUARE.replace(element, &format!("{name} {count}"))).is_err());
            let text = binary(false);
            let place = text.windows(element.len()).position(|w| w == element.as_bytes()).unwrap();
            let mut lie = text[..place].to_vec();
            lie.extend(format!("{name} {count}").bytes());
            lie.extend(&text[place + element.len()..]);
            assert!(read(lie).is_err());
        }
    }
    // A list that says that it has four thousand million corners.
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                  property float z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n";
    let list = |count: u32| {
        let places = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let mut bytes = header.as_bytes().to_vec();
        bytes.extend(places.iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend([count, 0, 1, 2].iter().flat_map(|value| value.to_le_bytes()));
        bytes
    };
    assert!(read(list(3)).is_ok());
    assert!(matches!(problem(list(u32::MAX)), PlyError::Malformed(_)));
    let endless = format!("ply\nformat ascii 1.0\ncomment {}\n", "x".repeat(3 << 20));
    assert!(problem(endless).to_string().contains("its header is longer than"));
    let line = SQUARE.replace("0 0 0 10\n", &format!("0 0 0 10{}\n", " ".repeat(3 << 20)));
    assert!(problem(line).to_string().contains("a line is longer than"));
}

#[test]
fn files_that_are_cut_off_are_errors() {
    for whole in [SQUARE.as_bytes().to_vec(), binary(false), binary(true)] {
        // The last line feed of a text may be missing.
        for length in 0..whole.len() - 1 {
            let cut = read(&whole[..length]);
            assert!(cut.is_err(), "cut at {length} of {}", whole.len());
        }
    }
}
