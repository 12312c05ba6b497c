//! Placement of instances: rules and areas to places, places to trees.
//!
//! | step | file |
//! |---|---|
//! | areas to a [`Region`] of known size | `region`, `triangulation`, `locator` |
//! | places: each on its own, at a distance, in rows | `uniform`, `poisson_disc`, `rows` |
//! | places as dense as a raster says | `map` |
//! | trees at the places | `trees`, `distribution` |
//! | patterns of instances that are left out | `pattern` |
//!
//! Each number comes from a stream that is keyed by the seed, the instances' name, what it is for,
//! and the number of the stem. So neither threads nor other instances nor one more species move a stem.

mod buckets;
pub mod canopy;
mod distribution;
mod error;
mod locator;
mod map;
mod pattern;
mod poisson_disc;
mod region;
mod rows;
#[cfg(test)]
mod tests;
mod trees;
mod triangulation;
mod uniform;

use glam::DVec2;

use crate::document::Rule;
use crate::geometry::Rectangle;
use crate::memory;
use crate::sampling::Key;
use crate::terrain::Cells;

use poisson_disc::poisson_disc;
use rows::StemRows;
use uniform::uniform;

pub use error::PlacementError;
pub use pattern::Pattern;
pub(crate) use pattern::is_like;
pub use region::Region;
pub use trees::{Habit, Species, instantiate_trees};

/// Most stems of one scatter.
const MOST_STEMS: usize = 20_000_000;

/// Memory of a stem while the ray engine builds its tree, bytes.
const STEM_BYTES: u64 = 410;

/// Number of stems to place.
#[derive(Clone, Copy, Debug)]
pub enum Amount<'a> {
    /// Number.
    Count(u32),
    /// Number per m² of the region.
    Density(f64),
    /// Number per m² by the cell at each place; none beside the cells and where the value is NaN.
    Map(&'a Cells<f64>),
    /// Maximum number of stems that find room.
    Fill,
}

/// Places by a rule in a region of the terrain's rectangle, m.
///
/// # Errors
/// No room for so many stems, or too many of them.
pub fn places(
    rule: &Rule,
    amount: Amount<'_>,
    region: &Region,
    terrain: Rectangle,
    is_periodic: bool,
    stream: Key,
) -> Result<Vec<DVec2>, PlacementError> {
    let tile = is_periodic.then_some(terrain);
    let wanted = match amount {
        Amount::Fill => None,
        Amount::Count(count) => Some(f64::from(count)),
        Amount::Density(density) => Some((density * region.area()).round()),
        Amount::Map(cells) => {
            let distance = match *rule {
                Rule::PoissonDisc { min_distance_m } => min_distance_m,
                // `document::check` refuses a density map for a grid.
                Rule::Uniform | Rule::Grid { .. } => 0.0,
            };
            return map::map(cells, region, tile, distance, stream);
        }
    };
    if let Some(stems) = wanted.filter(|&wanted| wanted > MOST_STEMS as f64) {
        return Err(PlacementError::TooManyStems { stems, most: MOST_STEMS });
    }
    if let Some(lack) = wanted.and_then(|stems| memory::lacking(stems, STEM_BYTES)) {
        return Err(PlacementError::NoMemory { stems: wanted.unwrap_or_default(), lack });
    }
    let wanted = wanted.map(|wanted| wanted as usize);
    match *rule {
        // `document::check` asks for a number.
        Rule::Uniform => Ok(uniform(region, wanted.unwrap_or(0), stream)),
        Rule::PoissonDisc { min_distance_m } => {
            poisson_disc(region, tile, min_distance_m, wanted, stream)
        }
        Rule::Grid { spacing_m, row_azimuth_deg, jitter_m } => {
            let spacing = DVec2::from(spacing_m);
            let rows =
                StemRows { spacing, azimuth: row_azimuth_deg.to_radians(), jitter: jitter_m };
            rows.places(region, terrain.min, stream)
        }
    }
}
