//! `summary.json`: every number of a run but the pixels.

use std::io::{self, Write};

use serde::{Serialize, Serializer};
use serde_json::ser::Formatter;

use super::daily::DailySums;
use super::derivatives::DerivativeTable;
use super::length;
use super::lines::Lines;
use super::manifest::SUMMARY;
use super::names::{ProductNames, SensorNames};
use super::provenance::RecipeRecord;
use super::rows::columns;
use crate::document::Param;
use crate::products::{AxisPoints, Forecast, Product, Report, SensorReport, SweepPoint};
use crate::spectral::ResponseRecord;

/// Names and sizes of a report's files.
pub(super) struct Sizes<'a> {
    pub(super) plan: &'a [SensorNames],
    /// Size of the files of each sensor, bytes.
    pub(super) bytes: &'a [u64],
}

/// Origin of results, and the names of their files.
#[derive(Serialize)]
pub(super) struct Head<'a> {
    scene: &'a str,
    command: &'a str,
    /// Path of the scene, relative to the folder of the results.
    scene_file: Option<String>,
    params: Ordered<'a, &'a Param>,
    variant: Option<&'a str>,
    set: Ordered<'a, &'a Param>,
    quality: f64,
    hash: &'a str,
    version: &'a str,
    seed: u64,
    files: Vec<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recipe: Option<RecipeRecord>,
}

impl<'a> Head<'a> {
    pub(super) fn new(report: &'a Report, command: &'a str, scene_file: Option<String>) -> Self {
        let source = report.source.as_ref();
        let values = |list: &'a [(String, Param)]| {
            Ordered(list.iter().map(|(name, value)| (name.as_str(), value)).collect())
        };
        Self {
            scene: &report.scene,
            command,
            scene_file,
            params: values(&report.params),
            variant: source.and_then(|source| source.variant.as_deref()),
            set: values(source.map_or(&[], |source| &source.set)),
            quality: source.map_or(1.0, |source| source.quality),
            hash: &report.hash,
            version: &report.version,
            seed: report.seed,
            files: Vec::new(),
            recipe: None,
        }
    }

    /// Adds the names of all files but the summary.
    pub(super) fn with_files(mut self, names: &[String]) -> Self {
        self.files = names.iter().cloned().chain([SUMMARY.to_owned()]).collect();
        self
    }

    /// Adds what repeats the run.
    pub(super) fn with_recipe(self, recipe: Option<RecipeRecord>) -> Self {
        Self { recipe, ..self }
    }

    /// Text about the changes that were made to the scene.
    pub(super) fn changes(&self) -> String {
        let set =
            self.set.0.iter().map(|(name, value)| (*name, serde_json::json!(value).to_string()));
        changes(self.variant, set, self.quality)
    }
}

/// Text about the changes that were made to a scene.
pub(super) fn changes<'a>(
    variant: Option<&str>,
    set: impl Iterator<Item = (&'a str, String)>,
    quality: f64,
) -> String {
    let mut set: Vec<String> = set.map(|(name, value)| format!("{name} = {value}")).collect();
    set.sort();
    let variant = variant.map(|name| format!("of the variant `{name}`"));
    let set = (!set.is_empty()).then(|| format!("with {}", set.join(", ")));
    #[expect(clippy::float_cmp, reason = "the default is this very number")]
    let quality = (quality != 1.0).then(|| format!("of the quality {quality}"));
    let all: Vec<String> = variant.into_iter().chain(set).chain(quality).collect();
    if all.is_empty() { "of the scene as it is".to_owned() } else { all.join(" ") }
}

/// Writes all results as JSON; numbers read back as the same f64, and NaN becomes `null`.
pub(super) fn write(
    head: &Head<'_>,
    report: &Report,
    sizes: &Sizes<'_>,
    file: &mut impl Write,
) -> io::Result<()> {
    let sensors = || report.sensors.iter().zip(sizes.plan);
    let summary = Summary {
        head,
        seconds: report.seconds,
        rays: report.rays,
        bands: &report.bands,
        wavelengths_nm: &report.wavelengths,
        irradiance: &report.irradiance,
        responses: report.responses.iter().map(ResponseRecord::from).collect(),
        stages: Ordered(report.stages.iter().map(|(name, s)| (name.as_str(), *s)).collect()),
        skipped: &report.skipped,
        notes: &report.notes,
        warnings: &report.warnings,
        sensors: Ordered(
            sensors().map(|(s, n)| (n.key.as_str(), products(report, s, n))).collect(),
        ),
        runs: Ordered(
            sensors()
                .zip(sizes.bytes)
                .map(|((s, n), size)| (n.key.as_str(), Run::new(s, *size)))
                .collect(),
        ),
    };
    write_json(&summary, file)
}

/// Writes where files come from, and no results.
pub(super) fn write_head(head: &Head<'_>, file: &mut impl Write) -> io::Result<()> {
    write_json(head, file)
}

/// Writes where a sweep comes from, warnings of its points, why points have no data, its sums over days, and what it has derivatives of.
pub(super) fn write_sweep(
    head: &Head<'_>,
    warnings: &[String],
    points: &[SweepPoint],
    daily: Option<&DailySums>,
    derivatives: Option<&DerivativeTable>,
    file: &mut impl Write,
) -> io::Result<()> {
    let dark = points.iter().filter_map(|point| Some((point.name(), point.darkness()?)));
    let no_data: serde_json::Map<_, _> = dark.map(|(name, why)| (name, why.into())).collect();
    let (daily, derivatives) = (daily.map(DailySums::json), derivatives.map(DerivativeTable::json));
    write_json(&SweepSummary { head, warnings, no_data, daily, derivatives }, file)
}

