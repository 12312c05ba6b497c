//! Formats of files by their first bytes, and by the extension of their names.

use std::path::Path;

use super::format::{FileContent, FileReader, FoundFormat};

/// Keywords that the first line of an OBJ file may begin with.
const OBJ_KEYWORDS: [&str; 11] =
    ["v", "vt", "vn", "vp", "f", "g", "o", "s", "usemtl", "mtllib", "l"];

type Signature = (&'static [u8], &'static str, FileContent);

/// First bytes that text tables and GeoJSON do not have.
const SIGNATURES: [Signature; 32] = [
    (b"\x00\x00\x27\x0a", "an Esri shapefile", FileContent::Features),
    (b"SQLite format 3\0", "a GeoPackage or another SQLite database", FileContent::Features),
    (b"fgb\x03", "a FlatGeobuf file", FileContent::Features),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook", FileContent::Spreadsheet),
    (b"LASF", "a LAS or LAZ point cloud", FileContent::PointCloud),
    (b"ASTM-E57", "an E57 point cloud", FileContent::PointCloud),
    (b"# .PCD", "a PCD point cloud", FileContent::PointCloud),
    (b"II*\0", "a TIFF image", FileContent::Cells),
    (b"MM\0*", "a TIFF image", FileContent::Cells),
    (b"II+\0", "a TIFF image", FileContent::Cells),
    (b"MM\0+", "a TIFF image", FileContent::Cells),
    (b"\x89PNG", "a PNG image", FileContent::Cells),
    (b"\xff\xd8\xff", "a JPEG image", FileContent::Cells),
    (b"CDF\x01", "a netCDF file", FileContent::Cells),
    (b"CDF\x02", "a netCDF file", FileContent::Cells),
    (b"\x89HDF", "an HDF5 or netCDF file", FileContent::Cells),
    (b"PAR1", "a Parquet file", FileContent::Numbers),
    (b"MATLAB", "a MATLAB file", FileContent::Numbers),
    (b"\x93NUMPY", "a NumPy file", FileContent::Numbers),
    (b"\x1f\x8b", "a gzip archive", FileContent::Archive),
    (b"7z\xbc\xaf", "a 7z archive", FileContent::Archive),
    (b"Rar!", "a RAR archive", FileContent::Archive),
    (b"BZh", "a bzip2 archive", FileContent::Archive),
    (b"\xfd7zXZ", "an xz archive", FileContent::Archive),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive", FileContent::Archive),
    (b"%PDF", "a PDF file", FileContent::Document),
    (b"<!DOCTYPE html", "a web page", FileContent::Document),
    (b"<html", "a web page", FileContent::Document),
    (b"<HTML", "a web page", FileContent::Document),
    (b"version https://git-lfs", "a Git LFS pointer, not the file itself", FileContent::Document),
    (b"ply\n", "a PLY file", FileContent::PointCloud),
    (b"ply\r", "a PLY file", FileContent::PointCloud),
];

/// First bytes of meshes, which a text table may have too.
const MESH_SIGNATURES: [Signature; 18] = [
    (b"ply\n", "a PLY file", FileContent::Ply),
    (b"ply\r", "a PLY file", FileContent::Ply),
    (b"Kaydara FBX", "an FBX file", FileContent::Mesh),
    (b"; FBX", "an FBX file", FileContent::Mesh),
    (b"glTF", "a GLB file", FileContent::Gltf),
    (b"BLENDER", "a Blender file", FileContent::Mesh),
    (b"#usda", "a USD file", FileContent::Mesh),
    (b"PXR-USDC", "a USD file", FileContent::Mesh),
    (b"Ogawa", "an Alembic file", FileContent::Mesh),
    (b"#VRML", "a VRML file", FileContent::Mesh),
    (b"#X3D", "an X3D file", FileContent::Mesh),
    (b"OFF\n", "an OFF file", FileContent::Mesh),
    (b"OFF\r", "an OFF file", FileContent::Mesh),
    (b"COFF", "an OFF file", FileContent::Mesh),
    (b"DRACO", "a Draco file", FileContent::Mesh),
    (b"ISO-10303-21", "a STEP or IFC file", FileContent::Mesh),
    (b"AC10", "a DWG file", FileContent::Drawing),
    (b"newmtl", "a material library of an OBJ file", FileContent::MaterialLibrary),
];

/// Words within the first bytes of files that begin with `<`.
const MARKUP: [Signature; 6] = [
    (b"<COLLADA", "a COLLADA file", FileContent::Mesh),
    (b"<X3D", "an X3D file", FileContent::Mesh),
    (b"<kml", "a KML file", FileContent::Features),
    (b"gml", "a GML file", FileContent::Features),
    (
        b"urn:schemas-microsoft-com:office:spreadsheet",
        "an Excel workbook in XML",
        FileContent::Spreadsheet,
    ),
    (b"<html", "a web page", FileContent::Document),
];

impl FoundFormat {
    const fn new(name: &'static str, content: FileContent) -> Self {
        Self { name, content }
    }
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
) -> Option<FoundFormat> {
    let starts = |signature: &&Signature| head.starts_with(signature.0);
    let mesh = MESH_SIGNATURES.iter().filter(|_| reader.reads_mesh()).find(starts);
    if let Some(&(_, name, content)) = mesh.or_else(|| SIGNATURES.iter().find(starts)) {
        return Some(FoundFormat::new(name, content));
    }
    let text = head.trim_ascii_start();
    if head.starts_with(b"PK\x03\x04") {
        Some(packed_format(head, path))
    } else if text.starts_with(b"<") {
        let markup = MARKUP.iter().find(|signature| holds(head, signature.0));
        match markup {
            Some(&(_, name, content)) => Some(FoundFormat::new(name, content)),
            None if text.starts_with(b"<?xml") => {
                Some(FoundFormat::new("an XML file", FileContent::Mesh))
            }
            None => None,
        }
    } else if reader.reads_mesh() {
        mesh_format(head, length)
    } else {
        None
    }
}

