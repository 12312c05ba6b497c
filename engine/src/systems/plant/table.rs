use glam::{DVec2, Vec3Swizzles as _};

use super::{HeightBase, Site, plant_rows};
use crate::assets::{StemRow, StemTable, degrees_to_metres, read_instances};
use crate::components::{Placement, PrototypeId};
use crate::counts::{agreeing, counted};
use crate::document::{
    Diagnostic, InstanceTable, Instances, ScenePath, SpeciesMeshes, TableCoordinates, suggestion,
};
use crate::geometry::place_text;

/// A plant's diameter below this part of its height is that of its stem, not of its crown.
const STEM_TO_HEIGHT: f64 = 0.05;

/// A plant that a diameter makes smaller than this part of its mesh was not meant.
const SMALLEST: f64 = 0.1;

/// Rows from which on places in a table that lie within [`NARROW_M`] are doubtful.
const FEWEST_ROWS: usize = 5;
/// Extent of a stand in degrees, where a plot of 1 km has 0.01.
const NARROW_M: f64 = 0.1;

/// Species that an error names.
const MOST_NAMED: usize = 10;

/// A mesh that rows may stand for, and its size, m.
#[derive(Clone, Copy)]
struct Kind {
    prototype: PrototypeId,
    /// Highest point above the origin.
    top: f64,
    /// Mean of the extents to the east and to the north.
    width: f64,
}

/// Instances of a table.
pub(super) fn plant_table(instances: &Instances, site: &mut Site<'_>) -> Vec<Placement> {
    let Instances::Table(InstanceTable { file, of, columns, on_terrain, coordinates, .. }) =
        instances
    else {
        return Vec::new();
    };
    let at = site.path.key("file");
    let table = match read_instances(&site.resources.file(file), columns.as_deref()) {
        Ok(table) => table,
        Err(error) => {
            site.report(Diagnostic::error(at, error.to_string()));
            return Vec::new();
        }
    };
    report_unused_columns(&table, of, file, &at, site);
    let Some(kinds) = kinds(&table, of, file, site) else { return Vec::new() };
    let base = match (on_terrain, table.has_heights) {
        (true, _) => HeightBase::Ground,
        (false, true) => HeightBase::Frame,
        (false, false) => HeightBase::GroundIfAny,
    };
    let mut rows = table.rows;
    let is_of_map = match coordinates {
        Some(TableCoordinates::Map) => true,
        Some(TableCoordinates::Local) => false,
        None => match guess_coordinates(&rows, file, &at, site) {
            Some(is_of_map) => is_of_map,
            None => return Vec::new(),
        },
    };
    warn_degrees(&rows, file, &at, site);
    if is_of_map {
        move_from_map(&mut rows, base, site);
    }
    let mut prototypes = Vec::with_capacity(rows.len());
    for row in &mut rows {
        let kind = kinds[row.species.map_or(0, |species| species as usize).min(kinds.len() - 1)];
        prototypes.push(kind.prototype);
        if let Err(problem) = scale(row, &kind, table.diameter_is_of_crown, file) {
            site.report(problem.with_path(&at));
            return Vec::new();
        }
    }
    plant_rows(instances, &rows, &prototypes, base, site)
}

/// Advice to convert degrees to the projection of the scene.
fn to_metres(site: &Site<'_>) -> String {
    let code = site.map.crs.as_ref().and_then(|system| system.crs.code).unwrap_or(32632);
    format!(
        "convert them to the projection of the scene, in metres: {}, and call its columns `x_m` and `y_m`",
        degrees_to_metres(code, ["x_m", "y_m"])
    )
}

/// Returns whether all places of rows could be longitudes and latitudes of one stand.
fn may_be_degrees(rows: &[StemRow]) -> bool {
    let places = || rows.iter().map(|row| row.position.truncate());
    let (low, high) = (
        places().fold(DVec2::INFINITY, DVec2::min),
        places().fold(DVec2::NEG_INFINITY, DVec2::max),
    );
    let is_of_earth =
        low.cmpge(DVec2::new(-180.0, -90.0)).all() && high.cmple(DVec2::new(180.0, 90.0)).all();
    is_of_earth && (high - low).max_element() < 10.0 * NARROW_M
}

