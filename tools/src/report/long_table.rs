//! Tables with a row a value: `sweep.csv` and `compare.csv`.

use std::collections::HashMap;
use std::path::Path;

use anyhow::{Context as _, bail};

/// Maximum number of values that are kept; the points of a longer table are thinned.
const MOST_VALUES: u64 = 2_000_000;

/// Columns that name pixels, whose rows are no products.
const PIXEL: [&str; 2] = ["row", "column"];

/// Values of several points, each of which has the same products: points of a sweep, or transport systems.
#[derive(Debug)]
pub(super) struct LongTable {
    /// Names of the columns that name a point.
    pub(super) params: Vec<String>,
    /// Texts of the points that were kept.
    pub(super) points: Vec<Vec<String>>,
    /// Number of points in the file.
    pub(super) point_count: usize,
    pub(super) products: Vec<LongProduct>,
}

/// A product of a sensor at all points.
#[derive(Debug)]
pub(super) struct LongProduct {
    pub(super) sensor: String,
    pub(super) name: String,
    pub(super) unit: String,
    /// Names of its axes.
    pub(super) axes: Vec<String>,
    /// Texts of the axes of each place.
    pub(super) places: Vec<Vec<String>>,
    pub(super) bands: Vec<String>,
    values: HashMap<[u32; 3], LongValue>,
}

/// A value of a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct LongValue {
    pub(super) value: f64,
    pub(super) error: f64,
    /// Difference to a reference in standard errors, if the table has it.
    pub(super) score: f64,
}

impl LongProduct {
    /// Value at a point, a place and a band; NaN if there is none.
    pub(super) fn at(&self, point: usize, place: usize, band: usize) -> LongValue {
        let none = LongValue { value: f64::NAN, error: f64::NAN, score: f64::NAN };
        self.values.get(&[point as u32, place as u32, band as u32]).copied().unwrap_or(none)
    }

    /// Column of an axis.
    pub(super) fn axis(&self, name: &str) -> Option<usize> {
        self.axes.iter().position(|axis| axis == name)
    }
}

/// Columns of a table.
struct Columns {
    point: Vec<usize>,
    sensor: usize,
    axes: Vec<usize>,
    pixel: Vec<usize>,
    band: usize,
    value: usize,
    score: Option<usize>,
}

impl Columns {
    /// - `system`: whether transport systems take the place of points
    fn new(header: &csv::StringRecord, system: bool) -> Option<Self> {
        let names: Vec<&str> = header.iter().collect();
        let from = |start: usize, name: &str| {
            names[start..].iter().position(|column| *column == name).map(|at| start + at)
        };
        // A parameter may be called `sensor` too.
        let sensor = (0..names.len().saturating_sub(2))
            .rev()
            .find(|&at| names[at..at + 3] == ["sensor", "product", "unit"])?;
        let band = from(sensor, "band")?;
        let between = sensor + 3..band;
        let (pixel, axes) = between.partition(|&at| system && PIXEL.contains(&names[at]));
        Some(Self {
            point: if system { vec![from(band, "system")?] } else { (0..sensor).collect() },
            sensor,
            axes,
            pixel,
            band,
            value: from(band, "value")?,
            score: from(band, "z"),
        })
    }
}

impl LongTable {
    /// Reads a table; of one that is too long, an even choice of its points.
    ///
    /// - `system`: whether transport systems take the place of points
    pub(super) fn read(file: &Path, system: bool) -> anyhow::Result<Self> {
        let shown = file.display();
        let damaged = || format!("{shown} is damaged: run the command again that made it");
        let open = || csv::Reader::from_path(file).with_context(|| format!("cannot read {shown}"));
        let mut reader = open()?;
        let header = reader.headers().with_context(damaged)?.clone();
        let Some(columns) = Columns::new(&header, system) else {
            bail!("{}: it has other columns", damaged());
        };
        let named = |column: &usize| header.get(*column).unwrap_or_default().to_owned();
        let mut table = Self {
            params: columns.point.iter().map(named).collect(),
            points: Vec::new(),
            point_count: 0,
            products: Vec::new(),
        };
        let (count, rows) = count_points(&mut reader, &columns).with_context(damaged)?;
        table.point_count = count;
        let step = if system { 1 } else { rows.div_ceil(MOST_VALUES).max(1) as usize };
        let names: Vec<String> = columns.axes.iter().map(named).collect();
        let mut builder =
            Builder { table, columns, names, step, number: 0, kept: 0, current: None };
        let mut row = csv::StringRecord::new();
        let mut reader = open()?;
        while reader.read_record(&mut row).with_context(damaged)? {
            builder.add(&row);
        }
        Ok(builder.finish())
    }
}

/// Number of points, and of rows.
fn count_points(
    reader: &mut csv::Reader<std::fs::File>,
    columns: &Columns,
) -> anyhow::Result<(usize, u64)> {
    let (mut count, mut rows) = (0, 0);
    let mut before: Vec<String> = Vec::new();
    let mut row = csv::StringRecord::new();
    while reader.read_record(&mut row)? {
        let is_same = before.len() == columns.point.len()
            && columns.point.iter().zip(&before).all(|(&at, text)| row.get(at) == Some(text));
        if !is_same || rows == 0 {
            count += 1;
            before = texts(&row, &columns.point);
        }
        rows += 1;
    }
    Ok((count, rows))
}

fn texts(row: &csv::StringRecord, columns: &[usize]) -> Vec<String> {
    columns.iter().map(|&at| row.get(at).unwrap_or_default().to_owned()).collect()
}

