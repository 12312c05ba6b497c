//! Outcome of an image: means over all pixels, and pixels that are computed from the sums of their tiles.

use std::io;
use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::blocks;
use super::image_mean::MeanDeviations;
use super::pixels::{PixelRows, Pixels};
use super::tile::{PooledVariance, Tile};
use super::tile_grid::{SIDE, TileGrid};
use super::tile_store::TileStore;
use crate::statistics::{Replicates, Sums};
use crate::transport::RANDOMISATIONS;

/// Outcome of an image measurement.
#[derive(Clone, Debug)]
pub struct ImageOutcome {
    /// Radiance of each pixel in the unit of its
    /// [`LightSource`](crate::transport::LightSource), columns `[spectra, bands]` (the whole
    /// and, on request, its parts): the mean over the samples that met the scene. Its standard error is from its own
    /// samples and, where those are few, from those of the tile of 16 × 16
    /// pixels around it; NaN with one sample per pixel.
    pub pixels: Pixels,
    /// Mean radiance over all samples that met the scene, shape `[spectra, bands]`.
    pub mean: Vec<f64>,
    /// Its standard error, from the differences between the two randomisations of each pixel; NaN with one sample per
    /// pixel, which has no spread.
    pub mean_error: Vec<f64>,
    /// Columns that are summed over the whole image only, shape `[image columns]`.
    pub image_sums: Replicates,
}

/// Sums and variances of a tile that means over the image take.
pub(super) struct TileSummary {
    pooled: Vec<PooledVariance>,
    deviations: Vec<MeanDeviations>,
    sums: Sums,
    count: u64,
}

impl TileSummary {
    /// Summary of a tile whose pixels have `done` samples each.
    pub(super) fn new(tile: &Tile, done: u64) -> Self {
        Self {
            pooled: tile.pooled(done as f64),
            deviations: MeanDeviations::from_tile(tile, done),
            sums: tile.sums.clone(),
            count: tile.valid.iter().flatten().sum(),
        }
    }
}

/// Sums over all pixels, of which means are made; tiles are added in their order.
pub(super) struct ImageMeans {
    /// Samples of each pixel.
    done: u64,
    sums: Sums,
    /// Samples that met the scene.
    count: u64,
    /// Deviations from the mean of each column.
    deviations: Vec<MeanDeviations>,
    /// Variances of the columns of each tile, shape `[tiles, columns]`; empty without samples.
    pooled: Vec<PooledVariance>,
}

impl ImageMeans {
    /// No tiles yet, of pixels with `done` samples each.
    pub(super) fn new(grid: TileGrid, columns: usize, done: u64) -> Self {
        let tiles = if done == 0 { 0 } else { grid.len() };
        Self {
            done,
            sums: Sums::new(RANDOMISATIONS as usize, columns),
            count: 0,
            deviations: vec![MeanDeviations::default(); columns],
            pooled: Vec::with_capacity(tiles * columns),
        }
    }

    /// Means of tiles that are read from their store.
    pub(super) fn from_store(store: &TileStore, columns: usize, done: u64) -> io::Result<Self> {
        let mut means = Self::new(store.grid(), columns, done);
        let tiles = if done == 0 { 0 } else { store.grid().len() };
        let mut failure = None;
        blocks::in_order(
            0..tiles,
            |tile| store.read(tile, |tile| TileSummary::new(tile, done)),
            |read| match read {
                Ok(summary) => means.add(summary),
                Err(error) => failure = Some(error),
            },
        );
        failure.map_or(Ok(means), Err)
    }

    /// Adds the next tile.
    pub(super) fn add(&mut self, summary: TileSummary) {
        self.sums.merge(&summary.sums);
        self.count += summary.count;
        let deviations = self.deviations.iter_mut().zip(&summary.deviations);
        deviations.for_each(|(all, one)| all.merge(one));
        self.pooled.extend(summary.pooled);
    }

    /// Returns whether they are of so many samples per pixel.
    pub(super) const fn is_of(&self, done: u64) -> bool {
        self.done == done
    }

    /// Means of the columns with their standard errors; NaN without samples, and standard errors with one sample per
    /// pixel.
    pub(super) fn means(&self) -> (Vec<f64>, Vec<f64>) {
        let columns = self.deviations.len();
        let count = self.count as f64;
        let of_column = |(column, deviations): (usize, &MeanDeviations)| {
            let rows = self.sums.values().iter().skip(column).step_by(columns);
            let mean = rows.sum::<f64>() / count;
            (mean, deviations.standard_error(mean, count, self.done))
        };
        self.deviations.iter().enumerate().map(of_column).unzip()
    }
}

