//! A scene at many values of its parameters: what does not change is built once.

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use indexmap::IndexMap;

use super::point_reader::PointReader;
use super::points::SettledPoints;
use super::pool::in_pool;
use super::provenance::joint_hashes;
use super::reading::folder_of;
use super::scene_world::SceneWorld;
use super::suns::{grouped_by_sun, sun_of_paths};
use super::{Failure, Options, Progress, day, derivatives, params, scene_source};
use crate::document::{
    self, Bands, Lambertian, Map, Material, Scene, Sensor, Sky, Spectrum, StopCriterion, Sun,
    System, ThermalSky,
};
use crate::products::{CentralDifference, Day, Night, Report, SweepPoint};

/// A scene file that has been read at every point of its sweep, and what its runs share.
///
/// Random streams have the seed and the sensor's path as keys, so each point is traced with the same
/// numbers: differences between points have far less noise than the points themselves. Points that differ in
/// spectra, temperatures or irradiance alone are traced on the same paths, as if their bands were those of one scene, and
/// so are those that differ in the sun's position if some paths start at sensors.
#[expect(missing_debug_implementations, reason = "a World has no Debug")]
pub struct SweepRun {
    file: PathBuf,
    options: Options,
    scene: Scene,
    points: Vec<SweepPoint>,
    differences: Vec<CentralDifference>,
    groups: Vec<Vec<usize>>,
    suns: Vec<Option<Sun>>,
    world: SceneWorld,
    reader: PointReader,
}

impl SweepRun {
    /// Reads a scene file at every point.
    ///
    /// # Errors
    /// Errors of the scene at the first point that has any.
    pub fn read(file: &Path, options: &Options, progress: &dyn Progress) -> Result<Self, Failure> {
        progress.stage("reading the scene");
        let (mut reader, scene) = PointReader::new(file, options)?;
        let Some(sweep) = &scene.sweep else {
            let example = "sweep: Grid({ \"sza\": [0.0, 30.0, 60.0] })";
            let text =
                format!("{} has no `sweep`: write, for example, `{example}`", file.display());
            return Err(Failure::Sweep(text));
        };
        let sweep = sweep.fixed(&options.document.set);
        let point = |index: usize| {
            let params = sweep.point(index, &scene.params);
            SweepPoint { params, key: String::new(), night: None }
        };
        let mut points: Vec<SweepPoint> = (0..sweep.len()).map(point).collect();
        let (mut options, mut differences) = (options.clone(), Vec::new());
        if let document::Sweep::Derivatives(steps) = &sweep {
            options.keeps_replicates = true;
            reader = reader.with_replicates();
            differences = derivatives::complete(&reader, &mut points, steps, &sweep)?;
        }
        let options = &options;
        let summaries = in_pool(options, || reader.summaries(&points, progress))?;
        for (point, summary) in points.iter_mut().zip(&summaries) {
            (point.key, point.night) = (summary.key.clone(), summary.night.clone());
        }
        let sharing: Vec<SharingKeys> = summaries.iter().map(|summary| summary.sharing).collect();
        let suns: Vec<Option<Sun>> = summaries.into_iter().map(|summary| summary.sun).collect();
        let mut names = HashSet::new();
        // A list may hold a value twice.
        let is_new = |index: &usize| names.insert(points[*index].name());
        let distinct: Vec<usize> = (0..points.len()).filter(is_new).collect();
        let groups = groups(&distinct, &sharing, &suns, scene.bands.len());
        for group in groups.iter().filter(|group| group.len() > 1) {
            // Results depend on which points share paths.
            let own: Vec<&str> = group.iter().map(|&index| points[index].key.as_str()).collect();
            for (&index, key) in group.iter().zip(joint_hashes(&own)) {
                points[index].key = key;
            }
        }
        let world = SceneWorld::new(folder_of(file));
        let (file, options) = (file.to_owned(), options.clone());
        Ok(Self { file, options, scene, points, differences, groups, suns, world, reader })
    }

    /// All points, the last parameter fastest.
    #[must_use]
    pub fn points(&self) -> &[SweepPoint] {
        &self.points
    }

    /// Differences between points that are derivatives of results; none of a sweep over given values.
    #[must_use]
    pub fn differences(&self) -> &[CentralDifference] {
        &self.differences
    }

    /// Groups of points by their places in the list of all, in the order to run them in: a group is traced on the same
    /// paths, and groups of the same geometry, which is then built once, follow each other.
    ///
    /// They depend on the sweep alone, and results on the group: a point is always run with the others of its group, and
    /// its key changes with them.
    #[must_use]
    pub fn groups(&self) -> &[Vec<usize>] {
        &self.groups
    }

    /// Number of times that the ray engine has been built so far.
    #[must_use]
    pub fn builds(&self) -> usize {
        self.world.builds
    }

    /// Days over whose hours the points can be summed; none if no parameter moves the sun's clock within
    /// one date.
    #[must_use]
    pub fn days(&self) -> Vec<Day> {
        match &self.scene.sweep {
            Some(document::Sweep::Grid(_)) => day::days(&self.points, &self.suns),
            Some(document::Sweep::Zip(_) | document::Sweep::Derivatives(_)) | None => Vec::new(),
        }
    }

