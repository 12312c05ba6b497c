//! Extensions of glTF: what they change of the shape is read, refused or told.

use std::collections::BTreeMap;

use ::gltf::json::Root;
use ::gltf::{Document, Node};
use glam::{DMat4, DQuat, DVec3, DVec4};
use serde_json::{Map, Value};

use super::GltfError;
use super::accessor::vectors;
use super::buffers::Buffers;

/// Extensions that change no shape, or that are read: beginnings of their names.
const HARMLESS: [&str; 20] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_audio",
    "KHR_animation",
    "KHR_interactivity",
    "KHR_physics",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "EXT_mesh_features",
    "EXT_instance_features",
    "EXT_structural_metadata",
    "CESIUM_primitive_outline",
    "MSFT_lod",
    "KHR_mesh_quantization",
    INSTANCING,
    VISIBILITY,
];

/// Extensions of which the file may hold the data uncompressed too.
const COMPRESSION: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Most extensions to speak of.
const MOST_SHOWN: usize = 10;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

const VISIBILITY: &str = "KHR_node_visibility";

fn is_harmless(name: &str) -> bool {
    HARMLESS.iter().any(|start| name.starts_with(start))
}

/// Takes the requirements off a document that can be read without more ado.
///
/// # Errors
/// An extension that is needed and not read, whether the file says that it is required or not.
pub(super) fn require_none(json: &mut Root) -> Result<(), GltfError> {
    json.extensions_required.retain(|name| !is_harmless(name));
    let needed = json.extensions_required.first().cloned().or_else(|| compression_needed(json));
    needed.map_or(Ok(()), |name| Err(GltfError::Extension { name }))
}

/// The compression that the file has no data without.
fn compression_needed(json: &Root) -> Option<String> {
    let named = |extensions: &Map<String, Value>| {
        COMPRESSION
            .iter()
            .find(|name| extensions.contains_key(**name))
            .map(|name| (*name).to_owned())
    };
    let has_no_data = json.accessors.iter().any(|a| a.buffer_view.is_none() && a.sparse.is_none());
    let mut primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let draco = primitives.find_map(|p| named(&p.extensions.as_ref()?.others));
    if has_no_data && draco.is_some() {
        return draco;
    }
    json.buffer_views.iter().find_map(|view| {
        let name = named(&view.extensions.as_ref()?.others)?;
        let buffer = json.buffers.get(view.buffer.value())?;
        // Only the first buffer may be that of a GLB file.
        (buffer.uri.is_none() && view.buffer.value() > 0).then_some(name)
    })
}

/// Sentences about extensions that may change the shape and are not read.
pub(super) fn unread(json: &Root) -> Vec<String> {
    /// Extensions of objects of one kind.
    macro_rules! extensions {
        ($objects:expr) => {
            $objects.iter().filter_map(|object| Some(&object.extensions.as_ref()?.others)).collect()
        };
    }
    let primitives: Vec<_> = json.meshes.iter().flat_map(|mesh| &mesh.primitives).collect();
    let kinds: [(&str, Vec<&Map<String, Value>>); 6] = [
        ("file", json.extensions.iter().map(|root| &root.others).collect()),
        ("nodes", extensions!(json.nodes)),
        ("meshes", extensions!(json.meshes)),
        ("primitives", extensions!(primitives)),
        ("accessors", extensions!(json.accessors)),
        ("buffer views", extensions!(json.buffer_views)),
    ];
    let mut found: BTreeMap<(&str, &str), usize> = BTreeMap::new();
    for (kind, all) in &kinds {
        for name in all.iter().flat_map(|extensions| extensions.keys()) {
            if !is_harmless(name) && !COMPRESSION.contains(&name.as_str()) {
                *found.entry((name, kind)).or_insert(0) += 1;
            }
        }
    }
    let sentence = |((name, kind), count): (&(&str, &str), &usize)| {
        let what = match (*kind, count) {
            ("file", _) => "the file".to_owned(),
            (kind, 1) => format!("one of the {kind}"),
            (kind, count) => format!("{count} {kind}"),
        };
        format!(
            "the extension {name:?} of {what} is not read; if it changes shapes or places, export the \
             file without it"
        )
    };
    found.iter().take(MOST_SHOWN).map(sentence).collect()
}

/// Returns whether a node, and with it all below it, is hidden.
pub(super) fn is_hidden(node: &Node<'_>) -> bool {
    let visible = node.extension_value(VISIBILITY).and_then(|value| value.get("visible"));
    visible.and_then(Value::as_bool) == Some(false)
}

/// Returns the transforms of a node's mesh, relative to the node.
pub(super) fn instances(
    node: &Node<'_>,
    document: &Document,
    buffers: &Buffers,
) -> Result<Vec<DMat4>, GltfError> {
    let Some(extension) = node.extension_value(INSTANCING) else {
        return Ok(vec![DMat4::IDENTITY]);
    };
    let wrong = |problem| GltfError::Instances { node: node.index(), problem };
    let attributes = extension
        .get("attributes")
        .and_then(Value::as_object)
        .ok_or_else(|| wrong("there are no attributes"))?;
    let accessor = |name: &str| {
        let Some(index) = attributes.get(name) else { return Ok(None) };
        let index = index.as_u64().and_then(|index| usize::try_from(index).ok());
        let accessor = index.and_then(|index| document.accessors().nth(index));
        accessor.map(Some).ok_or_else(|| wrong("an attribute names no accessor"))
    };
    let read = |name: &str| -> Result<Option<Vec<[f64; 3]>>, GltfError> {
        accessor(name)?.map(|accessor| vectors(&accessor, buffers)).transpose()
    };
    let (translations, scales) = (read("TRANSLATION")?, read("SCALE")?);
    let rotations: Option<Vec<[f64; 4]>> =
        accessor("ROTATION")?.map(|accessor| vectors(&accessor, buffers)).transpose()?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let mut counts = counts.into_iter().flatten();
    let count = counts.next().ok_or_else(|| wrong("there is no TRANSLATION, ROTATION or SCALE"))?;
    if counts.any(|other| other != count) {
        return Err(wrong("the attributes differ in length"));
    }
    let transform = |index: usize| {
        let translation = translations.as_ref().map_or(DVec3::ZERO, |all| all[index].into());
        let scale = scales.as_ref().map_or(DVec3::ONE, |all| all[index].into());
        let rotation = rotations.as_ref().map_or(DVec4::W, |all| all[index].into());
        // Rounding, and integers that are not normalised, change the length alone.
        let rotation = rotation.try_normalize().ok_or_else(|| wrong("a ROTATION is zero"))?;
        let rotation = DQuat::from_vec4(rotation);
        Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation))
    };
    (0..count).map(transform).collect()
}
