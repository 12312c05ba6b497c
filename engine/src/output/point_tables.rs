//! Tables of the points of a sweep on the disk.
//!
//! `points/sza=30,lai=2/` holds what [`Results::write`] writes, and the point's table, `point.csv`. Of many points on
//! the same paths, `points/1000_from_chl=20,n=1.5/points.csv` holds the tables of all, one behind the other. A table
//! begins with the key of its point: a point whose key is found is complete.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use serde::de::DeserializeOwned;

use super::names::{FOLDER_LENGTH, folder_name};
use super::point_warnings::PointWarnings;
use super::staging::Staging;
use super::sweep::write_rows;
use super::sweep_datasets::PointLayout;
use super::{OutputError, Results};
use crate::products::{Report, SweepPoint};

/// File of the table of one point, and of those of many.
const TABLE: &str = "point.csv";
const TABLES: &str = "points.csv";

/// Start of the comment line that holds the key of a point, and that which holds the irradiance on the horizontal plane
/// by band.
const KEY: &str = "# key: ";
const IRRADIANCE: &str = "# irradiance_w_m2_nm: ";

/// Start of the comment line that says what data sets hold.
const LAYOUT: &str = "# data set: ";

/// Start of the comment line that holds the warnings of the point's run.
const WARNINGS: &str = "# warnings: ";

/// Value of a table with its standard error.
#[derive(Clone, Copy, Debug)]
pub(super) struct PointValue<'a> {
    pub(super) sensor: &'a str,
    pub(super) product: &'a str,
    /// Value and standard error.
    pub(super) numbers: [f64; 2],
}

/// Number of points on the same paths above which their tables are all that is written, unless they have pictures:
/// charts and summaries of thousands of points would take longer than their rays.
const MOST_IN_FULL: usize = 64;

/// Folders that are written at a time: most of their time is that of the disk.
const WRITERS: usize = 8;

/// Number of tables that are formatted side by side, and held until they are written.
const AT_A_TIME: usize = 256;

/// Tables of the points that are complete in a folder.
#[derive(Clone, Debug)]
pub struct PointTables {
    folder: PathBuf,
    /// By the key of the point.
    found: HashMap<String, PointTable>,
}

/// Place of a point's table.
#[derive(Clone, Debug)]
pub(super) struct PointTable {
    path: Arc<Path>,
    bytes: Range<u64>,
}

/// Reader of the bytes of a table.
type TableBytes = io::Take<BufReader<File>>;

impl PointTables {
    /// Finds the tables of these points in a folder.
    ///
    /// # Errors
    /// If a file of tables cannot be read.
    pub fn open(folder: &Path, points: &[SweepPoint]) -> Result<Self, OutputError> {
        let mut tables = Self { folder: folder.to_owned(), found: HashMap::new() };
        let Ok(folders) = fs::read_dir(folder.join("points")) else { return Ok(tables) };
        for folder in folders.flatten() {
            let path = folder.path().join(TABLES);
            if path.is_file() {
                tables.found.extend(tables_in(&path)?);
            }
        }
        for point in points {
            let path = tables.folder_of(point).join(TABLE);
            let Ok(file) = File::open(&path) else { continue };
            let first = BufReader::new(file).lines().next();
            if first.is_some_and(|line| line.is_ok_and(|line| line == heading(point))) {
                tables.add(point, &path);
            }
        }
        Ok(tables)
    }

    /// Returns true if there are all results of a point.
    #[must_use]
    pub fn contains(&self, point: &SweepPoint) -> bool {
        self.found.contains_key(&point.key)
    }

    /// Table of a point; `None` if it is not complete.
    pub(super) fn get(&self, point: &SweepPoint) -> Option<&PointTable> {
        self.found.get(&point.key)
    }

    /// Warnings of the runs of these points, each with its points; see [`PointWarnings`].
    ///
    /// # Errors
    /// If a table cannot be read.
    pub fn warnings(&self, points: &[SweepPoint]) -> Result<Vec<String>, OutputError> {
        let mut all = PointWarnings::default();
        let mut keys = HashSet::new();
        // A list may hold a value twice.
        for point in points.iter().filter(|point| keys.insert(point.key.as_str())) {
            let Some(table) = self.get(point) else { continue };
            table.warnings()?.into_iter().for_each(|text| all.add(point, text));
        }
        Ok(all.texts().collect())
    }

