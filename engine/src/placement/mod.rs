//! Where instances stand: rules and areas to places, places to instances.
//!
//! | step | file |
//! |---|---|
//! | areas to a [`Region`] of known size | `region`, `crossings` |
//! | places: each on its own, at a distance, in rows | `uniform`, `poisson_disc`, `rows` |
//! | what stands there, and how | `stand`, `distribution` |
//! | what is left out | `pattern` |
//!
//! Each number comes from a stream that is keyed by the seed, the instances' name, what it is for,
//! and the number of the stem. So neither threads nor other instances nor one more species move a stem.

mod buckets;
pub mod canopy;
mod crossings;
mod distribution;
mod error;
mod pattern;
mod poisson_disc;
mod region;
mod rows;
mod stand;
#[cfg(test)]
mod tests;
mod uniform;

use glam::DVec2;

use crate::document::{Rule, Stems};
use crate::geometry::Rectangle;
use crate::sampling::Key;

pub use error::PlacementError;
pub use pattern::Pattern;
pub use region::Region;
pub use stand::{Habit, Species, stand};

/// Most stems of one scatter.
const MOST_STEMS: usize = 20_000_000;

/// Places by a rule in a region of the terrain's rectangle, m.
///
/// # Errors
/// No room for so many stems, or more than [`MOST_STEMS`].
pub fn places(
    rule: &Rule,
    stems: &Stems,
    region: &Region,
    terrain: Rectangle,
    is_periodic: bool,
    stream: Key,
) -> Result<Vec<DVec2>, PlacementError> {
    let wanted = match *stems {
        Stems::Fill => None,
        Stems::Count(count) => Some(f64::from(count)),
        Stems::PerHectare(density) => Some((density * region.area() / 1e4).round()),
    };
    if let Some(stems) = wanted.filter(|&wanted| wanted > MOST_STEMS as f64) {
        return Err(PlacementError::TooManyStems { stems, most: MOST_STEMS });
    }
    let wanted = wanted.map(|wanted| wanted as usize);
    match *rule {
        // `document::check` asks for a number.
        Rule::Uniform => Ok(uniform::uniform(region, wanted.unwrap_or(0), stream)),
        Rule::PoissonDisc { min_distance_m } => {
            let tile = is_periodic.then_some(terrain);
            poisson_disc::poisson_disc(region, tile, min_distance_m, wanted, stream)
        }
        Rule::Grid { spacing_m, row_azimuth_deg, jitter_m } => {
            let spacing = DVec2::from(spacing_m);
            let rows =
                rows::Rows { spacing, azimuth: row_azimuth_deg.to_radians(), jitter: jitter_m };
            rows.places(region, terrain.min, stream)
        }
    }
}
