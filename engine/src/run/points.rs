//! Points of a sweep that are traced on the same paths.

use std::path::Path;

use super::check::joined_memory;
use super::checkpoint::CheckpointStore;
use super::clock::Clock;
use super::provenance::FileHashes;
use super::reading::read;
use super::scene_world::SceneWorld;
use super::settled::SettledScene;
use super::staging::staged;
use super::sweep::{at, wrong_at};
use super::{Failure, Options, Progress, joined_context, joined_optics, measure_scenes, sensors};
use crate::document::Scene;
use crate::products::{Report, SweepPoint};

/// Memory that films and products of points on the same paths take at most, unless those of one point take more, bytes. It
/// is the same on every machine, as results depend on which points share paths.
const MOST_MEMORY: u64 = 1 << 30;

/// Runs of a scene file at points that share paths.
pub(super) struct PointRun<'a> {
    pub(super) world: &'a mut SceneWorld,
    pub(super) hashes: &'a mut FileHashes,
    pub(super) file: &'a Path,
    pub(super) options: &'a Options,
}

impl PointRun<'_> {
    /// Follows the scene at each of these points, and measures as many at a time as fit into memory on the same paths.
    pub(super) fn run(
        self,
        points: &[SweepPoint],
        progress: &dyn Progress,
    ) -> Result<Vec<Report>, Failure> {
        let Self { world, hashes, file, options } = self;
        let mut clock = Clock::start();
        let mut settled = Vec::with_capacity(points.len());
        let mut first = None;
        progress.stage("loading");
        for point in points {
            let reading = read(file, &at(options, point))?;
            // Every point has a long list of all points.
            let scene = Scene { sweep: None, ..reading.scene };
            let scene = SettledScene::new(world, scene, hashes)
                .map_err(|failure| wrong_at(point, failure.with_source(&reading.source)))?;
            settled.push(scene);
            first.get_or_insert((point, reading.source));
        }
        clock.lap("spawn");
        let mut measure = || {
            let most = most_at_a_time(world, &settled, options)?;
            let mut reports = Vec::with_capacity(points.len());
            for scenes in settled.chunks(most) {
                let mut store = CheckpointStore::disabled();
                let clock = std::mem::replace(&mut clock, Clock::start());
                let found = measure_scenes(world, scenes, options, &mut store, progress, clock)?;
                reports.extend(found);
            }
            Ok(reports)
        };
        measure().map_err(|failure: Failure| match &first {
            Some((point, source)) => wrong_at(point, failure.with_source(source)),
            None => failure,
        })
    }
}

/// Number of scenes whose films and products fit into [`MOST_MEMORY`] together, at least 1.
fn most_at_a_time(
    world: &mut SceneWorld,
    scenes: &[SettledScene],
    options: &Options,
) -> Result<usize, Failure> {
    let mut most = scenes.len();
    while most > 1 {
        let tried = &scenes[..most];
        let optics = joined_optics(tried);
        let stage = staged(world, &tried[0].scene, &optics, options.free_memory())?;
        let context = joined_context(tried);
        let measured = sensors::MeasureContext { stage: &stage, context: &context };
        if joined_memory(&sensors::in_order(&world.world), measured, options) <= MOST_MEMORY {
            break;
        }
        most = most.div_ceil(2);
    }
    Ok(most)
}
