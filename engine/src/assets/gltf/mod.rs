//! glTF 2.0, as JSON with buffers beside it or as one GLB file: geometry and material names.
//!
//! The `gltf` crate reads and validates the JSON; bytes are read here, because its iterators trust
//! that buffers are as long as the JSON claims.

mod accessor;
mod buffers;
mod error;

pub use error::GltfError;

use std::path::Path;

use ::gltf::mesh::Mode;
use ::gltf::{Document, Gltf, Node, Primitive, Semantic};
use glam::{DMat4, DVec3};
use indexmap::IndexSet;

use self::buffers::Buffers;
use super::import::{Collector, Import};
use super::{AssetError, Loaded, text};
use crate::components::Mesh;

/// Extensions that a file may require and that change no shape: beginnings of their names.
///
/// `KHR_mesh_quantization` does, and is read.
const HARMLESS: [&str; 5] =
    ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_mesh_quantization"];

/// A mesh from a glTF 2.0 file (`.gltf` or `.glb`): all nodes of the default scene.
///
/// A part is a material: it is called after it, `default` where there is none and `material_3`
/// where the material with index 3 has no name. Buffers may lie in the GLB file, in `data:` URIs
/// and in files beside it. Triangles, strips and fans are read; nodes that mirror keep their fronts
/// outside. Skins, morph targets, points and lines are left out with a warning; images are not read.
///
/// # Errors
/// A file that cannot be read or is cut, JSON that is not lawful glTF 2.0, accessors or indices
/// that reach beyond their data, a mesh without area.
pub fn read_gltf(path: &Path, import: &Import) -> Result<Loaded<Mesh>, AssetError> {
    import.check(path)?;
    let bytes = text::read(path)?;
    let wrong = |problem| AssetError::Gltf { file: path.to_owned(), problem };
    let Gltf { document, blob } = parse(&bytes).map_err(wrong)?;
    drop(bytes);
    let buffers = Buffers::load(&document, blob, path).map_err(wrong)?;
    let mut model = Model {
        import,
        buffers,
        mesh: Collector::new(path),
        parts: IndexSet::new(),
        left_out: IndexSet::new(),
    };
    model.scene(&document)?;
    let names: Vec<String> = model.parts.into_iter().collect();
    for what in model.left_out {
        model.mesh.warn(what);
    }
    model.mesh.finish(&names, import)
}

/// The validated document.
fn parse(mut bytes: &[u8]) -> Result<Gltf, GltfError> {
    if bytes.starts_with(b"glTF") {
        // The crate takes the length of the header off this one without asking.
        let field = bytes.get(8..12).and_then(|field| field.try_into().ok());
        let claimed = field.map_or(0, u32::from_le_bytes) as usize;
        if claimed < 12 || claimed > bytes.len() {
            return Err(GltfError::Cut { claimed, found: bytes.len() });
        }
        bytes = &bytes[..claimed];
    }
    let Gltf { document, blob } =
        Gltf::from_slice_without_validation(bytes).map_err(GltfError::from_crate)?;
    let mut json = document.into_json();
    json.extensions_required.retain(|name| !HARMLESS.iter().any(|start| name.starts_with(start)));
    if let Some(name) = json.extensions_required.first() {
        return Err(GltfError::Extension { name: name.clone() });
    }
    // The crate's own check takes these indices for granted.
    let count = json.accessors.len();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut attributes = primitives.flat_map(|primitive| primitive.attributes.values());
    if let Some(accessor) = attributes.find(|accessor| accessor.value() >= count) {
        return Err(GltfError::NoSuchAccessor { accessor: accessor.value(), count });
    }
    let document = Document::from_json(json).map_err(GltfError::from_crate)?;
    Ok(Gltf { document, blob })
}

struct Model<'a> {
    import: &'a Import,
    buffers: Buffers,
    mesh: Collector,
    parts: IndexSet<String>,
    left_out: IndexSet<&'static str>,
}