/// A table that is being read.
struct Builder {
    table: LongTable,
    columns: Columns,
    /// Names of the columns of axes.
    names: Vec<String>,
    /// Each so many points, one is kept.
    step: usize,
    /// Number of points so far.
    number: usize,
    /// Number of values so far.
    kept: u64,
    /// Texts of the point of the row before, and its number if it is kept.
    current: Option<(Vec<String>, Option<usize>)>,
}

impl Builder {
    fn add(&mut self, row: &csv::StringRecord) {
        let Some(point) = self.point(row) else { return };
        let cell = |at: usize| row.get(at).unwrap_or_default();
        let sensor = self.columns.sensor;
        let is_pixel = self.columns.pixel.iter().any(|&at| !cell(at).is_empty());
        // A point where nothing was traced has a row without a sensor.
        if cell(sensor).is_empty() || is_pixel || self.kept >= 2 * MOST_VALUES {
            return;
        }
        let products = &mut self.table.products;
        let known = products
            .iter()
            .position(|one| one.sensor == cell(sensor) && one.name == cell(sensor + 1));
        let at = known.unwrap_or_else(|| {
            products.push(LongProduct {
                sensor: cell(sensor).to_owned(),
                name: cell(sensor + 1).to_owned(),
                unit: cell(sensor + 2).to_owned(),
                axes: self.names.clone(),
                places: Vec::new(),
                bands: Vec::new(),
                values: HashMap::new(),
            });
            products.len() - 1
        });
        let product = &mut products[at];
        let place = position(&mut product.places, texts(row, &self.columns.axes));
        let band = position(&mut product.bands, cell(self.columns.band).to_owned());
        let number = |at: usize| cell(at).parse().unwrap_or(f64::NAN);
        let value = LongValue {
            value: number(self.columns.value),
            error: number(self.columns.value + 1),
            score: self.columns.score.map_or(f64::NAN, number),
        };
        product.values.insert([point as u32, place as u32, band as u32], value);
        self.kept += 1;
    }

    /// Number of the point of a row; `None` if it is left out.
    fn point(&mut self, row: &csv::StringRecord) -> Option<usize> {
        let columns = &self.columns.point;
        let is_same = self.current.as_ref().is_some_and(|(texts, _)| {
            columns.iter().zip(texts).all(|(&at, text)| row.get(at) == Some(text))
        });
        if !is_same {
            let point = texts(row, columns);
            let known = self.table.points.iter().position(|one| *one == point);
            let is_kept = self.number.is_multiple_of(self.step);
            self.number += 1;
            let at = known.or_else(|| {
                is_kept.then(|| {
                    self.table.points.push(point.clone());
                    self.table.points.len() - 1
                })
            });
            self.current = Some((point, at));
        }
        self.current.as_ref()?.1
    }

    fn finish(mut self) -> LongTable {
        for product in &mut self.table.products {
            // Axes of other products are empty throughout.
            let used: Vec<bool> = (0..product.axes.len())
                .map(|axis| product.places.iter().any(|texts| !texts[axis].is_empty()))
                .collect();
            let mut flags = used.iter();
            product.axes.retain(|_| *flags.next().unwrap_or(&false));
            for texts in &mut product.places {
                let mut flags = used.iter();
                texts.retain(|_| *flags.next().unwrap_or(&false));
            }
        }
        if self.table.params == ["system"] {
            self.table.point_count = self.table.points.len();
        }
        self.table
    }
}

/// Position of an element, which is appended if it is new.
fn position<T: PartialEq>(all: &mut Vec<T>, one: T) -> usize {
    // Rows are in order, so that it is one of the last or one of the first.
    all.iter().position(|known| *known == one).unwrap_or_else(|| {
        all.push(one);
        all.len() - 1
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    fn read(text: &str, system: bool) -> anyhow::Result<LongTable> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        LongTable::read(file.path(), system)
    }

    #[test]
    fn a_sweep_has_points_places_and_bands() {
        let text = "hour,sensor,product,unit,bottom_m,term,band,value,standard_error,note\n\
            3.0,s,fapar,1,0.0,,red,0.1,0.01,\n3.0,s,fapar,1,0.0,,nir,0.2,0.01,\n\
            3.0,s,fapar,1,1.0,,red,0.3,0.01,\n4.0,,,,,,,,,dark\n5.0,s,fapar,1,1.0,,red,0.4,0.01,\n";
        let table = read(text, false).unwrap();
        assert_eq!((&*table.params, table.point_count), (&["hour".to_owned()][..], 3));
        let product = &table.products[0];
        assert_eq!((&*product.axes, product.places.len()), (&["bottom_m".to_owned()][..], 2));
        assert_eq!(product.bands, ["red", "nir"]);
        assert!((product.at(2, 1, 0).value - 0.4).abs() < 1e-12);
        assert!(product.at(1, 0, 0).value.is_nan());
    }

    #[test]
    fn a_comparison_has_systems_for_points_and_no_pixels() {
        let text = "sensor,product,unit,row,column,band,system,value,standard_error,z,seconds\n\
            s,brf,1,,,red,backward,0.1,0.01,,1\ns,brf,1,,,red,forward,0.2,0.01,2.5,1\n\
            s,brf,1,0,0,red,forward,9.0,0.01,2.5,1\n";
        let table = read(text, true).unwrap();
        assert_eq!(table.points, [["backward"], ["forward"]]);
        assert!((table.products[0].at(1, 0, 0).score - 2.5).abs() < 1e-12);
        assert!((table.products[0].at(1, 0, 0).value - 0.2).abs() < 1e-12);
    }

    #[test]
    fn a_table_of_something_else_is_an_error() {
        let error = format!("{:#}", read("a,b\n1,2\n", false).unwrap_err());
        assert!(error.ends_with("it has other columns"), "{error}");
    }
}
