//! Image of paths from a sensor.

use std::io::{self, Read, Write};
use std::ops::Range;

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use super::tile::{PixelSample, PooledVariance, REPLICATES_PER_PIXEL, Tile};
use super::{Film, Partition, blocks};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::statistics::{Replicates, Sums, ratio};
use crate::transport::paths::{PathBatch, PathTracer};
use crate::transport::state::{restore_f64, restore_u64, save_f64, save_u64};
use crate::transport::{Camera, ProgressFn, RANDOMISATIONS};

/// Outcome of an image measurement.
#[derive(Clone, Debug)]
pub struct ImageOutcome {
    /// Radiance of each pixel in the unit of its
    /// [`LightSource`](crate::transport::LightSource), shape `[rows, columns, spectra, bands]` (the whole
    /// and, on request, its parts): the mean over the samples that met the scene; NaN where none did.
    pub pixels: Vec<f32>,
    /// Its standard error, from its own samples and, where those are few, from those of the tile of 16 × 16
    /// pixels around it; NaN with one sample per pixel.
    pub errors: Vec<f32>,
    /// Fraction of each pixel's samples that met the scene, shape `[rows, columns]`.
    pub coverage: Vec<f32>,
    /// Mean radiance over all samples that met the scene, shape `[spectra, bands]`.
    pub mean: Vec<f64>,
    /// Its standard error.
    pub mean_error: Vec<f64>,
    /// Columns that are summed over the whole image only, shape `[image columns]`.
    pub image_sums: Replicates,
}

/// Side of the square of pixels that one block traces.
const TILE: u32 = 16;

const _: () = assert!(
    (RANDOMISATIONS as usize).is_multiple_of(REPLICATES_PER_PIXEL),
    "the row of a sample tells its replicate"
);

/// Means and variances of the paths from a camera, pixel by pixel. For the errors of sums over the whole image,
/// the samples of all pixels are also summed in [`RANDOMISATIONS`] rows.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct ImageTiles<'a> {
    size: UVec2,
    columns: usize,
    trace: Box<TraceTile<'a>>,
    tiles: Vec<Tile>,
    /// Columns that are summed over the whole image only: whole numbers, so in any order. Shape
    /// `[1 + half-samples, replicates, image columns]`: over all pixels, and over the pixels of which a half-sample
    /// takes a replicate.
    image_sums: Sums,
    /// Samples of each pixel.
    done: u64,
    rays: u64,
    partition: Partition,
}

/// Adds samples to a tile; returns sums over the whole image and the number of rays.
type TraceTile<'a> = dyn Fn(&mut Tile, Range<u64>) -> (Sums, u64) + Sync + 'a;

impl<'a> ImageTiles<'a> {
    /// No samples yet, of paths whose first `columns` values count.
    pub(in crate::transport) fn new<P: PathTracer>(
        stage: &'a Stage,
        camera: Camera,
        key: Key,
        columns: usize,
        path: impl Fn() -> P + Sync + 'a,
    ) -> Self {
        let size = camera.size();
        let image_sums = Sums::new(IMAGE_SUM_CELLS, path().image_columns());
        let trace = move |tile: &mut Tile, samples: Range<u64>| {
            TileTracer { stage, camera: &camera, key, path: &path }.trace(tile, samples)
        };
        Self {
            size,
            columns,
            trace: Box::new(trace),
            tiles: Vec::new(),
            image_sums,
            done: 0,
            rays: 0,
            partition: Partition::ALL,
        }
    }

    /// Allocates the memory of a partition, as late as possible: films that are never traced need none.
    fn set_up(&mut self, partition: Partition) {
        if self.tiles.is_empty() {
            self.tiles = Vec::with_capacity(count(self.size) as usize);
            self.tiles.extend(tiles(self.size).map(|(low, high)| Tile::new(low, high)));
        }
        let tiles = self.tiles.par_iter_mut().enumerate();
        let owned = tiles.filter(|(tile, _)| partition.owns(*tile));
        owned.for_each(|(_, tile)| tile.set_up(self.columns));
    }

    /// Returns whether paths have columns that are summed over the whole image only.
    #[must_use]
    pub const fn has_image_sums(&self) -> bool {
        self.image_sums.bands() > 0
    }

