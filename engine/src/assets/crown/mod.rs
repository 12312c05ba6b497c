//! Trees and shrubs generated leaf by leaf.

mod angles;
mod apart;
mod error;
mod grid;
mod heights;
mod leaves;
mod places;
mod shape;
mod stream;
mod wood;

pub use error::CrownError;

use std::ops::RangeInclusive;

use angles::Normals;
use places::Places;

use super::AssetError;
use crate::components::{Mesh, MeshPart};
use crate::document::{CrownShape, GeneratedCrown, LeafProfile, LeafShape};
use crate::memory;

/// Most leaves, or needles, of one crown.
const MOST_LEAVES: f64 = 5e7;

/// Memory of a leaf or needle while the ray engine builds its tree, bytes.
const LEAF_BYTES: u64 = 160;

/// Most clumps of one crown.
const MOST_CLUMPS: u32 = 10_000_000;

/// Most branches of one crown.
const MOST_BRANCHES: u32 = 1_000_000;

/// Lawful lengths, m: what lies outside was not meant in metres.
const LENGTHS: RangeInclusive<f64> = 1e-6..=1e5;

/// Returns whether the place of each leaf is independent of all others.
fn has_independent_leaves(crown: &GeneratedCrown) -> bool {
    crown.overlap && crown.min_distance_m == 0.0
}

/// A crown as a mesh with the parts `leaf` and `wood`, as far as it has them.
///
/// Leaf centres are uniform in the volume of the outline, or follow the profile in height and are
/// uniform in each cross-section; clumps do so in place of leaves, where there are any, and leaves are
/// uniform in what a clump shares with the outline. Normals follow the leaf angle distribution with
/// uniform azimuths, and half of the fronts face down. There are `round(leaf area / area of a leaf)`
/// leaves, of a size adjusted so that their total area is `leaf_area_m2` (to f32 rounding). Squares,
/// rhombi and needles are two triangles each. Leaves that would intersect an earlier one without
/// `overlap`, or whose centre is nearer to that of an earlier one than `min_distance_m`, get another place and
/// keep their normal. Trunk and branches
/// are tapered, closed prisms, their corners on the circles of the given diameters; branches start
/// on the trunk's axis and end near the outline.
///
/// A crown without leaves and without a trunk is an empty mesh, such as the bare reference of a sweep.
///
/// The same specification always gives the same mesh, bit for bit.
///
/// # Errors
/// [`AssetError::Crown`] for what cannot grow: see [`CrownError`].
pub fn grow_crown(crown: &GeneratedCrown) -> Result<Mesh, AssetError> {
    let count = check(crown)?;
    let (places, normals) = (Places::new(crown)?, Normals::new(&crown.leaf_angle)?);
    let mut mesh = leaves::grow(crown, count, &places, &normals)?;
    let (leaf_triangles, leaf_discs) = (mesh.triangles.len() as u32, mesh.discs.len() as u32);
    wood::grow(crown, &mut mesh);
    let triangles = mesh.triangles.len() as u32;
    let parts = [
        ("leaf", 0..leaf_triangles, 0..leaf_discs),
        ("wood", leaf_triangles..triangles, leaf_discs..leaf_discs),
    ];
    let parts = parts.into_iter().filter(|(_, triangles, discs)| triangles.len() + discs.len() > 0);
    let named = |(name, triangles, discs): (&str, _, _)| MeshPart {
        name: name.to_owned(),
        triangles,
        discs,
    };
    mesh.parts = parts.map(named).collect();
    Ok(mesh)
}

