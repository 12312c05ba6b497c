//! Paths from a sensor into the scene, traced in batches.

use std::ops::Range;

use glam::DVec3;

use crate::accel::Ray;
use crate::extract::Stage;
use crate::sampling::Sampler;
use crate::scattering::with_simd;
use crate::statistics::Sums;
use crate::transport::band_blocks::{BLOCK, Block, blocks};
use crate::transport::ray_queue::{RayQueue, RayResults, RayRounds, TracedRay};

/// State machine of one path from a sensor: it queues rays and continues with their results. One value is
/// reused for many paths.
pub(in crate::transport) trait PathTracer {
    /// Starts a path along a ray, whose closest hit is queued by the caller.
    fn start(&mut self, ray: &Ray, sampler: Sampler);

    /// Continues with the results of the queued rays and queues the next ones; none at the path's end.
    fn advance(&mut self, stage: &Stage, results: RayResults<'_>, queue: &mut RayQueue);

    /// Returns whether the path has met the scene.
    fn has_hit(&self) -> bool;

    /// Takes the radiance of the sky in the direction of a camera ray that met nothing; returns whether there
    /// is sky.
    fn see_sky(&mut self, stage: &Stage, direction: DVec3) -> bool;

    /// Number of spectra of a path.
    fn spectrum_count(&self) -> usize {
        1
    }

    /// Writes the radiance of the last path in a range of bands of each of its spectra.
    fn write_radiance(&self, stage: &Stage, bands: Range<usize>, radiance: &mut [Block]);

    /// Number of columns that are summed over the whole image only.
    fn image_columns(&self) -> usize {
        0
    }

    /// Adds the last path to a cell of sums over the whole image, shape `[cells, image columns]`.
    fn add_to_image_sums(&self, _: &mut Sums, _cell: usize) {}

    /// Number of rays that were traced outside the queue so far.
    fn rays(&self) -> u64 {
        0
    }
}

/// Writes the radiance of each path to columns of shape `[spectra, bands]`: block by block of bands, and in
/// each block path by path, so that the receiver's memory stays in the cache. `write` receives the index of the
/// path, the columns, and their values.
#[inline(always)]
pub(in crate::transport) fn write_each<'p, P: PathTracer + 'p>(
    stage: &Stage,
    paths: &(impl Iterator<Item = &'p P> + Clone),
    columns: usize,
    mut write: impl FnMut(usize, Range<usize>, &[f64]),
) {
    let Some(spectra) = paths.clone().next().map(P::spectrum_count) else { return };
    let bands = columns / spectra;
    let mut radiance = vec![[0.0; BLOCK]; spectra];
    with_simd(
        #[inline(always)]
        || {
            for block in blocks(0..bands) {
                for (index, path) in paths.clone().enumerate() {
                    path.write_radiance(stage, block.clone(), &mut radiance);
                    for (spectrum, radiance) in radiance.iter().enumerate() {
                        let start = spectrum * bands + block.start;
                        write(index, start..start + block.len(), &radiance[..block.len()]);
                    }
                }
            }
        },
    );
}

/// Paths whose rays are traced together, which is faster than tracing them one by one. The result of each
/// path does not depend on the others.
pub(in crate::transport) struct PathBatch<P> {
    paths: Vec<P>,
    rounds: RayRounds,
}

/// Maximum number of paths in a batch: enough that the ray engine is seldom short of work when some have
/// ended.
const BATCH: usize = 256;

/// Paths that are evaluated together: few enough that their histories stay in the cache from one block of bands
/// to the next.
const EVALUATED: usize = 64;

impl<P> PathBatch<P> {
    pub(in crate::transport) fn new(path: impl Fn() -> P) -> Self {
        Self::with_len(BATCH, path)
    }

    /// A batch of one path at a time, with a log of its rays.
    pub(in crate::transport) fn logged(path: impl Fn() -> P) -> Self {
        Self { rounds: RayRounds::with_log(), ..Self::with_len(1, path) }
    }

    fn with_len(count: usize, path: impl Fn() -> P) -> Self {
        let paths = (0..count).map(|_| path()).collect();
        Self { paths, rounds: RayRounds::default() }
    }

    /// All rays so far, if they are logged.
    pub(in crate::transport) fn into_log(self) -> Vec<TracedRay> {
        self.rounds.into_log()
    }
}

impl<P: PathTracer> PathBatch<P> {
    /// Number of rays traced so far.
    pub(in crate::transport) fn rays(&self) -> u64 {
        self.rounds.rays() + self.paths.iter().map(P::rays).sum::<u64>()
    }

    /// Traces a path along each ray to its end. `visit` receives the finished paths with their tags, some at a
    /// time, in the order of the rays.
    pub(in crate::transport) fn trace<T>(
        &mut self,
        stage: &Stage,
        mut starts: impl Iterator<Item = (T, Ray, Sampler)>,
        mut visit: impl FnMut(&[T], &mut [P]),
    ) {
        let Self { paths, rounds } = self;
        let mut tags = Vec::with_capacity(paths.len());
        loop {
            tags.clear();
            let started = rounds.trace(
                stage,
                paths,
                |path, queue| {
                    let Some((tag, ray, sampler)) = starts.next() else { return false };
                    path.start(&ray, sampler);
                    queue.push_closest(ray);
                    tags.push(tag);
                    true
                },
                |path, results, queue| path.advance(stage, results, queue),
            );
            if started == 0 {
                return;
            }
            let paths = &mut paths[..started];
            for (tags, paths) in tags.chunks(EVALUATED).zip(paths.chunks_mut(EVALUATED)) {
                visit(tags, paths);
            }
        }
    }
}
