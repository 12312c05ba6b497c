use crate::counts::counted;
use crate::memory::Lack;

/// Error of a crown that cannot be generated.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum CrownError {
    #[error("{what} is {value}; write a length in metres between {least:e} and {most:e}")]
    BadLength { what: &'static str, value: f64, least: f64, most: f64 },
    #[error("base_m is {value}; write the height of the crown's lowest point in metres")]
    BadBase { value: f64 },
    #[error("leaf_area_m2 is {value}; write a finite area, 0 or above")]
    BadArea { value: f64 },
    #[error(
        "leaf_area_m2 and the leaf's size make {count:e} leaves, more than {most:e}; use fewer or \
         larger leaves, or several instances of a smaller crown"
    )]
    TooManyLeaves { count: f64, most: f64 },
    #[error(
        "leaf_area_m2 and the leaf's size make {count:e} leaves, which take {lack}; use fewer or larger \
         leaves, or several instances of a smaller crown"
    )]
    NoMemory { count: f64, lack: Lack },
    #[error("leaf_area_m2 is {area}, less than half of one leaf of {leaf} m²; use smaller leaves")]
    LessThanALeaf { area: f64, leaf: f64 },
    #[error(
        "overlap is false, and only {placed} of {} find a place where they intersect no other; \
         use smaller leaves, less leaf_area_m2, a larger crown or larger clumps, or leave out overlap",
        counted(.count, "leaf")
    )]
    NoRoom { placed: u64, count: u64 },
    #[error(
        "min_distance_m is {distance}, and only {placed} of {} find a place so far from all others; \
         about {possible} m is possible here: use that, less leaf_area_m2, larger leaves, a larger \
         crown or larger clumps",
        counted(.count, "leaf")
    )]
    NoRoomAtDistance { placed: u64, count: u64, distance: f64, possible: f64 },
    #[error("trunk.tip_diameter_m is {tip}; write 0 up to trunk.diameter_m = {foot}")]
    TipThickerThanFoot { tip: f64, foot: f64 },
    #[error(
        "trunk.height_m is {height}, above the crown's top at {top} m; shorten the trunk or raise \
         the crown"
    )]
    TrunkAboveCrown { height: f64, top: f64 },
    #[error("branches need a trunk to grow from; give a trunk")]
    BranchesWithoutTrunk,
    #[error(
        "trunk.height_m is {height}, below the crown's base at {base} m, so no branch can start in \
         the crown; lengthen the trunk or leave out the branches"
    )]
    TrunkBelowCrown { height: f64, base: f64 },
    #[error("branches.zenith_deg is {value}; write an angle from 0 (up) to 180 (down)")]
    BadZenith { value: f64 },
    #[error("branches.count is {count}, more than {most}")]
    TooManyBranches { count: u32, most: u32 },
    #[error("shape.widest_m is {value}; write a height from 0 to shape.height_m = {height}")]
    BadWidest { value: f64, height: f64 },
    #[error("leaf_angle.{what} is {value}; write a number from {least} to {most}")]
    BadLeafAngle { what: &'static str, value: f64, least: f64, most: f64 },
    #[error("leaf_angle needs either x or mean_deg, and not both")]
    RatioOrMean,
    #[error("leaf.needles is 0; a shoot has at least one needle")]
    NoNeedles,
    #[error("leaf.needle_angle_deg is {value}; write an angle from 0 (along the twig) to 90")]
    BadNeedleAngle { value: f64 },
    #[error("leaf_profile has {points} point(s); write at least two, from the lowest up")]
    ShortProfile { points: usize },
    #[error(
        "leaf_profile[{index}] is ({height}, {leaves}); write a height in metres and an amount of \
         leaves, 0 or above"
    )]
    BadProfile { index: usize, height: f64, leaves: f64 },
    #[error("leaf_profile[{index}] is lower than the point before; write them from the lowest up")]
    ProfileNotUpwards { index: usize },
    #[error("leaf_profile has no leaves within the crown, from {base} to {top} m above the ground")]
    ProfileBesideCrown { base: f64, top: f64 },
    #[error("clumps.count is {count}; write a number from 1 to {most}")]
    BadClumpCount { count: u32, most: u32 },
    #[error("clumps.on_branches needs branches; give the crown branches, or leave it out")]
    ClumpsWithoutBranches,
    #[error(
        "clumps.on_branches and a leaf_profile exclude each other: branches decide how high the \
         clumps are; leave out one of the two"
    )]
    ClumpsWithProfile,
}
