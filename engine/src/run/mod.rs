//! The list of stages, one call a line: text to document to world to stage to films to report.

mod advice;
mod check;
mod check_file;
mod checkpoint;
mod clock;
mod convergence;
mod cost;
mod day;
mod derivatives;
mod enclosed;
mod facts;
mod failure;
mod footprint;
mod images;
mod loaded;
mod observed;
mod options;
mod photons;
mod pixels;
mod point_reader;
mod points;
mod pool;
mod provenance;
mod queries;
mod radiance;
mod reading;
mod reports;
mod rerun;
mod respectrum;
mod rounds;
mod scene_world;
mod sensors;
mod session;
mod setting;
mod settled;
mod staging;
mod suns;
mod sweep;
#[cfg(test)]
mod tests;
mod uncovered;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use hecs::World;

use crate::components::{Projection, TerrainPatch};
use crate::document::{self, Diagnostic, Param, Reading, Scene, ScenePath};
use crate::extract::SceneOptics;
use crate::products::{Context, Report, SceneSource};
use crate::scattering::PathSpectra;

pub use crate::products::Forecast;
pub use crate::transport::Partition;
pub use check_file::{Checked, Ready, check_file, check_file_with, describe_file, stage_file};
pub use checkpoint::{Checkpoint, SaveRule};
pub use facts::{
    BandFacts, GroundFacts, HeightFacts, MeshFacts, SceneFacts, SensorFacts, SunFacts,
};
pub use failure::Failure;
pub use loaded::LoadedScene;
pub use options::{Options, Progress, SensorProgress, Unwatched};
pub use queries::{LeafAreaSettings, height_model_file, leaf_area_file};
pub use radiance::{RadianceError, RadianceQuantity, convert_radiance};
pub use rerun::{changed_files, rerun};
pub use respectrum::respectrum;
pub use scene_world::SceneWorld;
pub use session::Session;
pub use sweep::SweepRun;

use checkpoint::CheckpointStore;
use clock::Clock;
use pool::in_pool;
use provenance::FileHashes;
use reading::{folder_of, read, read_as};
use reports::{CommonResults, SharedReports, reports};
use respectrum::{KeptCoefficients, paths_hash, without_coefficients};
use sensors::MeasureContext;
use settled::SettledScene;
use staging::staged;

/// Runs a scene file.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn run_file(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    report_of(path, options, progress, None)
}

/// Runs the text of a scene. Paths in it are relative to the folder of `path`, which stands for its file in messages and
/// need not be there.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub fn run_text(
    path: &Path,
    text: &str,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    let start = Instant::now();
    progress.stage("reading the scene");
    let reading = read_as(path, text, options)?;
    report_of_reading(&reading, folder_of(path), options, progress, None, start)
}

/// Report of a scene file, perhaps from coefficients that a run has kept.
fn report_of(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
    coefficients: Option<&Path>,
) -> Result<Report, Failure> {
    let start = Instant::now();
    progress.stage("reading the scene");
    let reading = read(path, options)?;
    let report =
        report_of_reading(&reading, folder_of(path), options, progress, coefficients, start)?;
    Ok(Report { source: Some(scene_source(path, options)), ..report })
}

/// Report of a scene that was read from `start` on.
fn report_of_reading(
    reading: &Reading,
    folder: &Path,
    options: &Options,
    progress: &dyn Progress,
    coefficients: Option<&Path>,
    start: Instant,
) -> Result<Report, Failure> {
    let read_seconds = start.elapsed().as_secs_f64();
    in_pool(options, || {
        let mut world = SceneWorld::new(folder);
        let report = match coefficients {
            None => run_in(&mut world, &reading.scene, options, progress),
            Some(file) => evaluate_in(&mut world, &reading.scene, file, options, progress),
        };
        let mut report = report.map_err(|failure| failure.with_source(&reading.source))?;
        report.stages.insert(0, ("read".to_owned(), read_seconds));
        // After an error there would be no scene: these are warnings.
        report.warnings.splice(0..0, reading.diagnostics.iter().map(failure::one_line));
        report.seconds = start.elapsed().as_secs_f64();
        Ok(report)
    })
}

