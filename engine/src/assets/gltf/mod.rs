//! glTF 2.0, as JSON with buffers beside it or as one GLB file: geometry and material names.
//!
//! The `gltf` crate reads and validates the JSON; bytes are read here, because its iterators trust
//! that buffers are as long as the JSON claims.

mod accessor;
mod buffers;
mod error;
mod extensions;

pub use error::GltfError;

use std::path::Path;

use ::gltf::accessor::Dimensions;
use ::gltf::material::AlphaMode;
use ::gltf::mesh::Mode;
use ::gltf::{Document, Gltf, Node, Primitive, Semantic};
use glam::{DMat4, DVec3};
use indexmap::IndexSet;

use self::buffers::Buffers;
use super::format::{self, FileReader};
use super::import::{Import, MeshCollector};
use super::{AssetError, Loaded, text};
use crate::components::Mesh;

/// A mesh from a glTF 2.0 file (`.gltf` or `.glb`): all nodes of the default scene.
///
/// A part is a material: it is called after it, `default` where there is none and `material_3`
/// where the material with index 3 has no name. Buffers may lie in the GLB file, in `data:` URIs
/// and in files beside it. Triangles, strips and fans are read; nodes that mirror keep their fronts
/// outside. Instances (`EXT_mesh_gpu_instancing`) are read, hidden nodes (`KHR_node_visibility`) left
/// out. Skins, morph targets, points and lines are left out with a warning; images are not read, and of
/// materials with transparency a warning says how much area they have.
///
/// # Errors
/// A file that cannot be read, is cut or of another format, JSON that is not lawful glTF 2.0, accessors or indices
/// that reach beyond their data, a mesh without area.
pub fn read_gltf(path: &Path, import: &Import) -> Result<Loaded<Mesh>, AssetError> {
    import.check(path)?;
    format::check(path, FileReader::Gltf)?;
    let bytes = text::read(path)?;
    let wrong = |problem| AssetError::Gltf { file: path.to_owned(), problem };
    let (Gltf { document, blob }, unread) = parse(&bytes).map_err(wrong)?;
    drop(bytes);
    let buffers = Buffers::load(&document, blob, path).map_err(wrong)?;
    let mut model = GltfImporter {
        import,
        buffers,
        mesh: MeshCollector::new(path),
        parts: IndexSet::new(),
        left_out: IndexSet::new(),
    };
    model.scene(&document)?;
    let names: Vec<String> = model.parts.into_iter().map(|(_, name)| name).collect();
    for what in model.left_out {
        model.mesh.warn(what);
    }
    for sentence in unread {
        model.mesh.warn(&sentence);
    }
    model.mesh.finish(&names, import)
}

/// The validated document, and sentences about what of it is not read.
fn parse(mut bytes: &[u8]) -> Result<(Gltf, Vec<String>), GltfError> {
    if bytes.starts_with(b"glTF") {
        let version = bytes.get(4..8).and_then(|field| field.try_into().ok());
        let version = version.map_or(2, u32::from_le_bytes);
        if version != 2 {
            return Err(GltfError::Version { found: version.to_string() });
        }
        // The crate takes the length of the header off this one without asking.
        let field = bytes.get(8..12).and_then(|field| field.try_into().ok());
        let claimed = field.map_or(0, u32::from_le_bytes) as usize;
        if claimed < 12 || claimed > bytes.len() {
            return Err(GltfError::Cut { claimed, found: bytes.len() });
        }
        bytes = &bytes[..claimed];
    }
    bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let parsed = Gltf::from_slice_without_validation(bytes);
    let Gltf { document, blob } = parsed.map_err(|error| match other_version(bytes) {
        Some(found) => GltfError::Version { found },
        None => GltfError::from_crate(error),
    })?;
    let mut json = document.into_json();
    if !is_two(&json.asset.version) {
        return Err(GltfError::Version { found: json.asset.version });
    }
    extensions::require_none(&mut json)?;
    let unread = extensions::unread(&json);
    // The crate's own check takes these indices for granted.
    let count = json.accessors.len();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    let mut attributes = primitives.flat_map(|primitive| primitive.attributes.values());
    if let Some(accessor) = attributes.find(|accessor| accessor.value() >= count) {
        return Err(GltfError::NoSuchAccessor { accessor: accessor.value(), count });
    }
    let document = Document::from_json(json).map_err(GltfError::from_crate)?;
    Ok((Gltf { document, blob }, unread))
}

fn is_two(version: &str) -> bool {
    version.split('.').next() == Some("2")
}

