//! The list of stages, one call a line: text to document to world to stage to films to report.

mod advice;
mod again;
mod check;
mod checkpoint;
mod day;
mod enclosed;
mod facts;
mod failure;
mod footprint;
mod forecast;
mod growth;
mod photons;
mod pixels;
mod provenance;
mod scene_world;
mod sensors;
mod staging;
mod sweep;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::time::Instant;

use hecs::World;

use crate::accel::Boundary;
use crate::components::{Projection, TerrainPatch};
use crate::document::{self, Diagnostic, Param, Reading, Scene, Sun};
use crate::extract::{Rules, Setting, Stage};
use crate::memory;
use crate::products::{BandSources, Context, Origin, Report, SensorReport};
use crate::spawn::missing_files;
use crate::spectral::BandWindow;

pub use crate::products::Forecast;
pub use crate::transport::Partition;
pub use again::Runs;
pub use checkpoint::Checkpoint;
pub use facts::{BandFacts, GroundFacts, MeshFacts, SceneFacts, SensorFacts, SunFacts};
pub use failure::Failure;

pub use scene_world::SceneWorld;
pub use sweep::Sweep;

use checkpoint::Keeper;
use staging::staged;

/// What the caller decides beyond the scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// Parameters and variant.
    pub document: document::Options,
    /// Threads; all that the machine has if absent.
    pub threads: Option<usize>,
    /// Factor on all numbers of samples, and its inverse root on relative errors: 1 is the scene as
    /// it is written.
    pub quality: f64,
    /// Where to write down what is traced, to go on with it later.
    pub checkpoint: Option<Checkpoint>,
    /// Checkpoints of all shares of one run, whose films are united in place of tracing them.
    pub unite: Vec<PathBuf>,
    /// Memory that the ray engine, and films with results, may take, bytes; all that is free if absent. A run that takes more
    /// is refused before it traces anything.
    pub memory: Option<u64>,
    /// Trace no more of each sensor than tells how long it will take.
    pub forecast: bool,
    /// Names of the sensors that measure; all if empty.
    pub sensors: Vec<String>,
}

impl Options {
    /// Memory that a run may take, bytes.
    fn free_memory(&self) -> u64 {
        self.memory.or_else(memory::free).unwrap_or(u64::MAX)
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            document: document::Options::default(),
            threads: None,
            quality: 1.0,
            checkpoint: None,
            unite: Vec::new(),
            memory: None,
            forecast: false,
            sensors: Vec::new(),
        }
    }
}

