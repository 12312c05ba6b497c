//! Folder of the results of one command for one scene, and rules for replacing older results.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::daily::{self, DailySums};
use super::derivatives::{DERIVATIVES, DerivativeTable};
use super::manifest::{Manifest, relative};
use super::provenance::{RecipeRecord, RecipeTexts};
use super::staging::Staging;
use super::summary::{Head, Sizes};
use super::sweep::SweepTable;
use super::{OutputError, names, put_products, summary, sweep_datasets};
use crate::document::Param;
use crate::products::{Report, SceneSource, SweepPoint};

/// A folder that results of a command for a scene are written to, as one set of files.
///
/// A new set takes the place of an old one in one step: at any moment the folder holds all of one run
/// and nothing of another. Files in it that are no results stay.
#[derive(Clone, Debug)]
pub struct Results {
    folder: PathBuf,
    command: &'static str,
    /// Absolute path of the scene; none of a scene that was built.
    scene: Option<PathBuf>,
    force: bool,
}

/// Files that were written.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// Folder of the files. It has a number appended if files that are no results had their names.
    pub folder: PathBuf,
    /// Paths of the files, `summary.json` last.
    pub files: Vec<PathBuf>,
    /// Text about the results that they replace, if those are of another scene or of other parameters.
    pub replaced: Option<String>,
}

/// File of the coefficients that a run has kept.
pub const COEFFICIENTS: &str = "coefficients.bin";

/// Scene of the results in a folder, and the changes that were made to it.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultsOrigin {
    /// File of the scene.
    pub scene: PathBuf,
    /// Variant that was applied.
    pub variant: Option<String>,
    /// Parameters that were set.
    pub set: Vec<(String, Param)>,
}

impl ResultsOrigin {
    /// Origin of the results in a folder; `None` if it holds none of a run, or their scene is not known.
    #[must_use]
    pub fn read(folder: &Path) -> Option<Self> {
        let manifest = Manifest::read(folder)?;
        let folder = folder.canonicalize().ok()?;
        let param = |(name, value): (&String, &serde_json::Value)| {
            let value = match value {
                serde_json::Value::Number(number) => Param::Number(number.as_f64()?),
                serde_json::Value::String(text) => Param::Text(text.clone()),
                _ => return None,
            };
            Some((name.clone(), value))
        };
        Some(Self {
            scene: manifest.scene_file(&folder)?,
            set: manifest.set.iter().filter_map(param).collect(),
            variant: manifest.variant,
        })
    }
}

/// Number of folder names that are tried before writing fails.
const ATTEMPTS: u32 = 1000;

impl Results {
    /// Tries whether results can be written to a folder before anything is traced; leaves everything
    /// as it was, but ends what a killed run began there.
    ///
    /// - `command`: command that makes the results, such as `run`
    /// - `scene`: file of the scene
    /// - `force`: true if results of another scene or command may be replaced
    ///
    /// # Errors
    /// If the folder cannot be made or written to, or holds results of another scene or command.
    pub fn open(
        folder: &Path,
        command: &'static str,
        scene: &Path,
        force: bool,
    ) -> Result<Self, OutputError> {
        let scene = Some(scene.canonicalize().unwrap_or_else(|_not_there| scene.to_owned()));
        let results = Self { folder: folder.to_owned(), command, scene, force };
        results.stage(folder)?;
        Ok(results)
    }

