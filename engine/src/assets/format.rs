//! Readers of files, and advice for a file of another format than the reader reads.

use std::io::Read as _;
use std::path::Path;

use super::signatures::{by_content, by_extension, is_gltf, is_obj};
use super::{AssetError, text};

/// Number of bytes at the start of a file that tell its format.
const HEAD: u64 = 4096;

/// Reader of files, by its name in the scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileReader {
    Obj,
    Gltf,
    Ply,
    Discs,
    Table,
    GeoJson,
    Raster,
}

/// Kind of content: files with the same have the same advice for each reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FileContent {
    Obj,
    Gltf,
    Ply,
    /// Triangles without a unit and without parts.
    Stl,
    DiscTable,
    /// Materials of an OBJ file.
    MaterialLibrary,
    /// Mesh that only other programs read.
    Mesh,
    PointCloud,
    /// Drawing of a CAD program, in two or three dimensions.
    Drawing,
    /// Features of a geographic information system.
    Features,
    /// Attributes of such features, without their places.
    Attributes,
    Spreadsheet,
    /// Cells of values: a raster or an image.
    Cells,
    /// Table or arrays of a numerical program.
    Numbers,
    Archive,
    /// Text about data, in place of the data.
    Document,
}

impl FileContent {
    /// Returns whether only readers of meshes look for this content.
    fn is_of_mesh(self) -> bool {
        matches!(
            self,
            Self::Obj
                | Self::Gltf
                | Self::Ply
                | Self::Stl
                | Self::DiscTable
                | Self::MaterialLibrary
                | Self::Mesh
        )
    }
}

/// Format of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FoundFormat {
    /// Name with its article, as in `a PLY file`.
    pub(super) name: &'static str,
    pub(super) content: FileContent,
}

