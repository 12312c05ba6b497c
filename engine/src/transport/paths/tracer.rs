//! Paths from a sensor into the scene, traced in batches.

use std::mem::swap;
use std::ops::Range;

use glam::DVec3;

use crate::accel::{Hit, Ray, RayBatch};
use crate::extract::Stage;
use crate::sampling::Sampler;
use crate::scattering::with_simd;
use crate::statistics::Sums;
use crate::transport::band_blocks::{BLOCK, Block, blocks};

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

/// Queued rays: each path queues at most one of either kind a step.
#[derive(Debug, Default)]
pub(in crate::transport) struct RayQueue {
    shadow: Vec<Ray>,
    closest: Vec<Ray>,
}

impl RayQueue {
    /// Queues a test for anything that occludes a ray.
    pub(in crate::transport) fn push_shadow(&mut self, ray: Ray) {
        self.shadow.push(ray);
    }

    /// Queues a search for the closest hit of a ray.
    pub(in crate::transport) fn push_closest(&mut self, ray: Ray) {
        self.closest.push(ray);
    }

    fn clear(&mut self) {
        self.shadow.clear();
        self.closest.clear();
    }

    fn len(&self) -> QueuedRays {
        QueuedRays { shadow: self.shadow.len(), closest: self.closest.len() }
    }
}

/// Numbers of queued rays.
#[derive(Clone, Copy, PartialEq, Eq)]
struct QueuedRays {
    shadow: usize,
    closest: usize,
}

/// Results of the rays that a path queued.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct RayResults<'h> {
    /// True if there was a shadow ray and nothing occludes it.
    pub(in crate::transport) is_lit: bool,
    /// Closest hit, if one was queued and the ray meets anything.
    pub(in crate::transport) hit: Option<&'h Hit>,
}

/// A traced ray, for benchmarks of the ray engine.
#[derive(Clone, Copy, Debug)]
pub struct TracedRay {
    /// The ray.
    pub ray: Ray,
    /// True for a shadow ray, for which any hit will do; false if the closest hit was searched.
    pub any: bool,
}

/// Paths whose rays are traced together, which is faster than tracing them one by one. The result of each
/// path does not depend on the others.
pub(in crate::transport) struct PathBatch<P> {
    paths: Vec<P>,
    queue: RayQueue,
    rays: u64,
    log: Option<Vec<TracedRay>>,
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
        Self { log: Some(Vec::new()), ..Self::with_len(1, path) }
    }

    fn with_len(count: usize, path: impl Fn() -> P) -> Self {
        let paths = (0..count).map(|_| path()).collect();
        Self { paths, queue: RayQueue::default(), rays: 0, log: None }
    }

    /// All rays so far, if they are logged.
    pub(in crate::transport) fn into_log(self) -> Vec<TracedRay> {
        self.log.unwrap_or_default()
    }
}

impl<P: PathTracer> PathBatch<P> {
    /// Number of rays traced so far.
    pub(in crate::transport) fn rays(&self) -> u64 {
        self.rays + self.paths.iter().map(P::rays).sum::<u64>()
    }

    /// Traces a path along each ray to its end. `visit` receives the finished paths with their tags, some at a
    /// time, in the order of the rays.
    pub(in crate::transport) fn trace<T>(
        &mut self,
        stage: &Stage,
        mut starts: impl Iterator<Item = (T, Ray, Sampler)>,
        mut visit: impl FnMut(&[T], &mut [P]),
    ) {
        let mut tags = Vec::with_capacity(self.paths.len());
        loop {
            self.queue.clear();
            for (path, (tag, ray, sampler)) in self.paths.iter_mut().zip(&mut starts) {
                path.start(&ray, sampler);
                self.queue.push_closest(ray);
                tags.push(tag);
            }
            if tags.is_empty() {
                return;
            }
            self.finish(stage, tags.len());
            for (tags, paths) in tags.chunks(EVALUATED).zip(self.paths.chunks_mut(EVALUATED)) {
                visit(tags, &mut paths[..tags.len()]);
            }
            tags.clear();
        }
    }

    /// Traces the first `count` paths, each of which has queued its first ray, to their ends.
    fn finish(&mut self, stage: &Stage, count: usize) {
        let first = QueuedRays { shadow: 0, closest: 1 };
        let none = QueuedRays { shadow: 0, closest: 0 };
        let mut active: Vec<(usize, QueuedRays)> = (0..count).map(|path| (path, first)).collect();
        let mut next = RayQueue::default();
        let (mut occluded, mut hits) = (Vec::new(), Vec::new());
        while !active.is_empty() {
            let RayQueue { shadow: shadow_rays, closest: closest_rays } = &self.queue;
            if let Some(log) = &mut self.log {
                log.extend(shadow_rays.iter().map(|&ray| TracedRay { ray, any: true }));
                log.extend(closest_rays.iter().map(|&ray| TracedRay { ray, any: false }));
            }
            self.rays += (shadow_rays.len() + closest_rays.len()) as u64;
            occluded.resize(shadow_rays.len(), false);
            hits.resize(closest_rays.len(), None);
            stage.geometry.trace_each(RayBatch {
                shadow_rays,
                occluded: &mut occluded,
                closest_rays,
                hits: &mut hits,
            });
            let (mut occluded, mut hits) = (occluded.iter(), hits.iter());
            next.clear();
            active.retain_mut(|(path, queued)| {
                let is_lit = queued.shadow > 0 && occluded.next() == Some(&false);
                let hit =
                    if queued.closest > 0 { hits.next().and_then(Option::as_ref) } else { None };
                let before = next.len();
                self.paths[*path].advance(stage, RayResults { is_lit, hit }, &mut next);
                let after = next.len();
                queued.shadow = after.shadow - before.shadow;
                queued.closest = after.closest - before.closest;
                *queued != none
            });
            swap(&mut self.queue, &mut next);
        }
    }
}
