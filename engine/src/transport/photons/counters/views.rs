use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::virtual_photon_roulette::VirtualPhotonRoulette;
use super::{Counter, Event, Recorder, WeightFactor};
use crate::extract::Stage;
use crate::sampling::Key;
use crate::scattering::Lobe;
use crate::transport::{LightSource, OrthographicCamera};

/// Virtual photons: at each scattering or emission, the power that a surface sends towards each of several
/// parallel projections, per steradian (LESS manual eq. 7); cells are the pixels of each projection
/// and, if it has more than one, their total, projection by projection.
///
/// A cell's sum is `Σ w f cos θ V`, per steradian. A contribution `c` below the mean `m` that leaves the scene
/// is traced with probability `c / m` and divided by it.
#[derive(Clone, Debug)]
pub struct ViewCounter {
    cameras: Vec<OrthographicCamera>,
    first_cells: Vec<usize>,
    cells: usize,
    /// Russian roulette of virtual photons, if there is one: shared by the parts of the light.
    roulette: Option<Arc<PendingRoulette>>,
}

/// Source and random stream of a pilot run, and its result once it has run.
#[derive(Debug)]
struct PendingRoulette {
    source: LightSource,
    key: Key,
    roulette: OnceLock<VirtualPhotonRoulette>,
}

impl ViewCounter {
    /// A counter of the pixels of these cameras.
    #[must_use]
    pub fn new(cameras: Vec<OrthographicCamera>) -> Self {
        let mut cells = 0;
        let first_cells = cameras
            .iter()
            .map(|camera| {
                let first = cells;
                cells += camera.pixels() + usize::from(camera.pixels() > 1);
                first
            })
            .collect();
        Self { cameras, first_cells, cells, roulette: None }
    }

    /// The counter with Russian roulette of virtual photons of a source. A pilot run of a few packets finds its
    /// threshold before the first packet is traced.
    #[must_use]
    pub fn with_roulette(self, source: LightSource, key: Key) -> Self {
        let roulette = PendingRoulette { source, key, roulette: OnceLock::new() };
        Self { roulette: Some(Arc::new(roulette)), ..self }
    }

    /// The cameras.
    #[must_use]
    pub fn cameras(&self) -> &[OrthographicCamera] {
        &self.cameras
    }

    /// First cell of each camera.
    #[must_use]
    pub fn first_cells(&self) -> &[usize] {
        &self.first_cells
    }
}

/// Light that an event sends towards a view.
#[derive(Clone, Copy, Debug)]
struct SentTowards {
    /// Fraction of the packet's weight, before the cosine.
    factor: WeightFactor,
    /// Largest ratio of that part to the mean that leaves the scene.
    ratio: f64,
}

/// Fraction of a packet's weight that an event sends towards a view, before the cosine; `None` if it sends
/// nothing.
fn factor_towards(stage: &Stage, event: &Event<'_>, towards: DVec3) -> Option<WeightFactor> {
    match event {
        Event::Arrival { surface, .. } => surface.f(towards).map(WeightFactor::Lobe),
        Event::Emission { hit, ray, scale, band, .. } => {
            let surface = stage.interaction(hit, ray.direction);
            surface.is_same_side(towards).then(|| {
                let emitted = stage.interaction(hit, towards).absorbed_fraction();
                WeightFactor::Lobe(match band {
                    None => emitted.scaled(*scale),
                    Some(band) => {
                        let value = |fraction| stage.models.value(&fraction, *band);
                        let along_ray = value(surface.absorbed_fraction());
                        Lobe::ONE.scaled(value(emitted) / along_ray)
                    }
                })
            })
        }
        _ => None,
    }
}

impl ViewCounter {
    fn roulette(&self) -> Option<&VirtualPhotonRoulette> {
        self.roulette.as_ref().and_then(|pending| pending.roulette.get())
    }

    /// Light that an event with this throughput sends towards a view.
    fn sent_towards(
        &self,
        stage: &Stage,
        event: &Event<'_>,
        throughput: &[f32],
        towards: DVec3,
    ) -> Option<SentTowards> {
        let factor = factor_towards(stage, event, towards)?;
        // The throughput of emitted light holds the emitted fraction.
        let is_emitted = matches!(event, Event::Emission { .. });
        let rest = if is_emitted { WeightFactor::One } else { factor };
        let ratio = |roulette: &VirtualPhotonRoulette| {
            f64::from(roulette.largest_ratio(stage, throughput, rest))
        };
        Some(SentTowards { factor, ratio: self.roulette().map_or(f64::INFINITY, ratio) })
    }
}

impl Counter for ViewCounter {
    fn prepare(&self, stage: &Stage) {
        if let Some(PendingRoulette { source, key, roulette }) = self.roulette.as_deref() {
            let pilot_run = || VirtualPhotonRoulette::from_pilot_run(stage, *source, *key);
            roulette.get_or_init(pilot_run);
        }
    }

    fn cells(&self) -> usize {
        self.cells
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, recorder: &mut Recorder<'_>) {
        let (hit, throughput, sampler) = match event {
            Event::Arrival { is_last: false, hit, throughput, sampler, .. }
            | Event::Emission { hit, throughput, sampler, .. } => (*hit, *throughput, *sampler),
            _ => return,
        };
        let is_diffuse = stage.interaction(hit, hit.normal).is_diffuse();
        // A diffuse surface sends the same towards all views on a side.
        let mut by_side: [Option<Option<SentTowards>>; 2] = [None; 2];
        let mut u = sampler.aside();
        for (camera, &first_cell) in self.cameras.iter().zip(&self.first_cells) {
            let cosine = hit.normal.dot(camera.towards);
            let known = &mut by_side[usize::from(cosine >= 0.0)];
            if !is_diffuse || known.is_none() {
                *known = Some(self.sent_towards(stage, event, throughput, camera.towards));
            }
            let Some(Some(SentTowards { factor, ratio })) = *known else { continue };
            let cosine = cosine.abs();
            // Contribution to the reflectance factor over its mean.
            let probability = VirtualPhotonRoulette::probability(ratio * cosine / camera.towards.z);
            // One number for all views: as many are traced as the probabilities sum to, or one more, whatever
            // part of the scene they show.
            u += probability;
            if u < 1.0 {
                continue;
            }
            u -= 1.0;
            let scale = cosine / (probability * PI);
            let mut shadow_ray = None;
            camera.for_each_pixel(hit.point, stage, |pixel| {
                let push = || recorder.push_shadow(hit.leave(camera.towards));
                let shadow_ray = *shadow_ray.get_or_insert_with(push);
                let total = (camera.pixels() > 1).then_some(camera.pixels());
                for cell in [Some(pixel), total].into_iter().flatten() {
                    recorder.add_unless_occluded(shadow_ray, first_cell + cell, factor, scale);
                }
            });
        }
    }
}
