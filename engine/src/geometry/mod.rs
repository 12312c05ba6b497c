//! Small geometry that several modules share: frames, bounds, outward rounding.

mod bounds;
mod frame;
mod pixels;
mod polygon;
mod rounding;

pub use bounds::Bounds;
pub use frame::basis;
pub use pixels::PixelGrid;
pub use polygon::{Polygon, Rectangle};
pub use rounding::{round_down, round_up};
