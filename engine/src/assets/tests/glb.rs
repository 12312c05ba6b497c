//! GLB files made for tests.

use serde_json::{Value, json};

/// A GLB file of this JSON and these bytes.
pub(super) fn glb(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bin = bin.to_vec();
    bin.resize(bin.len().next_multiple_of(4), 0);
    let word = |value: usize| (value as u32).to_le_bytes();
    let mut all = b"glTF".to_vec();
    all.extend(word(2));
    all.extend(word(12 + 8 + text.len() + 8 + bin.len()));
    all.extend(word(text.len()));
    all.extend(b"JSON");
    all.extend(text);
    all.extend(word(bin.len()));
    all.extend(b"BIN\0");
    all.extend(bin);
    all
}

/// Four corners of a unit square, then the indices 0 1 2 0 2 3 as u16.
pub(super) fn square_bytes() -> Vec<u8> {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let indices = [0_u16, 1, 2, 0, 2, 3];
    let corners = corners.into_iter().flatten().flat_map(f32::to_le_bytes);
    corners.chain(indices.into_iter().flat_map(u16::to_le_bytes)).collect()
}

/// A scene of one node with the unit square; tests change what they are about.
pub(super) fn square_json() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "materials": [{ "name": "leaf" }, {}],
        "accessors": [
            {
                "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0]
            },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" }
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 12 }
        ],
        "buffers": [{ "byteLength": 60 }]
    })
}
