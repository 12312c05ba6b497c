//! Polygons of stands, plots and clearings.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use geojson::{Feature, FeatureCollection, GeoJson, Geometry, GeometryValue, JsonObject, Position};
use glam::DVec2;

use super::AssetError;
use super::crs::{Axes, Crs, TargetSystem, from_name};
use super::format::{self, FileReader};
use super::table::{Table, known_columns, missing};
use super::text;
use crate::geometry::Polygon;

/// Largest GeoJSON file, bytes: corners take some thirty each.
const MOST_BYTES: u64 = 1 << 27;

/// Columns of a table of polygons.
const COLUMNS: [&str; 4] = ["x_m", "y_m", "ring", "hole"];

/// An area that is no wider than this and whose coordinates may be degrees is taken to be in degrees:
/// 2 m are no stand.
const NARROWEST: f64 = 2.0;

/// Polygons and the coordinate reference system of their corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Areas {
    /// The polygons in the file's order.
    pub polygons: Vec<Polygon>,
    /// The system, if the file names it.
    pub crs: Option<Crs>,
}

/// All polygons of a GeoJSON file in metres, in its order; the third coordinate is left out.
///
/// # Errors
/// A file that cannot be read, is no GeoJSON, holds no polygon or anything without an area; a ring of
/// less than three corners; coordinates in degrees, by the file's `crs` or, without one, by their
/// range; coordinates in another unit than metres.
pub fn read_geojson(path: &Path) -> Result<Areas, AssetError> {
    let file = || path.to_owned();
    format::check(path, FileReader::GeoJson)?;
    let bytes = text::size(path)?;
    if bytes > MOST_BYTES {
        return Err(AssetError::TooLarge { file: file(), bytes, most: MOST_BYTES });
    }
    let bytes = text::read(path)?;
    // The mark that some programs write before UTF-8 text.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") || bytes.contains(&0) {
        return Err(AssetError::NotText { file: file(), line: 1, guess: "it looks like UTF-16" });
    }
    if !bytes.trim_ascii_start().starts_with(b"{") && path.extension().is_some_and(is_table) {
        let reason = "it is a text table: write `Table(file: ..)` in place of `GeoJson`".to_owned();
        return Err(AssetError::NotGeoJson { file: file(), reason });
    }
    let read = GeoJson::from_reader(bytes)
        .map_err(|error| AssetError::NotGeoJson { file: file(), reason: error.to_string() })?;
    let mut found = PolygonCollector { path, polygons: Vec::new() };
    let crs = match read {
        GeoJson::Geometry(geometry) => {
            found.geometry(&geometry)?;
            crs(geometry.foreign_members.as_ref())
        }
        GeoJson::Feature(feature) => {
            found.feature(&feature)?;
            crs(feature.foreign_members.as_ref())
        }
        GeoJson::FeatureCollection(FeatureCollection { features, foreign_members, .. }) => {
            features.iter().try_for_each(|feature| found.feature(feature))?;
            crs(foreign_members.as_ref())
        }
    };
    found.finish(crs.as_deref())
}

/// The coordinate reference system that GeoJSON had until 2008's version became RFC 7946.
fn crs(members: Option<&JsonObject>) -> Option<String> {
    let crs = members?.get("crs")?;
    let properties = crs.get("properties");
    let name =
        properties.and_then(|properties| properties.get("name")).and_then(|name| name.as_str());
    // Before 2008 it was the number itself: `{"type": "EPSG", "properties": {"code": 4326}}`.
    let code = properties.and_then(|properties| properties.get("code"));
    let code = code.map(|code| code.to_string().trim_matches('"').to_owned());
    name.map(str::to_owned).or(code).or_else(|| crs.as_str().map(str::to_owned))
}

struct PolygonCollector<'a> {
    path: &'a Path,
    polygons: Vec<Polygon>,
}