/// Number of leaves of a lawful crown.
fn check(crown: &GeneratedCrown) -> Result<usize, CrownError> {
    for (what, value) in
        shape::lengths(&crown.shape).into_iter().chain(leaves::lengths(&crown.leaf))
    {
        check_length(what, value)?;
    }
    if crown.min_distance_m != 0.0 {
        check_length("min_distance_m", crown.min_distance_m)?;
    }
    if crown.base_m.is_nan() || crown.base_m.abs() > *LENGTHS.end() {
        return Err(CrownError::BadBase { value: crown.base_m });
    }
    if let CrownShape::AsymmetricGaussian { widest_m: value, height_m: height, .. } = crown.shape
        && !(0.0..=height).contains(&value)
    {
        return Err(CrownError::BadWidest { value, height });
    }
    if let LeafShape::Shoot { needles, needle_angle_deg: value, .. } = crown.leaf {
        if needles == 0 {
            return Err(CrownError::NoNeedles);
        }
        if !(0.0..=90.0).contains(&value) {
            return Err(CrownError::BadNeedleAngle { value });
        }
    }
    check_trunk(crown)?;
    check_branches(crown)?;
    check_clumps(crown)?;
    let area = crown.leaf_area_m2;
    if !(area >= 0.0 && area.is_finite()) {
        return Err(CrownError::BadArea { value: area });
    }
    if area == 0.0 {
        return Ok(0);
    }
    let leaf = leaves::area(&crown.leaf);
    let count = (area / leaf).round();
    let flat = count * f64::from(leaves::pieces(&crown.leaf));
    if flat > MOST_LEAVES {
        return Err(CrownError::TooManyLeaves { count: flat, most: MOST_LEAVES });
    }
    if let Some(lack) = memory::lacking(flat, LEAF_BYTES) {
        return Err(CrownError::NoMemory { count: flat, lack });
    }
    if count < 1.0 {
        return Err(CrownError::LessThanALeaf { area, leaf });
    }
    Ok(count as usize)
}

fn check_length(what: &'static str, value: f64) -> Result<(), CrownError> {
    if LENGTHS.contains(&value) {
        return Ok(());
    }
    Err(CrownError::BadLength { what, value, least: *LENGTHS.start(), most: *LENGTHS.end() })
}

fn check_trunk(crown: &GeneratedCrown) -> Result<(), CrownError> {
    let Some(trunk) = &crown.trunk else { return Ok(()) };
    check_length("trunk.height_m", trunk.height_m)?;
    check_length("trunk.diameter_m", trunk.diameter_m)?;
    let (tip, foot) = (trunk.tip_diameter_m, trunk.diameter_m);
    if !(0.0..=foot).contains(&tip) {
        return Err(CrownError::TipThickerThanFoot { tip, foot });
    }
    let (height, top) = (trunk.height_m, crown.base_m + shape::height(&crown.shape));
    if height > top {
        return Err(CrownError::TrunkAboveCrown { height, top });
    }
    Ok(())
}

fn check_branches(crown: &GeneratedCrown) -> Result<(), CrownError> {
    let Some(branches) = &crown.branches else { return Ok(()) };
    let Some(trunk) = &crown.trunk else { return Err(CrownError::BranchesWithoutTrunk) };
    check_length("branches.diameter_m", branches.diameter_m)?;
    if !(0.0..=180.0).contains(&branches.zenith_deg) {
        return Err(CrownError::BadZenith { value: branches.zenith_deg });
    }
    if branches.count > MOST_BRANCHES {
        return Err(CrownError::TooManyBranches { count: branches.count, most: MOST_BRANCHES });
    }
    if trunk.height_m <= crown.base_m {
        let (height, base) = (trunk.height_m, crown.base_m);
        return Err(CrownError::TrunkBelowCrown { height, base });
    }
    Ok(())
}

fn check_clumps(crown: &GeneratedCrown) -> Result<(), CrownError> {
    let Some(clumps) = &crown.clumps else { return Ok(()) };
    check_length("clumps.radius_m", clumps.radius_m)?;
    check_length("clumps.height_m", clumps.height_m.unwrap_or(clumps.radius_m))?;
    if !(1..=MOST_CLUMPS).contains(&clumps.count) {
        return Err(CrownError::BadClumpCount { count: clumps.count, most: MOST_CLUMPS });
    }
    if clumps.on_branches && crown.branches.as_ref().is_none_or(|branches| branches.count == 0) {
        return Err(CrownError::ClumpsWithoutBranches);
    }
    if clumps.on_branches && crown.leaf_profile != LeafProfile::Even {
        return Err(CrownError::ClumpsWithProfile);
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests;