    /// The outcome of the samples so far.
    #[must_use]
    pub fn outcome(&self) -> ImageOutcome {
        let size = self.size;
        let (pixel_count, columns) = ((size.x * size.y) as usize, self.columns);
        let n = self.done as f64;
        let rows = self.done.clamp(1, RANDOMISATIONS.into()) as usize;
        let mut sums = Sums::new(RANDOMISATIONS as usize, columns);
        let mut counts = vec![0_u64; rows];
        let mut effects = vec![PooledVariance::default(); columns];
        let pooled: Vec<Vec<PooledVariance>> =
            self.tiles.par_iter().map(|tile| tile.pooled(n)).collect();
        for (tile, pooled) in self.tiles.iter().zip(&pooled) {
            sums.merge(&tile.sums);
            for (total, part) in counts.iter_mut().zip(&tile.counts) {
                *total += part;
            }
            effects.iter_mut().zip(pooled).for_each(|(effect, pooled)| effect.add(pooled));
        }
        let counts: Vec<f64> = counts.iter().map(|&count| count as f64).collect();
        let (mean, mut mean_error) = ratio(&sums.values()[..rows * columns], &counts);
        for (error, effect) in mean_error.iter_mut().zip(&effects) {
            *error *= effect.design_effect().sqrt();
        }
        let (mut pixels, mut errors) =
            (vec![0.0; pixel_count * columns], vec![0.0; pixel_count * columns]);
        let mut coverage = vec![0.0; pixel_count];
        // Rows of tiles in parallel, which also touch this memory first.
        let across = size.x.div_ceil(TILE) as usize;
        let pixels_of_row = (TILE * size.x) as usize;
        let values = pixels.par_chunks_mut(pixels_of_row * columns);
        let values = values.zip(errors.par_chunks_mut(pixels_of_row * columns));
        values.zip(coverage.par_chunks_mut(pixels_of_row)).enumerate().for_each(
            |(row, ((pixels, errors), coverage))| {
                pixels.fill(f32::NAN);
                errors.fill(f32::NAN);
                let first = row * pixels_of_row;
                let place = |at: UVec2| (at.y * size.x + at.x) as usize - first;
                for (tile, pooled) in self.tiles.iter().zip(&pooled).skip(row * across).take(across)
                {
                    let values = PixelValues { pixels, errors, coverage };
                    write_pixels(tile, pooled, n, place, values);
                }
            },
        );
        ImageOutcome { pixels, errors, coverage, mean, mean_error, image_sums: self.image_sums() }
    }

    /// Columns that are summed over the whole image only.
    fn image_sums(&self) -> Replicates {
        if !self.has_image_sums() {
            return Replicates::default();
        }
        let columns = self.image_sums.bands();
        let cells: Vec<&[f64]> = self.image_sums.values().chunks_exact(columns).collect();
        let pairs: Vec<[&[f64]; REPLICATES_PER_PIXEL]> =
            cells.chunks_exact(REPLICATES_PER_PIXEL).map(|pair| [pair[0], pair[1]]).collect();
        // The samples of a pixel alternate between its replicates.
        let samples = [self.done.div_ceil(2) as f64, (self.done / 2) as f64];
        Replicates::from_half_samples(pairs[0], &pairs[1..], samples)
    }
}

/// Cells of sums over the whole image, see [`ImageTiles`]: one half-sample for each bit of a random number.
const IMAGE_SUM_CELLS: usize = REPLICATES_PER_PIXEL * (1 + HALF_SAMPLES as usize);
/// Half-samples for the errors of sums over the whole image.
const HALF_SAMPLES: u32 = u32::BITS;

/// Adds a path to sums over the whole image, and to those of the half-samples that take this replicate of the
/// pixel.
fn add_to_image_sums(path: &impl PathTracer, sums: &mut Sums, replicate: usize, choices: u32) {
    path.add_to_image_sums(sums, replicate);
    for half_sample in 0..HALF_SAMPLES {
        if (choices >> half_sample & 1) as usize == replicate {
            let cell = REPLICATES_PER_PIXEL * (1 + half_sample as usize) + replicate;
            path.add_to_image_sums(sums, cell);
        }
    }
}

/// Values of the pixels of a row of tiles.
struct PixelValues<'v> {
    /// Shape `[pixels, columns]`.
    pixels: &'v mut [f32],
    /// Standard errors, shape `[pixels, columns]`.
    errors: &'v mut [f32],
    /// Fraction of samples that met the scene, shape `[pixels]`.
    coverage: &'v mut [f32],
}

/// Writes the values of the pixels of a tile, of `n` samples each, to their places.
fn write_pixels(
    tile: &Tile,
    pooled: &[PooledVariance],
    n: f64,
    place: impl Fn(UVec2) -> usize,
    values: PixelValues<'_>,
) {
    let PixelValues { pixels, errors, coverage } = values;
    let columns = pooled.len();
    let valid = tile.pixels().enumerate().filter(|(pixel, _)| tile.valid_samples(*pixel) > 0);
    for (pixel, at) in valid {
        let to = place(at);
        coverage[to] = (tile.valid_samples(pixel) as f64 / n) as f32;
        let range = to * columns..(to + 1) * columns;
        let values = pixels[range.clone()].iter_mut().zip(&mut errors[range]);
        for ((moments, pooled), (value, error)) in tile.moments(pixel).zip(pooled).zip(values) {
            *value = moments.mean as f32;
            *error = pooled.variance_of_mean(&moments, n).sqrt() as f32;
        }
    }
}

/// Number of tiles of an image.
fn count(size: UVec2) -> u64 {
    u64::from(size.x.div_ceil(TILE)) * u64::from(size.y.div_ceil(TILE))
}

