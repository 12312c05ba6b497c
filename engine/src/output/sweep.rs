//! Files of a sweep: a folder for each point, and one table of all.
//!
//! `points/sza=30,lai=2/` holds what [`write()`](super::write()) writes, and `point.csv`: where it bears the
//! point's key, the point is complete. Of many points on the same paths, each has `point.csv` alone.

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Write};
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::axes::AxisColumns;
use super::rows::{harmless, number};
use super::staging::Staging;
use super::{OutputError, Results};
use crate::document::Param;
use crate::products::{Report, SweepPoint};

/// Longest name of a point's folder.
const LENGTH: usize = 100;

const TABLE: &str = "point.csv";

/// Start of the comment line of a point's table that holds the irradiance on the horizontal plane by band.
const IRRADIANCE: &str = "# irradiance_w_m2_nm: ";

/// Returns true if `folder` holds all results of this point.
#[must_use]
pub fn is_complete(point: &SweepPoint, folder: &Path) -> bool {
    let Ok(file) = File::open(folder_of(point, folder).join(TABLE)) else { return false };
    let first = BufReader::new(file).lines().next();
    first.is_some_and(|line| line.is_ok_and(|line| line == heading(point)))
}

/// Number of points on the same paths above which each has its table alone, unless it has pictures: charts and summaries
/// of thousands of points would take longer than their rays.
const MOST_IN_FULL: usize = 64;

/// Files that are written at a time: most of their time is that of the disk.
const WRITERS: usize = 8;

