use std::f32::consts::FRAC_1_SQRT_2;

use glam::Vec3;
use serde_json::{Value, json};

use super::glb::{glb, square_bytes, square_json};
use super::*;
use crate::assets::{GltfError, Loaded, read_gltf};

fn read(json: &Value) -> Result<Loaded<Mesh>, AssetError> {
    read_gltf(file(glb(json, &square_bytes())).path(), &AS_IS)
}

fn mesh(json: &Value) -> Mesh {
    let loaded = read(json).unwrap();
    assert_lawful(&loaded.value);
    assert_eq!(loaded.warnings, [""; 0]);
    loaded.value
}

fn problem(json: &Value) -> GltfError {
    match read(json) {
        Err(AssetError::Gltf { problem, .. }) => problem,
        other => panic!("{other:?}"),
    }
}

fn normal_z(mesh: &Mesh, triangle: usize) -> f32 {
    let [a, b, c] = mesh.corners(triangle);
    (b - a).cross(c - a).z
}

#[test]
fn a_square_is_two_triangles_named_after_their_material() {
    let mut json = square_json();
    let square = mesh(&json);
    assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(square.bounds(), Some((Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0))));
    assert_eq!(part_names(&square), ["default"]);
    json["meshes"][0]["primitives"][0]["material"] = json!(0);
    assert_eq!(part_names(&mesh(&json)), ["leaf"]);
    json["meshes"][0]["primitives"][0]["material"] = json!(1);
    assert_eq!(part_names(&mesh(&json)), ["material_1"]);
}

#[test]
fn buffers_may_be_files_and_data_uris() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("square.gltf");
    std::fs::write(folder.path().join("my square.bin"), square_bytes()).unwrap();
    let mut json = square_json();
    json["buffers"][0]["uri"] = json!("my%20square.bin");
    std::fs::write(&path, json.to_string()).unwrap();
    let from_file = read_gltf(&path, &AS_IS).unwrap().value;
    assert_eq!(from_file, mesh(&square_json()));

    // Three corners of zeros and ones in base64: 36 bytes, 4 of them the f32 1.0.
    let data = format!("AACAPwAAAAAAAAAA{}AACAPwAAAAAAAAAA", "AAAAAAAAAAAAAIA/");
    json["buffers"][0] =
        json!({ "byteLength": 36, "uri": format!("data:application/octet-stream;base64,{data}") });
    json["accessors"] = json!([{
        "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 1]
    }]);
    json["bufferViews"] = json!([{ "buffer": 0, "byteLength": 36 }]);
    json["meshes"][0]["primitives"][0]["indices"] = Value::Null;
    std::fs::write(&path, json.to_string()).unwrap();
    let error = read_gltf(&path, &AS_IS).unwrap_err();
    assert!(matches!(error, AssetError::NoFaces { .. }), "two corners agree: {error}");
    let data = data.replacen("AACAPwAAAAAAAAAA", "AAAAAAAAgD8AAAAA", 1);
    json["buffers"][0]["uri"] = json!(format!("data:;base64,{data}"));
    std::fs::write(&path, json.to_string()).unwrap();
    let mesh = read_gltf(&path, &AS_IS).unwrap().value;
    assert_eq!(mesh.vertices, [Vec3::Y, Vec3::Z, Vec3::X], "no indices: corners in order");

    for (uri, fragment) in [
        ("gone.bin", "cannot read \"gone.bin\""),
        ("https://example.org/a.bin", "is not a relative path"),
        ("/etc/hostname", "is not a relative path"),
        ("data:;base64,@@@@", "is not a relative path or a base64 data URI"),
        ("data:;base64,AAAA", "has 3 bytes of the 36"),
        (".", "cannot read"),
    ] {
        json["buffers"][0]["uri"] = json!(uri);
        std::fs::write(&path, json.to_string()).unwrap();
        let error = read_gltf(&path, &AS_IS).unwrap_err().to_string();
        assert!(error.contains(fragment), "{error}");
    }
}

