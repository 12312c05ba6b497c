//! Formats that are not read, so that the error names them.

use super::RasterError;

/// Formats by their first bytes, with what they are.
const FORMATS: [(&[u8], &str); 14] = [
    (b"EHFA_HEADER_TAG", "an ERDAS Imagine file"),
    (b"\x89HDF", "an HDF5 or netCDF file"),
    (b"CDF\x01", "a netCDF file"),
    (b"CDF\x02", "a netCDF file"),
    (b"CDF\x05", "a netCDF file"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"\x00\x00\x00\x0cjP", "a JPEG 2000 file"),
    (b"GRIB", "a GRIB file"),
    (b"<VRTDataset", "a virtual raster (VRT)"),
    (b"DSAA", "a Surfer grid"),
    (b"DSBB", "a Surfer grid"),
    (b"DSRB", "a Surfer grid"),
    (b"SQLite format 3", "a GeoPackage"),
];

/// The error about a file of another format; `None` if it may be one that is read.
pub(super) fn format_of(start: &[u8]) -> Option<RasterError> {
    if let Some((_, name)) = FORMATS.iter().find(|(magic, _)| start.starts_with(magic)) {
        return Some(RasterError::Strange(name));
    }
    if start.starts_with(b"\xff\xfe") || start.starts_with(b"\xfe\xff") {
        return Some(RasterError::Utf16);
    }
    let text = std::str::from_utf8(start).unwrap_or_default().trim_start_matches('\u{feff}');
    let is_grass = text.trim_start().to_ascii_lowercase().starts_with("north:");
    is_grass.then_some(RasterError::Strange("a GRASS ASCII grid"))
}

/// Returns whether a file is no text.
pub(super) fn is_binary(start: &[u8]) -> bool {
    start.iter().any(|&byte| byte < 0x20 && !byte.is_ascii_whitespace() && byte != 0x1a)
}
