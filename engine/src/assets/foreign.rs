//! Formats of files that are given in place of tables, polygons and rasters: recognised by their first
//! bytes, or by the ending of a binary file.

use std::io::Read as _;
use std::path::Path;

use super::{AssetError, text};

/// Bytes that are looked at.
const HEAD: u64 = 4096;

/// A reader of files, by its name in the scene language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reader {
    Table,
    GeoJson,
    Raster,
}

/// Kinds of formats that are converted alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Features of a geographic information system.
    Features,
    /// Attributes of such features, without their places.
    Attributes,
    Spreadsheet,
    Points,
    /// Cells of values.
    Cells,
    Archive,
    /// Something that holds no data.
    Document,
    /// A table of another kind, or an archive of numbers.
    Binary,
}

type Found = (&'static str, Kind);

impl Reader {
    fn name(self) -> &'static str {
        match self {
            Self::Table => "Table",
            Self::GeoJson => "GeoJson",
            Self::Raster => "Raster",
        }
    }

    fn reads(self) -> &'static str {
        match self {
            Self::Table => "text tables (CSV)",
            Self::GeoJson => "GeoJSON",
            Self::Raster => "GeoTIFF, ENVI and ESRI grids",
        }
    }

    /// Advice for a file of another format, which has this name.
    fn remedy(self, kind: Kind, file: &str) -> String {
        let text = match (kind, self) {
            (Kind::Features, Self::GeoJson) => {
                return format!("convert it: `ogr2ogr polygons.geojson {file}`");
            }
            (Kind::Features, Self::Table) => {
                return format!(
                    "convert points to CSV: `ogr2ogr -f CSV -lco GEOMETRY=AS_XY points.csv {file}`; polygons \
                     to GeoJSON, for `GeoJson(file: ..)`: `ogr2ogr polygons.geojson {file}`"
                );
            }
            (Kind::Features, Self::Raster) => "make a raster of it, with `gdal_rasterize`",
            (Kind::Attributes, Self::Table) => {
                return format!(
                    "export it as CSV: `ogr2ogr -f CSV table.csv {file}`; places are in the `.shp` beside it"
                );
            }
            (Kind::Attributes, _) => "name the file of features beside it, converted by `ogr2ogr`",
            (Kind::Spreadsheet, Self::Table) => {
                "save it as CSV (UTF-8) in the spreadsheet program, and name that"
            }
            (Kind::Spreadsheet, Self::GeoJson) => {
                "save its corners as CSV (UTF-8), for `Table(file: ..)` in place of `GeoJson`"
            }
            (Kind::Spreadsheet | Kind::Binary, Self::Raster) => {
                "export its cells as an ESRI ASCII grid or a GeoTIFF"
            }
            (Kind::Points, Self::Raster) => {
                "make a raster of its points, with `pdal` (`writers.gdal`) or LAStools"
            }
            (Kind::Points, _) => {
                "a table or an area holds trees or corners: export those as CSV or GeoJSON; a canopy height \
                 model of it is read by `CanopyHeights`"
            }
            (Kind::Cells, _) => {
                "it is a raster: areas are polygons (`gdal_polygonize.py`), tables are text"
            }
            (Kind::Archive, _) => "unpack it and name the file in it",
            (Kind::Document, _) => "get the file itself",
            (Kind::Binary, _) => "export it as a text table (CSV), in UTF-8",
        };
        text.to_owned()
    }
}

/// Refuses a file of a known format that this reader does not read.
///
/// # Errors
/// [`AssetError::OtherFormat`], which names the format; a file that cannot be read.
pub(super) fn check(path: &Path, reader: Reader) -> Result<(), AssetError> {
    let mut head = Vec::new();
    let unreadable = |cause| AssetError::Unreadable { file: path.to_owned(), cause };
    text::open(path)?.take(HEAD).read_to_end(&mut head).map_err(unreadable)?;
    let Some((found, kind)) = format_of(&head, path) else { return Ok(()) };
    if kind == Kind::Cells && reader == Reader::Raster {
        return Ok(());
    }
    let file =
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    Err(AssetError::OtherFormat {
        file: path.to_owned(),
        found: found.to_owned(),
        reader: reader.name(),
        wanted: reader.reads(),
        remedy: reader.remedy(kind, &file),
    })
}

