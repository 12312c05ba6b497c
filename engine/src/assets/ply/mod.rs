//! PLY (Polygon File Format, ASCII and binary of both byte orders): vertices and faces. `ply-rs-bw` reads it.
//!
//! The crate never takes more memory than the elements that it is asked for, so elements are asked for in blocks; lines
//! without end are stopped by [`guarded`].

mod elements;
mod error;
mod guarded;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyAccess, PropertyType};

use self::elements::{INDICES, PlyFace, PlyVertex, Skipped};
use self::guarded::{Content, Guarded};
use super::face_cutter::{CutError, FaceCutter, MOST_CORNERS};
use super::format::{self, FileReader};
use super::import::{Import, MeshCollector};
use super::text::open;
use super::{AssetError, Loaded};
use crate::components::Mesh;

pub use error::PlyError;

/// Elements that are read at a time.
const BLOCK: usize = 1 << 14;

/// Reads a mesh from a PLY file; it has one part.
///
/// Polygons, concave ones too, are cut into triangles as those of OBJ are; triangles without area are dropped with a
/// warning. Colours, normals and other elements are skipped.
///
/// # Errors
/// A file that cannot be read, is of another format or malformed, a coordinate that is not finite, a face with a vertex
/// that is not there, or no face with an area.
pub fn read_ply(path: &Path, import: &Import) -> Result<Loaded<Mesh>, AssetError> {
    import.check(path)?;
    format::check(path, FileReader::Ply)?;
    let mut file = PlyFile::open(path)?;
    file.check_elements()?;
    let mut mesh = MeshCollector::new(path);
    let mut faces = FaceList::default();
    let elements: Vec<ElementDef> = file.header.elements.values().cloned().collect();
    for element in elements {
        match element.name.as_str() {
            "vertex" => file.vertices(&element, import, &mut mesh)?,
            "face" => file.faces(&element, &mut faces)?,
            _ => file.blocks::<Skipped>(&element, |_, _| Ok(()))?,
        }
    }
    let mut cutter = FaceCutter::default();
    for (face, corners) in faces.iter().enumerate() {
        let wrong = |problem| wrong(path, problem);
        let count = mesh.vertices.len();
        if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
            let index = i64::from(index);
            return Err(wrong(PlyError::NoSuchVertex { face, index, count }));
        }
        cutter.cut(&mut mesh, corners.iter().copied(), face, 0, true).map_err(
            |error| match error {
                CutError::Tangled => wrong(PlyError::TangledFace { face }),
                CutError::TooFar(value) => wrong(PlyError::FarVertex { vertex: count, value }),
                CutError::Mesh(error) => error,
            },
        )?;
    }
    cutter.warn_crossed(&mut mesh, "face");
    mesh.finish(&["default".to_owned()], import)
}

fn wrong(path: &Path, problem: PlyError) -> AssetError {
    AssetError::Ply { file: path.to_owned(), problem }
}

/// Corners of all faces, one face behind the other.
#[derive(Default)]
struct FaceList {
    corners: Vec<u32>,
    ends: Vec<usize>,
}

impl FaceList {
    fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.corners[start..end])
    }
}

/// A file whose header has been read.
struct PlyFile<'a> {
    path: &'a Path,
    reader: Reader<Guarded<BufReader<File>>>,
    header: Header,
}

impl<'a> PlyFile<'a> {
    fn open(path: &'a Path) -> Result<Self, AssetError> {
        let mut reader = Reader::new(Guarded::new(BufReader::with_capacity(1 << 16, open(path)?)));
        let header = Parser::<Skipped>::new().read_header(&mut reader);
        let header = header.map_err(|error| wrong(path, malformed(&error)))?;
        if (header.version.major, header.version.minor) != (1, 0) {
            let problem = "its header names a version other than 1.0".to_owned();
            return Err(wrong(path, PlyError::Malformed(problem)));
        }
        let is_text = header.encoding == Encoding::Ascii;
        let content = if is_text { Content::Lines } else { Content::Binary };
        reader.get_mut().set_content(content);
        Ok(Self { path, reader, header })
    }