    /// Writes the results of points that were traced on the same paths. `unfinished` are those to write, by their
    /// places among the reports.
    ///
    /// # Errors
    /// Errors of [`Results::write`]; other points may have been written.
    ///
    /// # Panics
    /// If a report or a point is missing.
    pub fn write(
        &mut self,
        reports: &[Report],
        points: &[SweepPoint],
        unfinished: &[usize],
    ) -> Result<(), OutputError> {
        let has_pictures = |report: &Report| {
            let mut products = report.sensors.iter().flat_map(|sensor| &sensor.products);
            products.any(|product| product.image.is_some() || product.faces.is_some())
        };
        let chosen: Vec<(&Report, &SweepPoint)> =
            unfinished.iter().map(|&index| (&reports[index], &points[index])).collect();
        if reports.len() <= MOST_IN_FULL || reports.iter().any(has_pictures) {
            self.write_in_full(&chosen)
        } else {
            self.write_tables(&chosen)
        }
    }

    /// Writes all files of points, each into its folder.
    fn write_in_full(&mut self, points: &[(&Report, &SweepPoint)]) -> Result<(), OutputError> {
        let write = |(report, point): &(&Report, &SweepPoint)| {
            let results = Results::for_any_scene(&self.folder_of(point));
            let table = |staging: &mut Staging| {
                staging.file(TABLE, |file| write_table(report, point, file)).map(drop)
            };
            results.write_with(report, table).map(drop)
        };
        match rayon::ThreadPoolBuilder::new().num_threads(WRITERS).build() {
            Ok(pool) => pool.install(|| points.par_iter().try_for_each(write))?,
            Err(_no_threads) => points.iter().try_for_each(write)?,
        }
        for (_, point) in points {
            self.add(point, &self.folder_of(point).join(TABLE));
        }
        Ok(())
    }

    /// Writes the tables of points into one file.
    fn write_tables(&mut self, points: &[(&Report, &SweepPoint)]) -> Result<(), OutputError> {
        let [(_, first), ..] = points else { return Ok(()) };
        let name = format!("{}_from_{}", points.len(), first.name());
        let folder = self.folder.join("points").join(folder_name(&name, &first.key));
        let write = |file: &mut dyn Write| {
            let mut ends = Vec::with_capacity(points.len());
            for some in points.chunks(AT_A_TIME) {
                let table = |(report, point): &(&Report, &SweepPoint)| {
                    let mut bytes = Vec::new();
                    write_table(report, point, &mut bytes).map(|()| bytes)
                };
                for bytes in some.par_iter().map(table).collect::<io::Result<Vec<_>>>()? {
                    file.write_all(&bytes)?;
                    ends.push(ends.last().unwrap_or(&0) + bytes.len() as u64);
                }
            }
            Ok(ends)
        };
        let mut ends = Vec::new();
        Results::for_any_scene(&folder).write_alone(|staging: &mut Staging| {
            staging.file(TABLES, |file| write(file).map(|found| ends = found)).map(drop)
        })?;
        let (path, mut start): (Arc<Path>, u64) = (folder.join(TABLES).into(), 0);
        for ((_, point), end) in points.iter().zip(ends) {
            let table = PointTable { path: Arc::clone(&path), bytes: start..end };
            self.found.insert(point.key.clone(), table);
            start = end;
        }
        Ok(())
    }

    fn add(&mut self, point: &SweepPoint, path: &Path) {
        let table = PointTable { path: path.into(), bytes: 0..u64::MAX };
        self.found.insert(point.key.clone(), table);
    }

    fn folder_of(&self, point: &SweepPoint) -> PathBuf {
        let written = point.name();
        let mut name = folder_name(&written, &point.key);
        // Texts may differ in what a folder's name cannot hold.
        if written.len() <= FOLDER_LENGTH && name != written {
            name = format!("{name},{}", point.key.get(..16).unwrap_or(&point.key));
        }
        self.folder.join("points").join(name)
    }
}

impl PointTable {
    /// Bytes of the table.
    pub(super) fn bytes(&self) -> Result<TableBytes, OutputError> {
        let open = || {
            let mut file = BufReader::new(File::open(&self.path)?);
            file.seek(SeekFrom::Start(self.bytes.start))?;
            Ok(file.take(self.bytes.end - self.bytes.start))
        };
        open().map_err(|source| self.unreadable(source))
    }

    /// Reader of the rows.
    pub(super) fn rows(&self) -> Result<csv::Reader<TableBytes>, OutputError> {
        Ok(csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(self.bytes()?))
    }