fn format_of(head: &[u8], path: &Path) -> Option<Found> {
    const STARTS: [(&[u8], Found); 26] = [
        (b"\x00\x00\x27\x0a", ("an Esri shapefile", Kind::Features)),
        (b"SQLite format 3\0", ("a GeoPackage or another SQLite database", Kind::Features)),
        (b"fgb\x03", ("a FlatGeobuf file", Kind::Features)),
        (b"\xd0\xcf\x11\xe0", ("an Excel workbook", Kind::Spreadsheet)),
        (b"LASF", ("a LAS or LAZ point cloud", Kind::Points)),
        (b"ASTM-E57", ("an E57 point cloud", Kind::Points)),
        (b"# .PCD", ("a PCD point cloud", Kind::Points)),
        (b"ply\n", ("a PLY file", Kind::Points)),
        (b"ply\r", ("a PLY file", Kind::Points)),
        (b"II*\0", ("a TIFF image", Kind::Cells)),
        (b"MM\0*", ("a TIFF image", Kind::Cells)),
        (b"II+\0", ("a TIFF image", Kind::Cells)),
        (b"MM\0+", ("a TIFF image", Kind::Cells)),
        (b"\x89PNG", ("a PNG image", Kind::Cells)),
        (b"\xff\xd8\xff", ("a JPEG image", Kind::Cells)),
        (b"CDF\x01", ("a netCDF file", Kind::Cells)),
        (b"CDF\x02", ("a netCDF file", Kind::Cells)),
        (b"\x89HDF", ("an HDF5 or netCDF file", Kind::Cells)),
        (b"PAR1", ("a Parquet file", Kind::Binary)),
        (b"MATLAB", ("a MATLAB file", Kind::Binary)),
        (b"\x93NUMPY", ("a NumPy file", Kind::Binary)),
        (b"\x1f\x8b", ("a gzip archive", Kind::Archive)),
        (b"7z\xbc\xaf", ("a 7z archive", Kind::Archive)),
        (b"Rar!", ("a RAR archive", Kind::Archive)),
        (b"%PDF", ("a PDF file", Kind::Document)),
        (b"version https://git-lfs", ("a Git LFS pointer, not the file itself", Kind::Document)),
    ];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    if head.starts_with(b"PK\x03\x04") {
        return Some(packed_format(head, path));
    }
    if let Some((_, found)) = STARTS.iter().find(|(start, _)| head.starts_with(start)) {
        return Some(*found);
    }
    let text = head.trim_ascii_start();
    let holds = |words: &[u8]| head.windows(words.len()).any(|window| window == words);
    if text.starts_with(b"<") {
        if holds(b"<kml") {
            return Some(("a KML file", Kind::Features));
        } else if holds(b"gml") {
            return Some(("a GML file", Kind::Features));
        } else if holds(b"urn:schemas-microsoft-com:office:spreadsheet") {
            return Some(("an Excel workbook in XML", Kind::Spreadsheet));
        } else if holds(b"<html") || holds(b"<HTML") || text.starts_with(b"<!DOCTYPE") {
            return Some(("a web page", Kind::Document));
        }
        return None;
    }
    // A text may go by any ending; UTF-16 is told by who reads it.
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    if is_utf16 || !head.contains(&0) {
        return None;
    }
    by_ending(path)
}

/// The format of a ZIP archive.
fn packed_format(head: &[u8], path: &Path) -> Found {
    let holds = |words: &[u8]| head.windows(words.len()).any(|window| window == words);
    match by_ending(path) {
        Some(found) => found,
        None if holds(b"xl/") => ("an Excel workbook", Kind::Spreadsheet),
        None if holds(b"opendocument.spreadsheet") => {
            ("an OpenDocument spreadsheet", Kind::Spreadsheet)
        }
        None if holds(b".kml") => ("a KMZ file", Kind::Features),
        None => ("a ZIP archive", Kind::Archive),
    }
}

fn by_ending(path: &Path) -> Option<Found> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    Some(match ending.as_str() {
        "shp" => ("an Esri shapefile", Kind::Features),
        "shx" => ("the index of an Esri shapefile", Kind::Attributes),
        "dbf" => ("a dBASE table", Kind::Attributes),
        "gpkg" => ("a GeoPackage", Kind::Features),
        "kmz" => ("a KMZ file", Kind::Features),
        "kml" => ("a KML file", Kind::Features),
        "tab" | "mif" | "map" => ("a MapInfo file", Kind::Features),
        "dwg" | "dxf" => ("a drawing", Kind::Features),
        "xlsx" | "xlsm" | "xlsb" | "xls" => ("an Excel workbook", Kind::Spreadsheet),
        "ods" => ("an OpenDocument spreadsheet", Kind::Spreadsheet),
        "numbers" => ("a Numbers spreadsheet", Kind::Spreadsheet),
        "las" | "laz" => ("a LAS or LAZ point cloud", Kind::Points),
        "rds" | "rdata" | "sav" | "mat" | "npz" => ("a file of a statistics program", Kind::Binary),
        "zip" => ("a ZIP archive", Kind::Archive),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_known_by_their_first_bytes_and_binary_files_by_their_ending() {
        let found = |head: &[u8], name: &str| format_of(head, Path::new(name)).map(|found| found.0);
        assert_eq!(found(b"PK\x03\x04....xl/workbook.xml", "a"), Some("an Excel workbook"));
        assert_eq!(found(b"PK\x03\x04....", "b.xlsx"), Some("an Excel workbook"));
        assert_eq!(found(b"PK\x03\x04....plot.shp", "b.zip"), Some("a ZIP archive"));
        assert_eq!(found(b"PK\x03\x04....doc.kml", "b"), Some("a KMZ file"));
        assert_eq!(found(b"\x03\x7a\x01\x01\0\0", "trees.DBF"), Some("a dBASE table"));
        assert_eq!(found(b"<?xml version=\"1.0\"?>\n<kml xmlns=", "a.kml"), Some("a KML file"));
        // Tables and GeoJSON are text, whatever their ending.
        assert_eq!(found(b"x_m,y_m\n1,2\n", "trees.xls"), None);
        assert_eq!(found(b"{\"type\": \"Polygon\"}", "plot.shp"), None);
        assert_eq!(found(b"\xff\xfex\0,\0", "trees.xls"), None);
    }

    #[test]
    fn each_reader_is_told_what_it_can_be_given() {
        for kind in
            [Kind::Features, Kind::Attributes, Kind::Spreadsheet, Kind::Points, Kind::Archive]
        {
            for reader in [Reader::Table, Reader::GeoJson, Reader::Raster] {
                assert!(!reader.remedy(kind, "plot.shp").is_empty());
            }
        }
        let polygons = Reader::GeoJson.remedy(Kind::Features, "plot.shp");
        assert_eq!(polygons, "convert it: `ogr2ogr polygons.geojson plot.shp`");
    }
}
