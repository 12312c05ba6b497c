use glam::DVec3;

use super::{Counter, Event};
use crate::extract::Stage;
use crate::film::Sums;
use crate::transport::Projection;

/// Virtual photons: at each scattering or emission, the power that a surface sends towards each of several
/// parallel projections, per steradian (LESS manual eq. 7); cells are the pixels of each projection
/// and then their total, one projection after the other.
///
/// A cell's sum is `Σ w f cos θ V`, per steradian.
#[derive(Clone, Debug)]
pub struct ViewCounter {
    projections: Vec<Projection>,
    first_cells: Vec<usize>,
    cells: usize,
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
        Self { projections, first_cells, cells }
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
        let (hit, weight) = match event {
            Event::Arrival { is_last: false, hit, weight, .. }
            | Event::Emission { hit, weight, .. } => (*hit, *weight),
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
        let mut rays = 0;
        for (projection, &first) in self.projections.iter().zip(&self.first_cells) {
            let Some(spectrum) = factor(projection.towards) else { continue };
            let mut is_visible = None;
            projection.for_each_pixel(hit.point, stage, |pixel| {
                let visible = *is_visible.get_or_insert_with(|| {
                    rays += 1;
                    !stage.geometry.occluded(&hit.leave(projection.towards))
                });
                if visible {
                    let cosine = hit.normal.dot(projection.towards).abs();
                    let scale = cosine / std::f64::consts::PI;
                    for cell in [first + pixel, first + projection.pixels()] {
                        sums.add_with(cell, |lane| {
                            let factor = spectrum.map_or(1.0, |spectrum| spectrum[lane]);
                            f64::from(weight[lane] * factor) * scale
                        });
                    }
                }
            });
        }
        rays
    }
}
