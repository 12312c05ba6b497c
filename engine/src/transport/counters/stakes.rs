use super::{AlbedoCounter, Share};
use crate::extract::Stage;
use crate::sampling::Key;
use crate::scattering::{Spectrum, largest_product};
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
    per_mean: Spectrum,
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
        Self { per_mean: Spectrum::new(per_mean) }
    }

    /// The largest share of the mean that an outline of a contribution amounts to, from that of the
    /// weight that it is a share of.
    pub(super) fn share(&self, weight: &[f32], share: Share<'_>) -> f32 {
        let per_mean = self.per_mean.outline();
        match share {
            Share::Of(spectrum) => largest_product([weight, spectrum.outline(), per_mean]),
            Share::Whole | Share::ButFor(_) => largest_product([weight, per_mean]),
        }
    }

    /// The chance with which a contribution of this share counts.
    pub(super) fn chance(share: f64) -> f64 {
        if share < NEARLY_ALL { share } else { 1.0 }
    }
}
