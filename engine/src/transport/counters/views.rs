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
/// and then their total, one projection after the other.
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
                cells += projection.pixels() + 1;
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
        let (hit, weight, mut u) = match event {
            Event::Arrival { is_last: false, hit, weight, u, .. }
            | Event::Emission { hit, weight, u, .. } => (*hit, *weight, *u),
            _ => return 0,
        };
        // π f towards the view, or 1 on the side that emits.
        let factor = |towards: DVec3| match event {
            Event::Arrival { wo, .. } => {
                stage.surface(hit).bsdf.eval(hit.normal, *wo, towards).map(Some)
            }
            Event::Emission { ray, .. } => {
                let is_same_side =
                    (hit.normal.dot(ray.direction) >= 0.0) == (hit.normal.dot(towards) >= 0.0);
                is_same_side.then_some(None)
            }
            _ => None,
        };
        let value = |spectrum: Option<&[f32]>, lane: usize| {
            weight[lane] * spectrum.map_or(1.0, |spectrum| spectrum[lane])
        };
        // Both sides of a leaf have one spectrum or two, however many views there are.
        let mut last: Option<(*const f32, f32)> = None;
        let mut share = |spectrum: Option<&[f32]>| {
            let name = spectrum.map_or(std::ptr::null(), <[f32]>::as_ptr);
            let known = last.filter(|(known, _)| *known == name);
            let values = || (0..stage.bands).map(|lane| value(spectrum, lane));
            let find = || self.stakes.as_ref().map_or(f32::MAX, |stakes| stakes.share(values()));
            let (_, share) = *last.insert(known.unwrap_or_else(|| (name, find())));
            f64::from(share)
        };
        let mut picks = Vec::new();
        let mut rays = Vec::new();
        for (projection, &first) in self.projections.iter().zip(&self.first_cells) {
            let Some(spectrum) = factor(projection.towards) else { continue };
            let cosine = hit.normal.dot(projection.towards).abs();
            // What it would add to the reflectance factor, over the mean of that.
            let chance = Stakes::chance(share(spectrum) * cosine / projection.towards.z);
            // One number for all views: those chosen are as many as the chances sum to, or one more,
            // and the same whatever part of the scene they show.
            u += chance;
            if u < 1.0 {
                continue;
            }
            u -= 1.0;
            if projection.shows(hit.point, stage) {
                picks.push((projection, first, spectrum, cosine / (chance * PI)));
                rays.push(hit.leave(projection.towards));
            }
        }
        let mut dark = vec![false; rays.len()];
        let batch = Batch { shadows: &rays, dark: &mut dark, rays: &[], hits: &mut [] };
        stage.geometry.trace_each(batch);
        let seen = picks.into_iter().zip(&dark).filter(|(_, is_dark)| !**is_dark);
        for ((projection, first, spectrum, scale), _) in seen {
            projection.for_each_pixel(hit.point, stage, |pixel| {
                for cell in [first + pixel, first + projection.pixels()] {
                    sums.add_with(cell, |lane| f64::from(value(spectrum, lane)) * scale);
                }
            });
        }
        rays.len() as u64
    }
}
