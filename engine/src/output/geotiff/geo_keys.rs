//! Place of a raster on the ground and its coordinate reference system.
//!
//! Source: OGC `GeoTIFF` 1.1 (19-008r4).

use super::directory::{TagDirectory, TagValue, tag};
use crate::components::Projection;
use crate::products::Georeference;

/// Numbers of projected systems in the registry of EPSG.
const EPSG: std::ops::RangeInclusive<u32> = 1024..=32_766;
/// Stands for a system that its text defines.
const USER_DEFINED: u16 = 32_767;

/// Inserts the place of a raster, and its system if one is known.
pub(super) fn insert(
    place: Georeference,
    projection: Option<&Projection>,
    directory: &mut TagDirectory,
) {
    let scale = vec![place.pixel_width, place.pixel_height, 0.0];
    directory.insert(tag::MODEL_PIXEL_SCALE, TagValue::Doubles(scale));
    // The north-west corner of the raster.
    let corner = vec![0.0, 0.0, 0.0, place.west, place.north, 0.0];
    directory.insert(tag::MODEL_TIEPOINT, TagValue::Doubles(corner));
    let (code, citation) = match projection {
        Some(Projection { epsg: Some(epsg), .. }) if EPSG.contains(epsg) => (*epsg as u16, None),
        // Names of systems as Esri writes them, which GDAL reads.
        Some(Projection { wkt: Some(wkt), .. }) => {
            let words: Vec<_> = wkt.split_whitespace().collect();
            (USER_DEFINED, Some(format!("ESRI PE String = {}|", words.join(" ").replace('|', "_"))))
        }
        _ => return,
    };
    // GTModelType: projected; GTRasterType: pixels are areas; ProjectedCRS; unit: metres.
    let mut keys = vec![[1024, 0, 1, 1], [1025, 0, 1, 1], [3072, 0, 1, code]];
    if let Some(citation) = &citation {
        keys.push([3073, tag::GEO_ASCII_PARAMS, citation.len() as u16, 0]);
    }
    keys.push([3076, 0, 1, 9001]);
    let header = [1, 1, 0, keys.len() as u16];
    let numbers = std::iter::once(header).chain(keys).flatten().collect();
    directory.insert(tag::GEO_KEY_DIRECTORY, TagValue::Shorts(numbers));
    if let Some(citation) = citation {
        directory.insert(tag::GEO_ASCII_PARAMS, TagValue::Ascii(citation));
    }
}
