//! Paths from the sensor, one file an integrator.

mod backward;
mod first_hit;
mod first_order;
mod history;
mod thermal;
mod tracer;

pub(super) use backward::BackwardPath;
pub(super) use first_hit::FirstHitPath;
pub use first_hit::{ComponentColumns, GAP_RINGS};
pub(super) use first_order::FirstOrderPath;
pub(super) use thermal::ThermalPath;
pub(super) use tracer::{PathBatch, PathTracer, write_each};