#[derive(Serialize)]
struct SweepSummary<'a> {
    #[serde(flatten)]
    head: &'a Head<'a>,
    /// Warnings, each with its points.
    warnings: &'a [String],
    /// Reason by the name of each point where nothing was traced.
    #[serde(skip_serializing_if = "serde_json::Map::is_empty")]
    no_data: serde_json::Map<String, serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    daily: Option<serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    derivatives: Option<serde_json::Value>,
}

fn write_json(value: &impl Serialize, file: &mut impl Write) -> io::Result<()> {
    let mut serializer = serde_json::Serializer::with_formatter(&mut *file, OneKeyALine::default());
    value.serialize(&mut serializer)?;
    writeln!(file)
}

#[derive(Serialize)]
struct Summary<'a> {
    #[serde(flatten)]
    head: &'a Head<'a>,
    seconds: f64,
    rays: u64,
    bands: &'a [String],
    wavelengths_nm: &'a [f64],
    /// Total irradiance on the horizontal plane, W m⁻² nm⁻¹.
    irradiance: &'a [f64],
    responses: Vec<ResponseRecord>,
    stages: Ordered<'a, f64>,
    skipped: &'a [String],
    notes: &'a [String],
    warnings: &'a [String],
    sensors: Ordered<'a, Ordered<'a, Entry<'a>>>,
    runs: Ordered<'a, Run<'a>>,
}

#[derive(Serialize)]
struct Entry<'a> {
    unit: &'a str,
    /// One axis per dimension, slowest first.
    axes: Ordered<'a, Points>,
    /// Points of further axes along the same dimension, as many as it has.
    #[serde(skip_serializing_if = "Ordered::is_empty")]
    coordinates: Ordered<'a, Coordinates>,
    shape: Vec<usize>,
    values: &'a [f64],
    standard_error: &'a [f64],
    files: Vec<String>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Points {
    Numbers(Vec<f64>),
    Labels(Vec<String>),
}

/// Points of further axes along one, each with its name.
struct Coordinates(Vec<(String, Points)>);

impl Serialize for Coordinates {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, points)| (name, points)))
    }
}

impl From<AxisPoints> for Points {
    fn from(points: AxisPoints) -> Self {
        match points {
            AxisPoints::Numbers(numbers) => Self::Numbers(numbers),
            AxisPoints::Labels(labels) => Self::Labels(labels),
        }
    }
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
    fn new(sensor: &'a SensorReport, size: u64) -> Self {
        let SensorReport { seconds, rays, samples, ref ended_by, energy_imbalance, .. } = *sensor;
        let Forecast { memory, files, .. } = sensor.forecast;
        let expected = Expected { seconds: sensor.forecast.seconds, memory, files };
        let forecast = sensor.forecast.is_long().then_some(expected);
        let file_bytes = forecast.is_some().then_some(size);
        Self { seconds, rays, samples, ended_by, file_bytes, forecast, energy_imbalance }
    }
}

/// Forecast of a long measurement after its first samples.
#[derive(Serialize)]
struct Expected {
    seconds: f64,
    #[serde(rename = "memory_bytes")]
    memory: u64,
    #[serde(rename = "file_bytes")]
    files: u64,
}

fn products<'a>(
    report: &Report,
    sensor: &'a SensorReport,
    names: &'a SensorNames,
) -> Ordered<'a, Entry<'a>> {
    let pairs = sensor.products.iter().zip(&names.products);
    let datasets: Vec<String> = names.datasets(&report.formats).collect();
    let entries = pairs.map(|(product, names)| {
        let mut entry = entry(report, product, names);
        entry.files.extend_from_slice(&datasets);
        (names.key.as_str(), entry)
    });
    Ordered(entries.collect())
}

fn entry<'a>(report: &Report, product: &'a Product, names: &ProductNames) -> Entry<'a> {
    let (mut axes, mut coordinates) = (Vec::new(), Vec::new());
    for dimension in &product.dimensions {
        let Some(first) = dimension.first() else { continue };
        axes.push((first.name.as_str(), first.points.clone().into()));
        let others = columns(dimension, report).split_off(1);
        if !others.is_empty() {
            let others = others.into_iter().map(|axis| (axis.name, axis.points.into()));
            coordinates.push((first.name.as_str(), Coordinates(others.collect())));
        }
    }
    Entry {
        unit: &product.unit,
        axes: Ordered(axes),
        coordinates: Ordered(coordinates),
        shape: product.dimensions.iter().map(|dimension| length(dimension)).collect(),
        values: &product.values,
        standard_error: &product.standard_error,
        files: match (&product.image, &product.faces) {
            (_, Some(_)) => vec![names.ply()],
            (Some(_), _) => names.image(&report.formats),
            (None, None) => {
                let chart = Lines::new(product, None).map(|_| names.svg());
                std::iter::once(names.csv()).chain(chart).collect()
            }
        },
    }
}

/// A JSON object whose keys keep their order.
struct Ordered<'a, V>(Vec<(&'a str, V)>);

impl<V> Ordered<'_, V> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<V: Serialize> Serialize for Ordered<'_, V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

/// Indents objects and keeps each array on one line, for people and for `diff`.
#[derive(Default)]
struct OneKeyALine {
    depth: usize,
    /// True if the object that began last has no key yet.
    is_empty: bool,
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
        self.is_empty = true;
        writer.write_all(b"{")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        if !first {
            w.write_all(b",")?;
        }
        self.is_empty = false;
        self.break_line(w)
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth -= 1;
        if !std::mem::take(&mut self.is_empty) {
            self.break_line(writer)?;
        }
        writer.write_all(b"}")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, w: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { w.write_all(b", ") }
    }
}
