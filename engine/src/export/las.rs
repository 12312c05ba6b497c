//! Points on the leaves of a scene as LAS 1.4, point format 7 (The American Society for Photogrammetry and Remote Sensing,
//! LAS Specification 1.4 - R15).

use std::fs::File;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use ::las::point::{Classification, Format};
use ::las::{Builder, Color, Header, Point, Transform, Vector, Vlr, Writer};
use glam::DVec3;
use rayon::prelude::*;

use super::contents::{ExportedScene, Pose};
use super::surface::{SampledSurface, area};
use super::{ExportError, ExportFormat, ExportSettings, Exported, put};
use crate::appearance::srgb;
use crate::components::{MaterialId, Mesh, MeshPart, PartMaterials, Scale};
use crate::counts::counted;
use crate::products::data_size;
use crate::sampling::Key;
use crate::terrain::Ground;

/// Resolution of coordinates, m.
const STEP: f64 = 0.001;

/// Bytes of a point of format 7.
const POINT_BYTES: u64 = 36;

/// Heights above the ground at which medium and high vegetation begin, m.
const MEDIUM_M: f64 = 0.5;
const HIGH_M: f64 = 2.0;

/// Instances whose points are drawn side by side.
const BLOCK: usize = 256;

/// Well-known text of coordinates without a known system: format 7 asks for one.
const LOCAL: &str = r#"LOCAL_CS["local frame",UNIT["metre",1.0],AXIS["x",EAST],AXIS["y",NORTH]]"#;

/// Kinds of surfaces in the user data of points.
const GROUND: u8 = 0;
const LEAF: u8 = 1;
const OTHER: u8 = 2;

/// Meaning of the fields of points, in the file itself.
const TEXT: &str = "classification: 2 ground, 3 vegetation up to 0.5 m above the ground, 4 up to 2 m, 5 above; \
    user data: 0 ground, 1 leaf, 2 other surfaces; point source: number of the material, from 0; \
    intensity: 65535 times the reflectance in visible light";

pub(super) fn write(
    scene: &ExportedScene<'_>,
    path: &Path,
    settings: &ExportSettings,
    written: &dyn Fn(f64),
) -> Result<Exported, ExportError> {
    let ground_parts = scene.ground_parts();
    let areas = areas(scene, &ground_parts, settings);
    let all: f64 = areas.iter().flatten().sum();
    if areas.iter().all(Vec::is_empty) || all <= 0.0 {
        return Err(ExportError::NoLeaves);
    }
    let points = (settings.points_per_m2 * all).round();
    if points * POINT_BYTES as f64 > settings.limit as f64 {
        return Err(ExportError::TooLarge {
            what: format!("{} on {all:.1} m²", counted(points as u64, "point")),
            size: data_size((points * POINT_BYTES as f64) as u64),
            limit: data_size(settings.limit),
            help: "lower `--points-per-m2`, or raise `--limit`",
        });
    }
    let header = header(scene, settings.format).map_err(|error| failed(path, error))?;
    put(path, |file| {
        let error = Arc::new(Mutex::new(None));
        let out = BufWriter::with_capacity(1 << 20, file.try_clone()?);
        let out = GuardedWriter { file: out, error: Arc::clone(&error) };
        let mut writer = Writer::new(out, header).map_err(io::Error::other)?;
        put_points(scene, &ground_parts, &areas, settings, written, &mut writer)
            .map_err(io::Error::other)?;
        writer.close().map_err(io::Error::other)?;
        writer.into_inner().map_err(io::Error::other)?.flush()?;
        let kept = error.lock().unwrap_or_else(PoisonError::into_inner).take();
        kept.map_or(Ok(()), Err)
    })?;
    let mut contents = vec![format!(
        "{} on {all:.2} m² of surface, counted on one side",
        counted(points as u64, "point")
    )];
    if scene.terrain.projection.as_ref().and_then(|one| one.wkt.as_ref()).is_none() {
        contents.push("no coordinate reference system: its text is not known".to_owned());
    }
    contents.extend(scene.told_tile());
    Ok(Exported { files: vec![path.to_owned()], contents })
}

fn failed(path: &Path, error: ::las::Error) -> ExportError {
    ExportError::Las { path: path.to_owned(), source: Box::new(error) }
}

