//! Points of a sweep that are traced on the same paths.

use std::ops::Range;
use std::sync::Arc;

use super::check::joined_memory;
use super::checkpoint::CheckpointStore;
use super::clock::Clock;
use super::point_reader::{AT_A_TIME, PointReader, wrong_at};
use super::scene_world::SceneWorld;
use super::settled::SettledScene;
use super::staging::staged;
use super::{
    Failure, Options, Progress, joined_context, joined_optics, measure_scenes, pixels, sensors,
    uncovered,
};
use crate::document::{Reading, Source};
use crate::products::{Report, SweepPoint};

/// Memory that films and products of points on the same paths take at most, unless those of one point take more, bytes. It
/// is the same on every machine with more than twice as much free, as results depend on which points share paths.
const MOST_MEMORY: u64 = 1 << 30;

/// Points of a sweep that can share paths: the scene at each.
pub(super) struct SettledPoints {
    scenes: Vec<SettledScene>,
    source: Arc<Source>,
    /// Number of points that are measured at a time.
    most: usize,
}

impl SettledPoints {
    /// Follows the scene at each of these points.
    ///
    /// # Errors
    /// All errors of the scene at the first point that has any.
    ///
    /// # Panics
    /// If there is no point.
    pub(super) fn new(
        reader: &PointReader,
        points: &[SweepPoint],
        options: &Options,
        world: &mut SceneWorld,
    ) -> Result<Self, Failure> {
        let (mut scenes, mut first) = (Vec::with_capacity(points.len()), None);
        for some in points.chunks(AT_A_TIME) {
            for (reading, point) in reader.read_all(some).into_iter().zip(some) {
                let Reading { scene, source, .. } = reading?;
                let scene = SettledScene::new(world, scene, reader.hashes())
                    .map_err(|failure| wrong_at(point, failure.with_source(&source)))?;
                scenes.push(scene);
                first.get_or_insert(source);
            }
        }
        let source = first.expect("a point");
        let mut settled = Self { scenes, source, most: points.len() };
        settled.most = settled
            .most_at_a_time(world, options)
            .map_err(|failure| wrong_at(&points[0], failure.with_source(&settled.source)))?;
        Ok(settled)
    }

    /// Places of the points that are measured together.
    pub(super) fn parts(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let (count, most) = (self.scenes.len(), self.most);
        (0..count).step_by(most).map(move |start| start..(start + most).min(count))
    }

    /// Measures the points of one of the parts on the same paths.
    ///
    /// # Errors
    /// Errors of the run, at the first of these points.
    pub(super) fn measure(
        &self,
        part: Range<usize>,
        first: &SweepPoint,
        options: &Options,
        world: &mut SceneWorld,
        progress: &dyn Progress,
    ) -> Result<Vec<Report>, Failure> {
        let mut store = CheckpointStore::disabled();
        measure_scenes(
            world,
            &self.scenes[part],
            options,
            &mut store,
            None,
            progress,
            Clock::start(),
        )
        .map_err(|failure| wrong_at(first, failure.with_source(&self.source)))
    }

    /// Number of scenes, at least 1, whose films and products fit into [`MOST_MEMORY`] together, and whose bands have
    /// representatives that cover all of them.
    fn most_at_a_time(&self, world: &mut SceneWorld, options: &Options) -> Result<usize, Failure> {
        let limit = MOST_MEMORY.min(options.free_memory() / 2);
        let mut most = self.scenes.len();
        while most > 1 {
            let tried = &self.scenes[..most];
            let optics = joined_optics(tried);
            let stage = staged(world, &tried[0].scene, &optics, options.free_memory())?;
            pixels::count_pixels(&mut world.world, &stage, tried[0].scene.bands.len())?;
            let context = joined_context(tried);
            let scratch = &options.scratch;
            let measured = sensors::MeasureContext { stage: &stage, context: &context, scratch };
            let memory = joined_memory(&sensors::in_order(&world.world), measured, options);
            if memory <= limit && uncovered::warning(&stage, &context).is_none() {
                break;
            }
            most = most.div_ceil(2);
        }
        Ok(most)
    }
}
