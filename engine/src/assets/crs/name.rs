//! Systems by name, as GeoJSON, scenes and well-known text write it.

use super::{Axes, Crs, Heights, from_code, from_wkt};

/// The system of a name: `EPSG:32632`, `EPSG:32632+5783`, `urn:ogc:def:crs:EPSG::32632`,
/// `http://www.opengis.net/def/crs/EPSG/0/32632`, `urn:ogc:def:crs:OGC:1.3:CRS84`, `ESRI:102003`, a
/// bare number, or well-known text.
///
/// `None` if the name says nothing that is known.
pub(crate) fn from_name(text: &str) -> Option<Crs> {
    let text = text.trim();
    if text.contains('[') {
        return from_wkt(text);
    }
    // `urn:ogc:def:crs,crs:EPSG::26910,crs:EPSG::5703`.
    if let Some((first, second)) =
        text.strip_prefix("urn:ogc:def:crs,").and_then(|t| t.split_once(','))
    {
        let heights: Option<Heights> = from_name(second)?.heights;
        return Some(Crs { heights, ..from_name(first)? });
    }
    // `EPSG:4326`, `EPSG::4326`, `EPSG/0/4326`: the last item is the code.
    let last = text.rsplit([':', '/', '#', ' ']).next()?;
    let upper = last.to_ascii_uppercase();
    if matches!(upper.as_str(), "CRS84" | "CRS83" | "CRS27" | "CRS84H") {
        return Some(Crs { axes: Axes::Degrees, ..Crs::named(format!("OGC:{upper}")) });
    }
    let (horizontal, vertical) = match last.split_once('+') {
        Some((horizontal, vertical)) => (horizontal, Some(vertical)),
        None => (last, None),
    };
    if let Some(mut crs) = horizontal.parse().ok().and_then(from_code) {
        if let Some(vertical) = vertical.and_then(|text| text.parse().ok()).and_then(from_code) {
            crs.heights = vertical.heights;
        }
        return Some(crs);
    }
    None
}