    /// Results that replace those of any scene in the folder.
    pub(super) fn for_any_scene(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), command: "run", scene: None, force: true }
    }

    /// Writes all files of a report.
    ///
    /// # Errors
    /// If a file cannot be written, or a product's shape contradicts its axes; then the folder is as
    /// it was.
    pub fn write(&self, report: &Report) -> Result<Written, OutputError> {
        self.write_with(report, |_| Ok(()))
    }

    /// Writes all files of a report, and more files.
    pub(super) fn write_with(
        &self,
        report: &Report,
        more: impl Fn(&mut Staging) -> Result<(), OutputError>,
    ) -> Result<Written, OutputError> {
        let plan = names::plan(report);
        self.put(|folder, staging| {
            let record = RecipeRecord::new(report, staging.target());
            let recipe = RecipeTexts::new(record.as_ref());
            let recipe =
                recipe.map_err(|source| OutputError::Write { path: folder.to_owned(), source })?;
            let sizes = put_products(report, &plan, &recipe, staging)?;
            if let Some(bytes) = &report.coefficients {
                staging.file(COEFFICIENTS, |file| file.write_all(bytes))?;
            }
            more(staging)?;
            let way = self.way_to_scene(staging, report.source.as_ref());
            let head = Head::new(report, self.command, way);
            let head = head.with_files(staging.names()).with_recipe(record);
            let sizes = Sizes { plan: &plan, bytes: &sizes };
            staging.file("summary.json", |file| summary::write(&head, report, &sizes, file))?;
            Ok(replaced(staging, folder, self.command, report))
        })
    }

    /// Writes files that need nothing beside them.
    pub(super) fn write_alone(
        &self,
        mut fill: impl FnMut(&mut Staging) -> Result<(), OutputError>,
    ) -> Result<Written, OutputError> {
        self.put(|_, staging| fill(staging).map(|()| None))
    }

    /// Writes texts, each with its name, and a `summary.json` that says what they are of; `report` is
    /// of one of the runs that they are made of.
    ///
    /// # Errors
    /// If a file cannot be written; then the folder is as it was.
    pub fn write_texts(
        &self,
        report: &Report,
        texts: &[(&str, String)],
    ) -> Result<Written, OutputError> {
        self.put(|folder, staging| {
            for (name, text) in texts {
                staging.file(name, |file| file.write_all(text.as_bytes()))?;
            }
            let way = self.way_to_scene(staging, report.source.as_ref());
            let head = Head::new(report, self.command, way);
            let head = head.with_files(staging.names());
            staging.file("summary.json", |file| summary::write_head(&head, file))?;
            Ok(replaced(staging, folder, self.command, report))
        })
    }

    /// Writes the table of a sweep, its sums over days and its derivatives if there are any, and a `summary.json` that
    /// holds the sums and the warnings of the report, and says where there are no data and what the derivatives are with
    /// respect to.
    ///
    /// # Errors
    /// If a file cannot be written; then the folder is as it was.
    pub fn write_sweep(
        &self,
        report: &Report,
        points: &[SweepPoint],
        table: &SweepTable<'_>,
        daily: Option<&DailySums>,
        derivatives: Option<&DerivativeTable>,
    ) -> Result<Written, OutputError> {
        self.put(|folder, staging| {
            staging.file("sweep.csv", |file| table.write(file))?;
            sweep_datasets::put(report, points, table, staging)?;
            if let Some(daily) = daily {
                staging.file(daily::FILE, |file| daily.write(file))?;
            }
            if let Some(table) = derivatives {
                staging.file(DERIVATIVES, |file| table.write(file))?;
            }
            let way = self.way_to_scene(staging, report.source.as_ref());
            let head = Head::new(report, self.command, way);
            let head = head.with_files(staging.names());
            let write = |file: &mut _| {
                summary::write_sweep(&head, &report.warnings, points, daily, derivatives, file)
            };
            staging.file("summary.json", write)?;
            Ok(replaced(staging, folder, self.command, report))
        })
    }

    /// Fills the folder. If other files have the names of results, it fills a folder beside it, so that a long run
    /// is not lost.
    fn put(
        &self,
        mut fill: impl FnMut(&Path, &mut Staging) -> Result<Option<String>, OutputError>,
    ) -> Result<Written, OutputError> {
        let mut put = |folder: &Path| -> Result<Written, OutputError> {
            let mut staging = self.stage(folder)?;
            let replaced = fill(folder, &mut staging)?;
            let files = staging.commit(self.force)?;
            Ok(Written { folder: folder.to_owned(), files, replaced })
        };
        let first = match put(&self.folder) {
            Err(error) if self.scene.is_some() && error.is_in_the_way() => error,
            written => return written,
        };
        let mut name = self.folder.file_name().unwrap_or_default().to_owned();
        name.push("_");
        for number in 2..ATTEMPTS {
            let mut numbered = name.clone();
            numbered.push(number.to_string());
            let folder = self.folder.with_file_name(numbered);
            if !folder.exists() {
                return put(&folder);
            }
        }
        Err(first)
    }

    /// Opens a folder, if the results in it may be replaced.
    fn stage(&self, folder: &Path) -> Result<Staging, OutputError> {
        let staging = Staging::open(folder)?;
        let Some(scene) = self.scene.as_ref().filter(|_| !self.force) else { return Ok(staging) };
        match staging.manifest() {
            Some(found) if !found.is_of(staging.target(), self.command, scene) => {
                let path = folder.to_owned();
                let found = found.described(staging.target());
                Err(OutputError::OfAnother { path, found })
            }
            _ => Ok(staging),
        }
    }

    fn way_to_scene(&self, staging: &Staging, source: Option<&SceneSource>) -> Option<String> {
        let file = self.scene.as_ref().or(source.map(|source| &source.file))?;
        let file = file.canonicalize().unwrap_or_else(|_not_there| file.clone());
        Some(relative(staging.target(), &file))
    }
}

/// Text about the results that are about to be replaced.
fn replaced(staging: &Staging, folder: &Path, command: &str, report: &Report) -> Option<String> {
    let old = staging.manifest()?;
    let source = report.source.as_ref()?;
    let file = source.file.canonicalize().unwrap_or_else(|_not_there| source.file.clone());
    if !old.is_of(staging.target(), command, &file) {
        return Some(format!(
            "{} held results of {}",
            folder.display(),
            old.described(staging.target())
        ));
    }
    let new = Head::new(report, command, None);
    let [before, now] = [changes_of(&old), new.changes()];
    (before != now).then(|| format!("{} held results {before}", folder.display()))
}

fn changes_of(manifest: &Manifest) -> String {
    let set = manifest.set.iter().map(|(name, value)| (name.as_str(), value.to_string()));
    summary::changes(manifest.variant.as_deref(), set, manifest.quality.unwrap_or(1.0))
}
