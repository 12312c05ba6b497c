//! Table of derivatives of results with respect to parameters.

use std::collections::BTreeSet;
use std::io::{self, Write};

use csv::StringRecord;
use serde_json::{Value, json};

use super::OutputError;
use super::point_tables::{PointTable, PointTables};
use super::rows::{harmless, number};
use super::sweep::REPLICATES;
use crate::products::{CentralDifference, SweepPoint};
use crate::statistics::Spread;

/// File of the derivatives of a sweep.
pub const DERIVATIVES: &str = "derivatives.csv";

/// Derivatives of all values of a scene that are made of light, by central differences: a row for each parameter and
/// value.
///
/// The values of each randomisation are subtracted before their spread is taken, so that the standard error is that of
/// the difference between the sides, which share their random numbers.
///
/// Source: Wolter (2007), "Introduction to variance estimation", chapter 2: random groups.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivativeTable {
    /// Columns that name a value: sensor, product, unit, axes and band.
    names: Vec<String>,
    differences: Vec<CentralDifference>,
    rows: Vec<DerivativeRow>,
    /// Products without a value for each randomisation.
    left_out: BTreeSet<String>,
}

#[derive(Clone, Debug, PartialEq)]
struct DerivativeRow {
    /// Place of the difference.
    difference: usize,
    /// A cell for each of the names.
    cells: Vec<String>,
    value: f64,
    derivative: f64,
    standard_error: f64,
}

/// Table of a point: its columns and its rows.
struct Rows<'a> {
    table: &'a PointTable,
    header: StringRecord,
    records: Vec<StringRecord>,
}

impl<'a> Rows<'a> {
    fn read(table: &'a PointTable) -> Result<Self, OutputError> {
        let unreadable = |error: csv::Error| table.unreadable(error.into());
        let mut rows = table.rows()?;
        let header = rows.headers().map_err(unreadable)?.clone();
        let records = rows.records().collect::<Result<_, _>>().map_err(unreadable)?;
        Ok(Self { table, header, records })
    }

    fn column(&self, name: &str) -> Result<usize, OutputError> {
        let place = self.header.iter().position(|column| column == name);
        place.ok_or_else(|| self.damaged(&format!("no column `{name}`")))
    }

    fn number(&self, text: &str) -> Result<f64, OutputError> {
        text.parse().map_err(|_no_number| self.damaged(&format!("`{text}` is no number")))
    }

    fn damaged(&self, what: &str) -> OutputError {
        self.table.unreadable(io::Error::new(io::ErrorKind::InvalidData, what))
    }

    /// Value of a row, and the values of its randomisations.
    fn values(&self, row: usize) -> Result<(f64, Vec<f64>), OutputError> {
        let record = &self.records[row];
        let cell = |name: &str| Ok(&record[self.column(name)?]);
        let replicates = cell(REPLICATES)?.split_whitespace().map(|text| self.number(text));
        Ok((self.number(cell("value")?)?, replicates.collect::<Result<_, _>>()?))
    }
}

impl DerivativeTable {
    /// Derivatives between points that have tables; `None` if there are no differences.
    ///
    /// # Errors
    /// If the table of a point is missing or cannot be read; if the sides of a parameter have other products.
    pub fn new(
        differences: &[CentralDifference],
        points: &[SweepPoint],
        tables: &PointTables,
    ) -> Result<Option<Self>, OutputError> {
        if differences.is_empty() {
            return Ok(None);
        }
        let table = |point: usize| {
            let point = &points[point];
            tables.get(point).ok_or_else(|| OutputError::NoTable { point: point.name() })
        };
        let own = Rows::read(table(0)?)?;
        let first = points[0].params.len();
        let places = first..own.column("value")?;
        let names = places.clone().map(|place| own.header[place].to_owned()).collect();
        let differences = differences.to_vec();
        let mut found = Self { names, differences, rows: Vec::new(), left_out: BTreeSet::new() };
        for index in 0..found.differences.len() {
            let sides = found.differences[index].points.map(|point| Rows::read(table(point)?));
            let [low, high] = sides;
            found.add(index, &own, [&low?, &high?], first)?;
        }
        Ok(Some(found))
    }

    /// Adds the rows of a parameter; names of values start at the column `first`.
    fn add(
        &mut self,
        index: usize,
        own: &Rows<'_>,
        sides: [&Rows<'_>; 2],
        first: usize,
    ) -> Result<(), OutputError> {
        let [low, high] = self.differences[index].sides;
        let width = high - low;
        let of_value = [first, first + 1, first + 2, own.column("band")?];
        for (row, record) in own.records.iter().enumerate() {
            let is_same = |side: &&Rows<'_>| {
                side.records.len() == own.records.len()
                    && side.header == own.header
                    && of_value.iter().all(|&cell| side.records[row][cell] == record[cell])
            };
            if !sides.iter().all(is_same) {
                let parameter = self.differences[index].parameter.clone();
                return Err(OutputError::OtherProducts { parameter });
            }
            let [(low, low_replicates), (high, high_replicates)] =
                [sides[0].values(row)?, sides[1].values(row)?];
            if low_replicates.is_empty() || low_replicates.len() != high_replicates.len() {
                self.left_out.insert(record[first + 1].to_owned());
                continue;
            }
            let slopes: Vec<f64> = low_replicates
                .iter()
                .zip(&high_replicates)
                .map(|(low, high)| (high - low) / width)
                .collect();
            let spread = Spread::from_rows(1, slopes.iter().map(std::slice::from_ref));
            self.rows.push(DerivativeRow {
                difference: index,
                cells: record
                    .iter()
                    .skip(first)
                    .take(self.names.len())
                    .map(str::to_owned)
                    .collect(),
                value: own.values(row)?.0,
                derivative: (high - low) / width,
                standard_error: spread.standard_error()[0],
            });
        }
        Ok(())
    }

    /// Number of derivatives.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there are no derivatives.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Products that have no derivatives, because they are not made of light, or of sums that are too large to keep.
    pub fn left_out(&self) -> impl Iterator<Item = &str> {
        self.left_out.iter().map(String::as_str)
    }

    /// Writes the table as CSV.
    pub(super) fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(file);
        let own = ["parameter", "at", "step"].map(str::to_owned);
        let last = ["value", "derivative", "standard_error"].map(str::to_owned);
        writer.write_record(own.iter().chain(&self.names).chain(&last))?;
        for row in &self.rows {
            let CentralDifference { parameter, at, step, .. } = &self.differences[row.difference];
            let own = [harmless(parameter), number(*at), number(*step)];
            let last = [row.value, row.derivative, row.standard_error].map(number);
            writer.write_record(own.iter().chain(&row.cells).chain(&last))?;
        }
        writer.flush()
    }

    /// The parameters, and products without derivatives, as they stand in `summary.json`.
    pub(super) fn json(&self) -> Value {
        let parameter = |one: &CentralDifference| json!({ "parameter": one.parameter, "at": one.at, "step": one.step });
        let parameters: Vec<Value> = self.differences.iter().map(parameter).collect();
        json!({ "parameters": parameters, "rows": self.rows.len(), "left_out": self.left_out })
    }
}
