//! Files of a sweep: a folder for each point, and one table of all.
//!
//! `points/sza=30,lai=2/` holds what [`write()`] writes, and `point.csv`, which gets its name after
//! all the others: where it bears the point's key, the point is complete.

use std::fs::File;
use std::io::{self, BufRead as _, BufReader, Write};
use std::path::{Path, PathBuf};

use super::rows::{indices, number, point as point_of_axis};
use super::staging::Staging;
use super::{OutputError, write};
use crate::products::{Point, Product, Report};

/// Longest name of a point's folder.
const LENGTH: usize = 100;

const TABLE: &str = "point.csv";

/// Whether `folder` holds all results of this very point.
#[must_use]
pub fn is_complete(point: &Point, folder: &Path) -> bool {
    let Ok(file) = File::open(folder_of(point, folder).join(TABLE)) else { return false };
    let first = BufReader::new(file).lines().next();
    first.is_some_and(|line| line.is_ok_and(|line| line == heading(point)))
}

/// Writes the results of a point.
///
/// # Errors
/// As [`write()`].
pub fn write_point(
    report: &Report,
    point: &Point,
    folder: &Path,
) -> Result<Vec<PathBuf>, OutputError> {
    let folder = folder_of(point, folder);
    let mut written = write(report, &folder)?;
    let mut staging = Staging::open(&folder)?;
    staging.file(TABLE, |file| write_rows(report, point, file))?;
    written.extend(staging.commit()?);
    Ok(written)
}

/// Writes `sweep.csv`, the rows of all points: a column a parameter, then sensor, product, unit,
/// place within the product, band, value and standard error.
///
/// # Errors
/// If a point is not complete, or the file cannot be written.
pub fn write_sweep(points: &[Point], folder: &Path) -> Result<PathBuf, OutputError> {
    let mut staging = Staging::open(folder)?;
    let mut unreadable = None;
    let written = staging.file("sweep.csv", |file| {
        for (index, point) in points.iter().enumerate() {
            let path = folder_of(point, folder).join(TABLE);
            let rows = File::open(&path).inspect_err(|_| unreadable = Some(path))?;
            // The key; and the header, which is the same for all.
            for line in BufReader::new(rows).lines().skip(if index == 0 { 1 } else { 2 }) {
                writeln!(file, "{}", line?)?;
            }
        }
        Ok(())
    });
    match (written, unreadable) {
        (Err(OutputError::Write { source, .. }), Some(path)) => {
            return Err(OutputError::Read { path, source });
        }
        (written, _) => drop(written?),
    }
    Ok(staging.commit()?.remove(0))
}

fn folder_of(point: &Point, folder: &Path) -> PathBuf {
    let mut name = point.name();
    if name.len() > LENGTH {
        let end = name.floor_char_boundary(LENGTH - 17);
        name.truncate(end);
        name = format!("{name},{}", point.key.get(..16).unwrap_or(&point.key));
    }
    folder.join("points").join(name)
}

fn heading(point: &Point) -> String {
    format!("# key: {}", point.key)
}

fn write_rows(report: &Report, point: &Point, file: &mut impl Write) -> io::Result<()> {
    writeln!(file, "{}", heading(point))?;
    let mut writer = csv::WriterBuilder::new().from_writer(file);
    let names = point.params.iter().map(|(name, _)| name.as_str());
    let columns = ["sensor", "product", "unit", "at", "band", "value", "standard_error"];
    writer.write_record(names.chain(columns))?;
    let params: Vec<_> = point.params.iter().map(|&(_, value)| number(value)).collect();
    for sensor in &report.sensors {
        for product in &sensor.products {
            for (row, (value, error)) in
                product.values.iter().zip(&product.standard_error).enumerate()
            {
                let (at, band) = place(product, row);
                let own = [&sensor.name, &product.name, &product.unit, &at, &band];
                let values = [number(*value), number(*error)];
                writer.write_record(params.iter().chain(own).chain(&values))?;
            }
        }
    }
    writer.flush()
}

/// Where a value stands in its product: `zenith_deg=30;azimuth_deg=90`, and the band.
#[must_use]
pub fn place(product: &Product, row: usize) -> (String, String) {
    let (mut at, mut band) = (Vec::new(), String::new());
    for (dimension, index) in product.dimensions.iter().zip(indices(&product.dimensions, row)) {
        for axis in dimension {
            let value = point_of_axis(axis, index);
            if axis.name == "band" {
                band = value;
            } else {
                at.push(format!("{}={value}", axis.name));
            }
        }
    }
    (at.join(";"), band)
}
