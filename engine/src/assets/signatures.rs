//! Formats of files by their first bytes, and by the extension of their names.

use std::path::Path;

use super::format::{Content, FileFormat, FileReader};

/// Keywords that the first line of an OBJ file may begin with.
const OBJ_KEYWORDS: [&str; 11] =
    ["v", "vt", "vn", "vp", "f", "g", "o", "s", "usemtl", "mtllib", "l"];

type Signature = (&'static [u8], &'static str, Content);

/// First bytes that text tables and GeoJSON do not have.
const SIGNATURES: [Signature; 32] = [
    (b"\x00\x00\x27\x0a", "an Esri shapefile", Content::Features),
    (b"SQLite format 3\0", "a GeoPackage or another SQLite database", Content::Features),
    (b"fgb\x03", "a FlatGeobuf file", Content::Features),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook", Content::Spreadsheet),
    (b"LASF", "a LAS or LAZ point cloud", Content::PointCloud),
    (b"ASTM-E57", "an E57 point cloud", Content::PointCloud),
    (b"# .PCD", "a PCD point cloud", Content::PointCloud),
    (b"II*\0", "a TIFF image", Content::Cells),
    (b"MM\0*", "a TIFF image", Content::Cells),
    (b"II+\0", "a TIFF image", Content::Cells),
    (b"MM\0+", "a TIFF image", Content::Cells),
    (b"\x89PNG", "a PNG image", Content::Cells),
    (b"\xff\xd8\xff", "a JPEG image", Content::Cells),
    (b"CDF\x01", "a netCDF file", Content::Cells),
    (b"CDF\x02", "a netCDF file", Content::Cells),
    (b"\x89HDF", "an HDF5 or netCDF file", Content::Cells),
    (b"PAR1", "a Parquet file", Content::Numbers),
    (b"MATLAB", "a MATLAB file", Content::Numbers),
    (b"\x93NUMPY", "a NumPy file", Content::Numbers),
    (b"\x1f\x8b", "a gzip archive", Content::Archive),
    (b"7z\xbc\xaf", "a 7z archive", Content::Archive),
    (b"Rar!", "a RAR archive", Content::Archive),
    (b"BZh", "a bzip2 archive", Content::Archive),
    (b"\xfd7zXZ", "an xz archive", Content::Archive),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive", Content::Archive),
    (b"%PDF", "a PDF file", Content::Document),
    (b"<!DOCTYPE html", "a web page", Content::Document),
    (b"<html", "a web page", Content::Document),
    (b"<HTML", "a web page", Content::Document),
    (b"version https://git-lfs", "a Git LFS pointer, not the file itself", Content::Document),
    (b"ply\n", "a PLY file", Content::PointCloud),
    (b"ply\r", "a PLY file", Content::PointCloud),
];

/// First bytes of meshes, which a text table may have too.
const MESH_SIGNATURES: [Signature; 18] = [
    (b"ply\n", "a PLY file", Content::Mesh),
    (b"ply\r", "a PLY file", Content::Mesh),
    (b"Kaydara FBX", "an FBX file", Content::Mesh),
    (b"; FBX", "an FBX file", Content::Mesh),
    (b"glTF", "a GLB file", Content::Gltf),
    (b"BLENDER", "a Blender file", Content::Mesh),
    (b"#usda", "a USD file", Content::Mesh),
    (b"PXR-USDC", "a USD file", Content::Mesh),
    (b"Ogawa", "an Alembic file", Content::Mesh),
    (b"#VRML", "a VRML file", Content::Mesh),
    (b"#X3D", "an X3D file", Content::Mesh),
    (b"OFF\n", "an OFF file", Content::Mesh),
    (b"OFF\r", "an OFF file", Content::Mesh),
    (b"COFF", "an OFF file", Content::Mesh),
    (b"DRACO", "a Draco file", Content::Mesh),
    (b"ISO-10303-21", "a STEP or IFC file", Content::Mesh),
    (b"AC10", "a DWG file", Content::Drawing),
    (b"newmtl", "a material library of an OBJ file", Content::MaterialLibrary),
];

/// Words within the first bytes of files that begin with `<`.
const MARKUP: [Signature; 6] = [
    (b"<COLLADA", "a COLLADA file", Content::Mesh),
    (b"<X3D", "an X3D file", Content::Mesh),
    (b"<kml", "a KML file", Content::Features),
    (b"gml", "a GML file", Content::Features),
    (
        b"urn:schemas-microsoft-com:office:spreadsheet",
        "an Excel workbook in XML",
        Content::Spreadsheet,
    ),
    (b"<html", "a web page", Content::Document),
];

fn format(name: &'static str, content: Content) -> Option<FileFormat> {
    Some(FileFormat { name, content })
}

/// Returns whether bytes hold some words.
fn holds(head: &[u8], words: &[u8]) -> bool {
    head.windows(words.len()).any(|window| window == words)
}

/// Returns the format that the first bytes of a file tell to a reader.
pub(super) fn by_content(
    head: &[u8],
    length: u64,
    path: &Path,
    reader: FileReader,
) -> Option<FileFormat> {
    let starts = |signature: &&Signature| head.starts_with(signature.0);
    let mesh = MESH_SIGNATURES.iter().filter(|_| reader.reads_mesh()).find(starts);
    if let Some(&(_, name, content)) = mesh.or_else(|| SIGNATURES.iter().find(starts)) {
        return format(name, content);
    }
    let text = head.trim_ascii_start();
    if head.starts_with(b"PK\x03\x04") {
        packed_format(head, path)
    } else if text.starts_with(b"<") {
        let markup = MARKUP.iter().find(|signature| holds(head, signature.0));
        match markup {
            Some(&(_, name, content)) => format(name, content),
            None if text.starts_with(b"<?xml") => format("an XML file", Content::Mesh),
            None => None,
        }
    } else if reader.reads_mesh() {
        mesh_format(head, length)
    } else {
        None
    }
}

