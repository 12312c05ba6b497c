//! Formats of files that are given in place of meshes, recognised by their first bytes.

use std::io::Read as _;
use std::path::Path;

use super::{AssetError, text};

/// Bytes that are looked at.
const HEAD: u64 = 4096;

/// Keywords that the first line of an OBJ file may begin with.
const OBJ: [&str; 11] = ["v", "vt", "vn", "vp", "f", "g", "o", "s", "usemtl", "mtllib", "l"];

/// A reader of meshes, by its name in the scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reader {
    Obj,
    Gltf,
    Discs,
}

impl Reader {
    fn name(self) -> &'static str {
        match self {
            Self::Obj => "Obj",
            Self::Gltf => "Gltf",
            Self::Discs => "Discs",
        }
    }

    fn reads(self) -> &'static str {
        match self {
            Self::Obj => "Wavefront OBJ",
            Self::Gltf => "glTF 2.0 and GLB",
            Self::Discs => "a table of discs (`radius,x,y,z,nx,ny,nz`)",
        }
    }
}

/// What to do with a file of another format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Remedy {
    /// Convert it.
    Convert,
    /// Triangulate points, or make discs of them.
    Mesh,
    Unpack,
    Use(Reader),
    /// Copy or download the file itself.
    Fetch,
    /// Name the file that it belongs to.
    NameObj,
}

impl Remedy {
    fn text(self) -> String {
        match self {
            Self::Convert => "convert it to OBJ or glTF, with Blender or MeshLab, for example",
            Self::Mesh => {
                "convert the points to a mesh (OBJ or glTF), or to a table of discs for `Discs`"
            }
            Self::Unpack => "unpack it and name the mesh file in it",
            Self::Fetch => "get the file itself",
            Self::NameObj => "name the OBJ file that it belongs to",
            Self::Use(reader) => {
                return format!("write `{}` in place of what reads it now", reader.name());
            }
        }
        .to_owned()
    }
}

/// Refuses a file of a known format that this reader does not read.
///
/// # Errors
/// [`AssetError::OtherFormat`], which names the format by content, else by the file's extension if the content is
/// not that of the reader; a file that cannot be read.
pub(super) fn check(path: &Path, reader: Reader) -> Result<(), AssetError> {
    let length = text::size(path)?;
    let mut head = Vec::new();
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    text::open(path)?.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&head);
    let is_own = match reader {
        Reader::Obj => is_obj(head),
        Reader::Gltf => is_gltf(head),
        // A table may begin in many ways.
        Reader::Discs => false,
    };
    if is_own {
        return Ok(());
    }
    let (found, remedy) = match (by_content(head, length), by_extension(path)) {
        (Some((found, remedy)), _) => (found.to_owned(), remedy),
        // The tables of `Discs` go by any name.
        (None, Some((found, remedy))) if reader != Reader::Discs => {
            (format!("{found}, by its name"), remedy)
        }
        _ => return Ok(()),
    };
    if remedy == Remedy::Use(reader) {
        return Ok(());
    }
    Err(AssetError::OtherFormat {
        file: path.to_owned(),
        found,
        reader: reader.name(),
        wanted: reader.reads(),
        remedy: remedy.text(),
    })
}

/// Returns whether a text begins as OBJ does, behind blank lines and comments.
fn is_obj(head: &[u8]) -> bool {
    let mut lines = head.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let Some(line) = lines.find(|line| !line.is_empty() && line[0] != b'#') else { return false };
    let Ok(line) = std::str::from_utf8(line) else { return line.starts_with(b"mtllib ") };
    let mut words = line.split_ascii_whitespace();
    let keyword = words.next().unwrap_or_default();
    // `o` and the like begin lines of prose too; numbers tell.
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    match keyword {
        "v" | "vt" | "vn" | "vp" => words.next().is_some_and(is_number),
        "f" | "l" => {
            words.next().is_some_and(|word| is_number(word.split('/').next().unwrap_or(word)))
        }
        _ => OBJ.contains(&keyword),
    }
}

fn is_gltf(head: &[u8]) -> bool {
    head.starts_with(b"glTF") || head.trim_ascii_start().starts_with(b"{")
}

