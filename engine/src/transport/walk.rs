//! Walks from a sensor into the scene, many side by side.

use std::mem::swap;
use std::ops::Range;

use glam::DVec3;

use super::history::{BLOCK, Block, blocks};
use crate::accel::{Batch, Hit, Ray};
use crate::extract::Stage;
use crate::film::Sums;
use crate::sampling::Sampler;
use crate::scattering::widely;

/// Follows a ray from a sensor into the scene, from one question of the ray engine to the next; one
/// value is reused for many rays.
pub(super) trait Walk<'a> {
    /// Sets out along a ray, the first that it waits for.
    fn start(&mut self, ray: &Ray, sampler: Sampler);

    /// Takes what was found on the rays that it waited for, and asks for those that it waits for now.
    fn go_on(&mut self, stage: &'a Stage, answer: Answer<'_>, asks: &mut Asks);

    /// Whether it has met the scene at all.
    fn has_met(&self) -> bool;

    /// Takes what a ray in this direction, which met nothing, finds in the sky; whether it finds
    /// anything. For cameras that see the sky.
    fn see_sky(&mut self, stage: &'a Stage, direction: DVec3) -> bool;

    /// Number of spectra that it finds.
    fn spectra(&self) -> usize {
        1
    }

    /// Writes down what the last ray found in these bands of each of its spectra.
    fn show(&self, bands: Range<usize>, found: &mut [Block]);

    /// Columns of what is summed over the whole image alone.
    fn zones(&self) -> usize {
        0
    }

    /// Adds what the last ray found to sums over the whole image, shape `[cells, zones]`.
    fn add_to_zones(&self, _: &mut Sums, _: usize) {}

    /// Rays so far that it has traced by itself, without waiting.
    fn rays(&self) -> u64 {
        0
    }
}

/// Shows what each of these walks found in columns of shape `[spectra, bands]`: block by block of bands, and
/// in each block walk by walk, so that what takes it stays in the cache. Receives the number of the walk, the
/// columns, and what it found in them.
#[inline(always)]
pub(super) fn show_each<'w, 'a, W: Walk<'a> + 'w>(
    walks: &(impl Iterator<Item = &'w W> + Clone),
    columns: usize,
    mut take: impl FnMut(usize, Range<usize>, &[f64]),
) {
    let Some(spectra) = walks.clone().next().map(W::spectra) else { return };
    let bands = columns / spectra;
    let mut found = vec![[0.0; BLOCK]; spectra];
    widely(
        #[inline(always)]
        || {
            for block in blocks(0..bands) {
                for (number, walk) in walks.clone().enumerate() {
                    walk.show(block.clone(), &mut found);
                    for (spectrum, found) in found.iter().enumerate() {
                        let start = spectrum * bands + block.start;
                        take(number, start..start + block.len(), &found[..block.len()]);
                    }
                }
            }
        },
    );
}

/// Rays that walks wait for, each of one ray of either kind at most; one that asks for none has come to its end.
#[derive(Debug, Default)]
pub(super) struct Asks {
    shadows: Vec<Ray>,
    onward: Vec<Ray>,
}

impl Asks {
    /// Asks whether anything is in the way of a ray.
    pub(super) fn shadow(&mut self, ray: Ray) {
        self.shadows.push(ray);
    }

    /// Asks what a ray meets first.
    pub(super) fn onward(&mut self, ray: Ray) {
        self.onward.push(ray);
    }

    fn clear(&mut self) {
        self.shadows.clear();
        self.onward.clear();
    }

    fn len(&self) -> Asked {
        [self.shadows.len(), self.onward.len()]
    }
}

/// Numbers of shadow rays and of rays onwards.
type Asked = [usize; 2];

/// What was found on the rays that a walk asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer<'h> {
    /// Whether there was a shadow ray and nothing in its way.
    pub(super) is_lit: bool,
    /// What the ray onwards meets first, if there was one and it meets anything.
    pub(super) hit: Option<&'h Hit>,
}

/// A ray that was traced, for benchmarks of the ray engine.
#[derive(Clone, Copy, Debug)]
pub struct Traced {
    /// The ray.
    pub ray: Ray,
    /// Whether any hit would do, as for a shadow ray, or the closest was asked for.
    pub any: bool,
}