impl FileReader {
    fn name(self) -> &'static str {
        match self {
            Self::Obj => "Obj",
            Self::Gltf => "Gltf",
            Self::Ply => "Ply",
            Self::Discs => "Discs",
            Self::Table => "Table",
            Self::GeoJson => "GeoJson",
            Self::Raster => "Raster",
        }
    }

    fn formats(self) -> &'static str {
        match self {
            Self::Obj => "Wavefront OBJ",
            Self::Gltf => "glTF 2.0 and GLB",
            Self::Ply => "PLY",
            Self::Discs => "a table of discs (`radius,x,y,z,nx,ny,nz`)",
            Self::Table => "text tables (CSV)",
            Self::GeoJson => "GeoJSON",
            Self::Raster => "GeoTIFF, ENVI and ESRI grids",
        }
    }

    pub(super) fn reads_mesh(self) -> bool {
        matches!(self, Self::Obj | Self::Gltf | Self::Ply | Self::Discs)
    }

    fn reads(self, content: FileContent) -> bool {
        matches!(
            (self, content),
            (Self::Obj, FileContent::Obj)
                | (Self::Gltf, FileContent::Gltf)
                | (Self::Ply, FileContent::Ply)
                | (Self::Discs, FileContent::DiscTable)
                | (Self::Raster, FileContent::Cells)
        )
    }

    /// Advice for a file with other content, which has this name.
    fn advice(self, content: FileContent, file: &str) -> String {
        let text = match (content, self) {
            (FileContent::Obj, _) => "write `Obj` in place of what reads it now",
            (FileContent::Gltf, _) => "write `Gltf` in place of what reads it now",
            (FileContent::Ply, _) => "write `Ply` in place of what reads it now",
            (FileContent::Stl, _) => {
                "it says neither its unit nor its parts: convert it to PLY, with Blender or MeshLab, for example, and \
                 write `Ply` with the `unit_m` that you know and the `material` of all of it; leaves and wood need a \
                 file each, or an OBJ with groups"
            }
            (FileContent::DiscTable, _) => "write `Discs` in place of what reads it now",
            (FileContent::MaterialLibrary, _) => "name the OBJ file that it belongs to",
            (FileContent::PointCloud, Self::Obj | Self::Gltf | Self::Ply | Self::Discs) => {
                "convert the points to a mesh (OBJ or glTF), or to a table of discs for `Discs`"
            }
            (FileContent::Archive, Self::Obj | Self::Gltf | Self::Ply | Self::Discs) => {
                "unpack it and name the mesh file in it"
            }
            (FileContent::Document, _) => "get the file itself",
            (FileContent::Mesh, _)
            | (
                FileContent::Drawing | FileContent::Features | FileContent::Numbers,
                Self::Obj | Self::Gltf | Self::Ply | Self::Discs,
            ) => "convert it to OBJ, glTF or PLY, with Blender or MeshLab, for example",
            (_, Self::Obj | Self::Gltf | Self::Ply | Self::Discs) => "name the file of the mesh",
            (FileContent::Features | FileContent::Drawing, Self::GeoJson) => {
                return format!("convert it: `ogr2ogr polygons.geojson {file}`");
            }
            (FileContent::Features | FileContent::Drawing, Self::Table) => {
                return format!(
                    "convert points to CSV: `ogr2ogr -f CSV -lco GEOMETRY=AS_XY points.csv {file}`; polygons \
                     to GeoJSON, for `GeoJson(file: ..)`: `ogr2ogr polygons.geojson {file}`"
                );
            }
            (FileContent::Features | FileContent::Drawing, Self::Raster) => {
                "make a raster of it, with `gdal_rasterize`"
            }
            (FileContent::Attributes, Self::Table) => {
                return format!(
                    "export it as CSV: `ogr2ogr -f CSV table.csv {file}`; places are in the `.shp` beside it"
                );
            }
            (FileContent::Attributes, _) => {
                "name the file of features beside it, converted by `ogr2ogr`"
            }
            (FileContent::Spreadsheet, Self::Table) => {
                "save it as CSV (UTF-8) in the spreadsheet program, and name that"
            }
            (FileContent::Spreadsheet, Self::GeoJson) => {
                "save its corners as CSV (UTF-8), for `Table(file: ..)` in place of `GeoJson`"
            }
            (FileContent::Spreadsheet | FileContent::Numbers, Self::Raster) => {
                "export its cells as an ESRI ASCII grid or a GeoTIFF"
            }
            (FileContent::PointCloud, Self::Raster) => {
                "make a raster of its points, with `pdal` (`writers.gdal`) or LAStools"
            }
            (FileContent::PointCloud, _) => {
                "a table or an area holds trees or corners: export those as CSV or GeoJSON; a canopy height \
                 model of it is read by `CanopyHeights`"
            }
            (FileContent::Cells, _) => {
                "it is a raster: areas are polygons (`gdal_polygonize.py`), tables are text"
            }
            (FileContent::Archive, _) => "unpack it and name the file in it",
            (FileContent::Numbers, _) => "export it as a text table (CSV), in UTF-8",
        };
        text.to_owned()
    }
}

/// Refuses a file of a known format that a reader does not read.
///
/// The first bytes tell the format. If they do not, the extension does: for OBJ and glTF always, for tables of
/// discs never, for other data if the file is binary.
///
/// # Errors
/// [`AssetError::OtherFormat`], which names the format; a file that cannot be read.
pub(super) fn check(path: &Path, reader: FileReader) -> Result<(), AssetError> {
    let length = text::size(path)?;
    let mut head = Vec::new();
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    text::open(path)?.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&head);
    if (reader == FileReader::Obj && is_obj(head)) || (reader == FileReader::Gltf && is_gltf(head))
    {
        return Ok(());
    }
    let (format, is_by_name) = match by_content(head, length, path, reader) {
        Some(format) => (format, false),
        None if reader == FileReader::Discs => return Ok(()),
        None if reader.reads_mesh() || is_binary(head) => match by_extension(path) {
            Some(format) => (format, reader.reads_mesh()),
            None => return Ok(()),
        },
        None => return Ok(()),
    };
    let FoundFormat { name, content } = format;
    if reader.reads(content) || (!reader.reads_mesh() && content.is_of_mesh()) {
        return Ok(());
    }
    let file =
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    Err(AssetError::OtherFormat {
        file: path.to_owned(),
        found: if is_by_name { format!("{name}, by its name") } else { name.to_owned() },
        reader: reader.name(),
        wanted: reader.formats(),
        remedy: reader.advice(content, &file),
    })
}

