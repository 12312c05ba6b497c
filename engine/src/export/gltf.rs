//! Scenes as glTF 2.0: each mesh once, and its instances by `EXT_mesh_gpu_instancing` or as a node each.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::ops::Range;
use std::path::Path;

use glam::{DQuat, DVec3, Vec3};
use serde_json::{Value, json};

use super::buffer::BinaryBuffer;
use super::contents::{ExportedScene, PlacedMesh, Pose, indices, polygon};
use super::{ExportError, ExportFormat, ExportSettings, Exported, put};
use crate::components::{Mesh, MeshPart, Placement};
use crate::counts::counted;
use crate::output::OutputError;
use crate::products::data_size;

/// Extension by which a node has many instances.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Length of the JSON of a node, bytes.
const NODE_BYTES: u64 = 190;

/// JSON of a file, and the binary part that it refers to.
struct GltfFile {
    buffer: BinaryBuffer,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    materials: Vec<Value>,
    /// Number of each material that is written, by its id.
    material_numbers: BTreeMap<u32, usize>,
    disc_sides: u32,
}

pub(super) fn write(
    scene: &ExportedScene<'_>,
    path: &Path,
    settings: &ExportSettings,
) -> Result<Exported, ExportError> {
    let nodes = if settings.is_flat { NODE_BYTES * scene.instances.len() as u64 } else { 0 };
    let size = buffer_bytes(scene, settings) + nodes;
    // Lengths in a binary file have 32 bits.
    let limit = settings.limit.min(u32::MAX.into());
    if size > limit {
        let what = format!(
            "{} and {}",
            counted(scene.meshes.len(), "mesh"),
            counted(scene.instances.len(), "instance")
        );
        let help = if nodes > limit / 2 {
            "leave out `--flat`, so that instances take 40 bytes each"
        } else {
            "leave instances out by `hide`, or take fewer `--disc-sides`"
        };
        let (size, limit) = (data_size(size), data_size(limit));
        return Err(ExportError::TooLarge { what, size, limit, help });
    }
    let mut file = built(scene, settings).map_err(|source| unwritten(path, source))?;
    let bin = path.with_extension("bin");
    let name = bin.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let is_binary = settings.format == ExportFormat::Glb;
    let document = document(&mut file, scene, settings, (!is_binary).then_some(name));
    let length = file.buffer.length();
    let mut data = file.buffer.into_file().map_err(|source| unwritten(path, source))?;
    let mut files = vec![path.to_owned()];
    if is_binary {
        put(path, |out| write_binary(&document, length, &mut data, out))?;
    } else {
        put(&bin, |out| io::copy(&mut data, out).map(drop))?;
        put(path, |out| {
            serde_json::to_writer(io::BufWriter::new(out), &document).map_err(io::Error::other)
        })?;
        files.push(bin);
    }
    Ok(Exported { files, contents: contents(scene, settings) })
}

fn unwritten(path: &Path, source: io::Error) -> ExportError {
    OutputError::Write { path: path.to_owned(), source }.into()
}

fn contents(scene: &ExportedScene<'_>, settings: &ExportSettings) -> Vec<String> {
    let instances = scene.instances.len();
    let mut contents = vec![format!(
        "{}, {}, {} in all",
        counted(scene.meshes.len(), "mesh"),
        counted(instances, "instance"),
        counted(scene.triangles(settings.disc_sides), "triangle")
    )];
    if instances > 0 && !settings.is_flat {
        contents.push(format!(
            "needs {INSTANCING}, which three.js and Babylon.js read; `--flat` writes a node per instance for other programs"
        ));
    }
    if scene.meshes.iter().any(|placed| !placed.mesh.discs.is_empty()) {
        contents
            .push(format!("discs as polygons of {} sides with the same area", settings.disc_sides));
    }
    contents.extend(scene.told_tile());
    contents
}

/// Upper bound of the length of the binary part, bytes.
fn buffer_bytes(scene: &ExportedScene<'_>, settings: &ExportSettings) -> u64 {
    let sides = u64::from(settings.disc_sides);
    let of_mesh = |mesh: &Mesh| {
        24 * mesh.triangles.len() as u64
            + 12 * mesh.vertices.len() as u64
            + (12 * sides + 12 * (sides - 2)) * mesh.discs.len() as u64
    };
    let meshes: u64 = scene.meshes.iter().map(|placed| of_mesh(&placed.mesh)).sum();
    let instances = if settings.is_flat { 0 } else { 40 * scene.instances.len() as u64 };
    meshes + of_mesh(&scene.terrain.mesh) + instances
}