/// Returns the format of a ZIP archive.
fn packed_format(head: &[u8], path: &Path) -> Option<FileFormat> {
    let packed = [Content::Spreadsheet, Content::Features, Content::Numbers];
    match by_extension(path) {
        Some(format) if packed.contains(&format.content) => Some(format),
        _ if holds(head, b"xl/") => format("an Excel workbook", Content::Spreadsheet),
        _ if holds(head, b"opendocument.spreadsheet") => {
            format("an OpenDocument spreadsheet", Content::Spreadsheet)
        }
        _ if holds(head, b".kml") => format("a KMZ file", Content::Features),
        _ => format("a ZIP archive", Content::Archive),
    }
}

/// Returns the format of a mesh whose first bytes have no fixed words.
fn mesh_format(head: &[u8], length: u64) -> Option<FileFormat> {
    // 80 bytes of text, the number of triangles, and 50 bytes for each.
    let count = head.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let is_binary_stl =
        count.is_some_and(|count| count > 0 && length == 84 + 50 * u64::from(count));
    let is_3ds = head.starts_with(b"MM")
        && head.get(2..6).and_then(|size| size.try_into().ok()).map(u32::from_le_bytes)
            == u32::try_from(length).ok();
    let text = head.trim_ascii_start();
    if is_binary_stl || (text.starts_with(b"solid") && holds(head, b"facet")) {
        format("an STL file", Content::Mesh)
    } else if is_3ds {
        format("a 3DS file", Content::Mesh)
    } else if text.starts_with(b"{") && holds(head, b"\"asset\"") {
        format("a glTF file", Content::Gltf)
    } else if text.starts_with(b"{") {
        format("a JSON file", Content::Mesh)
    } else if text.starts_with(b"0") && holds(head, b"SECTION") {
        format("a DXF file", Content::Drawing)
    } else if is_obj(head) {
        format("a Wavefront OBJ file", Content::Obj)
    } else {
        None
    }
}

/// Returns whether bytes begin as glTF and GLB do.
pub(super) fn is_gltf(head: &[u8]) -> bool {
    head.starts_with(b"glTF") || head.trim_ascii_start().starts_with(b"{")
}

/// Returns whether a text begins as OBJ does, behind blank lines and comments.
pub(super) fn is_obj(head: &[u8]) -> bool {
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
        _ => OBJ_KEYWORDS.contains(&keyword),
    }
}

/// Returns the format that the extension of a file's name stands for.
pub(super) fn by_extension(path: &Path) -> Option<FileFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let (name, content) = match extension.as_str() {
        "ply" => ("a PLY file", Content::Mesh),
        "stl" => ("an STL file", Content::Mesh),
        "fbx" => ("an FBX file", Content::Mesh),
        "dae" => ("a COLLADA file", Content::Mesh),
        "3ds" => ("a 3DS file", Content::Mesh),
        "max" => ("a 3ds Max file", Content::Mesh),
        "c4d" => ("a Cinema 4D file", Content::Mesh),
        "blend" => ("a Blender file", Content::Mesh),
        "skp" => ("a SketchUp file", Content::Mesh),
        "spm" | "srt" => ("a SpeedTree file", Content::Mesh),
        "usd" | "usda" | "usdc" | "usdz" => ("a USD file", Content::Mesh),
        "x3d" => ("an X3D file", Content::Mesh),
        "wrl" => ("a VRML file", Content::Mesh),
        "off" => ("an OFF file", Content::Mesh),
        "dxf" => ("a DXF file", Content::Drawing),
        "dwg" => ("a DWG file", Content::Drawing),
        "obj" => ("a Wavefront OBJ file", Content::Obj),
        "mtl" => ("a material library of an OBJ file", Content::MaterialLibrary),
        "gltf" | "glb" => ("a glTF file", Content::Gltf),
        "csv" | "def" => ("a table of discs", Content::DiscTable),
        "las" | "laz" => ("a LAS or LAZ point cloud", Content::PointCloud),
        "e57" => ("an E57 point cloud", Content::PointCloud),
        "pcd" => ("a PCD point cloud", Content::PointCloud),
        "xyz" => ("a point cloud", Content::PointCloud),
        "shp" => ("an Esri shapefile", Content::Features),
        "shx" => ("the index of an Esri shapefile", Content::Attributes),
        "dbf" => ("a dBASE table", Content::Attributes),
        "gpkg" => ("a GeoPackage", Content::Features),
        "kmz" => ("a KMZ file", Content::Features),
        "kml" => ("a KML file", Content::Features),
        "tab" | "mif" | "map" => ("a MapInfo file", Content::Features),
        "xlsx" | "xlsm" | "xlsb" | "xls" => ("an Excel workbook", Content::Spreadsheet),
        "ods" => ("an OpenDocument spreadsheet", Content::Spreadsheet),
        "numbers" => ("a Numbers spreadsheet", Content::Spreadsheet),
        "mat" => ("a MATLAB file", Content::Numbers),
        "rds" | "rdata" | "sav" | "npz" => ("a file of a statistics program", Content::Numbers),
        "gz" => ("a gzip archive", Content::Archive),
        "zip" => ("a ZIP archive", Content::Archive),
        "7z" => ("a 7z archive", Content::Archive),
        "rar" => ("a RAR archive", Content::Archive),
        _ => return None,
    };
    format(name, content)
}
