use super::{AlbedoCounter, WeightFactor};
use crate::extract::Stage;
use crate::sampling::Key;
use crate::scattering::largest_product;
use crate::transport::photons::{PacketOptions, PhotonKind, photon_film};
use crate::transport::{LightSource, ReferencePlane, RouletteThreshold};

/// Russian roulette of virtual photons: a contribution below the mean radiance that leaves the scene is traced
/// with a probability in proportion, and divided by it. Many weak contributions cost no more rays than the few
/// strong ones that they amount to.
#[derive(Clone, Debug)]
pub(super) struct VirtualPhotonRoulette {
    /// Reciprocal of the mean in the representative bands; the largest number where nothing leaves, so that
    /// whatever does leave is traced.
    reciprocal_mean: Box<[f32]>,
}

/// Packets of each randomisation in the pilot run. It decides probabilities and no result: a few percent are
/// accurate enough.
const PILOT: u64 = 16;

/// Probabilities above this are taken as 1: where all contributions are alike, all are traced.
const NEARLY_CERTAIN: f64 = 0.9;

impl VirtualPhotonRoulette {
    /// Finds the mean radiance of the light of a source in a pilot run of a few packets.
    pub(super) fn from_pilot_run(stage: &Stage, source: LightSource, key: Key) -> Self {
        let plane = ReferencePlane::new(None, stage);
        let albedo = Box::new(AlbedoCounter { plane: plane.clone() });
        let kind = PhotonKind::Packet(RouletteThreshold::High);
        let options = PacketOptions { source, beam: 0, kind, plane };
        let mut film = photon_film(stage, options, [albedo as _], key.path("stakes"));
        film.trace_in_memory(PILOT, &|_| {});
        let leaves = film.spread(1);
        let reciprocals: Vec<f32> =
            leaves.mean().iter().map(|mean| (mean.recip() as f32).min(f32::MAX)).collect();
        let representatives = stage.models.spectra.representative_bands();
        Self { reciprocal_mean: representatives.values_of(&reciprocals) }
    }

    /// Largest ratio over the representative bands of a contribution to the mean: of a fraction of the
    /// throughput of a packet.
    pub(super) fn largest_ratio(
        &self,
        stage: &Stage,
        throughput: &[f32],
        factor: WeightFactor,
    ) -> f32 {
        let mean = &self.reciprocal_mean;
        match factor {
            WeightFactor::Lobe(lobe) => {
                let largest = |lobe: &[f32]| largest_product([throughput, lobe, mean]);
                stage.models.with_representatives(&lobe.spectrum, largest) * lobe.scale
            }
            WeightFactor::One | WeightFactor::Complement(_) => largest_product([throughput, mean]),
        }
    }

    /// Probability to trace a contribution with this ratio to the mean.
    pub(super) fn probability(ratio: f64) -> f64 {
        if ratio < NEARLY_CERTAIN { ratio } else { 1.0 }
    }
}