    /// Runs the scene at the points of one of its groups. `take` receives the reports of some points at a time, as many as
    /// fit into memory together, with the places of these points in the group; a point without any light has a report
    /// without sensors.
    ///
    /// # Errors
    /// All errors of the scene at the first point that has any; errors of `take`.
    ///
    /// # Panics
    /// If there is no such group.
    pub fn run<E: From<Failure>>(
        &mut self,
        group: usize,
        progress: &dyn Progress,
        mut take: impl FnMut(Range<usize>, Vec<Report>) -> Result<(), E>,
    ) -> Result<(), E> {
        let points: Vec<SweepPoint> =
            self.groups[group].iter().map(|&index| self.points[index].clone()).collect();
        if let Some(why) = points[0].darkness() {
            let params = points[0].params.clone();
            let report = Report { notes: vec![why.to_owned()], params, ..self.report() };
            return take(0..1, vec![report]);
        }
        let Self { file, options, world, reader, .. } = self;
        progress.stage("loading");
        let settled = in_pool(options, || SettledPoints::new(reader, &points, options, world))?;
        for part in settled.parts() {
            let first = &points[part.start];
            let mut reports = in_pool(options, || {
                settled.measure(part.clone(), first, options, world, progress)
            })?;
            for (report, point) in reports.iter_mut().zip(&points[part.clone()]) {
                if let Some(Night::WithoutSun(warning)) = &point.night {
                    report.warnings.insert(0, warning.clone());
                }
                report.source = Some(scene_source(file, options));
            }
            take(part, reports)?;
        }
        Ok(())
    }

    /// Report of what is common to all points: it has no sensors, and its hash is that of all points.
    #[must_use]
    pub fn report(&self) -> Report {
        let mut hasher = blake3::Hasher::new();
        for point in &self.points {
            hasher.update(point.key.as_bytes());
        }
        Report {
            scene: self.scene.title.clone(),
            formats: self.scene.output.clone(),
            hash: hasher.finalize().to_hex().to_string(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seed: self.scene.transport.seed,
            params: params(&self.scene),
            source: Some(scene_source(&self.file, &self.options)),
            ..Report::default()
        }
    }
}

/// Hashes of what points can share.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct SharingKeys {
    /// Hash of the geometry: the ray engine is built once for points that are equal in it.
    geometry: blake3::Hash,
    /// Hash of all that decides the paths; none of a point that is traced alone.
    paths: Option<blake3::Hash>,
}

impl SharingKeys {
    /// Hashes of a scene; one without light is traced alone.
    pub(super) fn new(scene: &Scene, is_dark: bool) -> Self {
        let geometry = blake3::hash(geometry_of(scene).to_ron().as_bytes());
        let paths = paths_of(scene).filter(|_| !is_dark);
        let paths = paths.map(|paths| blake3::hash(paths.to_ron().as_bytes()));
        Self { geometry, paths }
    }
}

/// Largest number of bands that are traced on the same paths.
const MOST_BANDS: usize = 1 << 14;

/// Groups of points that are traced on the same paths; those of the same geometry follow each other.
fn groups(
    points: &[usize],
    sharing: &[SharingKeys],
    suns: &[Option<Sun>],
    bands: usize,
) -> Vec<Vec<usize>> {
    let most = (MOST_BANDS / bands.max(1)).max(1);
    let mut of_geometry: IndexMap<blake3::Hash, IndexMap<PathsOf, Vec<usize>>> = IndexMap::new();
    for &index in points {
        let one = sharing[index];
        let paths = one.paths.map_or(PathsOf::Point(index), PathsOf::Points);
        of_geometry.entry(one.geometry).or_default().entry(paths).or_default().push(index);
    }
    let alike = of_geometry.into_values().flat_map(IndexMap::into_values);
    alike.flat_map(|points| grouped_by_sun(points, suns, most)).collect()
}

/// Paths that points share.
#[derive(PartialEq, Eq, Hash)]
enum PathsOf {
    /// Paths of all points with this hash.
    Points(blake3::Hash),
    /// Paths of one point alone.
    Point(usize),
}

/// Scene without light, spectra and sensors: points that are equal in it follow each other, so that their geometry is
/// built once.
fn geometry_of(scene: &Scene) -> Scene {
    let material = |_: &Material| Material::Lambertian(Lambertian::new(Spectrum::Constant(0.0)));
    Scene {
        title: String::new(),
        bands: Bands::default(),
        spectra: Map::new(),
        materials: scene.materials.iter().map(|(n, m)| (n.clone(), material(m))).collect(),
        sun: None,
        sky: Sky::None,
        thermal_sky: ThermalSky::None,
        sensors: Map::<Sensor>::new(),
        ..scene.resolved()
    }
}

/// Scene without values by band, and without the sun's position if paths start at sensors: points that are equal in it
/// are traced on the same paths. `None` for a point that is
/// traced alone: because a sensor has a limit of time, or photons that carry one band each.
fn paths_of(scene: &Scene) -> Option<Scene> {
    let is_limited = |sensor: &Sensor| {
        sensor.until().iter().any(|stop| matches!(stop, StopCriterion::Seconds(_)))
    };
    let is_alone = |sensor: &Sensor| is_limited(sensor) || sensor.system() == Some(System::Analog);
    let shared = || Scene { sun: sun_of_paths(scene), ..without_values(scene) };
    (!scene.sensors.values().any(is_alone)).then(shared)
}

/// Scene without values by band.
pub(super) fn without_values(scene: &Scene) -> Scene {
    let one = || Spectrum::Constant(1.0);
    let sky = match &scene.sky {
        Sky::Fraction(shares) if shares.iter().any(|share| *share > 0.0) => {
            Sky::Fraction(vec![1.0; shares.len()])
        }
        Sky::None | Sky::Fraction(_) => Sky::None,
        Sky::Isotropic { .. } => Sky::Isotropic { irradiance: one() },
    };
    let materials = scene.materials.iter();
    Scene {
        title: String::new(),
        spectra: Map::new(),
        materials: materials.map(|(name, one)| (name.clone(), one.without_values())).collect(),
        sun: scene.sun.as_ref().map(|sun| Sun { irradiance: one(), ..sun.clone() }),
        sky,
        thermal_sky: ThermalSky::None,
        ..scene.resolved()
    }
}
