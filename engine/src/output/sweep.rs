//! Table of all points of a sweep.

use std::io::{self, Write};

use super::OutputError;
use super::axes::AxisColumns;
use super::point_tables::{PointTable, PointTables};
use super::rows::{harmless, number};
use crate::document::Param;
use crate::products::{Product, Report, SweepPoint};

/// Column of a point's table with the values of all randomisations, separated by spaces.
pub(super) const REPLICATES: &str = "replicates";

/// Rows of all points as one table: a column a parameter, then sensor, product, unit, a column an axis, band, value and
/// standard error. A point that was not traced has one row of its parameters alone, and a `note` that says why.
#[derive(Clone, Debug)]
pub struct SweepTable<'a> {
    columns: Vec<String>,
    tables: Vec<&'a PointTable>,
    /// Tables by point; `None` for points without one.
    by_point: Vec<Option<&'a PointTable>>,
    /// True if each point has all columns.
    is_uniform: bool,
}

impl<'a> SweepTable<'a> {
    /// Table of points that are complete.
    ///
    /// # Errors
    /// If the table of a point cannot be read.
    pub fn new(points: &[SweepPoint], tables: &'a PointTables) -> Result<Self, OutputError> {
        let by_point: Vec<Option<&PointTable>> =
            points.iter().map(|point| tables.get(point)).collect();
        let tables: Vec<&PointTable> = by_point.iter().copied().flatten().collect();
        // A point may lack what others have: another axis, say.
        let (mut columns, mut is_uniform) = (Vec::<String>::new(), true);
        for table in &tables {
            let header = table.rows()?.headers().cloned().map_err(unreadable(table))?;
            let has_replicates = header.iter().any(|name| name == REPLICATES);
            is_uniform &= !has_replicates && (columns.is_empty() || header.iter().eq(&columns));
            let mut place = columns.len();
            for name in header.iter().rev().filter(|name| *name != REPLICATES) {
                match columns.iter().position(|column| column == name) {
                    Some(known) => place = known,
                    None => columns.insert(place, name.to_owned()),
                }
            }
        }
        Ok(Self { columns, tables, by_point, is_uniform })
    }

    /// Table of each point; `None` for points without one.
    pub(super) fn by_point(&self) -> &[Option<&'a PointTable>] {
        &self.by_point
    }

    /// Writes the table as CSV.
    pub(super) fn write(&self, mut file: &mut dyn Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(&mut file);
        writer.write_record(&self.columns)?;
        if self.is_uniform {
            writer.flush()?;
            drop(writer);
            return self.tables.iter().try_for_each(|table| copy_rows(table, file));
        }
        for table in &self.tables {
            let mut rows = table.rows().map_err(io::Error::other)?;
            let header = rows.headers()?.clone();
            let place = |column: &String| header.iter().position(|name| name == column);
            let places: Vec<Option<usize>> = self.columns.iter().map(place).collect();
            for row in rows.records() {
                let row = row?;
                let cell =
                    |place: &Option<usize>| place.and_then(|place| row.get(place)).unwrap_or("");
                writer.write_record(places.iter().map(cell))?;
            }
        }
        writer.flush()
    }
}

/// Values of all randomisations of a value of a product.
fn replicates_of(product: &Product, value: usize) -> String {
    let each = product.replicates.iter().skip(value).step_by(product.values.len().max(1));
    each.map(|value| number(*value)).collect::<Vec<_>>().join(" ")
}

/// Copies the rows of a table.
fn copy_rows(table: &PointTable, file: &mut dyn Write) -> io::Result<()> {
    let mut rows = table.rows().map_err(io::Error::other)?;
    let mut row = csv::ByteRecord::new();
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(file);
    while rows.read_byte_record(&mut row)? {
        writer.write_byte_record(&row)?;
    }
    writer.flush()
}

fn unreadable(table: &PointTable) -> impl Fn(csv::Error) -> OutputError {
    |error| table.unreadable(error.into())
}

/// Writes the columns and rows of a point.
pub(super) fn write_rows(report: &Report, point: &SweepPoint, file: impl Write) -> io::Result<()> {
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
    let has_replicates = products().any(|(_, product)| !product.replicates.is_empty());
    let replicates = has_replicates.then(|| REPLICATES.to_owned());
    let columns = names.chain(before).chain(axes.names().map(harmless)).chain(after);
    let columns = columns.chain(note).chain(replicates);
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
        let own = [&sensor.name, &product.name, &product.unit].map(|name| harmless(name));
        let cells = axes.cells(product);
        for (row, (value, error)) in product.values.iter().zip(&product.standard_error).enumerate()
        {
            let place = cells.row(row);
            params.iter().chain(&own).try_for_each(|cell| writer.write_field(cell))?;
            place.cells.iter().try_for_each(|cell| writer.write_field(harmless(cell)))?;
            let last = [harmless(&place.band), number(*value), number(*error)];
            let replicates = has_replicates.then(|| replicates_of(product, row));
            writer.write_record(last.into_iter().chain(replicates))?;
        }
    }
    writer.flush()
}