fn built(scene: &ExportedScene<'_>, settings: &ExportSettings) -> io::Result<GltfFile> {
    let mut file = GltfFile {
        buffer: BinaryBuffer::new()?,
        meshes: Vec::new(),
        nodes: vec![Value::Null],
        materials: Vec::new(),
        material_numbers: BTreeMap::new(),
        disc_sides: settings.disc_sides,
    };
    file.add_ground(scene)?;
    let mut of_meshes: Vec<Vec<u32>> = vec![Vec::new(); scene.meshes.len()];
    for (index, one) in scene.instances.iter().enumerate() {
        of_meshes[scene.mesh_index(one.placement.prototype.0)].push(index as u32);
    }
    for (placed, numbers) in scene.meshes.iter().zip(&of_meshes) {
        let mesh = file.add_mesh(placed, scene)?;
        let instances = numbers.iter().map(|&one| &scene.instances[one as usize].placement);
        let Some(mesh) = mesh else { continue };
        if settings.is_flat {
            file.add_nodes(mesh, instances, scene.anchor);
        } else {
            file.add_instances(mesh, &placed.name, instances, scene.anchor)?;
        }
    }
    Ok(file)
}

/// Translation, rotation and scale of an instance, z up.
fn trs(placement: &Placement, anchor: DVec3) -> ([f32; 3], [f32; 4], [f32; 3]) {
    let scale = placement.scale;
    let turn = placement.world_from_object()
        * glam::DMat3::from_diagonal(
            DVec3::new(scale.horizontal.into(), scale.horizontal.into(), scale.vertical.into())
                .recip(),
        );
    let rotation = DQuat::from_mat3(&turn).normalize().as_quat();
    let place = (placement.position - anchor).as_vec3();
    (place.to_array(), rotation.to_array(), [scale.horizontal, scale.horizontal, scale.vertical])
}

impl GltfFile {
    /// Adds a material; returns its number in the file.
    fn material(&mut self, id: u32, scene: &ExportedScene<'_>) -> usize {
        let Self { materials, material_numbers, .. } = self;
        *material_numbers.entry(id).or_insert_with(|| {
            let colour = &scene.colours[id as usize];
            let [r, g, b] = colour.front;
            materials.push(json!({
                "name": colour.name,
                "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 },
                "doubleSided": true,
                "extras": {
                    "is_leaf": colour.is_leaf,
                    "back": colour.back,
                    "transmitted": colour.transmitted,
                    "colour_from": format!("{:?}", colour.source),
                },
            }));
            materials.len() - 1
        })
    }

    fn add_ground(&mut self, scene: &ExportedScene<'_>) -> io::Result<()> {
        let terrain = &scene.terrain;
        // Its mesh is in units of its extent: corners are written in metres from its origin.
        let pose = Pose { origin: DVec3::ZERO, ..Pose::of_ground(terrain) };
        let parts = scene.ground_parts();
        let place = |corner: Vec3| pose.apply(corner.as_dvec3()).as_vec3();
        let mut primitives = Vec::new();
        for (part, material) in parts.iter().zip(&terrain.materials.0) {
            let number = self.material(material.0, scene);
            primitives.extend(self.primitive(&terrain.mesh, part, number, place)?);
        }
        if primitives.is_empty() {
            return Ok(());
        }
        self.meshes.push(json!({ "name": "terrain", "primitives": primitives }));
        let translation = (terrain.origin() - scene.anchor).as_vec3().to_array();
        self.nodes.push(
            json!({ "name": "terrain", "mesh": self.meshes.len() - 1, "translation": translation }),
        );
        Ok(())
    }

    /// Adds a mesh; returns its number, if it has any triangle or disc.
    fn add_mesh(
        &mut self,
        placed: &PlacedMesh<'_>,
        scene: &ExportedScene<'_>,
    ) -> io::Result<Option<usize>> {
        let mut primitives = Vec::new();
        for (part, material) in placed.mesh.parts.iter().zip(&placed.materials.0) {
            let number = self.material(material.0, scene);
            primitives.extend(self.primitive(&placed.mesh, part, number, |corner| corner)?);
        }
        if primitives.is_empty() {
            return Ok(None);
        }
        self.meshes.push(json!({ "name": placed.name, "primitives": primitives }));
        Ok(Some(self.meshes.len() - 1))
    }

    /// Adds the triangles and discs of a part.
    fn primitive(
        &mut self,
        mesh: &Mesh,
        part: &MeshPart,
        material: usize,
        place: impl Fn(Vec3) -> Vec3,
    ) -> io::Result<Option<Value>> {
        let (mut corners, mut triangles) = part_triangles(mesh, &part.triangles, place);
        for disc in &mesh.discs[indices(&part.discs)] {
            let first = corners.len() as u32;
            corners
                .extend(polygon(disc, self.disc_sides).map(|corner| corner.as_vec3().to_array()));
            triangles.extend(
                (1..self.disc_sides - 1).map(|next| [first, first + next, first + next + 1]),
            );
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let position = self.buffer.add_corners(&corners)?;
        let indices = self.buffer.add_triangles(&triangles)?;
        Ok(Some(
            json!({ "attributes": { "POSITION": position }, "indices": indices, "material": material, "mode": 4 }),
        ))
    }

    fn add_instances<'a>(
        &mut self,
        mesh: usize,
        name: &str,
        instances: impl Iterator<Item = &'a Placement>,
        anchor: DVec3,
    ) -> io::Result<()> {
        let (mut places, mut turns, mut scales) = (Vec::new(), Vec::new(), Vec::new());
        for placement in instances {
            let (place, turn, scale) = trs(placement, anchor);
            places.push(place);
            turns.push(turn);
            scales.push(scale);
        }
        let attributes = json!({
            "TRANSLATION": self.buffer.add_attribute(&places)?,
            "ROTATION": self.buffer.add_attribute(&turns)?,
            "SCALE": self.buffer.add_attribute(&scales)?,
        });
        self.nodes.push(json!({
            "name": name, "mesh": mesh, "extensions": { INSTANCING: { "attributes": attributes } },
        }));
        Ok(())
    }

