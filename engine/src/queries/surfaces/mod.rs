//! Surfaces of plants as they stand in the world: trees over the meshes, placements, cuts by planes.

mod disc_area;
mod ground_heights;
mod patch;
mod placed;
mod planted;
mod span;
mod tree;

pub(super) use ground_heights::GroundHeights;
pub(super) use patch::{FlatPatch, PatchPiece};
pub(super) use placed::{MaterialTree, PlacedBox, PlacementTransform, prototype_trees};
pub(super) use planted::PlantedGround;
pub(super) use span::CoordinateSpan;
pub(super) use tree::{SurfaceTree, TreeNode};
