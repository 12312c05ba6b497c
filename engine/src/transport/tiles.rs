//! Pixels that paths from a sensor are averaged in.

use std::io::{self, Read, Write};
use std::ops::Range;

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use super::share::{restore_f64, restore_u64, save_f64, save_u64};
use super::tile::{Tile, of_ratio};
use super::walk::{Party, Walk};
use super::{Camera, Film, ImageOutcome, RANDOMISATIONS, Share, Watch, blocks};
use crate::extract::Stage;
use crate::film::{Sums, ratio};
use crate::sampling::{Key, Sampler};

/// Side of the square of pixels that one block traces.
const TILE: u32 = 16;

/// What walks from a camera found, pixel by pixel. Sample `s` of all pixels is randomisation `s`; for
/// the errors of sums over the whole image, [`RANDOMISATIONS`] of them are kept apart.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct Tiles<'a> {
    size: UVec2,
    columns: usize,
    trace: Box<TraceTile<'a>>,
    all: Vec<Tile>,
    /// What a walk sums over the whole image alone: whole numbers, so in any order.
    zones: Sums,
    /// Samples of each pixel.
    done: u64,
    rays: u64,
    share: Share,
}

/// Adds samples to a tile and zones; returns the number of rays.
type TraceTile<'a> = dyn Fn(&mut Tile, Range<u64>) -> (Sums, u64) + Sync + 'a;

/// Samples that the mean variance of a tile's pixels is worth beside those of a pixel.
///
/// Few samples of a skewed quantity, such as a leaf that is seldom lit, tell too small a variance
/// whenever they missed what is rare; the other pixels of the tile have seen it. With this weight the
/// errors of pixels of the benchmark stand are right (z spreads by 0.92 to 1.04) at 16 samples, where
/// by themselves they were too small (1.36 to 1.63), and from some hundred on it hardly counts.
const SHARED: f64 = 16.0;

