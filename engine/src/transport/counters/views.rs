use std::f64::consts::PI;

use glam::DVec3;

use super::stakes::Stakes;
use super::{Counter, Event};
use crate::accel::Batch;
use crate::extract::Stage;
use crate::film::Sums;
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
    stakes: Option<Stakes>,
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
        Self { projections, first_cells, cells, stakes: None }
    }

    /// The same, which plays for virtual photons of a source; a few packets tell for how much.
    #[must_use]
    pub fn playing(self, stage: &Stage, source: Source, key: Key) -> Self {
        Self { stakes: Some(Stakes::pilot(stage, source, key)), ..self }
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
    fn cells(&self) -> usize {
        self.cells
    }

    fn count(&self, stage: &Stage, event: &Event<'_>, sums: &mut Sums) -> u64 {
        let (hit, weight, sampler) = match event {
            Event::Arrival { is_last: false, hit, weight, sampler, .. }
            | Event::Emission { hit, weight, sampler, .. } => (*hit, *weight, *sampler),
            _ => return 0,
        };
        // π f towards the view, or 1 on the side that emits.
        let factor = |towards: DVec3| match event {
            Event::Arrival { wo, .. } => {
                stage.surface(hit).bsdf.eval(hit.normal, *wo, towards).map(|f| Some(&**f))
            }
            Event::Emission { ray, .. } => {
                let is_same_side =
                    (hit.normal.dot(ray.direction) >= 0.0) == (hit.normal.dot(towards) >= 0.0);
                is_same_side.then_some(None)
            }
            _ => None,
        };
        let mut u = sampler.aside();
        let mut sent = Sent::default();
        let (mut picks, mut rays) = (Vec::new(), Vec::new());
        for (projection, &first) in self.projections.iter().zip(&self.first_cells) {
            let Some(spectrum) = factor(projection.towards) else { continue };
            let side = sent.side(weight, spectrum, self.stakes.as_ref());
            let cosine = hit.normal.dot(projection.towards).abs();
            // What it would add to the reflectance factor, over the mean of that.
            let chance = Stakes::chance(sent.sides[side].1 * cosine / projection.towards.z);
            // One number for all views: those chosen are as many as the chances sum to, or one more,
            // and the same whatever part of the scene they show.
            u += chance;
            if u < 1.0 {
                continue;
            }
            u -= 1.0;
            if projection.shows(hit.point, stage) {
                picks.push((projection, first, side, cosine / (chance * PI)));
                rays.push(hit.leave(projection.towards));
            }
        }
        let mut dark = vec![false; rays.len()];
        let batch = Batch { shadows: &rays, dark: &mut dark, rays: &[], hits: &mut [] };
        stage.geometry.trace_each(batch);
        let seen = picks.into_iter().zip(&dark).filter(|(_, is_dark)| !**is_dark);
        for ((projection, first, side, scale), _) in seen {
            let power = &sent.sides[side].0;
            projection.for_each_pixel(hit.point, stage, |pixel| {
                sums.add(first + pixel, power, scale);
                if projection.pixels() > 1 {
                    sums.add(first + projection.pixels(), power, scale);
                }
            });
        }
        rays.len() as u64
    }
}

/// What a surface sends on to its sides: one spectrum or two, however many views there are.
#[derive(Default)]
struct Sent {
    names: Vec<*const f32>,
    /// Weight that is sent, shape `[lanes]`, and the share of the mean that it amounts to.
    sides: Vec<(Vec<f32>, f64)>,
}

impl Sent {
    /// The side that sends this share of a weight; all of it if there is none.
    fn side(&mut self, weight: &[f32], share: Option<&[f32]>, stakes: Option<&Stakes>) -> usize {
        let name = share.map_or(std::ptr::null(), <[f32]>::as_ptr);
        if let Some(known) = self.names.iter().position(|known| *known == name) {
            return known;
        }
        let sent: Vec<f32> = match share {
            Some(share) => weight.iter().zip(share).map(|(weight, share)| weight * share).collect(),
            None => weight.to_vec(),
        };
        let of_mean = stakes.map_or(f32::MAX, |stakes| stakes.share(&sent));
        self.names.push(name);
        self.sides.push((sent, of_mean.into()));
        self.names.len() - 1
    }
}
