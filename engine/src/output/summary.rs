//! `summary.json`: every number of a run but the pixels.

use std::io::{self, Write};

use serde::{Serialize, Serializer};
use serde_json::ser::Formatter;

use super::length;
use super::names::{ProductNames, SensorNames};
use crate::products::{AxisPoints, Forecast, Product, Report, SensorReport};

/// Writes numbers so that they read back as the same f64; NaN becomes `null`.
///
/// - `sizes`: of the files of each sensor, bytes
pub(super) fn write(
    report: &Report,
    (plan, sizes): (&[SensorNames], &[u64]),
    file: &mut impl Write,
) -> io::Result<()> {
    let sensors = || report.sensors.iter().zip(plan);
    let summary = Summary {
        scene: &report.scene,
        hash: &report.hash,
        version: &report.version,
        seed: report.seed,
        seconds: report.seconds,
        rays: report.rays,
        bands: &report.bands,
        wavelengths_nm: &report.wavelengths,
        stages: Ordered(report.stages.iter().map(|(name, s)| (name.as_str(), *s)).collect()),
        skipped: &report.skipped,
        warnings: &report.warnings,
        sensors: Ordered(sensors().map(|(s, n)| (n.key.as_str(), products(s, n))).collect()),
        runs: Ordered(
            sensors()
                .zip(sizes)
                .map(|((s, n), size)| (n.key.as_str(), Run::of(s, *size)))
                .collect(),
        ),
    };
    let mut serializer = serde_json::Serializer::with_formatter(&mut *file, OneKeyALine::default());
    summary.serialize(&mut serializer)?;
    writeln!(file)
}

#[derive(Serialize)]
struct Summary<'a> {
    scene: &'a str,
    hash: &'a str,
    version: &'a str,
    seed: u64,
    seconds: f64,
    rays: u64,
    bands: &'a [String],
    wavelengths_nm: &'a [f64],
    stages: Ordered<'a, f64>,
    skipped: &'a [String],
    warnings: &'a [String],
    sensors: Ordered<'a, Ordered<'a, Entry<'a>>>,
    runs: Ordered<'a, Run<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    unit: &'a str,
    axes: Ordered<'a, Points<'a>>,
    shape: Vec<usize>,
    values: &'a [f64],
    standard_error: &'a [f64],
    files: Vec<String>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Points<'a> {
    Numbers(&'a [f64]),
    Labels(&'a [String]),
}

#[derive(Serialize)]
struct Run<'a> {
    seconds: f64,
    rays: u64,
    samples: u64,
    ended_by: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    file_bytes: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    forecast: Option<Expected>,
    #[serde(skip_serializing_if = "Option::is_none")]
    energy_imbalance: Option<f64>,
}

impl<'a> Run<'a> {
    fn of(sensor: &'a SensorReport, size: u64) -> Self {
        let SensorReport { seconds, rays, samples, ref ended_by, energy_imbalance, .. } = *sensor;
        let Forecast { memory, files, .. } = sensor.forecast;
        let expected = Expected { seconds: sensor.forecast.seconds, memory, files };
        let forecast = sensor.forecast.is_long().then_some(expected);
        let file_bytes = forecast.is_some().then_some(size);
        Self { seconds, rays, samples, ended_by, file_bytes, forecast, energy_imbalance }
    }
}

/// What was told of a long measurement after its first samples.
#[derive(Serialize)]
struct Expected {
    seconds: f64,
    #[serde(rename = "memory_bytes")]
    memory: u64,
    #[serde(rename = "file_bytes")]
    files: u64,
}

fn products<'a>(sensor: &'a SensorReport, names: &'a SensorNames) -> Ordered<'a, Entry<'a>> {
    let pairs = sensor.products.iter().zip(&names.products);
    Ordered(pairs.map(|(product, names)| (names.key.as_str(), entry(product, names))).collect())
}

fn entry<'a>(product: &'a Product, names: &ProductNames) -> Entry<'a> {
    let axes = product.dimensions.iter().flatten().map(|axis| {
        let points = match &axis.points {
            AxisPoints::Numbers(numbers) => Points::Numbers(numbers),
            AxisPoints::Labels(labels) => Points::Labels(labels),
        };
        (axis.name.as_str(), points)
    });
    Entry {
        unit: &product.unit,
        axes: Ordered(axes.collect()),
        shape: product.dimensions.iter().map(|dimension| length(dimension)).collect(),
        values: &product.values,
        standard_error: &product.standard_error,
        files: match (&product.image, &product.faces) {
            (_, Some(_)) => vec![names.ply()],
            (Some(_), _) => names.image().into(),
            (None, None) => vec![names.csv()],
        },
    }
}

/// A JSON object whose keys keep their order.
struct Ordered<'a, V>(Vec<(&'a str, V)>);

impl<V: Serialize> Serialize for Ordered<'_, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

/// Indents objects and keeps each array on one line, for people and for `diff`.
#[derive(Default)]
struct OneKeyALine {
    depth: usize,
}

impl OneKeyALine {
    fn break_line<W: ?Sized + Write>(&self, writer: &mut W) -> io::Result<()> {
        writeln!(writer)?;
        (0..self.depth).try_for_each(|_| writer.write_all(b"  "))
    }
}

impl Formatter for OneKeyALine {
    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        writer.write_all(b"{")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        if !first {
            w.write_all(b",")?;
        }
        self.break_line(w)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth -= 1;
        self.break_line(writer)?;
        writer.write_all(b"}")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { w.write_all(b", ") }
    }
}
