//! `summary.json` of a folder of results, as a report needs it.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context as _, bail};
use indexmap::IndexMap;
use serde::Deserialize;
use serde_json::Value;

use super::quantity::Quantity;

/// Largest summary that is read, bytes.
const LARGEST: u64 = 4 << 30;

/// Name of the file.
const FILE: &str = "summary.json";

/// What the summary of a run, a sweep or a comparison holds.
#[derive(Debug, Deserialize)]
pub(super) struct Summary {
    /// Title of the scene.
    pub(super) scene: String,
    #[serde(default = "run")]
    pub(super) command: String,
    /// Path of the scene, relative to the folder of the results.
    pub(super) scene_file: Option<String>,
    #[serde(default)]
    pub(super) params: IndexMap<String, Value>,
    pub(super) variant: Option<String>,
    #[serde(default)]
    pub(super) set: IndexMap<String, Value>,
    pub(super) quality: Option<f64>,
    pub(super) hash: String,
    pub(super) version: String,
    pub(super) seed: u64,
    #[serde(default)]
    pub(super) files: Vec<String>,
    pub(super) seconds: Option<f64>,
    pub(super) rays: Option<u64>,
    #[serde(default)]
    pub(super) bands: Vec<String>,
    #[serde(default)]
    pub(super) wavelengths_nm: Vec<Option<f64>>,
    /// Wall time of each stage, s.
    #[serde(default)]
    pub(super) stages: IndexMap<String, f64>,
    #[serde(default)]
    pub(super) skipped: Vec<String>,
    #[serde(default)]
    pub(super) notes: Vec<String>,
    #[serde(default)]
    pub(super) warnings: Vec<String>,
    #[serde(default)]
    sensors: IndexMap<String, IndexMap<String, Entry>>,
    #[serde(default)]
    pub(super) runs: IndexMap<String, SensorRun>,
    /// Reason by the name of each point of a sweep where nothing was traced.
    #[serde(default)]
    pub(super) no_data: IndexMap<String, String>,
}

fn run() -> String {
    "run".to_owned()
}

/// A product in the summary.
#[derive(Debug, Deserialize)]
struct Entry {
    unit: String,
    axes: IndexMap<String, Points>,
    #[serde(default)]
    coordinates: IndexMap<String, IndexMap<String, Points>>,
    values: Vec<Option<f64>>,
    standard_error: Vec<Option<f64>>,
    #[serde(default)]
    files: Vec<String>,
}

/// Points of an axis.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub(super) enum Points {
    Numbers(Vec<f64>),
    Labels(Vec<String>),
}

/// Work of a sensor.
#[derive(Debug, Deserialize)]
pub(super) struct SensorRun {
    pub(super) seconds: f64,
    pub(super) rays: u64,
    pub(super) samples: u64,
    pub(super) ended_by: String,
    pub(super) file_bytes: Option<u64>,
    pub(super) forecast: Option<Forecast>,
    pub(super) energy_imbalance: Option<f64>,
}

/// Forecast of a long measurement.
#[derive(Debug, Deserialize)]
pub(super) struct Forecast {
    pub(super) memory_bytes: u64,
}

/// A folder of results.
#[derive(Debug)]
pub(super) struct Results {
    /// Path as the user wrote it.
    pub(super) folder: PathBuf,
    pub(super) summary: Summary,
    /// All products of all sensors, in the order of the scene.
    pub(super) quantities: Vec<Quantity>,
    /// Time when the summary was written, if the file system knows it.
    pub(super) written: Option<SystemTime>,
}

impl Results {
    /// Reads the summary of a folder.
    ///
    /// # Errors
    /// If the path is no folder, or holds no summary of sunfleck.
    pub(super) fn read(folder: &Path) -> anyhow::Result<Self> {
        let path = folder.join(FILE);
        let shown = folder.display();
        if folder.is_file() {
            bail!("{shown} is a file: name the folder of the results, such as out/birch_stand");
        }
        if !folder.is_dir() {
            bail!(
                "{shown} does not exist: name the folder of the results, such as out/birch_stand"
            );
        }
        if !path.is_file() {
            bail!(
                "{shown} holds no results of `run`, `sweep` or `compare`: it has no {FILE}{}",
                nearby(folder)
            );
        }
        let metadata =
            fs::metadata(&path).with_context(|| format!("cannot read {}", path.display()))?;
        if metadata.len() > LARGEST {
            bail!("{} is larger than 4 GiB: no report is made of it", path.display());
        }
        let file = File::open(&path).with_context(|| format!("cannot read {}", path.display()))?;
        let mut summary: Summary =
            serde_json::from_reader(BufReader::new(file)).with_context(|| {
                format!(
                    "{} is damaged, or not written by sunfleck; run the scene again",
                    path.display()
                )
            })?;
        let quantities = quantities(&mut summary)
            .with_context(|| format!("{} is damaged; run the scene again", path.display()))?;
        Ok(Self {
            folder: folder.to_owned(),
            summary,
            quantities,
            written: metadata.modified().ok(),
        })
    }

    /// Absolute path of the scene file, if it is still there.
    pub(super) fn scene_file(&self) -> Option<PathBuf> {
        let folder = self.folder.canonicalize().ok()?;
        folder.join(self.summary.scene_file.as_ref()?).canonicalize().ok()
    }

    /// Centre wavelength of a band, nm.
    pub(super) fn wavelength(&self, band: &str) -> Option<f64> {
        let index = self.summary.bands.iter().position(|name| name == band)?;
        self.summary.wavelengths_nm.get(index).copied().flatten()
    }
}

/// Text that names a folder of results within this one.
fn nearby(folder: &Path) -> String {
    let Ok(entries) = fs::read_dir(folder) else { return String::new() };
    // A folder may have very many entries.
    let mut found: Vec<PathBuf> = entries
        .take(10_000)
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.join(FILE).is_file())
        .collect();
    found.sort();
    found.first().map_or_else(String::new, |path| format!("; did you mean {}?", path.display()))
}

fn quantities(summary: &mut Summary) -> anyhow::Result<Vec<Quantity>> {
    let mut all = Vec::new();
    for (sensor, products) in std::mem::take(&mut summary.sensors) {
        for (name, entry) in products {
            let known = |values: Vec<Option<f64>>| -> Vec<f64> {
                values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()
            };
            let mut coordinates = entry.coordinates;
            let dimensions = entry.axes.into_iter().map(|(axis, points)| {
                let others = coordinates.swap_remove(&axis).unwrap_or_default();
                std::iter::once((axis, points)).chain(others).collect()
            });
            all.push(Quantity::new(Quantity {
                dimensions: dimensions.collect(),
                values: known(entry.values),
                errors: known(entry.standard_error),
                sensor: sensor.clone(),
                unit: entry.unit,
                files: entry.files,
                name,
            })?);
        }
    }
    Ok(all)
}
