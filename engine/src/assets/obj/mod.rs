//! Wavefront OBJ: vertices, faces, groups and material names; the rest of the format is left out.
//!
//! `tobj` reads the material libraries ([`materials`]) and is compared with this reader in `assets/tests/obj.rs`. It
//! does not read the geometry, because it
//!
//! - accepts `nan`, numbers beyond f64 and far indices of texture coordinates, makes a face of a line (`l`), and
//!   says neither line nor word of a fault, so that a layer around it has to parse each statement itself;
//! - joins parts whose materials no library defines, and finds no vertex that follows behind the next group;
//! - renumbers vertices by first use. With a layer that cleans its lines it took 1.9 to 2.8 times as long for files
//!   of 50 and 60 MB, and 2.2 to 3 times the memory.

mod line;
mod materials;

use std::path::Path;

use glam::DVec3;
use indexmap::{IndexMap, IndexSet};

use self::line::{comment, is_name, without_comment};
use super::error::excerpt;
use super::face_cutter::{CutError, FaceCutter, MOST_CORNERS};
use super::format::{self, FileReader};
use super::import::{Import, MeshCollector};
use super::text::{TextLines, decode, number};
use super::{AssetError, Loaded};
use crate::components::Mesh;
use crate::document::PartsBy;

/// Most unknown keywords in warnings.
const MOST_UNKNOWN: usize = 5;

/// Most material libraries that are read.
const MOST_LIBRARIES: usize = 64;

/// Keywords that are skipped: they do not concern surfaces.
const IGNORED: [&[u8]; 14] = [
    b"vt",
    b"vn",
    b"vp",
    b"s",
    b"l",
    b"p",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"usemap",
    b"maplib",
    b"shadow_obj",
    b"trace_obj",
];

