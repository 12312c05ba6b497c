use crate::counts::counted;
use glam::DVec2;

use super::RasterExtent;

/// Error of a file that is no raster or none that can be used, with advice; lines count from 1.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum RasterError {
    #[error(
        "line {line}: {found:?} is no key of an ESRI ASCII grid; write ncols, nrows, xllcorner, yllcorner, cellsize and NODATA_value above the values"
    )]
    AsciiKey { line: usize, found: String },
    #[error("line {line}: {key} is {found:?}; write {wanted}")]
    AsciiValue { line: usize, key: String, found: String, wanted: &'static str },
    #[error(
        "line {line}: the value {found:?} is not a number; write a decimal point and no separators of thousands"
    )]
    AsciiNumber { line: usize, found: String },
    #[error("line {line}: a second {key}; keep one")]
    Repeated { line: usize, key: String },
    #[error("has no {key}; write it above the values, as in `{example}`")]
    AsciiMissing { key: &'static str, example: &'static str },
    #[error(
        "says {columns} x {rows} cells, but holds only {}; the file is cut off, or its header is wrong",
        counted(.found, "value")
    )]
    Short { columns: usize, rows: usize, found: usize },
    #[error(
        "line {line}: values go on after the {columns} x {rows} cells of its header; correct ncols and nrows"
    )]
    Long { line: usize, columns: usize, rows: usize },
    #[error("has {columns} x {rows} cells; write a header with at least one of each")]
    Empty { columns: u64, rows: u64 },
    #[error(
        "has {columns} x {rows} cells, more than {most}; cut it, or resample it to larger cells (gdal_translate -outsize)"
    )]
    TooMany { columns: u64, rows: u64, most: u64 },
    #[error(
        "its {columns} x {rows} cells of {} take {lack}; cut it to the scene, or resample it \
         to larger cells (gdal_translate -outsize)",
        counted(.layers, "band")
    )]
    Memory { columns: usize, rows: usize, layers: usize, lack: crate::memory::Lack },
    #[error(
        "says {columns} x {rows} cells, which take {needed} bytes, but the file has {found}; it is cut off, or its header is wrong"
    )]
    TooShort { columns: u64, rows: u64, needed: u64, found: u64 },
    #[error(
        "cell {column}, {row} (from 0 in the north-west) is infinite; write a number or the NODATA value"
    )]
    Infinite { column: usize, row: usize },
    #[error("cells are {width} x {height}; write sizes above 0")]
    BadCell { width: f64, height: f64 },
    #[error("is rotated or stored from south to north; warp it to north up first (gdalwarp)")]
    Rotated,
    #[error(
        "does not say where it lies, so that no window of it can be found; write its place into it \
         (gdal_translate -a_ullr), or leave `window` out"
    )]
    WindowOfNowhere,
    #[error(
        "has no cell in the window from ({}, {}) to ({}, {}): it reaches from ({}, {}) to ({}, {}); \
         a window is given in the local frame, which is the map less `frame.origin_m`",
        .window.min.x, .window.min.y, .window.max.x, .window.max.y, .min.x, .min.y, .max.x, .max.y
    )]
    WindowBeside { window: RasterExtent, min: DVec2, max: DVec2 },
    #[error("is {0}, which is not read; convert it: gdal_translate -of GTiff in out.tif")]
    Strange(&'static str),
    #[error(
        "holds binary values, and there is no header beside it that says how they lie; name an ENVI \
         header (`dem.hdr` for `dem.img`) or convert it: gdal_translate -of GTiff in out.tif"
    )]
    Binary,
    #[error("is no image of ENVI (values beside a header), GeoTIFF or EXR")]
    NoImage,
    #[error("is UTF-16 text; save it as UTF-8 (ASCII) text")]
    Utf16,
    #[error("cannot be read: {0}")]
    Unreadable(String),
    #[error("its metadata say that its {what} is {found:?}; write a number (gdal_edit.py)")]
    BadMetadata { what: &'static str, found: String },
    #[error(
        "says that its heights are in the unit {one}, and that their vertical system is in the unit \
         {other}; correct one of the two (gdal_edit.py -units, or -a_srs), or write \
         `height_unit_m` in the scene"
    )]
    TwoHeightUnits { one: String, other: String },
    #[error(
        "the projection beside it, {0:?}, is no well-known text; write it again (gdalsrsinfo -o \
         wkt1_esri EPSG:32633 > dem.prj), or take the file away"
    )]
    BadProjection(String),
    #[error("the world file beside it, {0:?}, does not hold six numbers; write it again")]
    BadWorld(String),

    #[error(
        "no header {0:?} beside it; an ENVI raster is two files, the values and a text that starts with ENVI"
    )]
    NoHeader(String),
    #[error("no values beside this header; tried {0}")]
    NoValues(String),
    #[error(
        "several files beside this header may hold its values: {0}; name the one that is meant"
    )]
    ManyValues(String),
    #[error("its header {header:?} {problem}")]
    Envi { header: String, problem: String },

    #[error("is no TIFF that can be read: {0}")]
    Tiff(String),
    #[error(
        "is a TIFF in a way that is not read: {0}; write it plainly (gdal_translate -co \
         COMPRESS=DEFLATE in.tif out.tif)"
    )]
    Unsupported(String),
    #[error("holds {0} values a pixel; write one band to a file of its own (gdal_translate -b 1)")]
    Bands(u16),
    #[error(
        "holds {0} values a pixel, the last of which is a mask; write the first band and the mask \
         (gdal_translate -b 1 -mask {0} --config GDAL_TIFF_INTERNAL_MASK YES)"
    )]
    BandsWithMask(u16),
    #[error("holds values of {0} bits; write whole bytes (gdal_translate -ot Byte -co NBITS=8)")]
    Bits(u16),
    #[error("the mask of its cells is no picture of {columns} x {rows} cells; write it again")]
    BadMask { columns: u64, rows: u64 },
}
