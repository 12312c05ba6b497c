//! All triangles of a scene as binary PLY (Turk 1994, "The PLY Polygon File Format"), with normals, colours and materials.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use glam::DVec3;
use rayon::prelude::*;

use super::contents::{ExportedScene, Pose, indices, polygon};
use super::{ExportError, ExportSettings, Exported, put};
use crate::appearance::srgb;
use crate::components::{Instance, Mesh, MeshPart, PartMaterials};
use crate::counts::counted;
use crate::products::data_size;

/// Bytes of a corner: place, normal, colour; and of a face: number of corners, their numbers, its material.
const CORNER_BYTES: u64 = 12 + 12 + 3;
const FACE_BYTES: u64 = 1 + 12 + 4;

/// Instances whose corners are made side by side.
const BLOCK: usize = 64;

pub(super) fn write(
    scene: &ExportedScene<'_>,
    path: &Path,
    settings: &ExportSettings,
    written: &dyn Fn(f64),
) -> Result<Exported, ExportError> {
    let sides = settings.disc_sides;
    let triangles = scene.triangles(sides);
    let size = triangles * (3 * CORNER_BYTES + FACE_BYTES);
    if size > settings.limit || 3 * triangles > i32::MAX as u64 {
        return Err(ExportError::TooLarge {
            what: format!(
                "{}, those of each instance written out,",
                counted(triangles, "triangle")
            ),
            size: data_size(size),
            limit: data_size(
                settings.limit.min(i32::MAX as u64 / 3 * (3 * CORNER_BYTES + FACE_BYTES)),
            ),
            help: "take `--format glb`, which holds each mesh once, or leave instances out by `hide`",
        });
    }
    put(path, |file| {
        let mut out = BufWriter::with_capacity(1 << 20, file);
        header(scene, triangles, &mut out)?;
        let ground = ground(scene);
        out.write_all(&corners(&ground, scene, sides))?;
        // Corners take most of the time, as they take most of the file.
        let part_of_corners = (3 * CORNER_BYTES) as f64 / (3 * CORNER_BYTES + FACE_BYTES) as f64;
        let part_of_faces = 1.0 - part_of_corners;
        let part = |number: usize| number as f64 / scene.instances.len() as f64;
        for (number, block) in scene.instances.chunks(BLOCK).enumerate() {
            written(part_of_corners * part(number * BLOCK));
            let bytes: Vec<Vec<u8>> =
                block.par_iter().map(|one| corners(&shape(one, scene), scene, sides)).collect();
            bytes.iter().try_for_each(|bytes| out.write_all(bytes))?;
        }
        let mut next = 0;
        faces(&ground, sides, &mut next, &mut out)?;
        for (number, one) in scene.instances.iter().enumerate() {
            if number % BLOCK == 0 {
                written(part_of_corners + part_of_faces * part(number));
            }
            faces(&shape(one, scene), sides, &mut next, &mut out)?;
        }
        out.flush()
    })?;
    let mut contents = vec![format!("{}, {}", counted(triangles, "triangle"), data_size(size))];
    contents.extend(scene.told_tile());
    Ok(Exported { files: vec![path.to_owned()], contents })
}

fn header(scene: &ExportedScene<'_>, triangles: u64, out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    for (key, value) in &scene.provenance {
        writeln!(out, "comment {key}: {value}")?;
    }
    let DVec3 { x, y, z } = scene.origin + scene.anchor;
    writeln!(out, "comment origin_m: {x:?} {y:?} {z:?} is what coordinates count from")?;
    for (number, material) in scene.colours.iter().enumerate() {
        let name = material.name.split_whitespace().collect::<Vec<_>>().join(" ");
        writeln!(out, "comment material {number}: {name}")?;
    }
    writeln!(out, "element vertex {}", 3 * triangles)?;
    for name in ["x", "y", "z", "nx", "ny", "nz"] {
        writeln!(out, "property float {name}")?;
    }
    for name in ["red", "green", "blue"] {
        writeln!(out, "property uchar {name}")?;
    }
    writeln!(out, "element face {triangles}\nproperty list uchar int vertex_indices")?;
    writeln!(out, "property int material\nend_header")
}

/// A mesh in the world.
struct PlacedShape<'a> {
    mesh: &'a Mesh,
    parts: Vec<MeshPart>,
    materials: &'a PartMaterials,
    pose: Pose,
}

fn ground<'a>(scene: &'a ExportedScene<'_>) -> PlacedShape<'a> {
    PlacedShape {
        mesh: &scene.terrain.mesh,
        parts: scene.ground_parts(),
        materials: &scene.terrain.materials,
        pose: Pose::of_ground(&scene.terrain),
    }
}

fn shape<'a>(instance: &Instance, scene: &'a ExportedScene<'_>) -> PlacedShape<'a> {
    let placed = &scene.meshes[scene.mesh_index(instance.placement.prototype.0)];
    PlacedShape {
        mesh: &placed.mesh,
        parts: placed.mesh.parts.clone(),
        materials: &placed.materials,
        pose: Pose::of_instance(instance),
    }
}

/// Bytes of all corners of a mesh, three per triangle.
fn corners(shape: &PlacedShape<'_>, scene: &ExportedScene<'_>, sides: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let place = |corner: DVec3| shape.pose.apply(corner) - scene.anchor;
    let mut add = |corners: [DVec3; 3], colour: [u8; 3]| {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Z).as_vec3().to_array();
        for corner in corners {
            bytes.extend(corner.as_vec3().to_array().map(f32::to_le_bytes).as_flattened());
            bytes.extend(normal.map(f32::to_le_bytes).as_flattened());
            bytes.extend(colour);
        }
    };
    for (part, material) in shape.parts.iter().zip(&shape.materials.0) {
        let colour = srgb(scene.colours[material.0 as usize].front);
        for triangle in indices(&part.triangles) {
            add(shape.mesh.corners(triangle).map(|corner| place(corner.as_dvec3())), colour);
        }
        for disc in &shape.mesh.discs[indices(&part.discs)] {
            let ring: Vec<DVec3> = polygon(disc, sides).map(place).collect();
            for next in 1..ring.len() - 1 {
                add([ring[0], ring[next], ring[next + 1]], colour);
            }
        }
    }
    bytes
}

/// Writes the faces of a mesh, whose first corner has the number `next`.
fn faces(
    shape: &PlacedShape<'_>,
    sides: u32,
    next: &mut i32,
    out: &mut impl Write,
) -> io::Result<()> {
    for (part, material) in shape.parts.iter().zip(&shape.materials.0) {
        let of_discs = part.discs.len() * (sides as usize - 2);
        let material = (material.0 as i32).to_le_bytes();
        for _ in 0..part.triangles.len() + of_discs {
            out.write_all(&[3])?;
            out.write_all([*next, *next + 1, *next + 2].map(i32::to_le_bytes).as_flattened())?;
            out.write_all(&material)?;
            *next += 3;
        }
    }
    Ok(())
}