/// Warns of rows that lie so near to each other that their coordinates may be degrees.
fn warn_degrees(rows: &[StemRow], file: &str, path: &ScenePath, site: &mut Site<'_>) {
    let places = || rows.iter().map(|row| row.position.truncate());
    let Some(first) = places().next() else { return };
    let (low, high) = places().fold((first, first), |(a, b), p| (a.min(p), b.max(p)));
    let span = (high - low).max_element();
    let is_of_earth =
        low.cmpge(DVec2::new(-180.0, -90.0)).all() && high.cmple(DVec2::new(180.0, 90.0)).all();
    if rows.len() < FEWEST_ROWS || span >= NARROW_M || span == 0.0 || !is_of_earth {
        return;
    }
    let message = format!(
        "{file}: all {} rows stand within {span:.4} m, about ({:.4}, {:.4})",
        rows.len(),
        low.x,
        low.y
    );
    let help = format!("if these are longitudes and latitudes, {}", to_metres(site));
    site.report(Diagnostic::warning(path, message).help(help));
}

/// Notes columns that have no meaning, and warns of those that may be misspelt.
fn report_unused_columns(
    table: &StemTable,
    of: &SpeciesMeshes,
    file: &str,
    path: &ScenePath,
    site: &mut Site<'_>,
) {
    for (name, meant) in &table.misspelt {
        let message = format!("{file}: the column `{name}` is let be");
        let help = format!("if it is `{meant}`, call it so, in that unit");
        site.report(Diagnostic::warning(path, message).help(help));
    }
    let mut left_out = table.left_out.clone();
    if !table.species.is_empty() && matches!(of, SpeciesMeshes::One(_)) {
        left_out.push("species".to_owned());
    }
    if !left_out.is_empty() {
        let names: Vec<String> = left_out.iter().map(|name| format!("`{name}`")).collect();
        let note = format!("{file}: columns that are let be: {}", names.join(", "));
        site.resources.messages.note(note);
    }
}

/// Mesh of each species of a table, or the one mesh of all.
fn kinds(
    table: &StemTable,
    of: &SpeciesMeshes,
    file: &str,
    site: &mut Site<'_>,
) -> Option<Vec<Kind>> {
    let at = site.path.key("of");
    let named = match of {
        SpeciesMeshes::One(mesh) => return Some(vec![kind(mesh, table, &at, site)?]),
        SpeciesMeshes::BySpecies(named) => named,
    };
    if table.species.is_empty() {
        let message = format!("{file} has no column `species`, which `of` needs");
        let help = "name one mesh for all: `of: \"tree\"`, or the column in `columns`";
        site.report(Diagnostic::error(at, message).help(help));
        return None;
    }
    let known: Vec<&str> = named.keys().map(String::as_str).collect();
    let unknown: Vec<(u32, &String)> = (0..)
        .zip(&table.species)
        .filter(|(_, species)| !named.contains_key(species.as_str()))
        .collect();
    if let Some(&(first, name)) = unknown.first() {
        let line = table.rows.iter().find(|row| row.species == Some(first));
        let line = line.map_or(0, |row| row.line);
        let names = unknown.iter().take(MOST_NAMED).map(|(_, name)| format!("`{name}`"));
        let more = if unknown.len() > MOST_NAMED { ", .." } else { "" };
        let message = format!(
            "{file}:{line}: no mesh for the species {}{more}",
            names.collect::<Vec<_>>().join(", ")
        );
        let help = suggestion(name, &known, "`of` has a mesh for");
        site.report(Diagnostic::error(at, message).help(help));
        return None;
    }
    let kinds = table.species.iter().map(|species| {
        let mesh = named.get(species.as_str())?;
        kind(mesh, table, &at.name(species), site)
    });
    kinds.collect()
}

fn kind(mesh: &str, table: &StemTable, path: &ScenePath, site: &mut Site<'_>) -> Option<Kind> {
    let prototype = site.resources.prototype(mesh, path)?;
    let has = |size: fn(&StemRow) -> Option<f64>| table.rows.iter().any(|row| size(row).is_some());
    // A hidden mesh is not loaded, and its size not needed.
    let Some(shape) = site.shapes.get(&prototype.0) else {
        return Some(Kind { prototype, top: 1.0, width: 1.0 });
    };
    let (low, high) = shape.bounds.map(|box_| (box_.low, box_.high)).unwrap_or_default();
    let extent = (high - low).xy().as_dvec2();
    let kind = Kind { prototype, top: high.z.into(), width: 0.5 * (extent.x + extent.y) };
    let unscaled = [
        (has(|row| row.height) && kind.top <= 0.0, "does not rise above its origin", "`height_m`"),
        (has(|row| row.diameter) && kind.width <= 0.0, "has no width", "the diameter"),
    ];
    for (_, what, column) in unscaled.into_iter().filter(|(is_so, ..)| *is_so) {
        let message = format!("`{mesh}` {what}: {column} of the table cannot scale it");
        let help = "add `origin: BaseCenter` to the mesh if it lies below its origin";
        site.report(Diagnostic::warning(path, message).help(help));
    }
    Some(kind)
}