impl<'a> Tiles<'a> {
    /// No sample yet, of walks whose first `columns` values count.
    pub(super) fn new<W: Walk<'a>>(
        (stage, camera): (&'a Stage, Camera),
        key: Key,
        columns: usize,
        walk: impl Fn() -> W + Sync + 'a,
    ) -> Self {
        let size = camera.size();
        let zones = Sums::new(RANDOMISATIONS as usize, walk().zones());
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
        // Of fewer samples than there are rows, the others are no randomisations.
        let mut zones = Sums::new(rows, self.zones.bands());
        let of_rows = &self.zones.values()[..rows * self.zones.bands()];
        zones.values_mut().copy_from_slice(of_rows);
        let mut outcome = ImageOutcome {
            pixels: vec![f32::NAN; all * columns],
            errors: vec![f32::NAN; all * columns],
            coverage: vec![0.0; all],
            mean: Vec::new(),
            mean_error: Vec::new(),
            zones,
        };
        let mut sums = Sums::new(RANDOMISATIONS as usize, columns);
        let mut counts = vec![0_u64; rows];
        for tile in &self.all {
            sums.merge(&tile.sums);
            for (total, part) in counts.iter_mut().zip(&tile.counts) {
                *total += part;
            }
            let shared = tile.variance(n);
            for (pixel, at) in tile.pixels().enumerate() {
                let hits = tile.hits[pixel] as f64;
                if hits == 0.0 {
                    continue;
                }
                let to = (at.y * size.x + at.x) as usize;
                outcome.coverage[to] = (hits / n) as f32;
                let range = pixel * columns..(pixel + 1) * columns;
                let values = tile.mean[range.clone()].iter().zip(&tile.squares[range]);
                for (column, ((mean, squares), shared)) in values.zip(&shared).enumerate() {
                    outcome.pixels[to * columns + column] = *mean as f32;
                    let of_own = (hits - 1.0) * of_ratio(*squares, hits, n);
                    let variance = (of_own + SHARED * shared) / (hits - 1.0 + SHARED);
                    outcome.errors[to * columns + column] = (variance / hits).sqrt() as f32;
                }
            }
        }
        let counts: Vec<f64> = counts.iter().map(|&count| count as f64).collect();
        (outcome.mean, outcome.mean_error) = ratio(&sums.values()[..rows * columns], &counts);
        outcome
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
            save_u64(out, &tile.hits)?;
            save_u64(out, &tile.counts)?;
            for values in [&tile.mean, &tile.squares, tile.sums.values()] {
                save_f64(out, values)?;
            }
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
            restore_u64(input, &mut tile.hits)?;
            restore_u64(input, &mut tile.counts)?;
            for values in [&mut tile.mean, &mut tile.squares, tile.sums.values_mut()] {
                restore_f64(input, values)?;
            }
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
        // Of a pixel its hits, and mean and squares of its columns; of a tile its sums and counts.
        let columns = self.columns as u64;
        let words = pixels.saturating_mul(1 + 2 * columns)
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

/// Index of a pixel along the Z-order curve: pixels that are close have close indices, so that the
/// points of one low-discrepancy sequence are even over each part of the image.
///
/// Source: Ahmed and Wonka (2020), "Screen-space blue-noise diffusion of Monte Carlo sampling error
/// via hierarchical ordering of pixels".
fn morton(at: UVec2) -> u64 {
    let spread = |x: u32| {
        let mut x = u64::from(x);
        x = (x | (x << 16)) & 0x0000_ffff_0000_ffff;
        x = (x | (x << 8)) & 0x00ff_00ff_00ff_00ff;
        x = (x | (x << 4)) & 0x0f0f_0f0f_0f0f_0f0f;
        x = (x | (x << 2)) & 0x3333_3333_3333_3333;
        (x | (x << 1)) & 0x5555_5555_5555_5555
    };
    spread(at.x) | (spread(at.y) << 1)
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
    let mut zones = Sums::new(RANDOMISATIONS as usize, walk().zones());
    let mut rays = 0;
    // Of each pixel all samples that have rows of their own: its values stay in the cache. Sums over the
    // pixels are made in one order however rounds are cut.
    let rows = u64::from(RANDOMISATIONS);
    let ends = (samples.start / rows + 1..).map(|round| (round * rows).min(samples.end));
    let mut from = samples.start;
    for to in ends {
        let streams: Vec<(usize, Key)> =
            (from..to).map(|sample| ((sample % rows) as usize, key.index(sample))).collect();
        let places = tile.pixels().enumerate();
        let starts = places.flat_map(|(pixel, at)| streams.iter().map(move |of| (pixel, at, of)));
        let starts = starts.filter_map(|(pixel, at, &(row, stream))| {
            let mut sampler = Sampler::new(stream, morton(at));
            let [u, v, ..] = sampler.next_event();
            let ray = camera.ray((at.as_dvec2() + DVec2::new(u, v)) * scale)?;
            let is_admitted = camera.admits(&ray, stage, &mut rays);
            is_admitted.then_some((((pixel, row), ray.direction), ray, sampler))
        });
        party.follow(stage, starts, |tags, walks| {
            let (mut shown, mut samples) = (Vec::new(), Vec::new());
            for (&(sample, direction), walk) in tags.iter().zip(walks) {
                if walk.has_met() || camera.sees_sky() && walk.see_sky(stage, direction) {
                    walk.add_to_zones(&mut zones, sample.1);
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

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::morton;

    #[test]
    fn pixels_of_a_square_are_consecutive_along_the_curve() {
        let mut seen: Vec<u64> =
            (0..16).map(|i| morton(UVec2::new(4 + i % 4, 8 + i / 4))).collect();
        seen.sort_unstable();
        assert!(seen.windows(2).all(|pair| pair[1] == pair[0] + 1), "{seen:?}");
    }
}