    /// Refuses files without vertices in three dimensions or without faces.
    fn check_elements(&self) -> Result<(), AssetError> {
        let elements = &self.header.elements;
        let has_places = elements.get("vertex").is_some_and(|vertex| {
            let is_number = |name: &&str| {
                let property = vertex.properties.get(*name);
                property.is_some_and(|p| matches!(p.data_type, PropertyType::Scalar(_)))
            };
            ["x", "y", "z"].iter().all(is_number)
        });
        let has_faces = elements.get("face").is_some_and(|face| {
            face.count > 0 && INDICES.iter().any(|name| face.properties.contains_key(*name))
        });
        let problem = if !has_places {
            PlyError::NoVertices("vertex")
        } else if has_faces {
            return Ok(());
        } else if elements.contains_key("tristrips") {
            PlyError::Strips
        } else {
            PlyError::NoFaces
        };
        Err(wrong(self.path, problem))
    }

    /// Reads an element in blocks; `each` gets them one by one with their numbers.
    fn blocks<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        mut each: impl FnMut(usize, E) -> Result<(), AssetError>,
    ) -> Result<(), AssetError> {
        let parser = Parser::<E>::new();
        let mut done = 0;
        let mut block = element.clone();
        while done < element.count {
            block.count = BLOCK.min(element.count - done);
            let read = parser.read_payload_for_element(&mut self.reader, &block, &self.header);
            let read = read.map_err(|error| {
                let PlyError::Malformed(problem) = malformed(&error) else {
                    unreachable!("`malformed` makes this variant alone")
                };
                let (name, count) = (&element.name, element.count);
                let place = format!("after {done} of {count} elements `{name}`: {problem}");
                wrong(self.path, PlyError::Malformed(place))
            })?;
            for value in read {
                each(done, value)?;
                done += 1;
            }
        }
        Ok(())
    }

    fn vertices(
        &mut self,
        element: &ElementDef,
        import: &Import,
        mesh: &mut MeshCollector,
    ) -> Result<(), AssetError> {
        let path = self.path;
        self.blocks::<PlyVertex>(element, |vertex, PlyVertex(place)| {
            if let Some(&value) = place.iter().find(|value| !value.is_finite()) {
                return Err(wrong(path, PlyError::NotFinite { vertex, value }));
            }
            mesh.reserve(1)?;
            mesh.add_vertex(import.point(DVec3::from_array(place)))
                .map_err(|value| wrong(path, PlyError::FarVertex { vertex, value }))
        })
    }

    fn faces(&mut self, element: &ElementDef, faces: &mut FaceList) -> Result<(), AssetError> {
        let path = self.path;
        let count = self.header.elements.get("vertex").map_or(0, |vertex| vertex.count);
        self.blocks::<PlyFace>(element, |face, corners| {
            let found = corners.len();
            if found < 3 {
                return Err(wrong(path, PlyError::ShortFace { face, found }));
            }
            if found > MOST_CORNERS {
                let most = MOST_CORNERS;
                return Err(wrong(path, PlyError::LongFace { face, found, most }));
            }
            for index in corners.corners() {
                let vertex = u32::try_from(index).ok();
                let no_such = || wrong(path, PlyError::NoSuchVertex { face, index, count });
                faces.corners.push(vertex.ok_or_else(no_such)?);
            }
            faces.ends.push(faces.corners.len());
            Ok(())
        })
    }
}

/// Error with the parser's message, on one line and cut to the length of a message.
fn malformed(error: &ParseError) -> PlyError {
    let text = error.to_string();
    // The rest lists rules of the parser's grammar, which helps programmers alone.
    let text = text.split("Error: ParseError").next().unwrap_or_default();
    let words: Vec<&str> = text.split_whitespace().collect();
    PlyError::Malformed(excerpt_of_message(&words.join(" ")))
}

/// The beginning of a message that may quote a long line.
fn excerpt_of_message(text: &str) -> String {
    const MOST: usize = 200;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
