//! Traversal of the two levels: closest hits, shadow rays and batches of both.
//!
//! [`tiles`] cuts a ray into one [`TileRay`](tiles::TileRay) per tile; `trace` follows that through both levels and
//! finds the candidates of `ray` (SIMD, `f32`) that `exact` confirms (`f64`); `hit` turns the winner into a [`Hit`].
//! `batch` interleaves several traversals.

mod batch;
mod exact;
mod hit;
mod ray;
mod tiles;
mod trace;

use crate::accel::{
    layout::TwoLevelBvh,
    simd::{Isa, Kernel},
};
use tiles::{TileIter, TileRay};
use trace::Candidate;

pub use batch::RayBatch;
pub use hit::{Departure, Hit, Ray};

impl TwoLevelBvh {
    /// Returns the first surface on a ray at a distance above 0.
    ///
    /// Surfaces at one distance are told apart by instance, then by primitive: the lowest is the closest.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        TileIter::new(self, ray, f64::INFINITY).find_map(|tile_ray| {
            let candidate = self.level.run(ClosestHit(&tile_ray))?;
            Some(self.resolve(&tile_ray, &candidate))
        })
    }

    /// Returns whether any surface is on a ray at a distance above 0.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_within(ray, f64::INFINITY)
    }

    /// Returns whether any surface is on a ray at a distance above 0 and below `distance`, m.
    #[must_use]
    pub fn occluded_within(&self, ray: &Ray, distance: f64) -> bool {
        TileIter::new(self, ray, distance).any(|tile_ray| self.level.run(AnyHit(&tile_ray)))
    }

    /// Computes [`Self::occluded`] of shadow rays and [`Self::closest`] of others, which is faster than tracing them
    /// one by one.
    ///
    /// # Panics
    /// If the numbers of rays and results differ.
    pub fn trace_each(&self, batch: RayBatch<'_>) {
        let RayBatch { shadow_rays, occluded, closest_rays, hits } = &batch;
        let is_complete = shadow_rays.len() == occluded.len() && closest_rays.len() == hits.len();
        assert!(is_complete, "a batch has one result per ray");
        self.level.run(Interleaved { bvh: self, batch });
    }
}

/// Search for the closest candidate on a ray.
struct ClosestHit<'a>(&'a TileRay<'a>);

impl Kernel for ClosestHit<'_> {
    type Output = Option<Candidate>;

    #[inline(always)]
    fn run<I: Isa>(self, isa: I) -> Option<Candidate> {
        trace::trace(isa, self.0, false)
    }
}

/// Search for any candidate on a ray.
struct AnyHit<'a>(&'a TileRay<'a>);

impl Kernel for AnyHit<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<I: Isa>(self, isa: I) -> bool {
        trace::trace(isa, self.0, true).is_some()
    }
}

/// Tracing of a batch.
struct Interleaved<'a> {
    bvh: &'a TwoLevelBvh,
    batch: RayBatch<'a>,
}

impl Kernel for Interleaved<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Isa>(self, isa: I) {
        batch::trace_each(isa, self.bvh, self.batch);
    }
}
