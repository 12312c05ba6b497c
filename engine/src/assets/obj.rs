//! Wavefront OBJ: vertices, faces, groups and material names; the rest of the format is left out.

use std::path::Path;

use glam::DVec3;
use indexmap::{IndexMap, IndexSet};

use super::error::excerpt;
use super::import::{Collector, Import};
use super::polygon::triangulate;
use super::text::{Lines, number};
use super::{AssetError, Loaded};
use crate::components::Mesh;

/// Most corners of a face: cutting a concave polygon takes the square of them.
const MOST_CORNERS: usize = 2048;

/// Most unknown keywords to speak of.
const MOST_UNKNOWN: usize = 5;

/// Keywords that say nothing about the shape, or nothing that light can meet.
const IGNORED: [&str; 15] = [
    "vt",
    "vn",
    "vp",
    "s",
    "mtllib",
    "l",
    "p",
    "lod",
    "bevel",
    "c_interp",
    "d_interp",
    "usemap",
    "maplib",
    "shadow_obj",
    "trace_obj",
];

/// A mesh from a Wavefront OBJ file.
///
/// A part is a group (`g` or `o`, the later one counts) and within it a material (`usemtl`). It is
/// called after its group if the group has one material or the material has the same name, else
/// `group/material`; without a group after its material; without both `default`. Polygons, concave
/// ones too, are cut into triangles; triangles without area are dropped with a warning.
///
/// Coordinates are read and moved in f64, so `Origin::BaseCenter` loses nothing of a model that
/// stands at map coordinates.
///
/// # Errors
/// A file that cannot be read, is not text, has a malformed vertex or face, or no face with an area.
pub fn read_obj(path: &Path, import: &Import) -> Result<Loaded<Mesh>, AssetError> {
    import.check(path)?;
    let mut lines = Lines::open(path)?;
    let mut model = Model::new(path, import);
    let mut joined = String::new();
    while let Some((number, line)) = lines.next()? {
        if line.ends_with('\\') {
            joined.clear();
            joined.push_str(line);
            while joined.ends_with('\\') {
                joined.pop();
                joined.push_str(lines.continuation()?);
            }
            model.statement(number, &joined)?;
        } else {
            model.statement(number, line)?;
        }
    }
    model.finish()
}

/// A face that names vertices further down the file.
struct Deferred {
    line: usize,
    part: u32,
    corners: Vec<i64>,
}

/// What was read so far.
struct Model<'a> {
    import: &'a Import,
    mesh: Collector,
    /// (group, material) of each part, in first-appearance order; an empty name is none.
    parts: IndexSet<(String, String)>,
    group: String,
    material: String,
    /// Part of the next face; `None` after a change of group or material.
    part: Option<u32>,
    deferred: Vec<Deferred>,
    /// First line of each unknown keyword.
    unknown: IndexMap<String, usize>,
    // Kept from face to face, for their memory.
    corners: Vec<i64>,
    polygon: Vec<u32>,
    points: Vec<DVec3>,
    pieces: Vec<[usize; 3]>,
}

impl<'a> Model<'a> {
    fn new(path: &Path, import: &'a Import) -> Self {
        Self {
            import,
            mesh: Collector::new(path),
            parts: IndexSet::new(),
            group: String::new(),
            material: String::new(),
            part: None,
            deferred: Vec::new(),
            unknown: IndexMap::new(),
            corners: Vec::new(),
            polygon: Vec::new(),
            points: Vec::new(),
            pieces: Vec::new(),
        }
    }