/// Corners of all tiles of an image, row by row.
fn tiles(size: UVec2) -> impl Iterator<Item = (UVec2, UVec2)> {
    let starts = |length: u32| (0..length).step_by(TILE as usize);
    let corners = starts(size.y).flat_map(move |y| starts(size.x).map(move |x| UVec2::new(x, y)));
    corners.map(move |low| (low, (low + TILE).min(size)))
}

impl Film for ImageTiles<'_> {
    fn trace(&mut self, to: u64, progress: ProgressFn<'_>) {
        self.set_up(self.partition);
        let samples = self.done..to;
        let Self { tiles, trace, image_sums, rays, partition, .. } = self;
        let owned: Vec<&mut Tile> = tiles
            .iter_mut()
            .enumerate()
            .filter(|(tile, _)| partition.owns(*tile))
            .map(|(_, tile)| tile)
            .collect();
        let (mut traced, count) = (0, owned.len());
        blocks::in_order(
            owned,
            |tile| trace(tile, samples.clone()),
            |(tile_sums, tile_rays)| {
                image_sums.merge(&tile_sums);
                *rays += tile_rays;
                traced += 1;
                progress(f64::from(traced) / count as f64);
            },
        );
        self.done = to;
    }

    fn restrict(&mut self, partition: Partition) {
        self.partition = partition;
    }

    fn units(&self) -> UVec2 {
        UVec2::new(self.size.x.div_ceil(TILE), self.size.y.div_ceil(TILE))
    }

    fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        save_u64(out, &[self.rays])?;
        save_f64(out, self.image_sums.values())?;
        let tiles = self.tiles.iter().enumerate();
        for (_, tile) in tiles.filter(|(tile, _)| self.partition.owns(*tile)) {
            for counts in tile.valid.iter().chain([&tile.counts]) {
                save_u64(out, counts)?;
            }
            for values in tile.means.iter().chain([&tile.squares]) {
                save_f64(out, values)?;
            }
            save_f64(out, tile.sums.values())?;
        }
        Ok(())
    }

    fn restore(&mut self, partition: Partition, done: u64, input: &mut dyn Read) -> io::Result<()> {
        let mut rays = [0];
        restore_u64(input, &mut rays)?;
        self.rays += rays[0];
        let mut image_sums = self.image_sums.clone();
        restore_f64(input, image_sums.values_mut())?;
        self.image_sums.merge(&image_sums);
        self.done = done;
        self.set_up(partition);
        let tiles = self.tiles.iter_mut().enumerate();
        for (_, tile) in tiles.filter(|(tile, _)| partition.owns(*tile)) {
            for counts in tile.valid.iter_mut().chain([&mut tile.counts]) {
                restore_u64(input, counts)?;
            }
            for values in tile.means.iter_mut().chain([&mut tile.squares]) {
                restore_f64(input, values)?;
            }
            restore_f64(input, tile.sums.values_mut())?;
        }
        Ok(())
    }

    fn can_grow(&self) -> Result<(), u64> {
        Ok(())
    }

    fn samples(&self) -> u64 {
        let size = self.size;
        u64::from(size.x) * u64::from(size.y) * self.done
    }

    fn bytes(&self) -> u64 {
        let all = tiles(self.size).enumerate();
        let owned = all.filter(|(tile, _)| self.partition.owns(*tile));
        let (tiles, pixels) = owned.fold((0, 0), |(tiles, pixels), (_, (low, high))| {
            let size = high - low;
            (tiles + 1, pixels + u64::from(size.x * size.y))
        });
        // A pixel holds its valid samples, and means and squares of its columns; a tile its sums and counts.
        let (columns, replicates) = (self.columns as u64, REPLICATES_PER_PIXEL as u64);
        let words = pixels.saturating_mul(replicates + (replicates + 1) * columns)
            + tiles * u64::from(RANDOMISATIONS) * (1 + columns);
        let image_sums = self.image_sums.values().len() as u64;
        count(self.size) * size_of::<Tile>() as u64 + 8 * (words + image_sums)
    }

    fn bytes_beside(&self) -> u64 {
        let waiting = (blocks::ahead() * self.image_sums.values().len() * size_of::<f64>()) as u64;
        // The coverage of each pixel, and mean and error of its columns, as f32.
        let pixels = u64::from(self.size.x) * u64::from(self.size.y);
        waiting.max(pixels.saturating_mul(4 + 8 * self.columns as u64))
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

/// Traces the samples of a tile.
struct TileTracer<'t, F> {
    stage: &'t Stage,
    camera: &'t Camera,
    key: Key,
    path: &'t F,
}

impl<P: PathTracer, F: Fn() -> P> TileTracer<'_, F> {
    /// Adds samples to a tile; returns sums over the whole image and the number of rays.
    fn trace(&self, tile: &mut Tile, samples: Range<u64>) -> (Sums, u64) {
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
        let choices = key.path("half-samples");
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

/// Number of a pixel's random streams.
fn number_of(at: UVec2) -> u64 {
    u64::from(at.y) << 32 | u64::from(at.x)
}
