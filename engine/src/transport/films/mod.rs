//! Films: images and sums of samples with their errors; how samples are scheduled in rounds, partitions and blocks.

mod blocks;
mod film;
mod image_mean;
mod image_outcome;
mod image_replicates;
mod image_tiles;
mod partition;
mod pixels;
mod replicate_row;
mod replicate_sums;
mod tile;
mod tile_grid;
mod tile_store;
mod tile_tracer;

pub use film::{Film, Schedule};
pub use image_outcome::ImageOutcome;
pub use image_tiles::ImageTiles;
pub use partition::Partition;
pub use pixels::{PixelRows, Pixels};
pub(super) use replicate_row::ReplicateRow;
pub(super) use replicate_sums::SampleTracer;
pub use replicate_sums::{Randomisations, ReplicateSums};
