//! Films: images and sums of samples with their errors; how samples are scheduled in rounds, partitions and blocks.

mod blocks;
mod film;
mod image_tiles;
mod partition;
mod replicate_row;
mod replicate_sums;
mod tile;

pub use film::{Film, Schedule};
pub use image_tiles::{ImageOutcome, ImageTiles};
pub use partition::Partition;
pub(super) use replicate_row::ReplicateRow;
pub use replicate_sums::ReplicateSums;
pub(super) use replicate_sums::SampleTracer;