/// Walks that wait for their rays together: those are traced side by side, in less time than one after
/// the other. What each finds does not depend on the others.
pub(super) struct Party<W> {
    walks: Vec<W>,
    /// What the walks that go on wait for, in their order.
    asks: Asks,
    rays: u64,
    log: Option<Vec<Traced>>,
}

/// Most walks of a party: enough that the ray engine is seldom short of work when some have ended.
const MOST: usize = 256;

/// Walks that are shown together: so few that what they wrote down stays in the cache from one block of bands
/// to the next.
const SHOWN: usize = 64;

impl<W> Party<W> {
    pub(super) fn new(walk: impl Fn() -> W) -> Self {
        Self::of(MOST, walk)
    }

    /// One walk after the other, with a log of its rays.
    pub(super) fn logged(walk: impl Fn() -> W) -> Self {
        Self { log: Some(Vec::new()), ..Self::of(1, walk) }
    }

    fn of(count: usize, walk: impl Fn() -> W) -> Self {
        let walks = (0..count).map(|_| walk()).collect();
        Self { walks, asks: Asks::default(), rays: 0, log: None }
    }

    /// All rays so far, if they are logged.
    pub(super) fn into_log(self) -> Vec<Traced> {
        self.log.unwrap_or_default()
    }
}

impl<'a, W: Walk<'a>> Party<W> {
    /// Rays traced so far.
    pub(super) fn rays(&self) -> u64 {
        self.rays + self.walks.iter().map(W::rays).sum::<u64>()
    }

    /// Follows each of these rays to the end of its walk and shows them, some at a time, in their order.
    pub(super) fn follow<T>(
        &mut self,
        stage: &'a Stage,
        mut starts: impl Iterator<Item = (T, Ray, Sampler)>,
        mut found: impl FnMut(&[T], &mut [W]),
    ) {
        let mut tags = Vec::with_capacity(self.walks.len());
        loop {
            self.asks.clear();
            for (walk, (tag, ray, sampler)) in self.walks.iter_mut().zip(&mut starts) {
                walk.start(&ray, sampler);
                self.asks.onward(ray);
                tags.push(tag);
            }
            if tags.is_empty() {
                return;
            }
            self.finish(stage, tags.len());
            for (tags, walks) in tags.chunks(SHOWN).zip(self.walks.chunks_mut(SHOWN)) {
                found(tags, &mut walks[..tags.len()]);
            }
            tags.clear();
        }
    }

    /// Brings the first walks, which each wait for a ray onwards, to their ends.
    fn finish(&mut self, stage: &'a Stage, count: usize) {
        let mut going: Vec<(usize, Asked)> = (0..count).map(|walk| (walk, [0, 1])).collect();
        let mut next = Asks::default();
        let (mut dark, mut hits) = (Vec::new(), Vec::new());
        while !going.is_empty() {
            let Asks { shadows, onward: rays } = &self.asks;
            if let Some(log) = &mut self.log {
                log.extend(shadows.iter().map(|&ray| Traced { ray, any: true }));
                log.extend(rays.iter().map(|&ray| Traced { ray, any: false }));
            }
            self.rays += (shadows.len() + rays.len()) as u64;
            dark.resize(shadows.len(), false);
            hits.resize(rays.len(), None);
            stage.geometry.trace_each(Batch { shadows, dark: &mut dark, rays, hits: &mut hits });
            let (mut dark, mut hits) = (dark.iter(), hits.iter());
            next.clear();
            going.retain_mut(|(walk, asked)| {
                let is_lit = asked[0] > 0 && dark.next() == Some(&false);
                let hit = if asked[1] > 0 { hits.next().and_then(Option::as_ref) } else { None };
                let before = next.len();
                self.walks[*walk].go_on(stage, Answer { is_lit, hit }, &mut next);
                *asked = [0, 1].map(|kind| next.len()[kind] - before[kind]);
                *asked != [0, 0]
            });
            swap(&mut self.asks, &mut next);
        }
    }
}
