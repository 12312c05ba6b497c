//! Data sets of a sweep, from the tables of its points: a Zarr store, a `NetCDF` file per sensor.

use std::fs::File;
use std::io::{self, Seek as _, SeekFrom, Write as _};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::dataset::{SweptProduct, of_sweep};
use super::names::{DatasetStems, dataset_name};
use super::rows::harmless;
use super::staging::Staging;
use super::sweep::SweepTable;
use super::{OutputError, length, netcdf, zarr};
use crate::document::FileFormat;
use crate::products::{AxisPoints, Product, ProductAxis, Report, SweepPoint};

/// What the table of a point says of its bands and products, for data sets.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub(super) struct PointLayout {
    /// Centre and width of each band, nm.
    bands: IndexMap<String, [f64; 2]>,
    sensors: IndexMap<String, IndexMap<String, ProductLayout>>,
}

/// Unit and dimensions of a product.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
struct ProductLayout {
    unit: String,
    is_mean: bool,
    dimensions: Vec<Vec<(String, PointsLayout)>>,
}

/// Points of an axis.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(untagged)]
enum PointsLayout {
    Numbers(Vec<f64>),
    Labels(Vec<String>),
}

impl PointLayout {
    /// Layout of a report; `None` if no data sets are asked for.
    pub(super) fn new(report: &Report) -> Option<Self> {
        datasets(report).first()?;
        let sizes = report.wavelengths.iter().zip(&report.bandwidths);
        let bands = report.bands.iter().zip(sizes);
        let bands = bands.map(|(name, (center, width))| (name.clone(), [*center, *width]));
        let products = |products: &[Product]| {
            products.iter().map(|one| (one.name.clone(), ProductLayout::new(one))).collect()
        };
        let sensors = report.sensors.iter();
        let sensors = sensors.map(|sensor| (sensor.name.clone(), products(&sensor.products)));
        Some(Self { bands: bands.collect(), sensors: sensors.collect() })
    }
}

impl ProductLayout {
    fn new(product: &Product) -> Self {
        let points = |points: &AxisPoints| match points {
            AxisPoints::Numbers(numbers) => PointsLayout::Numbers(numbers.clone()),
            AxisPoints::Labels(labels) => PointsLayout::Labels(labels.clone()),
        };
        let axes = |axes: &Vec<ProductAxis>| {
            axes.iter().map(|axis| (axis.name.clone(), points(&axis.points))).collect()
        };
        Self {
            unit: product.unit.clone(),
            is_mean: product.image.is_some() || product.faces.is_some(),
            dimensions: product.dimensions.iter().map(axes).collect(),
        }
    }

    /// The product without values.
    fn product(&self, name: &str) -> Product {
        let points = |points: &PointsLayout| match points {
            PointsLayout::Numbers(numbers) => AxisPoints::Numbers(numbers.clone()),
            PointsLayout::Labels(labels) => AxisPoints::Labels(labels.clone()),
        };
        let axes = |axes: &Vec<(String, PointsLayout)>| {
            let axis = |(name, one): &(String, PointsLayout)| ProductAxis {
                name: name.clone(),
                points: points(one),
            };
            axes.iter().map(axis).collect()
        };
        Product {
            name: name.to_owned(),
            unit: self.unit.clone(),
            dimensions: self.dimensions.iter().map(axes).collect(),
            values: Vec::new(),
            standard_error: Vec::new(),
            replicates: Vec::new(),
            image: None,
            faces: None,
        }
    }
}

/// Formats of data sets that a report asks for.
fn datasets(report: &Report) -> Vec<FileFormat> {
    let all = FileFormat::ALL.into_iter().filter(|format| report.formats.contains(format));
    all.filter(|format| dataset_name("", *format).is_some()).collect()
}