/// Returns whether bytes are no text; UTF-16 is text, which its reader names.
fn is_binary(head: &[u8]) -> bool {
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    !is_utf16 && head.contains(&0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Message about a file of this name and content, from the format on.
    fn message(reader: FileReader, name: &str, head: &[u8]) -> Option<String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        std::fs::write(&path, head).expect("a file");
        let error = check(&path, reader).err()?.to_string();
        Some(
            error
                .split_once(&format!("{name}: "))
                .map_or(error.clone(), |(_, rest)| rest.to_owned()),
        )
    }

    #[test]
    fn formats_are_known_by_their_first_bytes_and_binary_files_by_their_extension() {
        use FileReader::{Discs, GeoJson, Gltf, Obj, Raster, Table};
        let binary = b"\x03\x7a\x01\x01\0\0".as_slice();
        for (reader, name, head, expected) in [
            (
                Table,
                "a",
                b"PK\x03\x04....xl/workbook.xml".as_slice(),
                Some("is an Excel workbook,"),
            ),
            (Table, "b.xlsx", b"PK\x03\x04....", Some("is an Excel workbook,")),
            (Table, "b.zip", b"PK\x03\x04....plot.shp", Some("is a ZIP archive,")),
            (GeoJson, "b", b"PK\x03\x04....doc.kml", Some("is a KMZ file,")),
            (Table, "trees.DBF", binary, Some("is a dBASE table,")),
            (GeoJson, "a.kml", b"<?xml version=\"1.0\"?>\n<kml xmlns=", Some("is a KML file,")),
            (Raster, "a.nc", b"CDF\x01....", None),
            (Raster, "a.las", b"LASF....", Some("is a LAS or LAZ point cloud,")),
            // Tables and GeoJSON are text, whatever their extension and first word.
            (Table, "trees.xls", b"x_m,y_m\n1,2\n", None),
            (Table, "trees.csv", b"COFFEE,DRACO\n1,2\n", None),
            (GeoJson, "plot.shp", b"{\"type\": \"Polygon\"}", None),
            (Table, "trees.xls", b"\xff\xfex\0,\0", None),
            (Table, "tree.glb", b"glTF\x02\0\0\0", None),
            (Obj, "tree.max", b"no mesh", Some("is a 3ds Max file, by its name,")),
            (Obj, "tree.obj", b"no mesh", None),
            (Obj, "plot.obj", b"\x00\x00\x27\x0a....", Some("is an Esri shapefile,")),
            (Gltf, "tree.gltf", b"solid a\nfacet normal", Some("is an STL file,")),
            (Discs, "discs.ply", b"radius,x\n", None),
            (Discs, "discs.csv", b"ply\nformat ascii 1.0\n", Some("is a PLY file,")),
        ] {
            let message = message(reader, name, head);
            let start =
                message.as_deref().map(|message| message.split(" and ").next().unwrap_or(""));
            assert_eq!(start, expected, "{name}");
        }
    }

    #[test]
    fn each_reader_says_what_it_can_be_given() {
        let shape = b"\x00\x00\x27\x0a....";
        assert_eq!(
            message(FileReader::GeoJson, "plot.shp", shape).as_deref(),
            Some(
                "is an Esri shapefile, and `GeoJson` reads GeoJSON; convert it: `ogr2ogr \
                 polygons.geojson plot.shp`"
            )
        );
        assert_eq!(
            message(FileReader::Gltf, "tree.glb", b"v 0 0 0\n").as_deref(),
            Some(
                "is a Wavefront OBJ file, and `Gltf` reads glTF 2.0 and GLB; write `Obj` in place of what \
                 reads it now"
            )
        );
    }
}
