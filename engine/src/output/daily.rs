//! Sums of a sweep over the hours of a day.
//!
//! `scenes/RESULTS.md` has the formulas. Products in units of power become energy; shares of the incident
//! light become their mean weighted with the irradiance. All others have no sum.

use std::io::{self, Write};

use indexmap::IndexMap;
use serde_json::{Map, Value, json};

use super::OutputError;
use super::point_tables::{PointTable, PointTables};
use super::rows::{harmless, number};
use crate::document::Param;
use crate::products::{Day, SweepPoint};

pub(super) const FILE: &str = "daily.csv";

/// Megajoules of a watt over an hour.
const MJ_OF_WH: f64 = 3600.0 * 1e-6;

/// Sums over the hours of each day of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct DailySums {
    /// Columns that name a value: those of the sweep's table without values and without the parameters.
    names: Vec<String>,
    rows: Vec<DailyRow>,
}

#[derive(Clone, Debug, PartialEq)]
struct DailyRow {
    params: Vec<(String, Param)>,
    span_h: (f64, f64),
    /// A cell for each of the names.
    cells: Vec<String>,
    value: f64,
    standard_error: f64,
}

/// Integral of a product over time, or its weighted mean, as it adds up over the points of a day.
#[derive(Clone, Debug, Default)]
struct Sum {
    value: f64,
    /// Bound of the standard error: that of points whose errors are equal.
    error: f64,
    /// Sum of the weights of a mean.
    weight: f64,
    points: usize,
}

/// Value and bound of its standard error.
#[derive(Clone, Copy, Debug)]
struct Estimate {
    value: f64,
    standard_error: f64,
}

/// Rule for the sum of a product over a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Power, whose integral over time is energy.
    Power,
    /// Fraction of the incident light.
    Share,
}

impl Kind {
    fn from_unit(product: &str, unit: &str) -> Option<Self> {
        let is_share = ["albedo", "fapar", "ftran"].iter().any(|name| product.starts_with(name));
        if unit.starts_with("W ") {
            Some(Self::Power)
        } else {
            (unit == "1" && is_share).then_some(Self::Share)
        }
    }

    fn unit(self, unit: &str) -> String {
        match self {
            Self::Power => unit.replacen("W ", "MJ ", 1),
            Self::Share => unit.to_owned(),
        }
    }
}

/// Sums over the days of a sweep whose points have these tables; none if no point of any day has a
/// product that adds up.
///
/// # Errors
/// If the table of a point cannot be read.
pub fn daily_sums(
    days: &[Day],
    points: &[SweepPoint],
    tables: &PointTables,
) -> Result<Option<DailySums>, OutputError> {
    let mut sums = DailySums { names: Vec::new(), rows: Vec::new() };
    for day in days {
        let mut found: IndexMap<Vec<(String, String)>, (Kind, Sum)> = IndexMap::new();
        for &(index, weight_h) in &day.weights_h {
            let point = &points[index];
            if let Some(table) = tables.get(point) {
                add_point(table, point.params.len(), weight_h, &mut found)?;
            }
        }
        for (cells, (kind, sum)) in found {
            let traced = day.weights_h.len();
            sums.push(day, &cells, sum.finish(kind, traced));
        }
    }
    Ok(Some(sums).filter(|sums| !sums.rows.is_empty()))
}