    fn add_nodes<'a>(
        &mut self,
        mesh: usize,
        instances: impl Iterator<Item = &'a Placement>,
        anchor: DVec3,
    ) {
        for placement in instances {
            let (translation, rotation, scale) = trs(placement, anchor);
            self.nodes.push(json!({
                "mesh": mesh, "translation": translation, "rotation": rotation, "scale": scale,
            }));
        }
    }
}

/// Corners of some triangles of a mesh, each once, and their numbers.
fn part_triangles(
    mesh: &Mesh,
    range: &Range<u32>,
    place: impl Fn(Vec3) -> Vec3,
) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let mut numbers = vec![u32::MAX; mesh.vertices.len()];
    let mut corners = Vec::new();
    let mut number = |vertex: u32| {
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = corners.len() as u32;
            corners.push(place(mesh.vertices[vertex as usize]).to_array());
        }
        *number
    };
    let triangles = mesh.triangles[indices(range)].iter().map(|triangle| triangle.map(&mut number));
    let triangles = triangles.collect();
    (corners, triangles)
}

/// JSON of the whole file; `uri` is the name of the binary file, if there is one.
fn document(
    file: &mut GltfFile,
    scene: &ExportedScene<'_>,
    settings: &ExportSettings,
    uri: Option<String>,
) -> Value {
    let mut nodes = std::mem::take(&mut file.nodes);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let DVec3 { x, y, z } = scene.anchor;
    let projection = scene.terrain.projection.as_ref();
    nodes[0] = json!({
        "name": "scene, z up",
        "children": (1..nodes.len()).collect::<Vec<_>>(),
        // A quarter turn about x makes z up that of glTF, y.
        "rotation": [-half, 0.0, 0.0, half],
        "translation": [x, z, -y],
        "extras": {
            "origin_m": scene.origin.to_array(),
            "crs": projection.and_then(|one| one.epsg).map(|code| format!("EPSG:{code}")),
        },
    });
    let has_instances = !settings.is_flat && !scene.instances.is_empty();
    let provenance: serde_json::Map<String, Value> = scene
        .provenance
        .iter()
        .map(|(key, value)| ((*key).to_owned(), value.clone().into()))
        .collect();
    let mut buffer = json!({ "byteLength": file.buffer.length() });
    if let Some(uri) = uri {
        buffer["uri"] = uri.into();
    }
    let mut document = json!({
        "asset": {
            "version": "2.0",
            "generator": format!("sunfleck {}", env!("CARGO_PKG_VERSION")),
            "extras": provenance,
        },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": nodes,
    });
    // glTF has no empty lists.
    let lists = [
        ("meshes", std::mem::take(&mut file.meshes)),
        ("materials", std::mem::take(&mut file.materials)),
        ("accessors", std::mem::take(&mut file.buffer.accessors)),
        ("bufferViews", std::mem::take(&mut file.buffer.views)),
    ];
    for (name, list) in lists {
        if !list.is_empty() {
            document[name] = list.into();
        }
    }
    if file.buffer.length() > 0 {
        document["buffers"] = json!([buffer]);
    }
    if has_instances {
        // Without the extension, each mesh would stand at the origin once.
        document["extensionsUsed"] = json!([INSTANCING]);
        document["extensionsRequired"] = json!([INSTANCING]);
    }
    document
}

/// Writes a binary glTF: a header, and two chunks.
fn write_binary(
    document: &Value,
    length: u64,
    data: &mut impl io::Read,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut text = serde_json::to_vec(document).map_err(io::Error::other)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let word = |value: u64| u32::try_from(value).map(u32::to_le_bytes).map_err(io::Error::other);
    let chunks = 8 + text.len() as u64 + if length > 0 { 8 + length } else { 0 };
    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&word(12 + chunks)?)?;
    out.write_all(&word(text.len() as u64)?)?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    if length > 0 {
        out.write_all(&word(length)?)?;
        out.write_all(b"BIN\0")?;
        io::copy(data, out)?;
    }
    Ok(())
}
