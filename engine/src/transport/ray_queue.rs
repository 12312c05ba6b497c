//! Queues of rays, and rounds in which the queued rays of many state machines are traced together.

use std::mem::swap;

use crate::accel::{Hit, Ray, RayBatch};
use crate::extract::Stage;

/// Queued rays: each path or packet queues any number of shadow rays and at most one closest ray a round.
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
}

/// Results of the rays that a path or packet queued.
#[derive(Clone, Copy, Debug)]
pub(in crate::transport) struct RayResults<'h> {
    /// True for each shadow ray that something occludes, in the order of the queue.
    pub(in crate::transport) occluded: &'h [bool],
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

/// Rounds of a batch of state machines, paths or packets: each round traces all queued rays together, which is
/// faster than one by one, and each state machine continues with its results.
#[derive(Debug, Default)]
pub(in crate::transport) struct RayRounds {
    queue: RayQueue,
    /// Rays of the next round.
    next: RayQueue,
    /// State machines with queued rays, in the order of the queue.
    active: Vec<Active>,
    occluded: Vec<bool>,
    hits: Vec<Option<Hit>>,
    rays: u64,
    log: Option<Vec<TracedRay>>,
}

/// Index of a state machine and the numbers of rays that it has queued.
#[derive(Clone, Copy, Debug)]
struct Active {
    index: usize,
    shadow: usize,
    closest: usize,
}

impl Active {
    /// Numbers of rays that `push` queues.
    fn from_queue(index: usize, queue: &mut RayQueue, push: impl FnOnce(&mut RayQueue)) -> Self {
        let (shadow, closest) = (queue.shadow.len(), queue.closest.len());
        push(queue);
        Self { index, shadow: queue.shadow.len() - shadow, closest: queue.closest.len() - closest }
    }

    const fn is_waiting(&self) -> bool {
        self.shadow + self.closest > 0
    }
}

impl RayRounds {
    /// Rounds with a log of all rays.
    pub(in crate::transport) fn with_log() -> Self {
        Self { log: Some(Vec::new()), ..Self::default() }
    }

    /// All rays so far, if they are logged.
    pub(in crate::transport) fn into_log(self) -> Vec<TracedRay> {
        self.log.unwrap_or_default()
    }

    /// Number of rays traced so far.
    pub(in crate::transport) const fn rays(&self) -> u64 {
        self.rays
    }

    /// Traces state machines to their ends: those that have no ray queued. `start` queues the first rays of one and
    /// returns whether there was anything to start; returns the number of those that were started.
    pub(in crate::transport) fn trace<T>(
        &mut self,
        stage: &Stage,
        machines: &mut [T],
        mut start: impl FnMut(&mut T, &mut RayQueue) -> bool,
        mut advance: impl FnMut(&mut T, RayResults<'_>, &mut RayQueue),
    ) -> usize {
        let Self { queue, next, active, occluded, hits, rays, log } = self;
        queue.clear();
        active.clear();
        let mut started = 0;
        for machine in &mut *machines {
            let mut is_started = false;
            active.push(Active::from_queue(started, queue, |queue| {
                is_started = start(machine, queue);
            }));
            if !is_started {
                break;
            }
            started += 1;
        }
        active.retain(Active::is_waiting);
        while !active.is_empty() {
            let RayQueue { shadow: shadow_rays, closest: closest_rays } = &*queue;
            if let Some(log) = log {
                log.extend(shadow_rays.iter().map(|&ray| TracedRay { ray, any: true }));
                log.extend(closest_rays.iter().map(|&ray| TracedRay { ray, any: false }));
            }
            *rays += (shadow_rays.len() + closest_rays.len()) as u64;
            occluded.resize(shadow_rays.len(), false);
            hits.resize(closest_rays.len(), None);
            stage.geometry.trace_each(RayBatch { shadow_rays, occluded, closest_rays, hits });
            let (mut occluded, mut hits) = (occluded.as_slice(), hits.iter());
            next.clear();
            active.retain_mut(|queued| {
                let own;
                (own, occluded) = occluded.split_at(queued.shadow);
                let hit =
                    if queued.closest > 0 { hits.next().and_then(Option::as_ref) } else { None };
                let results = RayResults { occluded: own, hit };
                *queued = Active::from_queue(queued.index, next, |next| {
                    advance(&mut machines[queued.index], results, next);
                });
                queued.is_waiting()
            });
            swap(queue, next);
        }
        started
    }
}