/// Pixels of tiles with these means.
pub(super) fn pixels(store: Arc<TileStore>, means: Arc<ImageMeans>) -> Pixels {
    let source = TilePixels { store, columns: means.deviations.len(), means };
    Pixels::new(move |rows| source.rows(rows))
}

/// Pixels of an image of tiles.
struct TilePixels {
    store: Arc<TileStore>,
    columns: usize,
    means: Arc<ImageMeans>,
}

/// Room for the rows of a tile that are asked for.
struct TileRoom<'v> {
    tile: usize,
    /// First of these rows, in the image.
    first: u32,
    /// Shapes `[rows][columns of pixels, columns]`, and `[rows][columns of pixels]` for the coverage.
    values: Vec<&'v mut [f32]>,
    errors: Vec<&'v mut [f32]>,
    coverage: Vec<&'v mut [f32]>,
}

impl TilePixels {
    fn rows(&self, rows: Range<usize>) -> io::Result<PixelRows> {
        let width = self.store.grid().size.x as usize;
        let count = rows.len() * width;
        let mut all = PixelRows {
            width,
            values: vec![f32::NAN; count * self.columns],
            standard_error: vec![f32::NAN; count * self.columns],
            coverage: vec![0.0; count],
        };
        let ImageMeans { pooled, done, .. } = &*self.means;
        if !pooled.is_empty() {
            self.rooms(rows, &mut all).into_par_iter().try_for_each(|room| {
                let pooled = &pooled[room.tile * self.columns..][..self.columns];
                self.store.read(room.tile, |tile| write_rows(tile, pooled, *done as f64, room))
            })?;
        }
        Ok(all)
    }

    /// Room of all tiles that have pixels in some rows.
    fn rooms<'v>(&self, rows: Range<usize>, all: &'v mut PixelRows) -> Vec<TileRoom<'v>> {
        let (width, side, columns) = (all.width, SIDE as usize, self.columns.max(1));
        let across = self.store.grid().counts().x as usize;
        let first_row = rows.start / side;
        let last_row = rows.end.div_ceil(side);
        let mut rooms: Vec<TileRoom<'v>> = (first_row * across..last_row * across)
            .map(|tile| TileRoom {
                tile,
                first: rows.start.max(tile / across * side) as u32,
                values: Vec::with_capacity(side),
                errors: Vec::with_capacity(side),
                coverage: Vec::with_capacity(side),
            })
            .collect();
        let values = all.values.chunks_mut(width * columns);
        let values = values.zip(all.standard_error.chunks_mut(width * columns));
        let values = values.zip(all.coverage.chunks_mut(width));
        for (row, ((values, errors), coverage)) in rows.zip(values) {
            let of_row = &mut rooms[(row / side - first_row) * across..][..across];
            let parts = values.chunks_mut(side * columns).zip(errors.chunks_mut(side * columns));
            let parts = parts.zip(coverage.chunks_mut(side));
            for (room, ((values, errors), coverage)) in of_row.iter_mut().zip(parts) {
                room.values.push(values);
                room.errors.push(errors);
                room.coverage.push(coverage);
            }
        }
        rooms
    }
}

/// Writes the values of some rows of a tile, whose pixels have `n` samples each.
fn write_rows(tile: &Tile, pooled: &[PooledVariance], n: f64, room: TileRoom<'_>) {
    let columns = pooled.len();
    let width = (tile.high.x - tile.low.x) as usize;
    let mut pixel = (room.first - tile.low.y) as usize * width;
    let rows = room.values.into_iter().zip(room.errors).zip(room.coverage);
    for ((values, errors), coverage) in rows {
        let pixels = values.chunks_mut(columns).zip(errors.chunks_mut(columns)).zip(coverage);
        for ((values, errors), coverage) in pixels {
            if tile.valid_samples(pixel) > 0 {
                *coverage = (tile.valid_samples(pixel) as f64 / n) as f32;
                let values = values.iter_mut().zip(errors);
                for ((moments, pooled), (value, error)) in
                    tile.moments(pixel).zip(pooled).zip(values)
                {
                    *value = moments.mean as f32;
                    *error = pooled.variance_of_mean(&moments, n).sqrt() as f32;
                }
            }
            pixel += 1;
        }
    }
}