/// File of a scene, and the changes that `options` make to it.
fn scene_source(file: &Path, options: &Options) -> SceneSource {
    SceneSource {
        file: file.to_owned(),
        variant: options.document.variant.clone(),
        set: options.document.set.clone(),
        quality: options.quality,
    }
}

/// Runs a scene that was read or built; paths in it are relative to `folder`.
///
/// # Errors
/// All errors of the scene.
pub fn run(
    scene: &Scene,
    folder: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    run_in(&mut SceneWorld::new(folder), scene, options, progress)
}

/// Runs a scene in a world, of which only what has changed since the last run is derived anew.
fn run_in(
    world: &mut SceneWorld,
    scene: &Scene,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    let mut clock = Clock::start();
    options.checkpoint.as_ref().map_or(Ok(()), Checkpoint::try_file)?;
    progress.stage("loading");
    let hashes = FileHashes::default();
    let mut settled = SettledScene::new(world, scene.clone(), &hashes)?;
    // Parts that were traced with some sensors are united with those.
    if let Some(chosen) = sensors_of_parts(scene, options, &settled.files)? {
        settled = SettledScene::new(world, chosen, &hashes)?;
    }
    let mut store = if options.keeps_coefficients {
        let folder = world.resources.folder.clone();
        CheckpointStore::of_coefficients(paths_hash(&settled.scene, &folder)?)
    } else {
        open_store(&settled.scene, &settled.files, options)?
    };
    clock.lap("spawn");
    let mut reports =
        measure_scenes(world, &[settled], options, &mut store, None, progress, clock)?;
    let mut report = reports.pop().expect("a report for each scene");
    if options.keeps_coefficients {
        report.warnings.extend(without_coefficients(&report, &store));
    }
    Ok(report)
}

/// Evaluates the coefficients in a file for the spectra of a scene.
fn evaluate_in(
    world: &mut SceneWorld,
    scene: &Scene,
    file: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    let mut clock = Clock::start();
    progress.stage("loading");
    let (kept, mut store, scene) =
        KeptCoefficients::open(file, scene, &world.resources.folder.clone())?;
    let settled = SettledScene::new(world, scene, &FileHashes::default())?;
    clock.lap("spawn");
    let mut reports =
        measure_scenes(world, &[settled], options, &mut store, Some(&kept), progress, clock)?;
    Ok(reports.pop().expect("a report for each scene"))
}

/// Measures scenes that differ in their optics and their suns alone, on the same paths; sensors whose light is traced from
/// the sun, sun by sun.
fn measure_scenes(
    world: &mut SceneWorld,
    scenes: &[SettledScene],
    options: &Options,
    store: &mut CheckpointStore,
    kept: Option<&KeptCoefficients>,
    progress: &dyn Progress,
    mut clock: Clock,
) -> Result<Vec<Report>, Failure> {
    progress.stage("building");
    let optics = joined_optics(scenes);
    let mut stage = staged(world, &scenes[0].scene, &optics, options.free_memory())?;
    stage.keeps_coefficients = store.collects();
    let misfit = kept.map_or(Ok(None), |kept| kept.check(&stage))?;
    let notes = pixels::count_pixels(&mut world.world, &stage, scenes[0].scene.bands.len())?;
    clock.lap("build");
    let context = joined_context(scenes);
    progress.stage("tracing");
    let scratch = &sensors::scratch(&sensors::in_order(&world.world), options);
    let measured = MeasureContext { stage: &stage, context: &context, scratch };
    let (by_sun, shared): (Vec<_>, Vec<_>) = sensors::in_order(&world.world)
        .into_iter()
        .partition(|one| stage.light.suns.len() > 1 && sensors::is_traced_from_sun(&one.sensor));
    let all = &mut world.world;
    let unsaved = sensors::measure_sensors(all, &shared, measured, options, store, progress)?;
    let mut shared = vec![SharedReports::take(&mut world.world, 0..scenes.len(), context.clone())];
    for suns in optics.suns_of_scenes(scenes.len()).filter(|_| !by_sun.is_empty()) {
        let (optics, context) =
            (joined_optics(&scenes[suns.clone()]), joined_context(&scenes[suns.clone()]));
        let stage = staged(world, &scenes[0].scene, &optics, options.free_memory())?;
        let measured = MeasureContext { stage: &stage, context: &context, scratch };
        sensors::measure_sensors(&mut world.world, &by_sun, measured, options, store, progress)?;
        shared.push(SharedReports::take(&mut world.world, suns, context));
    }
    clock.lap("trace");
    let common = CommonResults {
        world: &world.world,
        stage: &stage,
        context: &context,
        sensors: shared,
        notes,
        warnings: unsaved.into_iter().chain(misfit).collect(),
        coefficients: stage
            .keeps_coefficients
            .then(|| PathSpectra::new(&stage.models))
            .flatten()
            .and_then(|spectra| store.coefficients(&spectra))
            .map(Arc::new),
        quality: options.quality,
        is_traced: kept.is_none(),
        seconds: clock.seconds(),
        stages: clock.laps,
    };
    Ok(reports(scenes, common))
}

