//! Pixels that paths from a sensor are averaged in.

use std::io::{self, Read, Write};
use std::ops::Range;

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use super::share::{restore_f64, restore_u64, save_f64, save_u64};
use super::tile::{NETS, Pooled, Tile};
use super::walk::{Party, Walk};
use super::{Camera, Film, ImageOutcome, RANDOMISATIONS, Share, Watch, blocks};
use crate::extract::Stage;
use crate::film::{Replicates, Sums, ratio};
use crate::sampling::{Key, Sampler};

/// Side of the square of pixels that one block traces.
const TILE: u32 = 16;

/// What walks from a camera found, pixel by pixel. For the errors of sums over the whole image,
/// [`RANDOMISATIONS`] of the samples of all pixels are kept apart.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct Tiles<'a> {
    size: UVec2,
    columns: usize,
    trace: Box<TraceTile<'a>>,
    all: Vec<Tile>,
    /// What a walk sums over the whole image alone: whole numbers, so in any order. Shape `[1 + replicates,
    /// nets, zones]`: over all pixels, and over the pixels of which a half-sample takes a net.
    zones: Sums,
    /// Samples of each pixel.
    done: u64,
    rays: u64,
    share: Share,
}

/// Adds samples to a tile and zones; returns the number of rays.
type TraceTile<'a> = dyn Fn(&mut Tile, Range<u64>) -> (Sums, u64) + Sync + 'a;

impl<'a> Tiles<'a> {
    /// No sample yet, of walks whose first `columns` values count.
    pub(super) fn new<W: Walk<'a>>(
        (stage, camera): (&'a Stage, Camera),
        key: Key,
        columns: usize,
        walk: impl Fn() -> W + Sync + 'a,
    ) -> Self {
        let size = camera.size();
        let zones = Sums::new(ZONE_CELLS, walk().zones());
        let trace = move |tile: &mut Tile, samples: Range<u64>| {
            trace_tile((stage, &camera), tile, samples, key, &walk)
        };
        Self {
            size,
            columns,
            trace: Box::new(trace),
            all: Vec::new(),
            zones,
            done: 0,
            rays: 0,
            share: Share::ALL,
        }
    }

    /// Takes the memory that a share needs: what is never traced does without.
    fn set_up(&mut self, share: Share) {
        if self.all.is_empty() {
            self.all = Vec::with_capacity(count(self.size) as usize);
            self.all.extend(tiles(self.size).map(|(low, high)| Tile::new(low, high)));
        }
        let own = self.all.par_iter_mut().enumerate().filter(|(tile, _)| share.owns(*tile));
        own.for_each(|(_, tile)| tile.set_up(self.columns));
    }

    /// Whether walks sum anything over the whole image alone.
    #[must_use]
    pub const fn has_zones(&self) -> bool {
        self.zones.bands() > 0
    }