#[test]
fn nodes_move_their_meshes_and_mirrors_keep_fronts_in_front() {
    let mut json = square_json();
    json["nodes"] = json!([
        { "translation": [10.0, 0.0, 0.0], "children": [1, 2] },
        { "mesh": 0, "rotation": [0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2], "scale": [2, 2, 2] },
        { "mesh": 0, "scale": [-1.0, 1.0, 1.0] }
    ]);
    let mesh = mesh(&json);
    let near = |vertex: Vec3, x: f32, y: f32| (vertex - Vec3::new(x, y, 0.0)).length() < 1e-5;
    // Scaled, then turned from east to north, then moved.
    assert!(near(mesh.vertices[1], 10.0, 2.0), "{:?}", mesh.vertices);
    assert!(near(mesh.vertices[3], 8.0, 0.0), "{:?}", mesh.vertices);
    assert!(near(mesh.vertices[5], 9.0, 0.0), "{:?}", mesh.vertices);
    assert!((0..4).all(|triangle| normal_z(&mesh, triangle) > 0.0));
}

#[test]
fn strips_and_fans_run_around_like_lists() {
    for (mode, expected) in [
        (4, vec![[0, 1, 2], [0, 2, 3]]),
        (6, vec![[0, 1, 2], [0, 2, 3]]),
        (5, vec![[0, 1, 2], [2, 1, 3]]),
    ] {
        let mut json = square_json();
        let primitive = &mut json["meshes"][0]["primitives"][0];
        primitive["mode"] = json!(mode);
        if mode != 4 {
            primitive["indices"] = Value::Null;
        }
        assert_eq!(mesh(&json).triangles, expected, "mode {mode}");
    }
    let mut json = square_json();
    json["meshes"][0]["primitives"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "attributes": { "POSITION": 0 }, "mode": 1 }));
    let loaded = read(&json).unwrap();
    assert!(loaded.warnings[0].ends_with("points and lines are left out"));
}

/// A triangle of normalised i16 positions, 8 bytes apart, under indices of one byte.
#[test]
fn bytes_are_read_as_indices_and_quantized_shorts_as_positions() {
    let corners = [[0_i16, 0, 0, 99], [i16::MAX, 0, 0, 99], [0, i16::MIN, 16384, 99]];
    let mut bytes: Vec<u8> = corners.into_iter().flatten().flat_map(i16::to_le_bytes).collect();
    bytes.extend([2, 1, 0]);
    let mut json = square_json();
    json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    json["bufferViews"] = json!([
        { "buffer": 0, "byteLength": 24, "byteStride": 8 },
        { "buffer": 0, "byteOffset": 24, "byteLength": 3 }
    ]);
    json["accessors"][0]["componentType"] = json!(5122);
    json["accessors"][0]["normalized"] = json!(true);
    json["accessors"][0]["count"] = json!(3);
    json["accessors"][1]["componentType"] = json!(5121);
    json["accessors"][1]["count"] = json!(3);
    let read = |json: &Value| read_gltf(file(glb(json, &bytes)).path(), &AS_IS).unwrap().value;
    let mesh = read(&json);
    assert_eq!(mesh.triangles, [[2, 1, 0]]);
    let half = 16384.0 / 32767.0;
    assert_eq!(mesh.vertices, [Vec3::ZERO, Vec3::X, Vec3::new(0.0, -1.0, half)]);
    json["accessors"][0]["normalized"] = json!(false);
    assert_eq!(read(&json).vertices[2], Vec3::new(0.0, -32768.0, 16384.0));
}

#[test]
fn sparse_accessors_replace_positions() {
    let mut bytes = square_bytes();
    bytes.extend(2_u16.to_le_bytes());
    bytes.extend([0, 0]);
    bytes.extend([5.0_f32, 6.0, 7.0].into_iter().flat_map(f32::to_le_bytes));
    let mut json = square_json();
    json["buffers"][0]["byteLength"] = json!(bytes.len());
    let views = json["bufferViews"].as_array_mut().unwrap();
    views.push(json!({ "buffer": 0, "byteOffset": 60, "byteLength": 2 }));
    views.push(json!({ "buffer": 0, "byteOffset": 64, "byteLength": 12 }));
    json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": 2, "componentType": 5123 },
        "values": { "bufferView": 3 }
    });
    let read = |json: &Value| read_gltf(file(glb(json, &bytes)).path(), &AS_IS);
    assert_eq!(read(&json).unwrap().value.vertices[2], Vec3::new(5.0, 6.0, 7.0));
    json["accessors"][0]["sparse"]["count"] = json!(2);
    assert!(read(&json).unwrap_err().to_string().contains("accessor 0 reaches beyond its buffer"));
}

