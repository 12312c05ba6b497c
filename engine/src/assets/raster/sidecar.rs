//! Files beside a raster that say more about it.

use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec2;

use super::super::crs::{Crs, from_name};
use super::metadata::BandMetadata;
use super::names::{VALUES, headers, named, split, values, without};
use super::{RasterError, RasterGeoreference};
use crate::files;

/// Longest of them, bytes.
const LONGEST: u64 = 1 << 22;

fn text(path: &Path) -> Option<String> {
    let mut bytes = Vec::new();
    files::open(path).ok()?.take(LONGEST).read_to_end(&mut bytes).ok()?;
    Some(String::from_utf8_lossy(&bytes).trim_start_matches('\u{feff}').to_owned())
}

/// The file beside a raster whose name ends in another way.
fn beside(path: &Path, ending: &str) -> Option<PathBuf> {
    let (folder, name) = split(path);
    let stem = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    named(folder, &format!("{stem}.{ending}")).into_iter().next()
}

fn appended(path: &Path, ending: &str) -> Option<PathBuf> {
    let (folder, name) = split(path);
    named(folder, &format!("{name}.{ending}")).into_iter().next()
}

/// The system that the `.prj` beside a file names.
pub(super) fn projection(path: &Path) -> Result<Option<Crs>, RasterError> {
    let Some(file) = beside(path, "prj") else { return Ok(None) };
    let content = text(&file).unwrap_or_default();
    if content.trim().is_empty() {
        return Ok(None);
    }
    let name = split(&file).1;
    if let Some(crs) = from_name(&content) {
        return Ok(Some(crs));
    }
    arc_info(&content).ok_or(RasterError::BadProjection(name)).map(Some)
}

/// A `.prj` as ARC/INFO wrote it: lines of a key and a value.
fn arc_info(content: &str) -> Option<Crs> {
    use super::super::crs::{Axes, Length, UtmZone};
    let value = |key: &str| {
        let line = content.lines().find(|line| {
            line.split_whitespace().next().is_some_and(|word| word.eq_ignore_ascii_case(key))
        })?;
        Some(line.split_whitespace().skip(1).collect::<Vec<_>>().join(" ").to_uppercase())
    };
    let projection = value("Projection")?;
    let datum = value("Datum");
    if projection.starts_with("GEOGRAPHIC") {
        return Some(Crs { axes: Axes::Degrees, ..Crs::named("geographic coordinates") });
    }
    let zone = value("Zone").and_then(|zone| zone.parse::<i8>().ok()).filter(|zone| *zone != 0);
    let mut crs = match zone {
        Some(zone) if projection == "UTM" && zone.unsigned_abs() <= 60 => {
            let is_south =
                zone < 0 || value("Yshift").is_some_and(|shift| shift.starts_with("1000"));
            let zone = UtmZone { number: zone.unsigned_abs(), is_south };
            Crs::of_utm(zone, datum.as_deref())
        }
        _ => Crs::named(projection),
    };
    crs.axes = match value("Units").as_deref() {
        None | Some("METERS" | "METRES") => Axes::Metres,
        Some("DD" | "DS" | "DMS") => Axes::Degrees,
        Some("FEET") => Axes::Length(Length { name: "foot".to_owned(), metres: 0.3048 }),
        Some(unit) => Length::from_name(unit).map_or(Axes::Unknown, Axes::Length),
    };
    Some(crs)
}

/// Reads what the `.aux.xml` beside a file says of a band, which is counted from 0, and of the file.
pub(super) fn auxiliary(
    path: &Path,
    band: usize,
) -> Result<(BandMetadata, Option<Crs>), RasterError> {
    match appended(path, "aux.xml").and_then(|file| text(&file)) {
        Some(text) => BandMetadata::from_auxiliary(&text, band),
        None => Ok((BandMetadata::default(), None)),
    }
}

/// The mask of a `GeoTIFF` in a file of its own.
pub(super) fn mask(path: &Path) -> Option<PathBuf> {
    appended(path, "msk")
}

/// Reads the georeference of a picture from its world file: `dem.tfw`, `dem.tifw` or `dem.wld`.
pub(super) fn world(path: &Path, rows: f64) -> Result<Option<RasterGeoreference>, RasterError> {
    let found = ["tfw", "tifw", "tiffw", "wld"].into_iter().find_map(|ending| beside(path, ending));
    let Some(file) = found else { return Ok(None) };
    let content = text(&file).unwrap_or_default();
    let numbers: Vec<f64> =
        content.split_whitespace().map_while(|word| word.parse().ok()).collect();
    let &[width, turn, tilt, height, x, y] = numbers.as_slice() else {
        return Err(RasterError::BadWorld(split(&file).1));
    };
    if turn != 0.0 || tilt != 0.0 || height >= 0.0 || width <= 0.0 {
        return Err(RasterError::Rotated);
    }
    // The last two numbers are the centre of the first cell.
    let cell = DVec2::new(width, -height);
    let corner = DVec2::new(x - 0.5 * cell.x, y + 0.5 * cell.y - rows * cell.y);
    let crs = projection(path)?.unwrap_or_else(|| Crs::named(""));
    Ok(Some(RasterGeoreference { corner, cell, crs, projection: None }))
}

/// Files that belong to a raster, for lists of the files of a scene.
#[must_use]
pub(crate) fn companions(path: &Path) -> Vec<PathBuf> {
    let (_, name) = split(path);
    let mut found: Vec<PathBuf> = if without(&name, "hdr").is_some() {
        values(path).0
    } else if VALUES.iter().any(|ending| without(&name, ending).is_some()) || !name.contains('.') {
        headers(path)
    } else {
        Vec::new()
    };
    found.extend(beside(path, "prj"));
    found.extend(["aux.xml", "msk", "hdr"].into_iter().filter_map(|ending| appended(path, ending)));
    if without(&name, "tif").or(without(&name, "tiff")).is_some() {
        let endings = ["tfw", "tifw", "tiffw", "wld"];
        found.extend(endings.into_iter().find_map(|ending| beside(path, ending)));
    }
    let mut kept: Vec<PathBuf> = Vec::new();
    for file in found {
        if file != path && !kept.contains(&file) {
            kept.push(file);
        }
    }
    kept
}