impl PolygonCollector<'_> {
    fn feature(&mut self, feature: &Feature) -> Result<(), AssetError> {
        feature.geometry.as_ref().map_or(Ok(()), |geometry| self.geometry(geometry))
    }

    fn geometry(&mut self, geometry: &Geometry) -> Result<(), AssetError> {
        match &geometry.value {
            GeometryValue::Polygon { coordinates } => self.polygon(coordinates),
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.iter().try_for_each(|polygon| self.polygon(polygon))
            }
            GeometryValue::GeometryCollection { geometries } => {
                geometries.iter().try_for_each(|geometry| self.geometry(geometry))
            }
            other => {
                let (file, found) = (self.path.to_owned(), other.type_name());
                Err(AssetError::NoArea { file, found })
            }
        }
    }

    fn polygon(&mut self, rings: &[Vec<Position>]) -> Result<(), AssetError> {
        let corner = |position: &Position| match *position.as_slice() {
            [x, y, ..] if x.is_finite() && y.is_finite() => Ok(DVec2::new(x, y)),
            _ => Err(AssetError::NotGeoJson {
                file: self.path.to_owned(),
                reason: format!("a position is {:?}, not two finite numbers", position.as_slice()),
            }),
        };
        let rings: Vec<Vec<DVec2>> = rings
            .iter()
            .map(|ring| ring.iter().map(corner).collect())
            .collect::<Result<_, AssetError>>()?;
        if !rings.is_empty() {
            self.polygons.push(Polygon { rings });
        }
        Ok(())
    }

    /// The polygons, if they are what they should be.
    fn finish(self, name: Option<&str>) -> Result<Areas, AssetError> {
        let polygons = checked(self.path, self.polygons)?;
        let corners = || polygons.iter().flat_map(|polygon| &polygon.rings).flatten();
        let low = corners().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = corners().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let file = || self.path.to_owned();
        let crs = name.map(|name| from_name(name).unwrap_or_else(|| Crs::named(name)));
        match crs.as_ref().map(|crs| &crs.axes) {
            Some(Axes::Degrees) => {
                return Err(in_degrees(file(), low, high));
            }
            Some(Axes::Metres | Axes::Unknown) => {}
            Some(axes) => {
                let system = name.unwrap_or_default().to_owned();
                let what = match axes {
                    Axes::Length(unit) => format!("the unit {}", unit.name),
                    Axes::World => "metres of a map of the world".to_owned(),
                    _ => "distances from the centre of the Earth".to_owned(),
                };
                let target = TargetSystem::of_map(axes, 0.5 * (low + high));
                return Err(AssetError::NotInMetres { file: file(), what, system, target });
            }
            None => {
                let globe = DVec2::new(180.0, 90.0);
                let is_in_degrees = low.cmpge(-globe).all()
                    && high.cmple(globe).all()
                    && (high - low).max_element() < NARROWEST;
                if is_in_degrees {
                    return Err(in_degrees(file(), low, high));
                }
            }
        }
        Ok(Areas { polygons, crs })
    }
}

/// Returns whether an ending is one of text tables.
fn is_table(ending: &OsStr) -> bool {
    ["csv", "tsv", "txt"].iter().any(|known| ending.eq_ignore_ascii_case(known))
}

fn in_degrees(file: PathBuf, low: DVec2, high: DVec2) -> AssetError {
    let target = TargetSystem::of_degrees(0.5 * (low + high));
    AssetError::InDegrees { file, x: low.x, y: low.y, target }
}

/// Polygons from a text table, in its order: columns `x_m` and `y_m`, and perhaps `ring` (another
/// number in the next row begins another ring) and `hole` (1 in rings that are holes of the outline
/// before them). A file without a header has the columns `x_m` and `y_m`.
///
/// # Errors
/// A file that cannot be read, is not text or holds no row; an unknown or missing column; a number
/// that is not finite; a hole before any outline; a ring of less than three corners.
pub fn read_polygons(path: &Path) -> Result<Vec<Polygon>, AssetError> {
    let mut table = Table::open(path)?;
    let line = table.first_line;
    let names = if table.has_header() {
        table.skip_header()?;
        table.first.clone()
    } else {
        COLUMNS[..2].iter().map(|&name| name.to_owned()).collect()
    };
    let columns = known_columns(&names, &COLUMNS, path, line)?;
    if let Some(column) = COLUMNS[..2].iter().find(|&name| !names.iter().any(|n| n == name)) {
        return Err(missing(column, &names, path, line));
    }
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut row = [0.0; COLUMNS.len()];
    let mut current = None;
    while let Some(line) = table.read_row(&columns, &mut row)? {
        let [x, y, ring, hole] = row;
        if current != Some((ring, hole)) {
            if hole == 0.0 {
                polygons.push(Polygon::default());
            }
            current = Some((ring, hole));
            match polygons.last_mut() {
                Some(polygon) => polygon.rings.push(Vec::new()),
                None => return Err(AssetError::HoleOfNothing { file: path.to_owned(), line }),
            }
        }
        if let Some(ring) = polygons.last_mut().and_then(|polygon| polygon.rings.last_mut()) {
            ring.push(DVec2::new(x, y));
        }
    }
    checked(path, polygons)
}

/// Polygons of which every ring encloses something.
fn checked(path: &Path, polygons: Vec<Polygon>) -> Result<Vec<Polygon>, AssetError> {
    if polygons.is_empty() {
        return Err(AssetError::NoPolygon { file: path.to_owned() });
    }
    for (ring, corners) in polygons.iter().flat_map(|polygon| &polygon.rings).enumerate() {
        let mut distinct: Vec<_> = corners.iter().map(|p| (p.x.to_bits(), p.y.to_bits())).collect();
        distinct.sort_unstable();
        distinct.dedup();
        if distinct.len() < 3 {
            let (file, found) = (path.to_owned(), distinct.len());
            return Err(AssetError::ShortRing { file, ring: ring + 1, found });
        }
    }
    Ok(polygons)
}