/// Parts of a mesh that points are drawn on, with their materials.
fn sampled_parts<'p>(
    parts: &'p [MeshPart],
    materials: &'p PartMaterials,
    scene: &'p ExportedScene<'_>,
    settings: &ExportSettings,
) -> impl Iterator<Item = (&'p MeshPart, MaterialId)> + use<'p> {
    let has_all = settings.has_all_surfaces;
    let pairs = parts.iter().zip(materials.0.iter().copied());
    pairs.filter(move |(_, material)| has_all || scene.colours[material.0 as usize].is_leaf)
}

/// Areas of the sampled parts of the ground, and of each instance in document order, m².
fn areas(
    scene: &ExportedScene<'_>,
    ground_parts: &[MeshPart],
    settings: &ExportSettings,
) -> Vec<Vec<f64>> {
    let terrain = &*scene.terrain;
    let pose = Pose::of_ground(terrain);
    let ground = sampled_parts(ground_parts, &terrain.materials, scene, settings)
        .map(|(part, _)| area(&terrain.mesh, part, &pose));
    let ground: Vec<f64> = ground.collect();
    let of_mesh = scene.meshes.iter().map(|placed| {
        let parts = sampled_parts(&placed.mesh.parts, &placed.materials, scene, settings);
        parts.map(|(part, _)| placed.mesh.part_area(part)).collect::<Vec<f64>>()
    });
    let of_mesh: Vec<Vec<f64>> = of_mesh.collect();
    let instances = scene.instances.iter().collect::<Vec<_>>();
    let of_instances = instances.into_par_iter().map(|one| {
        let index = scene.mesh_index(one.placement.prototype.0);
        let scale = one.placement.scale;
        if is_similar(scale) {
            let factor = f64::from(scale.horizontal).powi(2);
            return of_mesh[index].iter().map(|area| area * factor).collect();
        }
        let (placed, pose) = (&scene.meshes[index], Pose::of_instance(one));
        let parts = sampled_parts(&placed.mesh.parts, &placed.materials, scene, settings);
        parts.map(|(part, _)| area(&placed.mesh, part, &pose)).collect()
    });
    std::iter::once(ground).chain(of_instances.collect::<Vec<Vec<f64>>>()).collect()
}

/// Returns whether an instance is similar to its mesh, so that all areas grow by the same factor.
fn is_similar(scale: Scale) -> bool {
    scale.horizontal.to_bits() == scale.vertical.to_bits()
}

fn header(scene: &ExportedScene<'_>, format: ExportFormat) -> Result<Header, ::las::Error> {
    let mut builder = Builder::from((1, 4));
    builder.point_format = Format::new(7)?;
    builder.point_format.is_compressed = format == ExportFormat::Laz;
    builder.generating_software = format!("sunfleck {}", env!("CARGO_PKG_VERSION"));
    "sunfleck".clone_into(&mut builder.system_identifier);
    builder.has_wkt_crs = true;
    let corner = scene.origin + scene.terrain.corner.extend(0.0);
    let transform = |offset: f64| Transform { scale: STEP, offset: offset.floor() };
    builder.transforms =
        Vector { x: transform(corner.x), y: transform(corner.y), z: transform(corner.z) };
    let wkt = scene.terrain.projection.as_ref().and_then(|one| one.wkt.clone());
    let mut text = wkt.unwrap_or_else(|| LOCAL.to_owned()).into_bytes();
    text.push(0);
    let record = |user_id: &str, record_id, description: &str, data| Vlr {
        user_id: user_id.to_owned(),
        record_id,
        description: description.to_owned(),
        data,
    };
    let materials = scene.colours.iter().enumerate();
    let about: Vec<String> = std::iter::once(TEXT.to_owned())
        .chain(scene.provenance.iter().map(|(key, value)| format!("{key}: {value}")))
        .chain(materials.map(|(number, material)| format!("material {number}: {}", material.name)))
        .collect();
    // Records hold less than 64 KiB.
    let mut about = about.join("; ").into_bytes();
    about.truncate(60_000);
    builder.vlrs = vec![
        record("LASF_Projection", 2112, "OGC coordinate system WKT", text),
        record("LASF_Spec", 3, "fields and provenance", about),
    ];
    builder.into_header()
}

/// Points of parts of a mesh in the world.
struct SurfacePoints<'a> {
    mesh: &'a Mesh,
    parts: Vec<(&'a MeshPart, MaterialId)>,
    /// Faces of the parts by area, if all areas have the same ratio as in the mesh.
    faces: Option<&'a [SampledSurface<'a>]>,
    pose: Pose,
    is_ground: bool,
    /// Stream of random numbers.
    stream: Key,
}

/// Number of points of each part in turn: their sum so far is the rounded product of density and area so far.
#[derive(Debug, Default)]
struct PointCounts {
    area: f64,
    points: u64,
}

impl PointCounts {
    fn next(&mut self, area: f64, density: f64) -> u64 {
        self.area += area;
        let all = (self.area * density).round() as u64;
        all - std::mem::replace(&mut self.points, all).min(all)
    }
}

