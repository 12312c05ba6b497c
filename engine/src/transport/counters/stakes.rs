use super::AlbedoCounter;
use crate::extract::Stage;
use crate::sampling::Key;
use crate::scattering::{largest_product, padded};
use crate::transport::{Film, Grain, ReferencePlane, Roulette, Source, photon_film};

/// What a contribution to a radiance is measured by before a ray is spent on whether it arrives: the
/// mean radiance that leaves the scene.
///
/// A contribution below that is played for: it counts with a chance in proportion, and then in full.
/// So many weak ones cost no more than the few that they amount to.
#[derive(Clone, Debug)]
pub(super) struct Stakes {
    /// 1 over the mean in each lane; the largest number where nothing leaves, so that whatever
    /// does is looked at.
    per_mean: Box<[f32]>,
}

/// Packets of each randomisation that find what leaves the scene. It weighs chances and no result, so a
/// few percent are near enough.
const PILOT: u64 = 16;

/// Chances above this are worth no game: where all contributions are alike, none is left to it.
const NEARLY_ALL: f64 = 0.9;

impl Stakes {
    /// Of the light of a source, from a few packets.
    pub(super) fn pilot(stage: &Stage, source: Source, key: Key) -> Self {
        let plane = ReferencePlane::of(None, stage);
        let albedo = Box::new(AlbedoCounter { plane: plane.clone() });
        let of = (source, Grain::Packet(Roulette::Firm), plane);
        let mut film = photon_film(stage, of, [albedo as _], key.path("stakes"));
        film.trace(PILOT, &|_| {});
        let leaves = film.spread(1);
        let per_mean = leaves.mean().iter().map(|mean| (mean.recip() as f32).min(f32::MAX));
        Self { per_mean: padded(per_mean) }
    }

    /// The largest share of the mean that a lane of a contribution amounts to.
    pub(super) fn share(&self, contribution: &[f32]) -> f32 {
        largest_product(contribution, &self.per_mean)
    }

    /// The chance with which a contribution of this share counts.
    pub(super) fn chance(share: f64) -> f64 {
        if share < NEARLY_ALL { share } else { 1.0 }
    }
}