impl Model<'_> {
    fn wrong(&self, problem: GltfError) -> AssetError {
        AssetError::Gltf { file: self.mesh.file.clone(), problem }
    }

    /// All nodes of the default scene, else of the first one, else all.
    fn scene(&mut self, document: &Document) -> Result<(), AssetError> {
        let scene = document.default_scene().or(document.scenes().next());
        let roots: Vec<Node<'_>> = if let Some(scene) = scene {
            scene.nodes().collect()
        } else {
            let children: IndexSet<usize> =
                document.nodes().flat_map(|node| node.children()).map(|c| c.index()).collect();
            document.nodes().filter(|node| !children.contains(&node.index())).collect()
        };
        let mut seen = vec![false; document.nodes().len()];
        let mut open: Vec<(Node<'_>, DMat4)> =
            roots.into_iter().rev().map(|node| (node, DMat4::IDENTITY)).collect();
        while let Some((node, scene_from_parent)) = open.pop() {
            // The standard asks for trees; a loop would never end.
            if std::mem::replace(&mut seen[node.index()], true) {
                return Err(self.wrong(GltfError::NodeTwice { node: node.index() }));
            }
            let columns = node.transform().matrix().map(|column| column.map(f64::from));
            let scene_from_node = scene_from_parent * DMat4::from_cols_array_2d(&columns);
            self.node(&node, scene_from_node)?;
            let first_child = open.len();
            open.extend(node.children().map(|child| (child, scene_from_node)));
            open[first_child..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &Node<'_>, scene_from_node: DMat4) -> Result<(), AssetError> {
        let Some(mesh) = node.mesh() else { return Ok(()) };
        if node.skin().is_some() {
            self.left_out.insert("skins are left out: skinned meshes stand as they were modelled");
        }
        for primitive in mesh.primitives() {
            if primitive.morph_targets().next().is_some() {
                self.left_out.insert("morph targets are left out");
            }
            self.primitive(&primitive, scene_from_node)?;
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        scene_from_node: DMat4,
    ) -> Result<(), AssetError> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.left_out.insert("points and lines are left out");
            return Ok(());
        }
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            self.left_out.insert("primitives without positions are left out");
            return Ok(());
        };
        let positions = accessor::positions(&accessor, &self.buffers).map_err(|e| self.wrong(e))?;
        let first = self.mesh.reserve(positions.len())?;
        for position in &positions {
            let vertex = self.import.point(scene_from_node.transform_point3(*position));
            let added = self.mesh.add_vertex(vertex);
            added.map_err(|value| self.wrong(GltfError::TooFar { value }))?;
        }
        let indices = match primitive.indices() {
            Some(accessor) => {
                accessor::indices(&accessor, &self.buffers).map_err(|e| self.wrong(e))?
            }
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(&index) = indices.iter().find(|&&index| index as usize >= positions.len()) {
            let count = positions.len();
            return Err(self.wrong(GltfError::NoSuchVertex { index, count }));
        }
        let part = self.parts.insert_full(part_name(primitive)).0 as u32;
        let mirrored = is_mirror(scene_from_node);
        for [a, b, c] in triangles(primitive.mode(), &indices) {
            let corners = if mirrored { [a, c, b] } else { [a, b, c] };
            self.mesh.add_triangle(corners.map(|corner| first + corner), part)?;
        }
        Ok(())
    }
}

fn part_name(primitive: &Primitive<'_>) -> String {
    let material = primitive.material();
    match (material.name(), material.index()) {
        (Some(name), _) => name.to_owned(),
        (None, Some(index)) => format!("material_{index}"),
        (None, None) => "default".to_owned(),
    }
}

/// Whether a transform turns right hands into left hands.
fn is_mirror(transform: DMat4) -> bool {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| transform.transform_vector3(axis));
    x.cross(y).dot(z) < 0.0
}

/// Triangles of a list, strip or fan, all running around the same way.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let turned = |(place, t): (usize, &[u32])| match place % 2 {
                0 => [t[0], t[1], t[2]],
                _ => [t[1], t[0], t[2]],
            };
            indices.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => {
            let rim = indices.get(1..).unwrap_or_default();
            rim.windows(2).map(|pair| [indices[0], pair[0], pair[1]]).collect()
        }
        _ => indices.as_chunks::<3>().0.to_vec(),
    }
}