/// Writes all points: those of the ground, then those of each instance in document order.
fn put_points(
    scene: &ExportedScene<'_>,
    ground_parts: &[MeshPart],
    areas: &[Vec<f64>],
    settings: &ExportSettings,
    written: &dyn Fn(f64),
    writer: &mut Writer<GuardedWriter>,
) -> Result<(), ::las::Error> {
    let terrain = &*scene.terrain;
    let height = Ground::of(terrain);
    let stream = Key::new(scene.seed).path("export");
    let mut counts = PointCounts::default();
    // Most instances are similar to their mesh, and have the same shares of its area on its faces.
    let mut similar: Vec<Vec<SampledSurface<'_>>> = Vec::new();
    for placed in &scene.meshes {
        let parts = sampled_parts(&placed.mesh.parts, &placed.materials, scene, settings);
        let faces = parts.map(|(part, _)| SampledSurface::new(&placed.mesh, part, &Pose::IDENTITY));
        similar.push(faces.collect());
    }
    let surface = |index: usize| {
        let Some(one) = index.checked_sub(1).map(|placed| &scene.instances[placed]) else {
            let parts = sampled_parts(ground_parts, &terrain.materials, scene, settings).collect();
            let pose = Pose::of_ground(terrain);
            return SurfacePoints {
                mesh: &terrain.mesh,
                parts,
                faces: None,
                pose,
                is_ground: true,
                stream: stream.path("ground"),
            };
        };
        let mesh = scene.mesh_index(one.placement.prototype.0);
        let placed = &scene.meshes[mesh];
        let parts = sampled_parts(&placed.mesh.parts, &placed.materials, scene, settings).collect();
        let (pose, stream) = (Pose::of_instance(one), stream.index(one.id.0.into()));
        let faces = is_similar(one.placement.scale).then_some(&similar[mesh][..]);
        SurfacePoints { mesh: &placed.mesh, parts, faces, pose, is_ground: false, stream }
    };
    for first in (0..areas.len()).step_by(BLOCK) {
        written(first as f64 / areas.len() as f64);
        let mut block = Vec::new();
        for (index, areas) in areas.iter().enumerate().skip(first).take(BLOCK) {
            let counts: Vec<u64> =
                areas.iter().map(|area| counts.next(*area, settings.points_per_m2)).collect();
            block.push((index, counts));
        }
        let points: Vec<Vec<Point>> = block
            .par_iter()
            .map(|(index, counts)| points(&surface(*index), counts, scene, &height))
            .collect();
        points.into_iter().flatten().try_for_each(|point| writer.write_point(point))?;
    }
    Ok(())
}

/// Points of a mesh, so many on each of its parts.
fn points(
    surface: &SurfacePoints<'_>,
    counts: &[u64],
    scene: &ExportedScene<'_>,
    ground: &Ground,
) -> Vec<Point> {
    let mut points = Vec::new();
    for (number, ((part, material), &count)) in surface.parts.iter().zip(counts).enumerate() {
        if count == 0 {
            continue;
        }
        let colour = &scene.colours[material.0 as usize];
        let [red, green, blue] = srgb(colour.front).map(|channel| u16::from(channel) * 257);
        let [r, g, b] = colour.front;
        let kind = match (surface.is_ground, colour.is_leaf) {
            (true, _) => GROUND,
            (false, true) => LEAF,
            (false, false) => OTHER,
        };
        let own;
        let faces = if let Some(faces) = surface.faces {
            &faces[number]
        } else {
            own = SampledSurface::new(surface.mesh, part, &surface.pose);
            &own
        };
        let stream = surface.stream.index(number as u64);
        points.extend(faces.points(count, &surface.pose, stream).map(|at| {
            let DVec3 { x, y, z } = at + scene.origin;
            Point {
                x,
                y,
                z,
                intensity: (65535.0 * (r + g + b) / 3.0).clamp(0.0, 65535.0) as u16,
                return_number: 1,
                number_of_returns: 1,
                classification: class(at, surface.is_ground, ground),
                user_data: kind,
                point_source_id: material.0 as u16,
                gps_time: Some(0.0),
                color: Some(Color { red, green, blue }),
                ..Point::default()
            }
        }));
    }
    points
}

fn class(at: DVec3, is_ground: bool, ground: &Ground) -> Classification {
    let above = ground.height(at.truncate()).map_or(f64::INFINITY, |height| at.z - height);
    match above {
        _ if is_ground => Classification::Ground,
        above if above < MEDIUM_M => Classification::LowVegetation,
        above if above < HIGH_M => Classification::MediumVegetation,
        _ => Classification::HighVegetation,
    }
}

/// File that remembers its first error and takes all that comes after it: `Writer` panics if it cannot end a file.
#[derive(Debug)]
struct GuardedWriter {
    file: BufWriter<File>,
    error: Arc<Mutex<Option<io::Error>>>,
}

impl GuardedWriter {
    fn guard<T>(&self, result: io::Result<T>, otherwise: T) -> T {
        result.unwrap_or_else(|error| {
            let mut kept = self.error.lock().unwrap_or_else(PoisonError::into_inner);
            kept.get_or_insert(error);
            otherwise
        })
    }
}

impl Write for GuardedWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes);
        Ok(self.guard(written, bytes.len()))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.guard(flushed, ());
        Ok(())
    }
}

impl Seek for GuardedWriter {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        let found = self.file.seek(position);
        Ok(self.guard(found, 0))
    }
}
