//! Image of paths from a sensor.

use std::io::{self, Read, Write};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::UVec2;

use super::image_mean::MeanDeviations;
use super::image_outcome::{ImageMeans, ImageOutcome, TileSummary, pixels};
use super::image_replicates::{half_sample_replicates, replicate_means};
use super::tile::{PooledVariance, REPLICATES_PER_PIXEL, Tile};
use super::tile_grid::TileGrid;
use super::tile_store::{self, TileStore, is_in_memory};
use super::tile_tracer::{IMAGE_SUM_CELLS, TileTracer, choices_of};
use super::{Film, Partition, blocks};
use crate::extract::Stage;
use crate::sampling::Key;
use crate::scratch::ScratchSpace;
use crate::statistics::{Replicates, Sums};
use crate::transport::paths::PathTracer;
use crate::transport::state::{restore_f64, restore_u64, save_f64, save_u64};
use crate::transport::{Camera, ProgressFn, RANDOMISATIONS};

const _: () = assert!(
    (RANDOMISATIONS as usize).is_multiple_of(REPLICATES_PER_PIXEL),
    "the row of a sample tells its replicate"
);

/// Means and variances of the paths from a camera, pixel by pixel. For means over the whole image, the samples of all
/// pixels are also summed in [`RANDOMISATIONS`] rows.
#[expect(missing_debug_implementations, reason = "what it traces has no Debug")]
pub struct ImageTiles<'a> {
    grid: TileGrid,
    columns: usize,
    /// Key of the choices of half-samples.
    choices: Key,
    trace: Box<TraceTile<'a>>,
    scratch: ScratchSpace,
    /// Sums of the tiles, once it is traced.
    store: Option<Arc<TileStore>>,
    /// Means over the image, if its tiles are in a file: they are made while tiles are in memory.
    means: Option<Arc<ImageMeans>>,
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
        let grid = TileGrid { size: camera.size() };
        let image_sums = Sums::new(IMAGE_SUM_CELLS, path().image_columns());
        let trace = move |tile: &mut Tile, samples: Range<u64>| {
            TileTracer { stage, camera: &camera, key, path: &path }.trace(tile, samples)
        };
        Self {
            grid,
            columns,
            choices: choices_of(key),
            trace: Box::new(trace),
            scratch: ScratchSpace::default(),
            store: None,
            means: None,
            image_sums,
            done: 0,
            rays: 0,
            partition: Partition::ALL,
        }
    }

    /// Sets the place of sums that take too much memory, before it is traced.
    pub fn keep_in(&mut self, scratch: ScratchSpace) {
        self.scratch = scratch;
    }

    /// Store of the tiles. It takes memory or disk as late as possible: films that are never traced need none.
    fn set_up(&mut self) -> io::Result<Arc<TileStore>> {
        if let Some(store) = &self.store {
            return Ok(Arc::clone(store));
        }
        let store = TileStore::new(self.grid, self.columns, self.is_in_memory(), &self.scratch)?;
        Ok(Arc::clone(self.store.insert(Arc::new(store))))
    }

    /// Returns whether its sums stay in memory.
    fn is_in_memory(&self) -> bool {
        is_in_memory(self.tile_bytes(Partition::ALL), &self.scratch)
    }

    /// Size of the sums of the tiles of a partition, bytes.
    fn tile_bytes(&self, partition: Partition) -> u64 {
        let columns = self.columns as u64;
        if partition == Partition::ALL {
            let UVec2 { x, y } = self.grid.size;
            let pixels = u64::from(x) * u64::from(y);
            let rows = (self.grid.len() as u64).saturating_sub(1);
            return Tile::bytes(pixels, columns).saturating_add(rows * Tile::bytes(0, columns));
        }
        let owned = self.grid.iter().enumerate().filter(|(tile, _)| partition.owns(*tile));
        let bytes = owned
            .map(|(_, (low, high))| Tile::bytes((high - low).element_product().into(), columns));
        bytes.fold(0, u64::saturating_add)
    }

    /// Returns whether paths have columns that are summed over the whole image only.
    #[must_use]
    pub const fn has_image_sums(&self) -> bool {
        self.image_sums.bands() > 0
    }

    /// The outcome of the samples so far. Its pixels are computed when they are asked for, before any other sample is added.
    ///
    /// # Errors
    /// If the temporary file of its sums cannot be read.
    ///
    /// # Panics
    /// If it was never traced nor restored.
    pub fn outcome(&self) -> io::Result<ImageOutcome> {
        let store = self.store.as_ref().expect("a film is traced before it has an outcome");
        let known = self.means.as_ref().filter(|means| means.is_of(self.done));
        let means = match known {
            Some(means) => Arc::clone(means),
            None => Arc::new(ImageMeans::from_store(store, self.columns, self.done)?),
        };
        let (mean, mean_error) = means.means();
        let pixels = pixels(Arc::clone(store), means);
        Ok(ImageOutcome { pixels, mean, mean_error, image_sums: self.image_sums() })
    }

    /// The outcome of each randomisation of the pixels: means over the image, whose spread is the error of the mean. None
    /// with one sample per pixel, which has no spread.
    ///
    /// # Errors
    /// If the temporary file of its sums cannot be read.
    ///
    /// # Panics
    /// If it was never traced nor restored.
    pub fn replicates(&self) -> io::Result<Vec<ImageOutcome>> {
        let ImageOutcome { pixels, mean_error, image_sums, .. } = self.outcome()?;
        let store = self.store.as_ref().expect("a film is traced before it has an outcome");
        let means = replicate_means(store, self.columns, self.done, self.choices)?;
        let outcome = |mean| {
            let (pixels, mean_error) = (pixels.clone(), mean_error.clone());
            ImageOutcome { pixels, mean, mean_error, image_sums: image_sums.clone() }
        };
        Ok(means.into_iter().map(outcome).collect())
    }

    /// Columns that are summed over the whole image only.
    fn image_sums(&self) -> Replicates {
        if !self.has_image_sums() {
            return Replicates::default();
        }
        half_sample_replicates(&self.image_sums, self.done)
    }
}

