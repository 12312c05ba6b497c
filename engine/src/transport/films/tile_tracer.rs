//! Samples of the pixels of a tile.

use std::ops::Range;

use glam::{DVec2, UVec2};

use super::tile::{PixelSample, REPLICATES_PER_PIXEL, Tile};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::statistics::Sums;
use crate::transport::paths::{PathBatch, PathTracer};
use crate::transport::{Camera, RANDOMISATIONS};

/// Cells of sums over the whole image: one half-sample for each bit of a random number.
pub(super) const IMAGE_SUM_CELLS: usize = REPLICATES_PER_PIXEL * (1 + HALF_SAMPLES as usize);
/// Half-samples for the errors of sums over the whole image.
const HALF_SAMPLES: u32 = u32::BITS;

/// Adds a path to sums over the whole image, and to those of the half-samples that take this replicate of the
/// pixel.
fn add_to_image_sums(path: &impl PathTracer, sums: &mut Sums, replicate: usize, choices: u32) {
    path.add_to_image_sums(sums, replicate);
    for half_sample in half_samples(choices, replicate) {
        path.add_to_image_sums(sums, REPLICATES_PER_PIXEL * (1 + half_sample) + replicate);
    }
}

/// Half-samples that take a replicate of a pixel with these choices.
pub(super) fn half_samples(choices: u32, replicate: usize) -> impl Iterator<Item = usize> {
    let all = 0..HALF_SAMPLES;
    let taken = all.filter(move |half_sample| (choices >> half_sample & 1) as usize == replicate);
    taken.map(|half_sample| half_sample as usize)
}

/// Traces the samples of a tile.
pub(super) struct TileTracer<'t, F> {
    pub(super) stage: &'t Stage,
    pub(super) camera: &'t Camera,
    pub(super) key: Key,
    pub(super) path: &'t F,
}

impl<P: PathTracer, F: Fn() -> P> TileTracer<'_, F> {
    /// Adds samples to a tile; returns sums over the whole image and the number of rays.
    pub(super) fn trace(&self, tile: &mut Tile, samples: Range<u64>) -> (Sums, u64) {
        let mut image_sums = Sums::new(IMAGE_SUM_CELLS, (self.path)().image_columns());
        let mut batch = PathBatch::new(self.path);
        let mut rays = 0;
        // All samples of a pixel that have rows of their own follow each other: its values stay in the cache. Sums
        // over the pixels are made in one order however rounds are cut.
        let rows = u64::from(RANDOMISATIONS);
        let ends = (samples.start / rows + 1..).map(|round| (round * rows).min(samples.end));
        let mut from = samples.start;
        for to in ends {
            self.trace_round(tile, from..to, &mut batch, &mut image_sums, &mut rays);
            if to == samples.end {
                break;
            }
            from = to;
        }
        (image_sums, rays + batch.rays())
    }

    /// Adds samples that each have a row of their own.
    fn trace_round(
        &self,
        tile: &mut Tile,
        samples: Range<u64>,
        batch: &mut PathBatch<P>,
        image_sums: &mut Sums,
        rays: &mut u64,
    ) {
        let Self { stage, camera, key, .. } = *self;
        let scale = camera.size().as_dvec2().recip();
        let starts = tile.pixels().enumerate();
        let starts = starts.flat_map(|(pixel, at)| samples.clone().map(move |of| (pixel, at, of)));
        let starts = starts.filter_map(|(pixel, at, sample)| {
            let row = (sample % u64::from(RANDOMISATIONS)) as usize;
            let replicates = REPLICATES_PER_PIXEL as u64;
            let points = key.index(sample % replicates).index(number_of(at));
            let mut sampler = Sampler::new(points, sample / replicates);
            let [u, v, ..] = sampler.next_4d();
            let ray = camera.ray((at.as_dvec2() + DVec2::new(u, v)) * scale)?;
            let is_admitted = camera.admits(&ray, stage, rays);
            is_admitted.then_some(((PixelSample { pixel, row }, ray.direction), ray, sampler))
        });
        // One bit of each pixel per half-sample: the replicate that it takes.
        let choices = choices_of(key);
        let width = (tile.high.x - tile.low.x) as usize;
        batch.trace(stage, starts, |tags, paths| {
            let (mut valid, mut samples) = (Vec::new(), Vec::new());
            for (&(sample, direction), path) in tags.iter().zip(paths) {
                if path.has_hit() || camera.sees_sky() && path.see_sky(stage, direction) {
                    if image_sums.bands() > 0 {
                        let PixelSample { pixel, row } = sample;
                        let at =
                            tile.low + UVec2::new((pixel % width) as u32, (pixel / width) as u32);
                        let bits = choices.index(number_of(at)).bits(0) as u32;
                        add_to_image_sums(path, image_sums, row % REPLICATES_PER_PIXEL, bits);
                    }
                    valid.push(&*path);
                    samples.push(sample);
                }
            }
            tile.push(stage, &valid.iter().copied(), &samples);
        });
    }
}

/// Key of the choices of half-samples of an image.
pub(super) fn choices_of(key: Key) -> Key {
    key.path("half-samples")
}

/// Number of a pixel's random streams.
pub(super) fn number_of(at: UVec2) -> u64 {
    u64::from(at.y) << 32 | u64::from(at.x)
}