    /// What was found so far.
    #[must_use]
    pub fn outcome(&self) -> ImageOutcome {
        let size = self.size;
        let (all, columns) = ((size.x * size.y) as usize, self.columns);
        let n = self.done as f64;
        let rows = self.done.clamp(1, RANDOMISATIONS.into()) as usize;
        let mut sums = Sums::new(RANDOMISATIONS as usize, columns);
        let mut counts = vec![0_u64; rows];
        let mut effects = vec![Pooled::default(); columns];
        let pooled: Vec<Vec<Pooled>> = self.all.par_iter().map(|tile| tile.pooled(n)).collect();
        for (tile, pooled) in self.all.iter().zip(&pooled) {
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
        let (mut pixels, mut errors) = (vec![0.0; all * columns], vec![0.0; all * columns]);
        let mut coverage = vec![0.0; all];
        // Rows of tiles side by side, which are the first to touch this memory too.
        let across = size.x.div_ceil(TILE) as usize;
        let of_row = (TILE * size.x) as usize;
        let values = pixels.par_chunks_mut(of_row * columns);
        let values = values.zip(errors.par_chunks_mut(of_row * columns));
        values.zip(coverage.par_chunks_mut(of_row)).enumerate().for_each(
            |(row, ((pixels, errors), coverage))| {
                pixels.fill(f32::NAN);
                errors.fill(f32::NAN);
                let first = row * of_row;
                let place = |at: UVec2| (at.y * size.x + at.x) as usize - first;
                for (tile, pooled) in self.all.iter().zip(&pooled).skip(row * across).take(across) {
                    show(tile, (pooled, n), place, (pixels, errors, coverage));
                }
            },
        );
        ImageOutcome { pixels, errors, coverage, mean, mean_error, zones: self.zones() }
    }

    /// What is summed over the whole image alone.
    fn zones(&self) -> Replicates {
        if !self.has_zones() {
            return Replicates::default();
        }
        let cells: Vec<&[f64]> = self.zones.values().chunks_exact(self.zones.bands()).collect();
        let pairs: Vec<[&[f64]; NETS]> =
            cells.chunks_exact(NETS).map(|pair| [pair[0], pair[1]]).collect();
        // The samples of a pixel take its nets in turn.
        let samples = [self.done.div_ceil(2) as f64, (self.done / 2) as f64];
        Replicates::from_half_samples(pairs[0], &pairs[1..], samples)
    }
}

/// Cells of zones, see [`Tiles`]: one replicate each bit of a random number.
const ZONE_CELLS: usize = NETS * (1 + REPLICATES as usize);
/// Half-samples that tell the errors of what is summed over the whole image.
const REPLICATES: u32 = u32::BITS;

/// Adds what a walk found to zones, and to those of the half-samples that take this net of the pixel.
fn add_to_zones<'a>(walk: &impl Walk<'a>, zones: &mut Sums, (net, choices): (usize, u32)) {
    walk.add_to_zones(zones, net);
    for replicate in 0..REPLICATES {
        if (choices >> replicate & 1) as usize == net {
            walk.add_to_zones(zones, NETS * (1 + replicate as usize) + net);
        }
    }
}