#[test]
fn accessors_and_indices_beyond_their_data_are_errors() {
    let change = |pointer: &str, value: Value| {
        let mut json = square_json();
        *json.pointer_mut(pointer).unwrap() = value;
        problem(&json)
    };
    let huge = json!(u64::MAX);
    let beyond = |problem: &GltfError| matches!(problem, GltfError::BeyondBuffer { .. });
    for (pointer, value) in [
        ("/accessors/0/count", json!(5)),
        ("/accessors/0/count", huge.clone()),
        ("/accessors/1/count", json!(7)),
        ("/bufferViews/0/byteLength", json!(1000)),
        ("/bufferViews/0/byteOffset", huge.clone()),
        ("/bufferViews/1/byteOffset", json!(61)),
    ] {
        let problem = change(pointer, value);
        assert!(beyond(&problem), "{pointer}: {problem}");
    }
    assert!(matches!(change("/buffers/0/byteLength", huge), GltfError::ShortBuffer { .. }));
    assert!(matches!(change("/scenes/0/nodes/0", json!(7)), GltfError::Invalid { .. }));
    let problem_of_index = change("/meshes/0/primitives/0/attributes/POSITION", json!(7));
    assert!(matches!(problem_of_index, GltfError::NoSuchAccessor { accessor: 7, count: 2 }));
    assert!(matches!(change("/accessors/1/bufferView", json!(7)), GltfError::Invalid { .. }));
    assert!(matches!(change("/accessors/1/componentType", json!(1)), GltfError::Invalid { .. }));
    assert!(matches!(
        change("/accessors/1/componentType", json!(5126)),
        GltfError::BeyondBuffer { .. } | GltfError::WrongType { .. }
    ));
    assert!(matches!(change("/accessors/1/type", json!("VEC2")), GltfError::WrongType { .. }));
    assert!(matches!(change("/accessors/0/type", json!("VEC2")), GltfError::WrongType { .. }));

    let mut json = square_json();
    json["accessors"][1]["componentType"] = json!(5125);
    json["accessors"][1]["count"] = json!(3);
    assert!(matches!(problem(&json), GltfError::NoSuchVertex { index: 0x1_0000, count: 4 }));
    let mut json = square_json();
    json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert!(matches!(problem(&json), GltfError::Invalid { .. }));
    json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": 1, "componentType": 5123 },
        "values": { "bufferView": 0 }
    });
    assert!(matches!(problem(&json), GltfError::NoData { accessor: 0 }));
}

#[test]
fn loops_of_nodes_and_unread_extensions_are_errors() {
    let mut json = square_json();
    json["nodes"] = json!([{ "children": [1] }, { "children": [0] }]);
    assert!(matches!(problem(&json), GltfError::NodeTwice { node: 0 }));
    let mut json = square_json();
    json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    let problem = problem(&json).to_string();
    assert!(problem.contains("needs the extension \"KHR_draco_mesh_compression\""), "{problem}");
    json["extensionsRequired"] = json!(["KHR_texture_transform", "KHR_materials_unlit"]);
    assert_eq!(mesh(&json).triangles.len(), 2, "these change no shape");
}

#[test]
fn numbers_that_are_not_finite_are_errors() {
    for number in [f32::NAN, f32::INFINITY, f32::MAX] {
        let mut bytes = square_bytes();
        bytes[12..16].copy_from_slice(&number.to_le_bytes());
        let error = read_gltf(file(glb(&square_json(), &bytes)).path(), &AS_IS).unwrap_err();
        assert!(error.to_string().contains("is too large to keep"), "{error}");
    }
}

/// Lengths in the header of a GLB file that its bytes do not keep.
#[test]
fn claims_of_a_glb_header_are_checked() {
    let whole = glb(&square_json(), &square_bytes());
    for (place, claims) in [(8, [0_u32, 11, 12, u32::MAX]), (12, [0, 3, 1 << 20, u32::MAX])] {
        for claim in claims {
            let mut bytes = whole.clone();
            bytes[place..place + 4].copy_from_slice(&claim.to_le_bytes());
            let error = read_gltf(file(&bytes).path(), &AS_IS).unwrap_err();
            let known = matches!(
                error,
                AssetError::Gltf {
                    problem: GltfError::Cut { .. }
                        | GltfError::BadGlb { .. }
                        | GltfError::BadJson { .. },
                    ..
                }
            );
            assert!(known, "{place} {claim}: {error}");
        }
    }
    for length in 0..whole.len() {
        assert!(read_gltf(file(&whole[..length]).path(), &AS_IS).is_err(), "cut at {length}");
    }
}