/// Optics of scenes, the bands of all one behind the other.
fn joined_optics(scenes: &[SettledScene]) -> SceneOptics {
    let optics: Vec<&SceneOptics> = scenes.iter().map(|settled| &settled.optics).collect();
    SceneOptics::joined(&optics)
}

/// Data that products of scenes are made with, the bands of all one behind the other.
fn joined_context(scenes: &[SettledScene]) -> Context {
    let contexts: Vec<&Context> = scenes.iter().map(|settled| &settled.context).collect();
    Context::joined(&contexts)
}

/// Checks a scene that may have been built and not read.
fn check_scene(scene: &Scene) -> Result<(), Failure> {
    let mut problems = document::check(scene);
    if let Some(name) = scene.include.keys().next() {
        let what = "files are included by reading a scene, and this one was built";
        let help = "write it with `to_ron` and read it with `read_file`";
        problems.push(Diagnostic::error(ScenePath::from("include").name(name), what).help(help));
    }
    if problems.iter().any(Diagnostic::is_error) {
        return Err(Failure::Problems(problems));
    }
    Ok(())
}

/// Store that the run is resumed from and saved to.
fn open_store(
    scene: &Scene,
    files: &[PathBuf],
    options: &Options,
) -> Result<CheckpointStore, Failure> {
    match &options.checkpoint {
        Some(to) => {
            CheckpointStore::open(to, provenance::stream_hash(scene, files)?, &options.scratch)
        }
        None if options.unite.is_empty() => Ok(CheckpointStore::disabled()),
        None => {
            let hash = provenance::stream_hash(scene, files)?;
            CheckpointStore::unite(&options.unite, hash, &options.scratch)
        }
    }
}

/// Scene with only those sensors that the parts of a run were traced with; `None` if they were traced with all, or if
/// they are not parts of this scene.
fn sensors_of_parts(
    scene: &Scene,
    options: &Options,
    files: &[PathBuf],
) -> Result<Option<Scene>, Failure> {
    let Some(first) = options.unite.first().filter(|_| options.checkpoint.is_none()) else {
        return Ok(None);
    };
    let names = {
        let hash = provenance::stream_hash(scene, files)?;
        CheckpointStore::other_sensors(first, hash, &options.scratch)?
    };
    let is_known = |name: &String| scene.sensors.contains_key(name);
    if names.is_empty() || !names.iter().all(is_known) || names.len() == scene.sensors.len() {
        return Ok(None);
    }
    let mut chosen = scene.clone();
    chosen.sensors.retain(|name, _| names.contains(name));
    Ok(Some(chosen))
}

/// Values of a scene's parameters.
fn params(scene: &Scene) -> Vec<(String, Param)> {
    scene.params.iter().map(|(name, value)| (name.clone(), value.clone())).collect()
}

/// Projection of the coordinates of the ground.
fn projection(world: &World) -> Option<Projection> {
    world.query::<&TerrainPatch>().iter().find_map(|patch| patch.projection.clone())
}