/// The version of a file that is glTF, but not 2.
fn other_version(json: &[u8]) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct Root {
        asset: Asset,
    }
    #[derive(serde::Deserialize)]
    struct Asset {
        version: String,
    }
    let Root { asset: Asset { version } } = serde_json::from_slice(json).ok()?;
    (!is_two(&version)).then_some(version)
}

struct GltfImporter<'a> {
    import: &'a Import,
    buffers: Buffers,
    mesh: MeshCollector,
    /// Index and name of each part's material.
    parts: IndexSet<(Option<usize>, String)>,
    left_out: IndexSet<&'static str>,
}

impl GltfImporter<'_> {
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
            if extensions::is_hidden(&node) {
                self.left_out.insert("hidden nodes (KHR_node_visibility) are left out");
                continue;
            }
            self.node(&node, document, scene_from_node)?;
            let first_child = open.len();
            open.extend(node.children().map(|child| (child, scene_from_node)));
            open[first_child..].reverse();
        }
        Ok(())
    }

    fn node(
        &mut self,
        node: &Node<'_>,
        document: &Document,
        scene_from_node: DMat4,
    ) -> Result<(), AssetError> {
        let Some(mesh) = node.mesh() else { return Ok(()) };
        if node.skin().is_some() {
            self.left_out.insert("skins are left out: skinned meshes stand as they were modelled");
        }
        let instances = extensions::instances(node, document, &self.buffers);
        let instances = instances.map_err(|problem| self.wrong(problem))?;
        let scene_from_mesh: Vec<DMat4> =
            instances.into_iter().map(|node_from_mesh| scene_from_node * node_from_mesh).collect();
        for primitive in mesh.primitives() {
            if primitive.morph_targets().next().is_some() {
                self.left_out.insert("morph targets are left out");
            }
            self.primitive(&primitive, &scene_from_mesh)?;
        }
        Ok(())
    }

    /// Adds a primitive wherever it stands.
    fn primitive(
        &mut self,
        primitive: &Primitive<'_>,
        scene_from_mesh: &[DMat4],
    ) -> Result<(), AssetError> {
        if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.left_out.insert("points and lines are left out");
            return Ok(());
        }
        let Some(accessor) = primitive.get(&Semantic::Positions) else {
            self.left_out.insert("primitives without positions are left out");
            return Ok(());
        };
        let positions = accessor::vectors(&accessor, &self.buffers).map_err(|e| self.wrong(e))?;
        self.mesh.reserve(positions.len().saturating_mul(scene_from_mesh.len()))?;
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
        let material = primitive.material().index();
        let part = self.parts.insert_full((material, part_name(primitive))).0 as u32;
        if let Some(how) = transparency(primitive) {
            self.mesh.transparent.insert(part, how);
        }
        let triangles = triangles(primitive.mode(), &indices);
        for transform in scene_from_mesh {
            let first = self.mesh.reserve(positions.len())?;
            for position in &positions {
                let vertex = self.import.point(transform.transform_point3((*position).into()));
                let added = self.mesh.add_vertex(vertex);
                added.map_err(|value| self.wrong(GltfError::TooFar { value }))?;
            }
            let mirrored = is_mirror(*transform);
            for &[a, b, c] in &triangles {
                let corners = if mirrored { [a, c, b] } else { [a, b, c] };
                self.mesh.add_triangle(corners.map(|corner| first + corner), part)?;
            }
        }
        Ok(())
    }
}

/// The words of the file that make a primitive transparent, if anything can be seen through it.
fn transparency(primitive: &Primitive<'_>) -> Option<String> {
    let material = primitive.material();
    let mode = match material.alpha_mode() {
        AlphaMode::Opaque => return None,
        AlphaMode::Mask => "MASK",
        AlphaMode::Blend => "BLEND",
    };
    let base = material.pbr_metallic_roughness();
    let factor = base.base_color_factor()[3];
    let has_texture = base.base_color_texture().is_some()
        || material.extension_value("KHR_materials_pbrSpecularGlossiness").is_some();
    let colors = primitive.get(&Semantic::Colors(0));
    let has_vertex_alpha = colors.is_some_and(|colors| colors.dimensions() == Dimensions::Vec4);
    if has_texture || has_vertex_alpha {
        return Some(format!("alphaMode {mode}"));
    }
    (factor < 1.0).then(|| format!("alphaMode {mode}, alpha {factor}"))
}

fn part_name(primitive: &Primitive<'_>) -> String {
    let material = primitive.material();
    match (material.name(), material.index()) {
        (Some(name), _) => name.to_owned(),
        (None, Some(index)) => format!("material_{index}"),
        (None, None) => "default".to_owned(),
    }
}

/// Returns whether a transform mirrors.
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