/// Writes the data sets that are asked for. Products whose axes differ from point to point, and those of points whose
/// tables do not say what they hold, are left out.
pub(super) fn put(
    report: &Report,
    points: &[SweepPoint],
    table: &SweepTable<'_>,
    staging: &mut Staging,
) -> Result<(), OutputError> {
    let asked = datasets(report);
    if asked.is_empty() {
        return Ok(());
    }
    let mut common = PointLayout::default();
    for table in table.by_point().iter().flatten() {
        common.join(table.layout()?);
    }
    let report = Report {
        bands: common.bands.keys().cloned().collect(),
        wavelengths: common.bands.values().map(|band| band[0]).collect(),
        bandwidths: common.bands.values().map(|band| band[1]).collect(),
        ..report.clone()
    };
    let mut names = DatasetStems::default();
    for (sensor, layouts) in &common.sensors {
        let stem = names.take(sensor);
        let fail = |source| OutputError::Write { path: staging.shown(&stem), source };
        let mut file = staging.scratch().map_err(fail)?;
        let products = swept_products(layouts, points.len());
        gather(sensor, &products, table, &mut file)?;
        let dataset = of_sweep(&report, sensor, points, &products, &file).map_err(fail)?;
        for format in &asked {
            let Some(name) = dataset_name(&stem, *format) else { continue };
            if *format == FileFormat::Zarr {
                let folder = staging.folder(&name)?;
                let fail = |source| OutputError::Write { path: staging.shown(&name), source };
                zarr::write(&dataset, &folder).map_err(fail)?;
            } else {
                staging.file(&name, |file| netcdf::write(&dataset, file))?;
            }
        }
    }
    Ok(())
}

impl PointLayout {
    /// Adds what another point has, and removes products that differ.
    fn join(&mut self, other: Self) {
        self.bands.extend(other.bands);
        for (sensor, products) in other.sensors {
            let known = self.sensors.entry(sensor).or_default();
            for (name, mut layout) in products {
                let first = known.entry(name).or_insert_with(|| layout.clone());
                if *first != layout {
                    // No point has so many axes: it is left out.
                    layout.dimensions.clear();
                    layout.unit.clear();
                    *first = layout;
                }
            }
        }
    }
}

/// Number of values of a product at a point.
fn count(product: &Product) -> usize {
    product.dimensions.iter().map(|axes| length(axes)).product()
}

/// Products with the places of their numbers.
fn swept_products(layouts: &IndexMap<String, ProductLayout>, points: usize) -> Vec<SweptProduct> {
    let mut place = 0;
    let known = layouts.iter().filter(|(_, layout)| !layout.unit.is_empty());
    let swept = known.map(|(name, layout)| {
        let product = layout.product(name);
        let bytes = (points * count(&product) * size_of::<f64>()) as u64;
        let starts = [place, place + bytes];
        place += 2 * bytes;
        SweptProduct { product, is_mean: layout.is_mean, starts }
    });
    swept.filter(|swept| count(&swept.product) > 0).collect()
}

/// Writes the numbers of all points of a sensor to their places in a file: NaN where there are none.
fn gather(
    sensor: &str,
    products: &[SweptProduct],
    table: &SweepTable<'_>,
    file: &mut File,
) -> Result<(), OutputError> {
    for (place, table) in table.by_point().iter().enumerate() {
        let none = |swept: &SweptProduct| [(); 2].map(|()| vec![f64::NAN; count(&swept.product)]);
        let mut numbers: Vec<[Vec<f64>; 2]> = products.iter().map(none).collect();
        if let Some(table) = table {
            let mut used = vec![0; products.len()];
            table.visit(&mut |row| {
                if row.sensor != harmless(sensor) {
                    return;
                }
                let found =
                    products.iter().position(|swept| row.product == harmless(&swept.product.name));
                let Some(product) = found else { return };
                for (all, number) in numbers[product].iter_mut().zip(row.numbers) {
                    if let Some(value) = all.get_mut(used[product]) {
                        *value = number;
                    }
                }
                used[product] += 1;
            })?;
        }
        let mut write = |start: u64, values: &[f64]| -> io::Result<()> {
            file.seek(SeekFrom::Start(start + (place * values.len() * size_of::<f64>()) as u64))?;
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            file.write_all(&bytes)
        };
        for (swept, numbers) in products.iter().zip(&numbers) {
            for (start, values) in swept.starts.iter().zip(numbers) {
                let written = write(*start, values);
                let path = std::path::PathBuf::from(sensor);
                written.map_err(|source| OutputError::Write { path, source })?;
            }
        }
    }
    Ok(())
}