/// Writes what is known of the pixels of a tile, of `n` samples of each, to where each has its place: the values
/// of its columns, their standard errors, and the share of samples that met the scene.
fn show(
    tile: &Tile,
    (pooled, n): (&[Pooled], f64),
    place: impl Fn(UVec2) -> usize,
    (pixels, errors, coverage): (&mut [f32], &mut [f32], &mut [f32]),
) {
    let columns = pooled.len();
    for (pixel, at) in tile.pixels().enumerate().filter(|(pixel, _)| tile.hits(*pixel) > 0) {
        let to = place(at);
        coverage[to] = (tile.hits(pixel) as f64 / n) as f32;
        let own = to * columns..(to + 1) * columns;
        let values = pixels[own.clone()].iter_mut().zip(&mut errors[own]);
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

impl Film for Tiles<'_> {
    fn trace(&mut self, to: u64, watch: Watch<'_>) {
        self.set_up(self.share);
        let samples = self.done..to;
        let Self { all, trace, zones, rays, share, .. } = self;
        let own: Vec<&mut Tile> = all
            .iter_mut()
            .enumerate()
            .filter(|(tile, _)| share.owns(*tile))
            .map(|(_, tile)| tile)
            .collect();
        let (mut traced, tiles) = (0, own.len());
        blocks::in_order(
            own,
            |tile| trace(tile, samples.clone()),
            |(of_zones, of_rays)| {
                zones.merge(&of_zones);
                *rays += of_rays;
                traced += 1;
                watch(f64::from(traced) / tiles as f64);
            },
        );
        self.done = to;
    }

    fn restrict(&mut self, share: Share) {
        self.share = share;
    }

    fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        save_u64(out, &[self.rays])?;
        save_f64(out, self.zones.values())?;
        let own = self.all.iter().enumerate().filter(|(tile, _)| self.share.owns(*tile));
        for (_, tile) in own {
            for counts in tile.hits.iter().chain([&tile.counts]) {
                save_u64(out, counts)?;
            }
            for values in tile.means.iter().chain([&tile.squares]) {
                save_f64(out, values)?;
            }
            save_f64(out, tile.sums.values())?;
        }
        Ok(())
    }

    fn restore(&mut self, share: Share, done: u64, input: &mut dyn Read) -> io::Result<()> {
        let mut rays = [0];
        restore_u64(input, &mut rays)?;
        self.rays += rays[0];
        let mut zones = self.zones.clone();
        restore_f64(input, zones.values_mut())?;
        self.zones.merge(&zones);
        self.done = done;
        self.set_up(share);
        let own = self.all.iter_mut().enumerate().filter(|(tile, _)| share.owns(*tile));
        for (_, tile) in own {
            for counts in tile.hits.iter_mut().chain([&mut tile.counts]) {
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
        let own = tiles(self.size).enumerate().filter(|(tile, _)| self.share.owns(*tile));
        let (tiles, pixels) = own.fold((0, 0), |(tiles, pixels), (_, (low, high))| {
            let size = high - low;
            (tiles + 1, pixels + u64::from(size.x * size.y))
        });
        // Of a pixel its hits, and means and squares of its columns; of a tile its sums and counts.
        let (columns, nets) = (self.columns as u64, NETS as u64);
        let words = pixels.saturating_mul(nets + (nets + 1) * columns)
            + tiles * u64::from(RANDOMISATIONS) * (1 + columns);
        let zones = self.zones.values().len() as u64;
        count(self.size) * size_of::<Tile>() as u64 + 8 * (words + zones)
    }

    fn bytes_beside(&self) -> u64 {
        let waiting = (blocks::ahead() * self.zones.values().len() * size_of::<f64>()) as u64;
        // Of each pixel the coverage, and of its columns mean and error, as f32.
        let pixels = u64::from(self.size.x) * u64::from(self.size.y);
        waiting.max(pixels.saturating_mul(4 + 8 * self.columns as u64))
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}

fn trace_tile<'a, W: Walk<'a>>(
    (stage, camera): (&'a Stage, &Camera),
    tile: &mut Tile,
    samples: Range<u64>,
    key: Key,
    walk: impl Fn() -> W,
) -> (Sums, u64) {
    let scale = camera.size().as_dvec2().recip();
    let mut party = Party::new(&walk);
    let mut zones = Sums::new(ZONE_CELLS, walk().zones());
    let has_zones = zones.bands() > 0;
    // Of each pixel one bit a half-sample: the net that this takes.
    let choices = key.path("half-samples");
    let width = (tile.high.x - tile.low.x) as usize;
    let mut rays = 0;
    // Of each pixel all samples that have rows of their own: its values stay in the cache. Sums over the
    // pixels are made in one order however rounds are cut.
    let rows = u64::from(RANDOMISATIONS);
    let ends = (samples.start / rows + 1..).map(|round| (round * rows).min(samples.end));
    let mut from = samples.start;
    for to in ends {
        let places = tile.pixels().enumerate();
        let starts = places.flat_map(|(pixel, at)| (from..to).map(move |of| (pixel, at, of)));
        let starts = starts.filter_map(|(pixel, at, sample)| {
            let row = (sample % rows) as usize;
            let nets = NETS as u64;
            let points = key.index(sample % nets).index(number_of(at));
            let mut sampler = Sampler::new(points, sample / nets);
            let [u, v, ..] = sampler.next_event();
            let ray = camera.ray((at.as_dvec2() + DVec2::new(u, v)) * scale)?;
            let is_admitted = camera.admits(&ray, stage, &mut rays);
            is_admitted.then_some((((pixel, row), ray.direction), ray, sampler))
        });
        party.follow(stage, starts, |tags, walks| {
            let (mut shown, mut samples) = (Vec::new(), Vec::new());
            for (&(sample, direction), walk) in tags.iter().zip(walks) {
                if walk.has_met() || camera.sees_sky() && walk.see_sky(stage, direction) {
                    if has_zones {
                        let (pixel, row) = sample;
                        let at =
                            tile.low + UVec2::new((pixel % width) as u32, (pixel / width) as u32);
                        let bits = choices.index(number_of(at)).bits(0) as u32;
                        add_to_zones(walk, &mut zones, (row % NETS, bits));
                    }
                    shown.push(&*walk);
                    samples.push(sample);
                }
            }
            tile.push(&shown.iter().copied(), &samples);
        });
        if to == samples.end {
            break;
        }
        from = to;
    }
    (zones, rays + party.rays())
}

/// Number of a pixel's random streams.
fn number_of(at: UVec2) -> u64 {
    u64::from(at.y) << 32 | u64::from(at.x)
}