type Found = (&'static str, Remedy);

fn by_content(head: &[u8], length: u64) -> Option<Found> {
    use Remedy::{Convert, Fetch, Mesh, NameObj, Unpack, Use};
    const STARTS: [(&[u8], Found); 35] = [
        (b"ply\n", ("a PLY file", Convert)),
        (b"ply\r", ("a PLY file", Convert)),
        (b"Kaydara FBX", ("an FBX file", Convert)),
        (b"; FBX", ("an FBX file", Convert)),
        (b"glTF", ("a GLB file", Use(Reader::Gltf))),
        (b"BLENDER", ("a Blender file", Convert)),
        (b"#usda", ("a USD file", Convert)),
        (b"PXR-USDC", ("a USD file", Convert)),
        (b"Ogawa", ("an Alembic file", Convert)),
        (b"#VRML", ("a VRML file", Convert)),
        (b"#X3D", ("an X3D file", Convert)),
        (b"OFF\n", ("an OFF file", Convert)),
        (b"OFF\r", ("an OFF file", Convert)),
        (b"COFF", ("an OFF file", Convert)),
        (b"DRACO", ("a Draco file", Convert)),
        (b"ISO-10303-21", ("a STEP or IFC file", Convert)),
        (b"AC10", ("a DWG file", Convert)),
        (b"LASF", ("a LAS or LAZ point cloud", Mesh)),
        (b"ASTM-E57", ("an E57 point cloud", Mesh)),
        (b"# .PCD", ("a PCD point cloud", Mesh)),
        (b"MATLAB", ("a MATLAB file", Convert)),
        (b"\x89HDF", ("an HDF5 file", Convert)),
        (b"\x1f\x8b", ("a gzip archive", Unpack)),
        (b"PK\x03\x04", ("a ZIP archive", Unpack)),
        (b"7z\xbc\xaf", ("a 7z archive", Unpack)),
        (b"Rar!", ("a RAR archive", Unpack)),
        (b"BZh", ("a bzip2 archive", Unpack)),
        (b"\xfd7zXZ", ("an xz archive", Unpack)),
        (b"\x28\xb5\x2f\xfd", ("a Zstandard archive", Unpack)),
        (b"\x89PNG", ("a PNG image", Fetch)),
        (b"\xff\xd8\xff", ("a JPEG image", Fetch)),
        (b"%PDF", ("a PDF file", Fetch)),
        (b"<!DOCTYPE html", ("a web page", Fetch)),
        (b"version https://git-lfs", ("a Git LFS pointer, not the file itself", Fetch)),
        (b"newmtl", ("a material library of an OBJ file", NameObj)),
    ];
    if let Some((_, found)) = STARTS.iter().find(|(start, _)| head.starts_with(start)) {
        return Some(*found);
    }
    let holds = |words: &[u8]| head.windows(words.len()).any(|window| window == words);
    // 80 bytes of text, the number of triangles, and 50 bytes of each.
    let count = head.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let is_binary_stl =
        count.is_some_and(|count| count > 0 && length == 84 + 50 * u64::from(count));
    let is_3ds = head.starts_with(b"MM")
        && head.get(2..6).and_then(|size| size.try_into().ok()).map(u32::from_le_bytes)
            == u32::try_from(length).ok();
    let text = head.trim_ascii_start();
    if is_binary_stl || (text.starts_with(b"solid") && holds(b"facet")) {
        Some(("an STL file", Convert))
    } else if is_3ds {
        Some(("a 3DS file", Convert))
    } else if holds(b"<COLLADA") {
        Some(("a COLLADA file", Convert))
    } else if holds(b"<X3D") {
        Some(("an X3D file", Convert))
    } else if text.starts_with(b"<html") || text.starts_with(b"<HTML") {
        Some(("a web page", Fetch))
    } else if text.starts_with(b"<?xml") {
        Some(("an XML file", Convert))
    } else if text.starts_with(b"{") && holds(b"\"asset\"") {
        Some(("a glTF file", Use(Reader::Gltf)))
    } else if text.starts_with(b"{") {
        Some(("a JSON file", Convert))
    } else if text.starts_with(b"0") && holds(b"SECTION") {
        Some(("a DXF file", Convert))
    } else if is_obj(head) {
        Some(("a Wavefront OBJ file", Use(Reader::Obj)))
    } else {
        None
    }
}

fn by_extension(path: &Path) -> Option<Found> {
    use Remedy::{Convert, Mesh, NameObj, Unpack, Use};
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    Some(match extension.as_str() {
        "ply" => ("a PLY file", Convert),
        "stl" => ("an STL file", Convert),
        "fbx" => ("an FBX file", Convert),
        "dae" => ("a COLLADA file", Convert),
        "3ds" => ("a 3DS file", Convert),
        "max" => ("a 3ds Max file", Convert),
        "c4d" => ("a Cinema 4D file", Convert),
        "blend" => ("a Blender file", Convert),
        "skp" => ("a SketchUp file", Convert),
        "spm" | "srt" => ("a SpeedTree file", Convert),
        "usd" | "usda" | "usdc" | "usdz" => ("a USD file", Convert),
        "x3d" => ("an X3D file", Convert),
        "wrl" => ("a VRML file", Convert),
        "off" => ("an OFF file", Convert),
        "dxf" => ("a DXF file", Convert),
        "mat" => ("a MATLAB file", Convert),
        "las" | "laz" => ("a LAS or LAZ point cloud", Mesh),
        "e57" => ("an E57 point cloud", Mesh),
        "pcd" => ("a PCD point cloud", Mesh),
        "xyz" => ("a point cloud", Mesh),
        "gz" => ("a gzip archive", Unpack),
        "zip" => ("a ZIP archive", Unpack),
        "7z" => ("a 7z archive", Unpack),
        "rar" => ("a RAR archive", Unpack),
        "mtl" => ("a material library of an OBJ file", NameObj),
        "obj" => ("a Wavefront OBJ file", Use(Reader::Obj)),
        "gltf" | "glb" => ("a glTF file", Use(Reader::Gltf)),
        "csv" | "def" => ("a table of discs", Use(Reader::Discs)),
        _ => return None,
    })
}
