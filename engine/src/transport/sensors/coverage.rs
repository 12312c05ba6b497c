use glam::{DVec2, UVec2};
use rayon::prelude::*;

use crate::accel::Ray;
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::transport::OrthographicCamera;

/// Number of cells along each side of the square grid of a pixel; each holds one ray at random.
const SIDE: u32 = 8;

/// Fraction of each pixel of a parallel projection in which it shows the scene, shape `[rows, columns]`.
///
/// Photon packets count the flux of a pixel. Its radiance, the mean over the part that shows the scene, is the
/// flux over this fraction.
#[derive(Clone, Debug)]
pub(super) struct Coverage {
    pub(super) fractions: Vec<f32>,
}

impl Coverage {
    /// Estimate from 64 stratified rays a pixel. A periodic ground without holes is met by every ray.
    pub(super) fn from_rays(camera: &OrthographicCamera, stage: &Stage, key: Key) -> Self {
        if stage.periodic && !stage.has_holes && !camera.has_plane() {
            return Self { fractions: vec![1.0; camera.pixels()] };
        }
        let shows = |ray: &Ray| {
            camera.admits(ray, stage, &mut 0)
                && stage.geometry.closest(ray).is_some_and(|hit| !stage.is_cut(&hit))
        };
        let fraction = |pixel: usize| {
            let width = camera.size.x as usize;
            let corner = UVec2::new((pixel % width) as u32, (pixel / width) as u32).as_dvec2();
            let mut sampler = Sampler::new(key, pixel as u64);
            let hits = (0..SIDE * SIDE).filter(|cell| {
                let [u, v, ..] = sampler.next_4d();
                let cell = UVec2::new(cell % SIDE, cell / SIDE).as_dvec2();
                let at = corner + (cell + DVec2::new(u, v)) / f64::from(SIDE);
                shows(&camera.ray(at / camera.size.as_dvec2()))
            });
            hits.count() as f32 / (SIDE * SIDE) as f32
        };
        Self { fractions: (0..camera.pixels()).into_par_iter().map(fraction).collect() }
    }

    /// Bound of the standard error of a fraction: that of independent rays.
    pub(super) fn error(fraction: f64) -> f64 {
        (fraction * (1.0 - fraction)).max(0.0).sqrt() / f64::from(SIDE)
    }

    /// Mean over all pixels, and a bound of its standard error.
    pub(super) fn mean(&self) -> (f64, f64) {
        let pixels = self.fractions.len() as f64;
        let fractions = || self.fractions.iter().map(|&fraction| f64::from(fraction));
        let variance: f64 = fractions().map(|fraction| Self::error(fraction).powi(2)).sum();
        (fractions().sum::<f64>() / pixels, variance.sqrt() / pixels)
    }
}
