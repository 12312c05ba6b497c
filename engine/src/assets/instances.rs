//! Tables of instances.

use std::collections::HashMap;
use std::path::Path;

use glam::DVec3;

use super::AssetError;
use super::table::{Column, ColumnContent, Table, known_columns};
use crate::document::{INSTANCE_COLUMNS, meant_column};

/// Position, orientation and size of one instance, from a row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StemRow {
    /// Position, m.
    pub position: DVec3,
    /// Turn about the vertical, counter-clockwise seen from above, rad.
    pub yaw: f64,
    /// Lean from the vertical, rad.
    pub tilt: f64,
    /// Azimuth of the lean, clockwise from north, rad.
    pub tilt_azimuth: f64,
    /// Horizontal scale.
    pub scale_horizontal: f64,
    /// Vertical scale.
    pub scale_vertical: f64,
    /// Height of the plant, m, in place of the vertical scale.
    pub height: Option<f64>,
    /// Diameter of its crown, m, in place of the horizontal scale.
    pub diameter: Option<f64>,
    /// Place of its species in [`StemTable::species`].
    pub species: Option<u32>,
    /// Line of the file.
    pub line: usize,
}

/// Content of a table of instances.
#[derive(Clone, Debug, PartialEq)]
pub struct StemTable {
    /// Rows in file order.
    pub rows: Vec<StemRow>,
    /// Species in the order of their first rows.
    pub species: Vec<String>,
    /// True if the diameters are said to be those of crowns.
    pub diameter_is_of_crown: bool,
    /// True if there is a column of the heights of places.
    pub has_heights: bool,
    /// Columns that mean nothing here.
    pub left_out: Vec<String>,
    /// Columns that are spelled almost as a column with a meaning, with that one.
    pub misspelt: Vec<(String, &'static str)>,
}

/// Columns that say the same.
const CONTRADICTIONS: [(&str, &str); 8] = [
    ("yaw_deg", "yaw_rad"),
    ("diameter_m", "crown_diameter_m"),
    ("scale", "height_m"),
    ("scale_vertical", "height_m"),
    ("scale", "diameter_m"),
    ("scale", "crown_diameter_m"),
    ("scale_vertical", "diameter_m"),
    ("scale_vertical", "crown_diameter_m"),
];

/// Reads a table of instances.
///
/// Columns `x_m`, `y_m` and perhaps others of [`INSTANCE_COLUMNS`] in any order, separated by commas,
/// semicolons, tabs or white space. A missing column is 0, a missing `scale` 1, a missing
/// `scale_vertical` the same as `scale`. Other columns are let be. `columns` names them where the file
/// has no header, or in place of its header.
///
/// # Errors
/// A file that cannot be read, is not text or holds no row; a missing column, or two that say the same;
/// a number that is not finite; a scale, height or diameter that is not above 0.
pub fn read_instances(path: &Path, columns: Option<&[String]>) -> Result<StemTable, AssetError> {
    let mut table = Table::open(path)?;
    let line = table.first_line;
    let names = names(&mut table, columns)?;
    let has = |name: &str| names.iter().any(|n| n == name);
    if !has("x_m") || !has("y_m") {
        return Err(no_places(&names, path, line));
    }
    if let Some((first, second)) = CONTRADICTIONS.into_iter().find(|(a, b)| has(a) && has(b)) {
        let (first, second) = (first.to_owned(), second.to_owned());
        return Err(AssetError::RepeatedColumn { file: path.to_owned(), line, first, second });
    }
    let (fields, left_out) = contents(&names, path, line)?;
    let misspelt = left_out.iter().filter_map(|name| {
        let free: Vec<_> = INSTANCE_COLUMNS.into_iter().filter(|known| !has(known)).collect();
        Some((name.clone(), meant_column(name, &free)?))
    });
    let misspelt = misspelt.collect();
    let mut rows = Vec::new();
    let mut species: Vec<String> = Vec::new();
    let mut places: HashMap<String, u32> = HashMap::new();
    let mut numbers = [0.0; INSTANCE_COLUMNS.len()];
    (numbers[SCALE], numbers[SCALE + 1]) = (1.0, 1.0);
    let mut texts = [String::new()];
    while let Some(line) = table.read_mixed_row(&fields, &mut numbers, &mut texts)? {
        let mut row = row(&numbers, &has, path, line)?;
        if has("species") {
            let [name] = &texts;
            let place = places.get(name).copied().unwrap_or_else(|| {
                let place = species.len() as u32;
                species.push(name.clone());
                places.insert(name.clone(), place);
                place
            });
            row.species = Some(place);
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(AssetError::NoRows { file: path.to_owned() });
    }
    let (diameter_is_of_crown, has_heights) = (has("crown_diameter_m"), has("z_m"));
    Ok(StemTable { rows, species, diameter_is_of_crown, has_heights, left_out, misspelt })
}

/// Names of the columns, by the header or by the scene; a header is left behind.
fn names(table: &mut Table, columns: Option<&[String]>) -> Result<Vec<String>, AssetError> {
    let (file, line) = (table.file().to_owned(), table.first_line);
    if !table.has_header() {
        return columns.map(<[String]>::to_vec).ok_or_else(|| {
            let wanted = "`x_m,y_m` and perhaps `z_m,yaw_deg,scale` and others, or list them under \
                          `columns` in the scene";
            AssetError::NoHeader { file, line, wanted: wanted.to_owned() }
        });
    }
    table.skip_header()?;
    let Some(columns) = columns else { return Ok(table.first.clone()) };
    // The scene's names go before those of the file, but must not turn them around.
    let mut pairs = table.first.iter().zip(columns);
    match pairs.find(|(own, given)| own != given && columns.contains(own)) {
        Some((own, given)) => Err(AssetError::ContradictedColumn {
            file,
            line,
            own: own.clone(),
            given: given.clone(),
        }),
        None => Ok(columns.to_vec()),
    }
}

/// Place of `scale` among the columns, which `scale_vertical` follows.
const SCALE: usize = 7;

/// Returns the content of each column, and the names of columns that are not read.
fn contents(
    names: &[String],
    path: &Path,
    line: usize,
) -> Result<(Vec<Column>, Vec<String>), AssetError> {
    let is_known = |name: &&String| INSTANCE_COLUMNS.contains(&name.as_str());
    let known: Vec<String> = names.iter().filter(is_known).cloned().collect();
    let mut known = known_columns(&known, &INSTANCE_COLUMNS, path, line)?.into_iter();
    let mut left_out = Vec::new();
    let fields = names.iter().map(|name| {
        if !is_known(&name) {
            left_out.extend((!name.is_empty()).then(|| name.clone()));
            return Column { name: name.clone(), content: ColumnContent::Ignored };
        }
        match known.next() {
            Some(column) if column.name != "species" => column,
            _ => Column { name: name.clone(), content: ColumnContent::Text(0) },
        }
    });
    Ok((fields.collect(), left_out))
}

fn row(
    numbers: &[f64; INSTANCE_COLUMNS.len()],
    has: &impl Fn(&str) -> bool,
    path: &Path,
    line: usize,
) -> Result<StemRow, AssetError> {
    let &[
        x,
        y,
        z,
        yaw_deg,
        yaw_rad,
        tilt_deg,
        tilt_azimuth_deg,
        scale,
        vertical,
        height,
        d,
        crown,
        _,
    ] = numbers;
    let scale_vertical = if has("scale_vertical") { vertical } else { scale };
    let height = has("height_m").then_some(height);
    let diameter = match (has("diameter_m"), has("crown_diameter_m")) {
        (true, _) => Some(d),
        (_, true) => Some(crown),
        _ => None,
    };
    let sizes = [
        (Some(scale), "scale"),
        (Some(scale_vertical), "scale_vertical"),
        (height, "height_m"),
        (diameter, "the diameter"),
    ];
    for (value, name) in sizes {
        if let Some(value) = value.filter(|value| *value <= 0.0) {
            let (file, what) = (path.to_owned(), name.to_owned());
            return Err(AssetError::NotPositive { file, line, what, value });
        }
    }
    Ok(StemRow {
        position: DVec3::new(x, y, z),
        yaw: yaw_deg.to_radians() + yaw_rad,
        tilt: tilt_deg.to_radians(),
        tilt_azimuth: tilt_azimuth_deg.to_radians(),
        scale_horizontal: scale,
        scale_vertical,
        height,
        diameter,
        species: None,
        line,
    })
}

/// Error of a table that lacks a coordinate: says which columns may be meant.
fn no_places(found: &[String], file: &Path, line: usize) -> AssetError {
    let lacking: Vec<&str> =
        ["x_m", "y_m"].into_iter().filter(|&name| found.iter().all(|own| own != name)).collect();
    let are_degrees = found
        .iter()
        .any(|name| ["lon", "lat", "lng", "long"].iter().any(|word| is_word(name, word)));
    let alike: Vec<&str> = lacking.iter().filter_map(|column| like(column, found)).collect();
    let listed = |names: &[&str]| {
        let quoted: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
        quoted.join(" and ")
    };
    let columns = listed(&lacking);
    let [noun_is, that_is, its, it] = match lacking.len() {
        1 => ["column {} is", "is that", "its", "it"],
        _ => ["columns {} are", "are those", "their", "them"],
    };
    let help = if are_degrees {
        format!(
            "a scene is in metres: convert longitudes and latitudes to the projection of its map and call the columns \
             {columns}, as by {}",
            degrees_to_metres(32632, ["lon", "lat"])
        )
    } else if alike.len() == lacking.len() {
        format!(
            "if {} {that_is} in metres, write {columns} in {its} place, or list the names of all columns under \
             `columns` in the scene",
            listed(&alike)
        )
    } else {
        format!("add {it}, or list the names of all columns under `columns` in the scene")
    };
    let problem = format!("{} missing among {found:?}", noun_is.replace("{}", &columns));
    AssetError::NoStemPlaces { file: file.to_owned(), line, problem, help }
}

/// Command that converts a table of longitudes and latitudes to a system in metres, by its EPSG code.
pub(crate) fn degrees_to_metres(code: u32, [x, y]: [&str; 2]) -> String {
    format!(
        "`ogr2ogr -s_srs EPSG:4326 -t_srs EPSG:{code} -oo X_POSSIBLE_NAMES={x} -oo Y_POSSIBLE_NAMES={y} -lco \
         GEOMETRY=AS_XY metres.csv degrees.csv`"
    )
}

/// Returns whether the name of a column is a word, long or short, and perhaps a unit: `lat`, `latitude_deg`.
fn is_word(name: &str, word: &str) -> bool {
    let lower = name.trim().to_lowercase();
    let Some(rest) = lower.strip_prefix(word) else { return false };
    let rest = rest.trim_start_matches("itude");
    rest.is_empty() || rest.starts_with(['_', ' ', '('])
}

/// The column that a person may have meant by a coordinate.
fn like<'a>(column: &str, names: &'a [String]) -> Option<&'a str> {
    let words: &[&str] =
        if column == "x_m" { &["x", "east", "rechts"] } else { &["y", "north", "hoch"] };
    let is_like = |name: &&String| {
        let lower = name.to_lowercase();
        words.iter().any(|word| lower == *word || lower.contains(word) && lower.len() < 20)
    };
    names.iter().find(is_like).map(String::as_str)
}
