/// Why a file is not a raster that can be used, and what to do about it. Lines count from 1.
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
        "says {columns} x {rows} cells, but holds only {found} values; the file is cut off, or its header is wrong"
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
        "says {columns} x {rows} cells, which take {needed} bytes, but the file has {found}; it is cut off, or its header is wrong"
    )]
    TooShort { columns: u64, rows: u64, needed: u64, found: u64 },
    #[error(
        "cell {column}, {row} (from 0 in the north-west) is infinite; write a number or the NODATA value"
    )]
    Infinite { column: usize, row: usize },
    #[error("cells are {width} x {height}; write sizes above 0")]
    BadCell { width: f64, height: f64 },
    #[error("is rotated; warp it to north up first (gdalwarp)")]
    Rotated,

    #[error(
        "no header {0:?} beside it; an ENVI raster is two files, the values and a text that starts with ENVI"
    )]
    NoHeader(String),
    #[error("no values beside this header; tried {0}")]
    NoValues(String),
    #[error("its header {header:?} {problem}")]
    Envi { header: String, problem: String },

    #[error("is no TIFF that can be read: {0}")]
    Tiff(String),
    #[error("holds {0} values a pixel; write one band to a file of its own (gdal_translate -b 1)")]
    Bands(u16),
    #[error("holds values of {0} bits; write whole bytes (gdal_translate -ot Byte -co NBITS=8)")]
    Bits(u16),
}