    /// Irradiance on the horizontal plane, W m⁻² nm⁻¹, by the name of the band; empty where the table does not say.
    pub(super) fn irradiance(&self) -> Result<HashMap<String, f64>, OutputError> {
        self.comment(IRRADIANCE)
    }

    /// Products of the table as data sets have them; nothing if it was written without.
    pub(super) fn layout(&self) -> Result<PointLayout, OutputError> {
        self.comment(LAYOUT)
    }

    /// Warnings of the point's run.
    fn warnings(&self) -> Result<Vec<String>, OutputError> {
        self.comment(WARNINGS)
    }

    /// Value of the comment line above the rows that has this start; the default without such a line.
    fn comment<T: DeserializeOwned + Default>(&self, start: &str) -> Result<T, OutputError> {
        for line in self.bytes()?.lines() {
            let line = line.map_err(|source| self.unreadable(source))?;
            if let Some(value) = line.strip_prefix(start) {
                return serde_json::from_str(value)
                    .map_err(|source| self.unreadable(source.into()));
            }
            if !line.starts_with('#') {
                break;
            }
        }
        Ok(T::default())
    }

    /// Visits all values in order.
    pub(super) fn visit(&self, each: &mut dyn FnMut(PointValue<'_>)) -> Result<(), OutputError> {
        let mut rows = self.rows()?;
        let unreadable = |error: csv::Error| self.unreadable(error.into());
        let header = rows.headers().map_err(unreadable)?.clone();
        // Parameters come first, and may have any name.
        let last = |name: &str| {
            header
                .iter()
                .enumerate()
                .filter(|(_, column)| *column == name)
                .last()
                .map(|(place, _)| place)
        };
        let places = [last("sensor"), last("product"), last("value"), last("standard_error")];
        let [Some(sensor), Some(product), Some(value), Some(error)] = places else {
            return Ok(());
        };
        let mut row = csv::StringRecord::new();
        while rows.read_record(&mut row).map_err(unreadable)? {
            let number = |place: usize| row.get(place).and_then(|text| text.parse().ok());
            if let [Some(value), Some(error)] = [number(value), number(error)] {
                let [sensor, product] = [sensor, product].map(|place| &row[place]);
                each(PointValue { sensor, product, numbers: [value, error] });
            }
        }
        Ok(())
    }

    /// Error of reading the table.
    pub(super) fn unreadable(&self, source: io::Error) -> OutputError {
        OutputError::Read { path: self.path.to_path_buf(), source }
    }
}

/// Tables in a file, by the keys of their points.
fn tables_in(path: &Path) -> Result<Vec<(String, PointTable)>, OutputError> {
    let shared: Arc<Path> = path.into();
    let read = || {
        let mut file = BufReader::new(File::open(path)?);
        let (mut tables, mut line, mut at) = (Vec::<(String, PointTable)>::new(), Vec::new(), 0);
        loop {
            line.clear();
            let length = file.read_until(b'\n', &mut line)? as u64;
            if length == 0 {
                return Ok(tables);
            }
            if let Some(key) = line.strip_prefix(KEY.as_bytes()) {
                let key = String::from_utf8_lossy(key).trim_end().to_owned();
                let table = PointTable { path: Arc::clone(&shared), bytes: at..at };
                tables.push((key, table));
            }
            at += length;
            if let Some((_, table)) = tables.last_mut() {
                table.bytes.end = at;
            }
        }
    };
    read().map_err(|source| OutputError::Read { path: path.to_owned(), source })
}

fn heading(point: &SweepPoint) -> String {
    format!("{KEY}{}", point.key)
}

/// Writes the table of a point.
fn write_table(report: &Report, point: &SweepPoint, mut file: impl Write) -> io::Result<()> {
    writeln!(file, "{}", heading(point))?;
    let lit: std::collections::BTreeMap<_, _> =
        report.bands.iter().zip(&report.irradiance).collect();
    if !lit.is_empty() {
        writeln!(file, "{IRRADIANCE}{}", serde_json::to_string(&lit)?)?;
    }
    if let Some(layout) = PointLayout::new(report) {
        writeln!(file, "{LAYOUT}{}", serde_json::to_string(&layout)?)?;
    }
    if !report.warnings.is_empty() {
        writeln!(file, "{WARNINGS}{}", serde_json::to_string(&report.warnings)?)?;
    }
    write_rows(report, point, file)
}