/// Writes the results of points that were traced on the same paths, with the `point.csv` of each. `unfinished` are
/// those to write, by their places among the reports.
///
/// # Errors
/// Errors of [`write()`](super::write()); other points may have been written.
///
/// # Panics
/// If a report or a point is missing.
pub fn write_points(
    reports: &[Report],
    points: &[SweepPoint],
    unfinished: &[usize],
    folder: &Path,
) -> Result<(), OutputError> {
    let has_pictures = |report: &Report| {
        let mut products = report.sensors.iter().flat_map(|sensor| &sensor.products);
        products.any(|product| product.image.is_some() || product.faces.is_some())
    };
    let in_full = reports.len() <= MOST_IN_FULL || reports.iter().any(has_pictures);
    let write = |&index: &usize| {
        let (report, point) = (&reports[index], &points[index]);
        let results = Results::for_any_scene(&folder_of(point, folder));
        let table = |staging: &mut Staging| {
            staging.file(TABLE, |file| write_rows(report, point, file)).map(drop)
        };
        if in_full { results.write_with(report, table) } else { results.write_alone(table) }
            .map(drop)
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(WRITERS).build();
    match pool {
        Ok(pool) => pool.install(|| unfinished.par_iter().try_for_each(write)),
        Err(_no_threads) => unfinished.iter().try_for_each(write),
    }
}

/// Rows of all points as one table: a column a parameter, then sensor, product, unit, a column an axis,
/// band, value and standard error. A point that was not traced has one row of its parameters alone, and a
/// `note` that says why.
///
/// # Errors
/// If a point is not complete.
pub fn sweep_table(points: &[SweepPoint], folder: &Path) -> Result<String, OutputError> {
    let paths: Vec<PathBuf> =
        points.iter().map(|point| folder_of(point, folder).join(TABLE)).collect();
    // A point may lack what others have: another axis, say.
    let mut columns: Vec<String> = Vec::new();
    for path in &paths {
        let header = table(path)?.headers().cloned().map_err(|error| unreadable(path, error))?;
        let mut place = columns.len();
        for name in header.iter().rev() {
            match columns.iter().position(|column| column == name) {
                Some(known) => place = known,
                None => columns.insert(place, name.to_owned()),
            }
        }
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    let written = |error: csv::Error| OutputError::Write {
        path: folder.join("sweep.csv"),
        source: error.into(),
    };
    writer.write_record(&columns).map_err(written)?;
    for path in &paths {
        let mut rows = table(path)?;
        let header = rows.headers().cloned().map_err(|error| unreadable(path, error))?;
        let places: Vec<Option<usize>> =
            columns.iter().map(|column| header.iter().position(|name| name == column)).collect();
        for row in rows.records() {
            let row = row.map_err(|error| unreadable(path, error))?;
            let cell = |place: &Option<usize>| place.and_then(|place| row.get(place)).unwrap_or("");
            writer.write_record(places.iter().map(cell)).map_err(written)?;
        }
    }
    let bytes = writer.into_inner().map_err(|error| written(error.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Irradiance on the horizontal plane at a point, W m⁻² nm⁻¹, by the name of the band; empty where its table
/// does not say.
pub(super) fn irradiance(path: &Path) -> Result<HashMap<String, f64>, OutputError> {
    let error = |source| OutputError::Read { path: path.to_owned(), source };
    let file = BufReader::new(File::open(path).map_err(error)?);
    for line in file.lines().take(2) {
        if let Some(values) = line.map_err(error)?.strip_prefix(IRRADIANCE) {
            return serde_json::from_str(values).map_err(|source| error(source.into()));
        }
    }
    Ok(HashMap::new())
}

/// File of a point's table.
pub(super) fn table_file(point: &SweepPoint, folder: &Path) -> PathBuf {
    folder_of(point, folder).join(TABLE)
}

/// Reader of a point's table.
pub(super) fn table(path: &Path) -> Result<csv::Reader<File>, OutputError> {
    let file =
        File::open(path).map_err(|source| OutputError::Read { path: path.to_owned(), source })?;
    Ok(csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(file))
}

pub(super) fn unreadable(path: &Path, error: csv::Error) -> OutputError {
    OutputError::Read { path: path.to_owned(), source: error.into() }
}

fn folder_of(point: &SweepPoint, folder: &Path) -> PathBuf {
    let written = point.name();
    let mut name = folder_name(&written, &point.key);
    // Texts may differ in what a folder's name cannot hold.
    if written.len() <= LENGTH && name != written {
        name = format!("{name},{}", point.key.get(..16).unwrap_or(&point.key));
    }
    folder.join("points").join(name)
}

/// Name of a folder that is safe on every file system. A hash of `identity` distinguishes names that are cut.
#[must_use]
pub fn folder_name(name: &str, identity: &str) -> String {
    let safe = |letter: char| {
        if letter.is_alphanumeric() || "-_.=,+".contains(letter) { letter } else { '_' }
    };
    let mut name: String = name.chars().map(safe).collect();
    if name.len() > LENGTH {
        let hash = blake3::hash(identity.as_bytes()).to_hex();
        name.truncate(name.floor_char_boundary(LENGTH - 17));
        name = format!("{name},{}", &hash[..16]);
    }
    name
}

fn heading(point: &SweepPoint) -> String {
    format!("# key: {}", point.key)
}

fn write_rows(report: &Report, point: &SweepPoint, file: &mut impl Write) -> io::Result<()> {
    writeln!(file, "{}", heading(point))?;
    let lit: BTreeMap<_, _> = report.bands.iter().zip(&report.irradiance).collect();
    if !lit.is_empty() {
        writeln!(file, "{IRRADIANCE}{}", serde_json::to_string(&lit)?)?;
    }
    let products = || {
        report
            .sensors
            .iter()
            .flat_map(|sensor| sensor.products.iter().map(move |one| (sensor, one)))
    };
    let axes = AxisColumns::new(products().map(|(_, product)| product), report);
    let mut writer = csv::WriterBuilder::new().comment(Some(b'#')).from_writer(file);
    let names = point.params.iter().map(|(name, _)| harmless(name));
    let before = ["sensor", "product", "unit"].map(str::to_owned);
    let after = ["band", "value", "standard_error"].map(str::to_owned);
    // A column that tables of points with results do not have.
    let note = point.darkness().map(|_| "note".to_owned());
    let columns = names.chain(before).chain(axes.names().map(harmless)).chain(after).chain(note);
    writer.write_record(columns)?;
    let shown = |(_, value): &(String, Param)| match value {
        Param::Number(value) => number(*value),
        Param::Text(text) => harmless(text),
    };
    let params: Vec<_> = point.params.iter().map(shown).collect();
    if let Some(why) = point.darkness() {
        let empty = vec![String::new(); 6];
        writer.write_record(params.iter().cloned().chain(empty).chain([harmless(why)]))?;
    }
    for (sensor, product) in products() {
        for (row, (value, error)) in product.values.iter().zip(&product.standard_error).enumerate()
        {
            let place = axes.place(product, row);
            let own = [&sensor.name, &product.name, &product.unit].map(|name| harmless(name));
            let after = [harmless(&place.band), number(*value), number(*error)];
            let cells = place.cells.iter().map(|cell| harmless(cell));
            writer.write_record(params.iter().cloned().chain(own).chain(cells).chain(after))?;
        }
    }
    writer.flush()
}