/// Returns the format of a ZIP archive.
fn packed_format(head: &[u8], path: &Path) -> FoundFormat {
    let packed = [FileContent::Spreadsheet, FileContent::Features, FileContent::Numbers];
    match by_extension(path) {
        Some(format) if packed.contains(&format.content) => format,
        _ if holds(head, b"xl/") => FoundFormat::new("an Excel workbook", FileContent::Spreadsheet),
        _ if holds(head, b"opendocument.spreadsheet") => {
            FoundFormat::new("an OpenDocument spreadsheet", FileContent::Spreadsheet)
        }
        _ if holds(head, b".kml") => FoundFormat::new("a KMZ file", FileContent::Features),
        _ => FoundFormat::new("a ZIP archive", FileContent::Archive),
    }
}

/// Returns the format of a mesh whose first bytes have no fixed words.
fn mesh_format(head: &[u8], length: u64) -> Option<FoundFormat> {
    // 80 bytes of text, the number of triangles, and 50 bytes for each.
    let count = head.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let is_binary_stl =
        count.is_some_and(|count| count > 0 && length == 84 + 50 * u64::from(count));
    let is_3ds = head.starts_with(b"MM")
        && head.get(2..6).and_then(|size| size.try_into().ok()).map(u32::from_le_bytes)
            == u32::try_from(length).ok();
    let text = head.trim_ascii_start();
    if is_binary_stl || (text.starts_with(b"solid") && holds(head, b"facet")) {
        Some(FoundFormat::new("an STL file", FileContent::Stl))
    } else if is_3ds {
        Some(FoundFormat::new("a 3DS file", FileContent::Mesh))
    } else if text.starts_with(b"{") && holds(head, b"\"asset\"") {
        Some(FoundFormat::new("a glTF file", FileContent::Gltf))
    } else if text.starts_with(b"{") {
        Some(FoundFormat::new("a JSON file", FileContent::Mesh))
    } else if text.starts_with(b"0") && holds(head, b"SECTION") {
        Some(FoundFormat::new("a DXF file", FileContent::Drawing))
    } else if is_obj(head) {
        Some(FoundFormat::new("a Wavefront OBJ file", FileContent::Obj))
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
pub(super) fn by_extension(path: &Path) -> Option<FoundFormat> {
    let extension = path.extension()?.to_str()?.to_ascii_lowercase();
    let (name, content) = match extension.as_str() {
        "ply" => ("a PLY file", FileContent::Ply),
        "stl" => ("an STL file", FileContent::Stl),
        "fbx" => ("an FBX file", FileContent::Mesh),
        "dae" => ("a COLLADA file", FileContent::Mesh),
        "3ds" => ("a 3DS file", FileContent::Mesh),
        "max" => ("a 3ds Max file", FileContent::Mesh),
        "c4d" => ("a Cinema 4D file", FileContent::Mesh),
        "blend" => ("a Blender file", FileContent::Mesh),
        "skp" => ("a SketchUp file", FileContent::Mesh),
        "spm" | "srt" => ("a SpeedTree file", FileContent::Mesh),
        "usd" | "usda" | "usdc" | "usdz" => ("a USD file", FileContent::Mesh),
        "x3d" => ("an X3D file", FileContent::Mesh),
        "wrl" => ("a VRML file", FileContent::Mesh),
        "off" => ("an OFF file", FileContent::Mesh),
        "dxf" => ("a DXF file", FileContent::Drawing),
        "dwg" => ("a DWG file", FileContent::Drawing),
        "obj" => ("a Wavefront OBJ file", FileContent::Obj),
        "mtl" => ("a material library of an OBJ file", FileContent::MaterialLibrary),
        "gltf" | "glb" => ("a glTF file", FileContent::Gltf),
        "csv" | "def" => ("a table of discs", FileContent::DiscTable),
        "las" | "laz" => ("a LAS or LAZ point cloud", FileContent::PointCloud),
        "e57" => ("an E57 point cloud", FileContent::PointCloud),
        "pcd" => ("a PCD point cloud", FileContent::PointCloud),
        "xyz" => ("a point cloud", FileContent::PointCloud),
        "shp" => ("an Esri shapefile", FileContent::Features),
        "shx" => ("the index of an Esri shapefile", FileContent::Attributes),
        "dbf" => ("a dBASE table", FileContent::Attributes),
        "gpkg" => ("a GeoPackage", FileContent::Features),
        "kmz" => ("a KMZ file", FileContent::Features),
        "kml" => ("a KML file", FileContent::Features),
        "tab" | "mif" | "map" => ("a MapInfo file", FileContent::Features),
        "xlsx" | "xlsm" | "xlsb" | "xls" => ("an Excel workbook", FileContent::Spreadsheet),
        "ods" => ("an OpenDocument spreadsheet", FileContent::Spreadsheet),
        "numbers" => ("a Numbers spreadsheet", FileContent::Spreadsheet),
        "mat" => ("a MATLAB file", FileContent::Numbers),
        "rds" | "rdata" | "sav" | "npz" => ("a file of a statistics program", FileContent::Numbers),
        "gz" => ("a gzip archive", FileContent::Archive),
        "zip" => ("a ZIP archive", FileContent::Archive),
        "7z" => ("a 7z archive", FileContent::Archive),
        "rar" => ("a RAR archive", FileContent::Archive),
        _ => return None,
    };
    Some(FoundFormat::new(name, content))
}
