use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::stakes::Stakes;
use super::{Counter, Event, Share, Tally};
use crate::accel::Batch;
use crate::extract::Stage;
use crate::sampling::Key;
use crate::transport::{Projection, Source};

/// Virtual photons: at each scattering or emission, the power that a surface sends towards each of several
/// parallel projections, per steradian (LESS manual eq. 7); cells are the pixels of each projection
/// and, of more than one, then their total, one projection after the other.
///
/// A cell's sum is `Σ w f cos θ V`, per steradian. Of virtual photons that would bring less than the mean
/// that leaves the scene, a ray is traced for as many as they amount to, and those count in full.
#[derive(Clone, Debug)]
pub struct ViewCounter {
    projections: Vec<Projection>,
    first_cells: Vec<usize>,
    cells: usize,
    /// Russian roulette of virtual photons, if it is played: shared by the parts of the light.
    roulette: Option<Arc<PendingRoulette>>,
}

/// Source and random stream of a pilot run, and what it found once it has run.
#[derive(Debug)]
struct PendingRoulette {
    source: Source,
    key: Key,
    stakes: OnceLock<Stakes>,
}

impl ViewCounter {
    /// Towards these projections.
    #[must_use]
    pub fn new(projections: Vec<Projection>) -> Self {
        let mut cells = 0;
        let first_cells = projections
            .iter()
            .map(|projection| {
                let first = cells;
                cells += projection.pixels() + usize::from(projection.pixels() > 1);
                first
            })
            .collect();
        Self { projections, first_cells, cells, roulette: None }
    }

    /// The counter with Russian roulette of virtual photons of a source. A pilot run of a few packets finds its
    /// threshold before the first packet is traced.
    #[must_use]
    pub fn with_roulette(self, source: Source, key: Key) -> Self {
        let roulette = PendingRoulette { source, key, stakes: OnceLock::new() };
        Self { roulette: Some(Arc::new(roulette)), ..self }
    }

    /// The projections.
    #[must_use]
    pub fn projections(&self) -> &[Projection] {
        &self.projections
    }

    /// First cell of each projection.
    #[must_use]
    pub fn first_cells(&self) -> &[usize] {
        &self.first_cells
    }
}

impl Counter for ViewCounter {
    fn prepare(&self, stage: &Stage) {
        if let Some(PendingRoulette { source, key, stakes }) = self.roulette.as_deref() {
            stakes.get_or_init(|| Stakes::pilot(stage, *source, *key));
        }
    }

    fn cells(&self) -> usize {
        self.cells
    }

    fn count<'a>(&self, stage: &'a Stage, event: &Event<'_, 'a>, tally: &mut Tally<'a>) -> u64 {
        let (hit, outline, sampler) = match event {
            Event::Arrival { is_last: false, hit, outline, sampler, .. }
            | Event::Emission { hit, outline, sampler, .. } => (*hit, *outline, *sampler),
            _ => return 0,
        };
        // π f towards the view, or all on the side that emits.
        let sent = |towards: DVec3| match event {
            Event::Arrival { wo, .. } => {
                stage.surface(hit).bsdf.eval(hit.normal, *wo, towards).map(Share::Of)
            }
            Event::Emission { ray, .. } => {
                let is_same_side =
                    (hit.normal.dot(ray.direction) >= 0.0) == (hit.normal.dot(towards) >= 0.0);
                is_same_side.then_some(Share::Whole)
            }
            _ => None,
        };
        let mut u = sampler.aside();
        let (mut picks, mut rays) = (Vec::new(), Vec::new());
        // Most views see the same side.
        let mut known: Option<(Share<'_>, f64)> = None;
        for (projection, &first) in self.projections.iter().zip(&self.first_cells) {
            let Some(share) = sent(projection.towards) else { continue };
            let cosine = hit.normal.dot(projection.towards).abs();
            let stakes = self.roulette.as_ref().and_then(|roulette| roulette.stakes.get());
            let chance = stakes.map_or(1.0, |stakes| {
                let (_, of_mean) =
                    known.filter(|(known, _)| known.is(share)).unwrap_or_else(|| {
                        let of_mean = f64::from(stakes.share(outline, share));
                        *known.insert((share, of_mean))
                    });
                // What it would add to the reflectance factor, over the mean of that.
                Stakes::chance(of_mean * cosine / projection.towards.z)
            });
            // One number for all views: those chosen are as many as the chances sum to, or one more,
            // and the same whatever part of the scene they show.
            u += chance;
            if u < 1.0 {
                continue;
            }
            u -= 1.0;
            if projection.shows(hit.point, stage) {
                picks.push((projection, first, share, cosine / (chance * PI)));
                rays.push(hit.leave(projection.towards));
            }
        }
        let mut dark = vec![false; rays.len()];
        let batch = Batch { shadows: &rays, dark: &mut dark, rays: &[], hits: &mut [] };
        stage.geometry.trace_each(batch);
        let seen = picks.into_iter().zip(&dark).filter(|(_, is_dark)| !**is_dark);
        for ((projection, first, share, scale), _) in seen {
            projection.for_each_pixel(hit.point, stage, |pixel| {
                tally.add(first + pixel, share, scale);
                if projection.pixels() > 1 {
                    tally.add(first + projection.pixels(), share, scale);
                }
            });
        }
        rays.len() as u64
    }
}
