//! Batches: several traversals that take steps in turn.

use crate::accel::{
    layout::TwoLevelBvh,
    simd::{Isa, StackMemory},
};

use super::{
    hit::{Hit, Ray},
    tiles::TileIter,
    trace::Traversal,
};

/// Number of rays that are traced side by side if the geometry lies in the cache.
const SLOTS: usize = 3;

/// Number of rays that are traced side by side while memory is fetched ahead: steps of the others fill the time that
/// this takes.
const FETCHING_SLOTS: usize = 10;

/// Rays that are traced together, and their results.
#[derive(Debug)]
pub struct RayBatch<'a> {
    /// Rays for which any surface counts.
    pub shadow_rays: &'a [Ray],
    /// Set to whether a surface is on each shadow ray, shape `[shadow_rays]`.
    pub occluded: &'a mut [bool],
    /// Rays for which the first surface is wanted.
    pub closest_rays: &'a [Ray],
    /// Set to the first surface on each of those, shape `[closest_rays]`.
    pub hits: &'a mut [Option<Hit>],
}

/// Traces rays side by side.
#[inline(always)]
pub(super) fn trace_each<I: Isa>(isa: I, bvh: &TwoLevelBvh, batch: RayBatch<'_>) {
    if bvh.is_fetched_ahead {
        trace_in_slots::<I, FETCHING_SLOTS, true>(isa, bvh, batch);
    } else {
        trace_in_slots::<I, SLOTS, false>(isa, bvh, batch);
    }
}

/// Traces one ray per slot; a slot whose ray is finished takes the next.
///
/// Each step of a traversal depends on the one before: it waits for a node, then for the result of its box tests.
/// Steps of independent traversals fill that time. With `FETCHES`, what a ray reads next is fetched while they run.
#[inline(always)]
fn trace_in_slots<I: Isa, const SLOTS: usize, const FETCHES: bool>(
    isa: I,
    bvh: &TwoLevelBvh,
    batch: RayBatch<'_>,
) {
    let RayBatch { shadow_rays, occluded, closest_rays, hits } = batch;
    occluded.fill(false);
    hits.fill(None);
    let mut memories: [StackMemory; SLOTS] = std::array::from_fn(|_| StackMemory::new());
    // Closest hits take longer to find: short searches come last, when slots run empty.
    let mut queue = closest_rays
        .iter()
        .enumerate()
        .map(|(index, ray)| QueuedRay { index, ray, any: false })
        .chain(shadow_rays.iter().enumerate().map(|(index, ray)| QueuedRay {
            index,
            ray,
            any: true,
        }));
    let mut slots = memories.each_mut().map(|memory| Slot {
        traversal: Traversal::new(isa, bvh, memory),
        tiles: None,
        index: 0,
        is_active: true,
    });
    for slot in &mut slots {
        slot.is_active = slot.take_ray(isa, bvh, &mut queue);
    }
    let mut active = slots.iter().filter(|slot| slot.is_active).count();
    while active > 0 {
        for slot in &mut slots {
            if !slot.is_active {
                continue;
            }
            if slot.traversal.step(isa) {
                if FETCHES {
                    slot.traversal.prefetch();
                }
                continue;
            }
            let Some(candidate) = slot.traversal.closest.candidate else {
                slot.is_active = slot.take_tile(isa) || slot.take_ray(isa, bvh, &mut queue);
                active -= usize::from(!slot.is_active);
                continue;
            };
            if slot.traversal.any {
                occluded[slot.index] = true;
            } else {
                hits[slot.index] = Some(bvh.resolve(&slot.traversal.tile_ray, &candidate));
            }
            slot.is_active = slot.take_ray(isa, bvh, &mut queue);
            active -= usize::from(!slot.is_active);
        }
    }
}

/// Ray that waits for a slot.
struct QueuedRay<'a> {
    /// Index among the rays of its kind.
    index: usize,
    ray: &'a Ray,
    /// `true` for a shadow ray.
    any: bool,
}

/// One of the traversals of [`trace_each`].
struct Slot<'a, I: Isa> {
    traversal: Traversal<'a, I>,
    /// Tiles that its ray has still to cross.
    tiles: Option<TileIter<'a>>,
    /// Index of its ray.
    index: usize,
    is_active: bool,
}

impl<'a, I: Isa> Slot<'a, I> {
    /// Starts its ray in the next tile that holds anything; returns whether there is one.
    #[inline(always)]
    fn take_tile(&mut self, isa: I) -> bool {
        let Some(tiles) = &mut self.tiles else { return false };
        let any = self.traversal.any;
        // No closure: that would not be compiled for the instruction set.
        for tile_ray in tiles.by_ref() {
            if self.traversal.start(isa, tile_ray, any) {
                return true;
            }
        }
        false
    }

    /// Starts the next ray that can hit anything; returns whether there is one.
    #[inline(always)]
    fn take_ray(
        &mut self,
        isa: I,
        bvh: &'a TwoLevelBvh,
        queue: &mut impl Iterator<Item = QueuedRay<'a>>,
    ) -> bool {
        for QueuedRay { index, ray, any } in queue.by_ref() {
            self.index = index;
            self.tiles = Some(TileIter::new(bvh, ray, f64::INFINITY));
            self.traversal.any = any;
            if self.take_tile(isa) {
                return true;
            }
        }
        false
    }
}