/// Watches a run; the library itself shows nothing.
pub trait Progress: Sync {
    /// A stage starts.
    fn stage(&self, name: &str);
    /// This part of a sensor's measurement, 0 to 1, is done.
    fn sensor(&self, name: &str, done: f64);
    /// A sensor will run for long: so long.
    fn forecast(&self, name: &str, forecast: &Forecast);
    /// Something is not as it should be, and the run goes on.
    fn warn(&self, _warning: &str) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Progress for Unwatched {
    fn stage(&self, _: &str) {}
    fn sensor(&self, _: &str, _: f64) {}
    fn forecast(&self, _: &str, _: &Forecast) {}
}

/// Runs a scene file.
///
/// # Errors
/// All that is wrong with the scene, rendered for a person.
pub fn run_file(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    let start = Instant::now();
    progress.stage("reading the scene");
    let reading = read(path, options)?;
    let folder = folder_of(path);
    let read_seconds = start.elapsed().as_secs_f64();
    in_pool(options, || {
        let mut report = run(&reading.scene, folder, options, progress)
            .map_err(|failure| failure.with_source(&reading.source))?;
        report.stages.insert(0, ("read".to_owned(), read_seconds));
        // Reading found no error, or there would be no scene: what is left are warnings.
        report.warnings.splice(0..0, reading.diagnostics.iter().map(failure::one_line));
        report.seconds = start.elapsed().as_secs_f64();
        report.origin = Some(origin(path, options));
        Ok(report)
    })
}

/// Where a scene is read, and what `options` change in it.
fn origin(file: &Path, options: &Options) -> Origin {
    Origin {
        file: file.to_owned(),
        variant: options.document.variant.clone(),
        set: options.document.set.clone(),
        quality: options.quality,
    }
}

/// A scene that was checked.
#[derive(Clone, Debug)]
pub struct Checked {
    /// What its author should know, rendered for a person.
    pub warnings: Vec<String>,
    /// What it consists of, if that was asked for.
    pub facts: Option<SceneFacts>,
}

/// Does all that a run does before it traces the first ray; returns what the scene's author should know.
///
/// # Errors
/// All that is wrong with the scene, rendered for a person.
pub fn check_file(path: &Path, options: &Options) -> Result<Vec<String>, Failure> {
    check_file_with(path, options, &Unwatched)
}

/// The same, watched.
///
/// # Errors
/// All that is wrong with the scene, rendered for a person.
pub fn check_file_with(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Vec<String>, Failure> {
    checked(path, options, (progress, false)).map(|checked| checked.warnings)
}

/// The same, and what the scene consists of; for its canopy cover, some rays are traced.
///
/// # Errors
/// All that is wrong with the scene, rendered for a person.
pub fn describe_file(
    path: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Checked, Failure> {
    checked(path, options, (progress, true))
}

fn checked(
    path: &Path,
    options: &Options,
    (progress, with_facts): (&dyn Progress, bool),
) -> Result<Checked, Failure> {
    progress.stage("reading the scene");
    let reading = read(path, options)?;
    let build = || {
        progress.stage("loading");
        let mut world =
            SceneWorld::from_scene(&reading.scene, folder_of(path)).map_err(Failure::Problems)?;
        progress.stage("building");
        let stage = staged(&mut world, &reading.scene, options.free_memory())?;
        let mut notes: Vec<String> = world.resources.messages.notes().cloned().collect();
        notes.extend(pixels::count_pixels(&mut world.world, &stage)?);
        let context = context(&reading.scene, &stage);
        let sensors = sensors::in_order(&world.world);
        check::check(&sensors, (&stage, &context), options, &Keeper::idle())?;
        let mut warnings = world.diagnostics();
        warnings.extend(enclosed::warnings(&sensors, &stage));
        if with_facts {
            warnings.extend(facts::warn_bright_ground(&reading.scene, &world.world));
        }
        let facts = with_facts
            .then(|| SceneFacts::new(&reading.scene, &world.world, (&stage, &context), options));
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

/// A scene ready to be traced, and how long that took; for benchmarks.
#[derive(Debug)]
pub struct Ready {
    /// The stage.
    pub stage: Stage,
    /// Seconds to read and spawn the scene.
    pub load_seconds: f64,
    /// Seconds to build the stage, the ray engine's trees above all.
    pub build_seconds: f64,
}

/// Reads, spawns and builds a scene file, and traces nothing.
///
/// # Errors
/// All that is wrong with the scene, rendered for a person.
pub fn stage_file(path: &Path, options: &Options) -> Result<Ready, Failure> {
    let mut clock = Clock::start();
    let reading = read(path, options)?;
    in_pool(options, || {
        let mut world = SceneWorld::from_scene(&reading.scene, folder_of(path))
            .map_err(|problems| Failure::Scene(reading.source.render(&problems)))?;
        clock.lap("load");
        let stage = staged(&mut world, &reading.scene, options.free_memory())
            .map_err(|failure| failure.with_source(&reading.source))?;
        clock.lap("build");
        let seconds = |lap: usize| clock.laps[lap].1;
        Ok(Ready { stage, load_seconds: seconds(0), build_seconds: seconds(1) })
    })
}

/// Runs a scene that was read or built; paths in it are relative to `folder`.
///
/// # Errors
/// All that is wrong with the scene.
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
    let start = Instant::now();
    let mut clock = Clock::start();
    options.checkpoint.as_ref().map_or(Ok(()), Checkpoint::try_file)?;
    let mut problems = document::check(scene);
    if let Some(name) = scene.include.keys().next() {
        let what = "files are included by reading a scene, and this one was built";
        let help = "write it with `to_ron` and read it with `read_file`";
        problems.push(Diagnostic::error(format!("include.{name}"), what).help(help));
    }
    if problems.iter().any(Diagnostic::is_error) {
        return Err(Failure::Problems(problems));
    }
    progress.stage("loading");
    world.set(scene).map_err(Failure::Problems)?;
    // Parts that were traced with some sensors are united with those.
    let chosen = sensors_of_parts(scene, options, &world.resources.messages.files())?;
    let scene = chosen.as_ref().unwrap_or(scene);
    if chosen.is_some() {
        world.set(scene).map_err(Failure::Problems)?;
    }
    let files = world.resources.messages.files();
    let hash = provenance::hash(scene, &files)?;
    let mut keeper = match &options.checkpoint {
        Some(to) => Keeper::open(to, provenance::stream_hash(scene, &files)?)?,
        None if options.unite.is_empty() => Keeper::idle(),
        None => Keeper::unite(&options.unite, provenance::stream_hash(scene, &files)?)?,
    };
    clock.lap("spawn");
    progress.stage("building");
    let stage = staged(world, scene, options.free_memory())?;
    let pixel_notes = pixels::count_pixels(&mut world.world, &stage)?;
    clock.lap("build");
    let context = context(scene, &stage);
    progress.stage("tracing");
    let (reports, unsaved) =
        measure(&world.world, (&stage, &context), options, &mut keeper, progress)?;
    clock.lap("trace");
    let messages = &world.resources.messages;
    let sensors = sensors::in_order(&world.world);
    Ok(Report {
        projection: projection(&world.world),
        scene: scene.title.clone(),
        hash,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: scene.transport.seed,
        seconds: start.elapsed().as_secs_f64(),
        rays: reports.iter().map(|report| report.rays).sum(),
        bands: context.bands,
        wavelengths: scene.bands.iter().map(|band| band.center_nm).collect(),
        irradiance: context.irradiance,
        stages: clock.laps,
        skipped: messages.skipped().cloned().collect(),
        notes: messages.notes().cloned().chain(pixel_notes).collect(),
        warnings: messages
            .diagnostics()
            .chain(&enclosed::warnings(&sensors, &stage))
            .map(failure::one_line)
            .chain(footprint::warnings(&sensors, &stage))
            .chain(unbalanced(&reports))
            .chain(unsaved)
            .collect(),
        sensors: reports,
        params: params(scene),
        sun_azimuth_deg: scene.sun.as_ref().and_then(Sun::known_azimuth_deg),
        origin: None,
    })
}

/// The scene with those sensors alone that parts of a run were traced with; `None` if they were traced with all,
/// or if these are not parts of this scene.
fn sensors_of_parts(
    scene: &Scene,
    options: &Options,
    files: &[PathBuf],
) -> Result<Option<Scene>, Failure> {
    let Some(first) = options.unite.first().filter(|_| options.checkpoint.is_none()) else {
        return Ok(None);
    };
    let names = Keeper::other_sensors(first, provenance::stream_hash(scene, files)?)?;
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

/// Shares of the incident energy that may get lost in the rounding of f64.
const BALANCE: f64 = 1e-9;

/// A warning for each sensor whose photon packets gained or lost energy that nothing accounts for.
fn unbalanced(reports: &[SensorReport]) -> impl Iterator<Item = String> {
    let off = |report: &&SensorReport| report.energy_imbalance.is_some_and(|off| off > BALANCE);
    reports.iter().filter(off).map(|report| {
        let off = report.energy_imbalance.unwrap_or(f64::NAN);
        format!(
            "sensors.{}: {off:.1e} of the energy is not accounted for: this is a bug of sunfleck",
            report.name
        )
    })
}

fn context(scene: &Scene, stage: &Stage) -> Context {
    Context {
        bands: scene.bands.iter().map(|band| band.name.clone()).collect(),
        irradiance: stage.light.irradiance.clone(),
        has_sky: stage.light.dome.is_some(),
        origin: (scene.frame.origin_m.0, scene.frame.origin_m.1),
        sources: scene.bands.iter().map(sources).collect(),
    }
}

/// What the radiance in a band consists of.
fn sources(band: &document::Band) -> BandSources {
    let window = BandWindow { center: band.center_nm, width: band.width_nm };
    BandSources { window, emits: band.emits(), reflects: band.reflects() }
}

/// Measures every sensor of the world in document order; returns a warning too if the checkpoint
/// could not be written.
fn measure(
    world: &World,
    (stage, context): (&Stage, &Context),
    options: &Options,
    keeper: &mut Keeper,
    progress: &dyn Progress,
) -> Result<(Vec<SensorReport>, Option<String>), Failure> {
    let scene = (stage, context);
    let sensors = sensors::in_order(world);
    check::check(&sensors, scene, options, keeper)?;
    let reports = sensors
        .iter()
        .map(|(name, sensor)| sensors::measure(name, sensor, scene, options, keeper, progress));
    let reports = reports.collect::<Result<_, _>>()?;
    Ok((reports, keeper.finish()?))
}

fn read(path: &Path, options: &Options) -> Result<Reading, Failure> {
    let reading = document::read_file(path, &options.document)
        .map_err(|error| Failure::Scene(error.to_string()))?;
    sound(reading, path, options)
}

/// A scene without errors, with the sensors that are asked for.
fn sound(mut reading: Reading, path: &Path, options: &Options) -> Result<Reading, Failure> {
    if reading.is_sound() {
        let unknown = choose_sensors(&mut reading.scene, &options.sensors);
        return if unknown.is_empty() {
            Ok(reading)
        } else {
            Err(Failure::Scene(reading.source.render(&unknown)))
        };
    }
    // What can be found out beyond the text is reported at once with the rest.
    let mut problems = reading.diagnostics;
    // A path that could not be read is a placeholder, and its error is known.
    let known: Vec<String> = problems.iter().map(|problem| problem.path.clone()).collect();
    let missing = missing_files(&reading.scene, folder_of(path)).into_iter();
    problems.extend(missing.filter(|m| !known.iter().any(|path| m.path.starts_with(path))));
    Err(Failure::Scene(reading.source.render(&problems)))
}

/// Leaves out all sensors but these; returns an error for each name that is none.
fn choose_sensors(scene: &mut Scene, names: &[String]) -> Vec<Diagnostic> {
    let unknown = names.iter().filter(|name| !scene.sensors.contains_key(name.as_str()));
    let known = || scene.sensors.keys().map(String::as_str);
    let unknown = unknown.map(|name| document::unknown_name("sensors", "sensor", name, known()));
    let unknown = unknown.collect();
    if !names.is_empty() {
        scene.sensors.retain(|name, _| names.contains(name));
    }
    unknown
}

/// Folder that paths in a scene file are relative to.
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// Largest number of threads that a run may be given.
fn most_threads() -> usize {
    const MOST: usize = 1024;
    std::thread::available_parallelism().map_or(MOST, |here| here.get().max(MOST))
}

/// Runs in a pool of as many threads as asked for; no result depends on their number.
fn in_pool<T: Send>(
    options: &Options,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    match options.threads {
        None => work(),
        Some(threads) if threads == 0 || threads > most_threads() => {
            let reason = format!(
                "give 1 to {}; results do not depend on it, and more than the machine has gain nothing",
                most_threads()
            );
            Err(Failure::Threads { threads, reason })
        }
        Some(threads) => rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|error| Failure::Threads { threads, reason: error.to_string() })?
            .install(work),
    }
}

fn setting(scene: &Scene) -> Setting {
    let transport = &scene.transport;
    Setting {
        bands: scene.bands.len(),
        boundary: match scene.boundary {
            document::Boundary::Periodic => Boundary::Periodic,
            document::Boundary::Isolated => Boundary::Isolated,
        },
        rules: Rules {
            seed: transport.seed,
            roulette_after: transport.roulette.after_order,
            roulette_kill: transport.roulette.kill,
            max_order: transport.most_orders(),
        },
    }
}

/// Wall time of stages. It is reported and decides nothing.
struct Clock {
    last: Instant,
    laps: Vec<(String, f64)>,
}

impl Clock {
    fn start() -> Self {
        Self { last: Instant::now(), laps: Vec::new() }
    }

    fn lap(&mut self, name: &str) {
        let now = Instant::now();
        self.laps.push((name.to_owned(), (now - self.last).as_secs_f64()));
        self.last = now;
    }
}