    fn statement(&mut self, line: usize, text: &str) -> Result<(), AssetError> {
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        match keyword {
            "v" => self.vertex(line, rest)?,
            "f" | "fo" => self.face(line, rest)?,
            "g" | "o" => {
                self.group = words(rest);
                self.part = None;
            }
            "usemtl" => {
                self.material = words(rest);
                self.part = None;
            }
            _ if IGNORED.contains(&keyword) => {}
            _ if self.unknown.len() < MOST_UNKNOWN => {
                self.unknown.entry(excerpt(keyword)).or_insert(line);
            }
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, line: usize, rest: &str) -> Result<(), AssetError> {
        let mut coordinates = [0.0; 3];
        let mut texts = rest.split_ascii_whitespace();
        for (found, coordinate) in coordinates.iter_mut().enumerate() {
            let Some(text) = texts.next() else {
                return Err(AssetError::ShortVertex { file: self.mesh.file.clone(), line, found });
            };
            *coordinate = number(text, "a coordinate", &self.mesh.file, line)?;
        }
        self.mesh.reserve(1)?;
        let vertex = self.import.point(DVec3::from_array(coordinates));
        self.mesh.add_vertex(vertex).map_err(|value| AssetError::TooFar {
            file: self.mesh.file.clone(),
            line,
            value,
        })
    }

    fn face(&mut self, line: usize, rest: &str) -> Result<(), AssetError> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        // Negative indices count backwards from here, wherever the face is cut.
        let count = self.mesh.vertices.len() as i64;
        let mut forward = false;
        for text in rest.split_ascii_whitespace() {
            let index = corner(text).ok_or_else(|| AssetError::BadCorner {
                file: self.mesh.file.clone(),
                line,
                found: excerpt(text),
            })?;
            let absolute = if index < 0 { index.saturating_add(count + 1) } else { index };
            if index == 0 || absolute <= 0 {
                return Err(self.no_such_vertex(line, index));
            }
            forward |= absolute > count;
            corners.push(absolute);
        }
        let (file, found) = (self.mesh.file.clone(), corners.len());
        if found < 3 {
            return Err(AssetError::ShortFace { file, line, found });
        }
        if found > MOST_CORNERS {
            return Err(AssetError::LongFace { file, line, found, most: MOST_CORNERS });
        }
        let part = self.current_part();
        if forward {
            self.deferred.push(Deferred { line, part, corners });
            return Ok(());
        }
        self.cut(line, part, &corners)?;
        self.corners = corners;
        Ok(())
    }

    fn current_part(&mut self) -> u32 {
        let (parts, names) = (&mut self.parts, (&self.group, &self.material));
        *self
            .part
            .get_or_insert_with(|| parts.insert_full((names.0.clone(), names.1.clone())).0 as u32)
    }

    /// Adds the triangles of a face whose corners count from 1.
    fn cut(&mut self, line: usize, part: u32, corners: &[i64]) -> Result<(), AssetError> {
        self.polygon.clear();
        for &corner in corners {
            let index = (corner - 1) as usize;
            if index >= self.mesh.vertices.len() {
                return Err(self.no_such_vertex(line, corner));
            }
            let index = index as u32;
            if self.polygon.last() != Some(&index) {
                self.polygon.push(index);
            }
        }
        let vertices = &self.mesh.vertices;
        self.points.clear();
        self.points.extend(self.polygon.iter().map(|&index| vertices[index as usize]));
        if self.polygon.len() < 3 {
            // A face with repeated corners; as a triangle without area it is dropped and counted.
            let index = self.polygon[0];
            return self.mesh.add_triangle([index; 3], part);
        }
        triangulate(&self.points, &mut self.pieces);
        for piece in &self.pieces {
            self.mesh.add_triangle(piece.map(|place| self.polygon[place]), part)?;
        }
        Ok(())
    }

    fn no_such_vertex(&self, line: usize, index: i64) -> AssetError {
        let count = self.mesh.vertices.len();
        AssetError::NoSuchVertex { file: self.mesh.file.clone(), line, index, count }
    }

    fn finish(mut self) -> Result<Loaded<Mesh>, AssetError> {
        for Deferred { line, part, corners } in std::mem::take(&mut self.deferred) {
            self.cut(line, part, &corners)?;
        }
        for (keyword, line) in &self.unknown {
            self.mesh.warn(&format!("lines with {keyword:?} were left out (first: line {line})"));
        }
        self.mesh.finish(&part_names(&self.parts), self.import)
    }
}

/// Vertex index of a face's corner: `7`, `7/1`, `7//3` or `7/1/3`.
fn corner(text: &str) -> Option<i64> {
    let mut indices = text.split('/');
    let vertex = indices.next()?.parse().ok()?;
    let mut rest = indices.by_ref().take(2);
    let lawful = rest.all(|index| index.is_empty() || index.parse::<i64>().is_ok());
    (lawful && indices.next().is_none()).then_some(vertex)
}

/// A name with single spaces.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn part_names(parts: &IndexSet<(String, String)>) -> Vec<String> {
    let mut materials: IndexMap<&str, usize> = IndexMap::new();
    for (group, _) in parts {
        *materials.entry(group).or_insert(0) += 1;
    }
    let name = |(group, material): &(String, String)| match (group.as_str(), material.as_str()) {
        ("", "") => "default".to_owned(),
        ("", material) => material.to_owned(),
        (group, material) if material.is_empty() || material == group || materials[group] == 1 => {
            group.to_owned()
        }
        (group, material) => format!("{group}/{material}"),
    };
    parts.iter().map(name).collect()
}
