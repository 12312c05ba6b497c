//! Data structures of the ray engine as they lie in memory.
//!
//! Nothing here builds a hierarchy or follows a ray: `build` fills these types, `traversal` reads them. They are
//! made of the vectors of `simd`.

mod bounds;
mod instance;
mod leaf;
mod mesh;
mod node;
mod two_level;

pub(super) use bounds::{Bounds32, slab_padding};
pub(super) use instance::{InstanceRecord, PeriodicCopies};
pub(super) use leaf::{DiscBlock, PARALLELOGRAM, PlanarBlock};
pub(super) use mesh::{MeshBvh, SurfaceRange};
pub(super) use node::{ChildRef, WideBvh, WideNode};
pub(super) use two_level::MIN_FETCHED_BYTES;
pub use two_level::{BvhMemory, Domain, TwoLevelBvh};
