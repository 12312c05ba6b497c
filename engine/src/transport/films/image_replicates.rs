//! Means over an image by randomisation.

use std::io;

use super::blocks;
use super::tile::{REPLICATES_PER_PIXEL, Tile};
use super::tile_store::TileStore;
use super::tile_tracer::{IMAGE_SUM_CELLS, half_samples, number_of};
use crate::sampling::Key;
use crate::statistics::{Replicates, Sums};

/// Means of the columns over an image whose pixels have `done` samples each, shape `[randomisations][columns]`. Their
/// spread is the error of the mean, as each pixel has two independent randomisations and each of these means leans to one
/// of the two in every pixel, drawn at random by the key `choices`.
pub(super) fn replicate_means(
    store: &TileStore,
    columns: usize,
    done: u64,
    choices: Key,
) -> io::Result<Vec<Vec<f64>>> {
    // The samples that count are the last column.
    let mut sums = Sums::new(IMAGE_SUM_CELLS, columns + 1);
    let mut failure = None;
    blocks::in_order(
        0..store.grid().len(),
        |tile| store.read(tile, |tile| half_sample_sums(tile, columns, choices)),
        |read| match read {
            Ok(tile) => sums.merge(&tile),
            Err(error) => failure = Some(error),
        },
    );
    failure.map_or_else(|| Ok(means(&half_sample_replicates(&sums, done), columns)), Err)
}

/// Sums over all pixels and over those of each half-sample, by replicate; `done` is the number of samples of each pixel.
pub(super) fn half_sample_replicates(sums: &Sums, done: u64) -> Replicates {
    let cells: Vec<&[f64]> = sums.values().chunks_exact(sums.bands()).collect();
    let pairs: Vec<[&[f64]; REPLICATES_PER_PIXEL]> =
        cells.chunks_exact(REPLICATES_PER_PIXEL).map(|pair| [pair[0], pair[1]]).collect();
    // The samples of a pixel alternate between its replicates.
    let samples = [done.div_ceil(2) as f64, (done / 2) as f64];
    Replicates::from_half_samples(pairs[0], &pairs[1..], samples)
}

/// Sums of a tile, shape `[1 + half-samples, replicates, columns + 1]`.
fn half_sample_sums(tile: &Tile, columns: usize, choices: Key) -> Sums {
    let mut sums = Sums::new(IMAGE_SUM_CELLS, columns + 1);
    for (pixel, at) in tile.pixels().enumerate() {
        let bits = choices.index(number_of(at)).bits(0) as u32;
        for (replicate, (valid, means)) in tile.valid.iter().zip(&tile.means).enumerate() {
            let count = valid[pixel] as f64;
            let means = &means[pixel * columns..(pixel + 1) * columns];
            let cells = half_samples(bits, replicate)
                .map(|half_sample| REPLICATES_PER_PIXEL * (1 + half_sample) + replicate);
            for cell in std::iter::once(replicate).chain(cells) {
                let (samples, sums) = sums.cell_mut(cell).split_last_mut().expect("a count");
                sums.iter_mut().zip(means).for_each(|(sum, mean)| *sum += mean * count);
                *samples += count;
            }
        }
    }
    sums
}

/// Means whose mean is the ratio of each column to the last, and whose spread is the error of that ratio.
fn means(replicates: &Replicates, columns: usize) -> Vec<Vec<f64>> {
    let (count, sums) = replicates.sums.split_last().expect("a count");
    let rows = || replicates.deviations.chunks_exact(columns + 1);
    let all = rows().len() as f64;
    let centres: Vec<f64> =
        (0..=columns).map(|column| rows().map(|row| row[column]).sum::<f64>() / all).collect();
    // Deviations vary as the sums; the mean of this number of values varies less than each of them.
    let scale = all.sqrt() / count;
    let mean_of = |row: &[f64]| {
        let deviation = |column: usize| row[column] - centres[column];
        let of_column = |(column, sum): (usize, &f64)| {
            let mean = sum / count;
            mean + scale * (deviation(column) - mean * deviation(columns))
        };
        sums.iter().enumerate().map(of_column).collect()
    };
    rows().map(mean_of).collect()
}