impl Film for ImageTiles<'_> {
    fn trace(&mut self, to: u64, progress: ProgressFn<'_>) -> io::Result<()> {
        let store = self.set_up()?;
        let samples = self.done..to;
        if samples.is_empty() {
            return Ok(());
        }
        let keeps_means = !self.is_in_memory() && self.partition == Partition::ALL;
        let mut means = keeps_means.then(|| ImageMeans::new(self.grid, self.columns, to));
        let Self { trace, image_sums, rays, partition, .. } = self;
        let owned: Vec<usize> =
            (0..store.grid().len()).filter(|tile| partition.owns(*tile)).collect();
        let (mut traced, count) = (0, owned.len());
        let (has_failed, mut failure) = (AtomicBool::new(false), None);
        blocks::in_order(
            owned,
            |tile| {
                // Nothing is worth tracing beside a tile that could not be kept.
                let goes_on = !has_failed.load(Ordering::Relaxed);
                goes_on.then(|| {
                    store.update(tile, |tile| {
                        let traced = trace(tile, samples.clone());
                        (traced, keeps_means.then(|| TileSummary::new(tile, to)))
                    })
                })
            },
            |result| match result {
                Some(Ok(((tile_sums, tile_rays), summary))) => {
                    means.as_mut().zip(summary).into_iter().for_each(|(all, one)| all.add(one));
                    image_sums.merge(&tile_sums);
                    *rays += tile_rays;
                    traced += 1;
                    progress(f64::from(traced) / count as f64);
                }
                Some(Err(error)) => {
                    has_failed.store(true, Ordering::Relaxed);
                    failure = Some(error);
                }
                None => {}
            },
        );
        self.done = to;
        self.means = means.map(Arc::new);
        failure.map_or(Ok(()), Err)
    }

    fn restrict(&mut self, partition: Partition) {
        self.partition = partition;
    }

    fn units(&self) -> UVec2 {
        self.grid.counts()
    }

    fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        save_u64(out, &[self.rays])?;
        save_f64(out, self.image_sums.values())?;
        let Some(store) = &self.store else { return Ok(()) };
        let mut owned = (0..self.grid.len()).filter(|tile| self.partition.owns(*tile));
        owned.try_for_each(|tile| store.save(tile, out))
    }

    fn restore(&mut self, partition: Partition, done: u64, input: &mut dyn Read) -> io::Result<()> {
        let mut rays = [0];
        restore_u64(input, &mut rays)?;
        self.rays += rays[0];
        let mut image_sums = self.image_sums.clone();
        restore_f64(input, image_sums.values_mut())?;
        self.image_sums.merge(&image_sums);
        self.done = done;
        let store = self.set_up()?;
        let mut owned = (0..self.grid.len()).filter(|tile| partition.owns(*tile));
        owned.try_for_each(|tile| store.restore(tile, input))
    }

    fn can_grow(&self) -> Result<(), u64> {
        Ok(())
    }

    fn samples(&self) -> u64 {
        let size = self.grid.size;
        u64::from(size.x) * u64::from(size.y) * self.done
    }

    fn bytes(&self) -> u64 {
        let in_memory = self.is_in_memory().then(|| self.tile_bytes(self.partition));
        tile_store::bytes(self.grid.len(), in_memory) + 8 * self.image_sums.values().len() as u64
    }

    fn bytes_on_disk(&self) -> u64 {
        // The places of tiles of other partitions are holes.
        if self.is_in_memory() { 0 } else { self.tile_bytes(self.partition) }
    }

    fn bytes_of_state(&self) -> u64 {
        let words = 1 + self.image_sums.values().len() as u64;
        self.tile_bytes(self.partition) + 8 * words
    }

    fn bytes_beside(&self) -> u64 {
        let waiting = blocks::ahead() as u64;
        // A tile that is not in memory is there twice while it is read or written.
        let (low, high) = self.grid.corners(0);
        let tile = Tile::bytes((high - low).element_product().into(), self.columns as u64);
        let tiles = if self.is_in_memory() { 0 } else { 2 * waiting * tile };
        let image_sums = waiting * 8 * self.image_sums.values().len() as u64;
        // Variances of each tile, and the sums and deviations of those that are read, when products are computed.
        let columns = self.columns as u64;
        let pooled = self.grid.len() as u64 * columns * size_of::<PooledVariance>() as u64;
        let summary = u64::from(RANDOMISATIONS) * 8 + size_of::<MeanDeviations>() as u64;
        let outcome = pooled + waiting * columns * summary;
        tiles + image_sums.max(outcome)
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