/// Returns whether coordinates are those of the map rather than the scene's: whichever lies on the terrain.
fn guess_coordinates(
    rows: &[StemRow],
    file: &str,
    path: &ScenePath,
    site: &mut Site<'_>,
) -> Option<bool> {
    let Some(ground) = site.ground else { return Some(false) };
    let map = site.transform();
    let is_same = |place: DVec2| (map.apply(place) - place).abs().max_element() < 1e-3;
    if is_same(DVec2::ZERO) && is_same(DVec2::splat(1000.0)) {
        return Some(false);
    }
    let (low, high) = (ground.corner(), ground.corner() + ground.size());
    let room = 1e-6 * ground.size();
    let is_on = |place: DVec2| place.cmpge(low - room).all() && place.cmple(high + room).all();
    let places = || rows.iter().map(|row| row.position.truncate());
    let local = places().filter(|place| is_on(*place)).count();
    let mapped = places().filter(|place| is_on(map.apply(*place))).count();
    let (message, help) = match (local > 0, mapped > 0) {
        (true, false) => return Some(false),
        (false, true) => {
            let note = "the coordinates are those of the map, less `frame.origin_m`";
            site.resources.messages.note(format!("{file}: {note} (write `coordinates: Map`)"));
            return Some(true);
        }
        (true, true) => (
            format!(
                "{file}: {local} of {} {} on the terrain as written, {mapped} if `frame.origin_m` is subtracted",
                counted(rows.len(), "row"),
                agreeing(local, "lies", "lie")
            ),
            "write `coordinates: Local` if they are those of the scene, `coordinates: Map` if they \
                 are those of the map"
                .to_owned(),
        ),
        (false, false) => {
            let first = places().next().unwrap_or_default();
            let other = map.apply(first);
            (
                format!(
                    "{file}: no row lies on the terrain: the first is at {} m as it is written, at {} m \
                         less `frame.origin_m`, and the terrain reaches from {} to {} m",
                    place_text(first),
                    place_text(other),
                    place_text(low),
                    place_text(high)
                ),
                if may_be_degrees(rows) {
                    format!("they look like longitudes and latitudes: {}", to_metres(site))
                } else {
                    "correct `frame.origin_m`, or write `coordinates: Local` or `coordinates: Map`"
                        .to_owned()
                },
            )
        }
    };
    site.report(Diagnostic::error(path, message).help(help));
    None
}

/// Converts coordinates of the map to the local frame.
fn move_from_map(rows: &mut [StemRow], base: HeightBase, site: &Site<'_>) {
    let (map, (.., height)) = (site.transform(), site.resources.frame.origin_m);
    for row in rows {
        let z = row.position.z - if base == HeightBase::Frame { height } else { 0.0 };
        row.position = map.apply(row.position.truncate()).extend(z);
    }
}

/// Scales a row so that its mesh gets the size that the row says.
fn scale(row: &mut StemRow, kind: &Kind, is_of_crown: bool, file: &str) -> Result<(), SizeProblem> {
    let vertical = row.height.filter(|_| kind.top > 0.0).map(|height| height / kind.top);
    let horizontal = row.diameter.filter(|_| kind.width > 0.0).map(|width| width / kind.width);
    let (Some(vertical), Some(horizontal)) = (vertical.or(horizontal), horizontal.or(vertical))
    else {
        return Ok(());
    };
    (row.scale_vertical, row.scale_horizontal) = (vertical, horizontal);
    let Some(diameter) = row.diameter.filter(|_| !is_of_crown) else { return Ok(()) };
    let is_of_stem = match row.height {
        Some(height) => diameter < STEM_TO_HEIGHT * height,
        None => horizontal < SMALLEST,
    };
    if !is_of_stem {
        return Ok(());
    }
    let height = vertical * kind.top;
    Err(SizeProblem(format!(
        "{file}:{}: a diameter of {diameter} m of a plant that is {height:.2} m high looks like that of \
         its stem, but `diameter_m` is that of its crown",
        row.line
    )))
}

/// A size that cannot be meant.
struct SizeProblem(String);

impl SizeProblem {
    fn with_path(self, path: &ScenePath) -> Diagnostic {
        let help = "call the column of stems `dbh_m`, which is let be, or that of crowns \
                    `crown_diameter_m`";
        Diagnostic::error(path, self.0).help(help)
    }
}
