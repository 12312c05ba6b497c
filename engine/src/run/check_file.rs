use std::path::Path;

use super::checkpoint::CheckpointStore;
use super::clock::Clock;
use super::pool::in_pool;
use super::provenance::{self, FileHashes};
use super::reading::{folder_of, read};
use super::sensors::MeasureContext;
use super::setting::context;
use super::staging::staged;
use super::{Failure, LoadedScene, Options, Progress, SceneFacts, SceneWorld, Unwatched};
use super::{check, enclosed, facts, pixels, sensors};
use crate::extract::{SceneOptics, Stage};

/// Result of the check of a scene.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Warnings and notes, rendered for a person.
    pub warnings: Vec<String>,
    /// Contents of the scene, if they were requested.
    pub facts: Option<SceneFacts>,
}

/// Does all that a run does before it traces the first ray; returns warnings and notes.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn check_file(path: &Path, options: &Options) -> Result<Vec<String>, Failure> {
    check_file_with(path, options, &Unwatched)
}

/// Does what [`check_file`] does, and reports its progress.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn check_file_with(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Vec<String>, Failure> {
    checked(path, options, progress, false).map(|checked| checked.warnings)
}

/// Checks a scene file and describes its contents; traces some rays for the canopy cover.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn describe_file(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Checked, Failure> {
    checked(path, options, progress, true)
}

fn checked(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
    with_facts: bool,
) -> Result<Checked, Failure> {
    progress.stage("reading the scene");
    let reading = read(path, options)?;
    let build = || {
        progress.stage("loading");
        let mut world =
            SceneWorld::from_scene(&reading.scene, folder_of(path)).map_err(Failure::Problems)?;
        progress.stage("building");
        let optics = SceneOptics::from_world(&world.world, reading.scene.bands.len());
        let stage = staged(&mut world, &reading.scene, &optics, options.free_memory())?;
        let mut notes: Vec<String> = world.resources.messages.notes().cloned().collect();
        notes.extend(pixels::count_pixels(&mut world.world, &stage, stage.bands)?);
        let context = context(&reading.scene, world.resources.responses.all(), &optics);
        let sensors = sensors::in_order(&world.world);
        let scratch = sensors::scratch(&sensors, options);
        let measured = MeasureContext { stage: &stage, context: &context, scratch: &scratch };
        check::check(&sensors, measured, options, &CheckpointStore::disabled())?;
        let mut warnings = world.diagnostics();
        warnings.extend(enclosed::warnings(&sensors, &stage));
        if with_facts {
            warnings.extend(facts::warn_bright_ground(&context, &world.world));
        }
        let facts = with_facts.then(|| {
            let files = world.resources.messages.files();
            let hash = provenance::hash(&reading.scene, &files, &FileHashes::default())?;
            Ok::<_, Failure>(SceneFacts::new(&reading.scene, &world.world, measured, options, hash))
        });
        let facts = facts.transpose()?;
        let skipped: Vec<String> = world.resources.messages.skipped().cloned().collect();
        Ok((warnings, skipped, notes, facts))
    };
    let (found, skipped, notes, facts) = in_pool(options, || {
        build().map_err(|failure: Failure| failure.with_source(&reading.source))
    })?;
    let warnings = reading.diagnostics.iter().chain(&found);
    let mut warnings: Vec<String> =
        warnings.map(|one| reading.source.render(std::slice::from_ref(one))).collect();
    warnings.extend(skipped.iter().map(|what| format!("skipped: {what}")));
    warnings.extend(notes.iter().map(|what| format!("note: {what}")));
    Ok(Checked { warnings, facts })
}

/// Stage of a scene, and the time that it took to build; for benchmarks.
#[derive(Debug)]
pub struct Ready {
    /// The stage.
    pub stage: Stage,
    /// Seconds to read and spawn the scene.
    pub load_seconds: f64,
    /// Seconds to build the stage, above all the ray engine's hierarchies.
    pub build_seconds: f64,
}

/// Reads a scene file and builds its stage, and traces nothing.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn stage_file(path: &Path, options: &Options) -> Result<Ready, Failure> {
    let mut clock = Clock::start();
    in_pool(options, || {
        let mut loaded = LoadedScene::from_file(path, options, &Unwatched)?;
        clock.lap("load");
        let stage = loaded.stage(options, &Unwatched)?;
        clock.lap("build");
        let seconds = |lap: usize| clock.laps[lap].1;
        Ok(Ready { stage, load_seconds: seconds(0), build_seconds: seconds(1) })
    })
}