/// Reads a mesh from a Wavefront OBJ file.
///
/// By [`PartsBy::Group`], a part is a group (`g` or `o`, the later one counts) and within it a material
/// (`usemtl`). It is called after its group if the group has one material or the material has the same
/// name, else `group/material`; without a group after its material; without both `default`. By
/// [`PartsBy::Material`], a part is a material, whatever its groups.
///
/// Polygons, concave ones too, are cut into triangles; triangles without area are dropped with a
/// warning. A comment (`#`) may end any line; in names it follows a space. Material libraries are read for
/// transparency alone, of which a warning says how much area it concerns.
///
/// Coordinates are read and moved in f64, so `Origin::BaseCenter` loses nothing of a model that
/// stands at map coordinates.
///
/// # Errors
/// A file that cannot be read, is of another format, has a name that is not UTF-8, a malformed vertex or
/// face, or no face with an area.
pub fn read_obj(
    path: &Path,
    import: &Import,
    parts_by: &PartsBy,
) -> Result<Loaded<Mesh>, AssetError> {
    import.check(path)?;
    format::check(path, FileReader::Obj)?;
    let mut lines = TextLines::open(path)?;
    let mut model = ObjImporter::new(path, import, parts_by);
    let mut joined = Vec::new();
    while let Some((number, line)) = lines.next_bytes()? {
        let line = without_comment(line);
        if line.ends_with(b"\\") {
            joined.clear();
            joined.extend_from_slice(line);
            let is_name = is_name(line);
            while joined.ends_with(b"\\") {
                joined.pop();
                // The joint separates words.
                joined.push(b' ');
                let more = lines.continuation()?;
                joined.extend_from_slice(&more[..comment(more, is_name)]);
                joined.truncate(joined.trim_ascii_end().len());
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

/// Mesh and state of the reader after some lines.
struct ObjImporter<'a> {
    import: &'a Import,
    parts_by: &'a PartsBy,
    mesh: MeshCollector,
    /// Group and material of each part, in order of appearance; an empty name is none.
    parts: IndexSet<(String, String)>,
    group: String,
    material: String,
    /// Part of the next face; `None` after a change of group or material.
    part: Option<u32>,
    deferred: Vec<Deferred>,
    /// True once all vertices of the file are read; new ones may then be added behind them.
    is_read: bool,
    cutter: FaceCutter,
    /// Names that follow `mtllib`.
    libraries: IndexSet<String>,
    /// First line of each unknown keyword.
    unknown: IndexMap<String, usize>,
    /// Buffer that is reused from face to face.
    corners: Vec<i64>,
}

impl<'a> ObjImporter<'a> {
    fn new(path: &Path, import: &'a Import, parts_by: &'a PartsBy) -> Self {
        Self {
            import,
            parts_by,
            mesh: MeshCollector::new(path),
            parts: IndexSet::new(),
            group: String::new(),
            material: String::new(),
            part: None,
            deferred: Vec::new(),
            is_read: false,
            cutter: FaceCutter::default(),
            libraries: IndexSet::new(),
            unknown: IndexMap::new(),
            corners: Vec::new(),
        }
    }

    fn statement(&mut self, line: usize, text: &[u8]) -> Result<(), AssetError> {
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        let (keyword, rest) = text.split_at(end);
        let decoded = decode(rest, &self.mesh.file, line);
        match keyword {
            b"v" => self.vertex(line, decoded?)?,
            b"f" | b"fo" => self.face(line, decoded?)?,
            b"g" | b"o" => {
                self.group = words(decoded?);
                self.part = None;
            }
            b"usemtl" => {
                self.material = words(decoded?);
                self.part = None;
            }
            // Nothing but warnings comes of it, so its name may be in any encoding.
            b"mtllib" if self.libraries.len() < MOST_LIBRARIES => {
                self.libraries.extend(decoded.ok().map(|names| names.trim().to_owned()));
            }
            b"mtllib" => {}
            _ if text.contains(&0) => drop(decode(text, &self.mesh.file, line)?),
            _ if IGNORED.contains(&keyword) => {}
            _ if self.unknown.len() < MOST_UNKNOWN => {
                let keyword = excerpt(&String::from_utf8_lossy(keyword));
                self.unknown.entry(keyword).or_insert(line);
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
        if forward || !self.cut(line, part, &corners)? {
            self.deferred.push(Deferred { line, part, corners });
            return Ok(());
        }
        self.corners = corners;
        Ok(())
    }

    fn current_part(&mut self) -> u32 {
        let parts = &mut self.parts;
        let group = match self.parts_by {
            PartsBy::Group => self.group.as_str(),
            PartsBy::Material => "",
        };
        let material = &self.material;
        *self
            .part
            .get_or_insert_with(|| parts.insert_full((group.to_owned(), material.clone())).0 as u32)
    }

    /// Adds the triangles of a face whose corners count from 1. Returns false if that takes new vertices
    /// while some of the file's are still to come.
    fn cut(&mut self, line: usize, part: u32, corners: &[i64]) -> Result<bool, AssetError> {
        let count = self.mesh.vertices.len();
        if let Some(&corner) = corners.iter().find(|&&corner| (corner - 1) as usize >= count) {
            return Err(self.no_such_vertex(line, corner));
        }
        let indices = corners.iter().map(|&corner| (corner - 1) as u32);
        let cut = self.cutter.cut(&mut self.mesh, indices, line, part, self.is_read);
        cut.map_err(|error| match error {
            CutError::Tangled => AssetError::TangledFace { file: self.mesh.file.clone(), line },
            CutError::TooFar(value) => {
                AssetError::TooFar { file: self.mesh.file.clone(), line, value }
            }
            CutError::Mesh(error) => error,
        })
    }

    fn no_such_vertex(&self, line: usize, index: i64) -> AssetError {
        let count = self.mesh.vertices.len();
        AssetError::NoSuchVertex { file: self.mesh.file.clone(), line, index, count }
    }

    fn finish(mut self) -> Result<Loaded<Mesh>, AssetError> {
        self.is_read = true;
        for Deferred { line, part, corners } in std::mem::take(&mut self.deferred) {
            self.cut(line, part, &corners)?;
        }
        for (keyword, line) in &self.unknown {
            self.mesh.warn(&format!("lines with {keyword:?} were left out (first: line {line})"));
        }
        self.cutter.warn_crossed(&mut self.mesh, "line");
        let transparent = materials::transparent(&self.mesh.file, &self.libraries);
        if !transparent.is_empty() {
            let parts = self.parts.iter().enumerate();
            let parts = parts.filter_map(|(part, (_, material))| {
                Some((part as u32, transparent.get(material)?.clone()))
            });
            self.mesh.transparent.extend(parts);
        }
        self.mesh.finish(&part_names(&self.parts), self.import)
    }
}

/// Returns the vertex index of a face's corner: `7`, `7/1`, `7//3` or `7/1/3`.
fn corner(text: &str) -> Option<i64> {
    let mut indices = text.split('/');
    let vertex = indices.next()?.parse().ok()?;
    let mut rest = indices.by_ref().take(2);
    let lawful = rest.all(|index| index.is_empty() || index.parse::<i64>().is_ok());
    (lawful && indices.next().is_none()).then_some(vertex)
}

/// Returns a name with single spaces.
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
