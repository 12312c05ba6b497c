use glam::DVec2;

use crate::counts::counted;
use crate::memory::Lack;

/// Error of a rule that cannot place its stems.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum PlacementError {
    #[error(
        "the outline or a hole of the polygon crosses itself or another ring at ({:.3}, {:.3})",
        .at.x, .at.y
    )]
    CrossesItself { polygon: u32, at: DVec2 },
    #[error("the areas have {corners} corners, more than {most}; simplify them")]
    TooManyCorners { corners: usize, most: usize },
    #[error(
        "the areas have a corner at ({:e}, {:e}) m, more than {most:e} m away; check the unit of its \
         coordinates", .at.x, .at.y
    )]
    FarCorner { at: DVec2, most: f64 },
    #[error("the areas cross each other more than {most} times; simplify them")]
    TooManyCrossings { most: usize },
    #[error("the areas are too intricate; simplify them")]
    TooIntricate,
    #[error("no ground of the terrain is left where a stem may stand")]
    NoGround,
    #[error(
        "{stems:.3e} stems are more than {most} for one `Scatter`; use several, or fewer stems"
    )]
    TooManyStems { stems: f64, most: usize },
    #[error("{stems:.3e} stems take {lack}; use fewer")]
    NoMemory { stems: f64, lack: Lack },
    #[error(
        "only {placed} of {} stand {distance} m apart, then no place is left: at random \
         about {at_random:.0} find a place here, and in the tightest order (rows of equilateral \
         triangles) {at_most:.0}", counted(.wanted, "stem")
    )]
    NoRoom { placed: usize, wanted: usize, distance: f64, at_random: f64, at_most: f64 },
    #[error(
        "the raster asks for {} around ({:.1}, {:.1}), {distance} m apart: no place is left \
         there", counted(.wanted, "stem"), .at.x, .at.y
    )]
    NoRoomInMap { wanted: usize, at: DVec2, distance: f64 },
    #[error(
        "a stem and its own image across the border of the periodic scene are {side} m apart, \
         less than {distance} m"
    )]
    TooCloseToItself { distance: f64, side: f64 },
}