/// Adds all values of a point's table, behind its columns of parameters, to the sums of a day.
fn add_point(
    table: &PointTable,
    params: usize,
    weight_h: f64,
    found: &mut IndexMap<Vec<(String, String)>, (Kind, Sum)>,
) -> Result<(), OutputError> {
    let unreadable = |error: csv::Error| table.unreadable(error.into());
    let lit = table.irradiance()?;
    let mut rows = table.rows()?;
    let header = rows.headers().cloned().map_err(unreadable)?;
    for row in rows.records() {
        let row = row.map_err(unreadable)?;
        let cell = |name: &str| {
            let at = header.iter().skip(params).position(|column| column == name);
            at.and_then(|at| row.get(at + params)).unwrap_or("")
        };
        let Some(kind) = Kind::from_unit(cell("product"), cell("unit")) else { continue };
        let weight = match kind {
            Kind::Power => weight_h * MJ_OF_WH,
            Kind::Share => match lit.get(cell("band")) {
                Some(irradiance) => weight_h * irradiance,
                None => continue,
            },
        };
        let names = header.iter().zip(&row).skip(params);
        let names = names.filter(|(name, _)| !["value", "standard_error"].contains(name));
        let cells = names.map(|(name, cell)| match name {
            "unit" => (name.to_owned(), kind.unit(cell)),
            _ => (name.to_owned(), cell.to_owned()),
        });
        let value = |name: &str| cell(name).parse().unwrap_or(f64::NAN);
        let (_, sum) = found.entry(cells.collect()).or_insert((kind, Sum::default()));
        sum.add(weight, value("value"), value("standard_error"));
    }
    Ok(())
}

impl Sum {
    fn add(&mut self, weight: f64, value: f64, error: f64) {
        self.points += 1;
        // A share of no light has no value and no weight.
        if weight > 0.0 {
            self.value += weight * value;
            self.error += weight * error;
            self.weight += weight;
        }
    }

    /// Value and standard error; none of a product that some of the traced points lack.
    fn finish(&self, kind: Kind, traced: usize) -> Estimate {
        let divisor = match kind {
            _ if self.points != traced => f64::NAN,
            Kind::Power => 1.0,
            Kind::Share => self.weight,
        };
        Estimate { value: self.value / divisor, standard_error: self.error / divisor }
    }
}

impl DailySums {
    fn push(&mut self, day: &Day, cells: &[(String, String)], estimate: Estimate) {
        let mut place = self.names.len();
        for (name, _) in cells.iter().rev() {
            if let Some(known) = self.names.iter().position(|known| known == name) {
                place = known;
            } else {
                self.names.insert(place, name.clone());
                let rows = self.rows.iter_mut();
                rows.for_each(|row| row.cells.insert(place, String::new()));
            }
        }
        let cell = |name: &String| {
            let found = cells.iter().find(|(known, _)| known == name);
            found.map(|(_, cell)| cell.clone()).unwrap_or_default()
        };
        self.rows.push(DailyRow {
            params: day.params.clone(),
            span_h: day.span_h,
            cells: self.names.iter().map(cell).collect(),
            value: estimate.value,
            standard_error: estimate.standard_error,
        });
    }

    /// Writes them as a table.
    pub(super) fn write(&self, file: &mut impl Write) -> io::Result<()> {
        let mut writer = csv::Writer::from_writer(file);
        let params = self.rows.first().map_or(&[][..], |row| &row.params);
        let params = params.iter().map(|(name, _)| harmless(name));
        let after = ["value", "standard_error", "from_h", "to_h"].map(str::to_owned);
        writer.write_record(params.chain(self.names.iter().cloned()).chain(after))?;
        for row in &self.rows {
            let params = row.params.iter().map(|(_, value)| match value {
                Param::Number(value) => number(*value),
                Param::Text(text) => harmless(text),
            });
            let numbers = [row.value, row.standard_error, row.span_h.0, row.span_h.1];
            let cells = params.chain(row.cells.iter().cloned()).chain(numbers.map(number));
            writer.write_record(cells)?;
        }
        writer.flush()
    }

    /// Returns the rows as a list of objects; numbers without a value are null.
    pub(super) fn json(&self) -> Value {
        let row = |row: &DailyRow| {
            let params: Map<_, _> =
                row.params.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
            let mut entry = Map::from_iter([("params".to_owned(), Value::Object(params))]);
            let cells = self.names.iter().zip(&row.cells).filter(|(_, cell)| !cell.is_empty());
            entry.extend(cells.map(|(name, cell)| (name.clone(), json!(cell))));
            let numbers = [
                ("value", row.value),
                ("standard_error", row.standard_error),
                ("from_h", row.span_h.0),
                ("to_h", row.span_h.1),
            ];
            entry.extend(numbers.map(|(name, value)| (name.to_owned(), json!(value))));
            Value::Object(entry)
        };
        self.rows.iter().map(row).collect()
    }
}
